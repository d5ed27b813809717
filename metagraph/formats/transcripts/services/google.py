"""Google Cloud Speech-to-Text: results[].alternatives[0].words[], version 1 with `startTime`, version 2 with
`startOffset`, as "1.300s" or as seconds and nanos; and Video Intelligence's speechTranscriptions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import (
    list_of,
    list_row_dicts,
    name_of,
    parse_json_seconds,
    parse_text,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_STARTS = ("startTime", "startOffset", "start_time", "start_offset")
_ENDS = ("endTime", "endOffset", "end_time", "end_offset")
_WHO = ("speakerLabel", "speakerTag", "speaker_label", "speaker_tag")


def is_google(source: TranscriptSource) -> bool:
    if any("resultEndTime" in r or "resultEndOffset" in r for r in _results(source.data)):
        return True
    for one in _best(source.data):
        words = one.get("words")
        first = words[0] if isinstance(words, list) and words else None
        if isinstance(first, dict):
            return any(k in first for k in (*_STARTS, *_ENDS))
    return False


def _results(data: Any, depth: int = 0) -> Iterator[Mapping[str, Any]]:
    """Yield the results of an answer, however it is wrapped: `response` of an operation, a file of a
    batch.
    """
    if not isinstance(data, dict) or depth > 6:
        return
    for key in ("results", "speechTranscriptions", "annotationResults"):
        value = data.get(key)
        if isinstance(value, list):
            for one in value:
                if isinstance(one, dict) and "alternatives" in one:
                    yield one
                else:
                    yield from _results(one, depth + 1)
        elif isinstance(value, dict):
            for one in value.values():
                yield from _results(one, depth + 1)
    for key in ("response", "transcript", "inlineResult", "inline_result"):
        yield from _results(data.get(key), depth + 1)


def _best(data: Any) -> Iterator[Mapping[str, Any]]:
    for one in _results(data):
        tries = one.get("alternatives")
        if isinstance(tries, list) and tries and isinstance(tries[0], dict):
            yield tries[0]


def _of(word: Mapping[str, Any], keys: tuple[str, ...]) -> Any:
    return next((word[k] for k in keys if word.get(k) is not None), None)


def read_google(source: TranscriptSource) -> Transcript:
    """Read words by their speaker tag, else by their channel.

    With speakers, version 1 repeats all words in the last result, and only there with the tags: then that one
    counts. A start that is left out is 0. Raises FileError.
    """
    out = Collected(source.path)
    found: list[tuple[str, list[dict[str, Any]], str]] = []
    untimed = 0
    for n, (result, best) in enumerate(zip(_results(source.data), _best(source.data), strict=False)):
        words = []
        place = f"results[{n}].alternatives[0]"
        for where, word in list_row_dicts(out, best, "words", place):
            end = parse_json_seconds(out, _of(word, _ENDS), where)
            start = parse_json_seconds(out, _of(word, _STARTS), where)
            words.append(
                {
                    "word": parse_text(word.get("word")),
                    "start": 0.0 if start is None and end is not None else start,
                    "end": end,
                    "speaker": _speaker(word),
                }
            )
        untimed += not words and bool(parse_text(best.get("transcript")).strip())
        if words:
            found.append((name_of(result.get("channelTag", "")), words, place))
    tags = [any(w["speaker"] for w in words) for _, words, _ in found]
    before = sum(len(words) for _, words, _ in found[:-1])
    if before and tags[-1] and not any(tags[:-1]) and len(found[-1][1]) >= before:
        found = found[-1:]
    if untimed and not found:
        raise out.fail(
            phrase("its words have no times"),
            "'results'",
            phrase("Request word times from the service (enableWordTimeOffsets)."),
        )
    if untimed:
        out.notes.append(phrase("skipped {untimed} results without times", untimed=untimed))
    several = len({channel for channel, _, _ in found}) > 1
    for channel, words, place in found:
        add_words(out, list_of(out, words, place), channel if several else "", f"{place}.words")
    return out.finished()


def _speaker(word: Mapping[str, Any]) -> str:
    tag = name_of(_of(word, _WHO) or "")
    return "" if tag == "0" else tag
