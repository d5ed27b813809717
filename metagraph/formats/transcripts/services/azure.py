"""Azure Speech: batch transcription (recognizedPhrases), fast transcription (phrases) and the Speech SDK's
detailed results (NBest). Times are ticks of 100 ns, `...Milliseconds`, or ISO 8601 durations such as PT1.5S.
"""

from __future__ import annotations

from collections.abc import Mapping
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

_TICK = 1e-7  # seconds
_PHRASES = ("recognizedphrases", "phrases")


def is_azure(source: TranscriptSource) -> bool:
    keys = {k.lower() for k in source.keys}
    return bool(keys & {"recognizedphrases", "combinedrecognizedphrases", "combinedphrases"}) or (
        {
            "offset",
            "duration",
        }
        <= keys
        and bool(keys & {"nbest", "displaytext", "recognitionstatus"})
    )


def read_azure(source: TranscriptSource) -> Transcript:
    """Read phrases by their speaker, else by their channel. Raises FileError."""
    out = Collected(source.path)
    some = source.data if isinstance(source.data, list) else [source.data]
    found: list[tuple[str, dict[str, Any]]] = []
    for n, item in enumerate(some):
        where, one = f"[{n}]", _lower(item)
        key = next((k for k in _PHRASES if k in one), None)
        if key is None:
            found.append((where, one))
            continue
        for m, row in enumerate(list_of(out, one[key], key)):
            found.append((f"{key}[{m}]", _lower(row)))
    speakers = {name_of(p.get("speaker", p.get("speakerid", ""))) for _, p in found} - {""}
    channels = {name_of(p.get("channel", "")) for _, p in found}
    for where, one in found:
        who = name_of(one.get("speaker", one.get("speakerid", ""))) if speakers else ""
        if len(channels) > 1:
            channel = name_of(one.get("channel", ""))
            who = f"{channel} {who}".strip() if len(speakers) > 1 else channel
        _phrase(out, one, who, where)
    return out.finished()


def _lower(value: Any) -> dict[str, Any]:
    return {k.lower(): v for k, v in value.items()} if isinstance(value, dict) else {}


def _span(out: Collected, one: Mapping[str, Any], where: str) -> tuple[float | None, float | None]:
    """Return start and end of a phrase or a word."""
    ends: list[float | None] = []
    for name in ("offset", "duration"):
        milliseconds, ticks = one.get(f"{name}milliseconds"), one.get(f"{name}inticks")
        if milliseconds is not None:
            ends.append(parse_json_seconds(out, milliseconds, where, 1e-3))
        elif ticks is not None:
            ends.append(parse_json_seconds(out, ticks, where, _TICK))
        else:
            ends.append(parse_json_seconds(out, one.get(name), where, _TICK))
    start, length = ends
    return start, None if start is None or length is None else start + length


def _phrase(out: Collected, one: dict[str, Any], who: str, where: str) -> None:
    status = one.get("recognitionstatus")
    if status not in (None, "Success", 0):
        return
    best = one
    for _, row in list(list_row_dicts(out, one, "nbest", where))[:1]:
        best = _lower(row)
    start, end = _span(out, one, where)
    rows = best.get("displaywords") or best.get("words") or one.get("words")
    if rows:
        words = []
        for n, row in enumerate(list_of(out, rows, f"{where}.words")):
            word = _lower(row)
            begin, until = _span(out, word, f"{where}.words[{n}]")
            text = parse_text(word.get("word", word.get("displaytext", word.get("text"))))
            words.append({"word": text, "start": begin, "end": until})
        add_words(out, words, who, f"{where}.words", (start, end))
        return
    text = parse_text(best.get("display", best.get("text", one.get("displaytext"))))
    if not text.strip():
        return
    if start is None or end is None:
        raise out.fail(phrase("has no start and end"), where)
    out.add(who, text, start, end, where)
