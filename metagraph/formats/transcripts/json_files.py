"""JSON transcripts without a service's marks: Whisper and its kin (openai-whisper, faster-whisper, WhisperX,
the API's verbose JSON, whisper.cpp, Transformers), plain lists of words, IBM's, Vosk's, and what
`metagraph speech` writes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_values import (
    list_of,
    list_row_dicts,
    name_of,
    parse_json_number,
    parse_json_seconds,
    parse_text,
    require_dict,
    timed_row_of,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.speaker_names import find_speaker_names
from metagraph.formats.transcripts.units import infer_time_unit
from metagraph.formats.transcripts.words import Collected, Transcript

_REMEDY = phrase(
    "Whisper writes 'segments', with 'words' if word timestamps were "
    "requested; IBM writes 'results' with 'timestamps'."
)


def is_word_list(source: TranscriptSource) -> bool:
    """Return whether JSON holds segments or words with their times."""
    return (
        bool(_rows(source.data) or {"segments", "words", "word_segments"} & source.keys) or source.data == []
    )


def is_saved_conversation(source: TranscriptSource) -> bool:
    """Return whether JSON is a conversation as `metagraph speech` writes it."""
    return "sides" in source.keys and isinstance(source.data, dict)


def read_saved_conversation(source: TranscriptSource) -> Transcript:
    """Read what `metagraph speech` writes. Raises FileError."""
    import msgspec

    from metagraph.graph.conversation.model import Conversation

    out = Collected(source.path)
    try:
        read = msgspec.json.decode(source.text, type=Conversation)
    except (msgspec.ValidationError, msgspec.DecodeError, ValueError) as error:
        raise out.fail(
            phrase("is not a conversation as 'metagraph speech' writes it: {error}", error=error)
        ) from None
    names = [side.name or str(n + 1) for n, side in enumerate(read.sides)]
    if len(set(names)) < len(names):
        names = [str(n + 1) for n in range(len(names))]
    for name, side in zip(names, read.sides, strict=True):
        out.speakers[name] = []
        for word in side.words:
            out.add(name, word.text, word.start, word.end, whole=True)
    return out.finished({name: side.segments for name, side in zip(names, read.sides, strict=True)})


def _rows(data: Any) -> list[Any]:
    """Return a plain list of segments or words; empty where data is none."""
    if not isinstance(data, list) or not data or not isinstance(data[0], dict):
        return []
    first = timed_row_of(data[0])
    return data if first.text and (first.start is not None or first.end is not None) else []


def infer_unit(out: Collected, source: TranscriptSource) -> None:
    """Settle which unit a file's times have, by all texts that have a start and an end in it."""
    out.unit, told = infer_time_unit(_timed_texts(source.data), source.sound.seconds)
    if told is not None:
        out.notes.append(told)


def _timed_texts(data: Any) -> Iterator[tuple[float, float, str]]:
    """Yield starts, ends and texts of all objects that have them, however deep they lie."""
    waiting = [data]
    while waiting:
        value = waiting.pop()
        if isinstance(value, list):
            waiting.extend(value)
        elif isinstance(value, dict):
            waiting.extend(value.values())
            row = timed_row_of(value)
            start, end, length = (
                parse_json_number(row.start),
                parse_json_number(row.end),
                parse_json_number(row.length),
            )
            if end is None and start is not None and length is not None:
                end = start + length
            known = start is not None and end is not None and not row.milliseconds
            if known and abs(start or 0.0) + abs(end or 0.0) < 1e15:
                yield start or 0.0, end or 0.0, row.text


def read_word_list(source: TranscriptSource) -> Transcript:
    """Read segments, with words in them or beside them, or words alone. Raises FileError."""
    out, data = Collected(source.path), source.data
    infer_unit(out, source)
    if isinstance(data, list):
        texts = any(isinstance(x, dict) and "text" in x for x in data)
        segments = any(isinstance(x, dict) and "text" in x and x.get("words") for x in data)
        data = {"segments": data} if texts or segments else {"words": data}
    if "segments" in data:
        _segments(out, data)
    else:
        key = "word_segments" if "word_segments" in data else "words"
        add_words(out, list_of(out, data[key], key), "", key)
    return out.finished()


def _segments(out: Collected, data: Mapping[str, Any]) -> None:
    rows = list_of(out, data["segments"], "segments")
    inside = any(isinstance(r, dict) and r.get("words") for r in rows)
    beside = data.get("word_segments") or data.get("words")
    if not inside and beside:  # the API's verbose JSON lists words apart
        add_words(out, list_of(out, beside, "words"), "", "words")
        return
    names = find_speaker_names([[parse_text(r.get("text"))] for r in rows if isinstance(r, dict)])
    names.tell(out)
    before = ""
    for n, row in enumerate(rows):
        where = f"segments[{n}]"
        one = require_dict(out, row, where)
        speaker = name_of(one.get("speaker", one.get("channel", "")))
        timed = timed_row_of(one)
        start, end = timed.span(out, where)
        if one.get("words"):
            words = list_of(out, one["words"], f"{where}.words")
            add_words(out, words, speaker, f"{where}.words", (start, end))
        elif start is None or end is None:
            raise out.fail(phrase("has no start and end"), where, _REMEDY)
        else:
            named = None if speaker else names.part(timed.text)
            who, said = named if named is not None else (speaker or before, timed.text)
            out.add(who, said, start, end, where)
            before = who


def _word(out: Collected, row: Any, speaker: str, where: str) -> tuple[str, str, float | None, float | None]:
    """Return speaker, text, start and end of a word: an object, or faster-whisper's tuple as a list of start,
    end, word and probability.
    """
    if isinstance(row, list) and len(row) >= 3 and isinstance(row[2], str):
        row = {"start": row[0], "end": row[1], "word": row[2]}
    one = require_dict(out, row, where)
    timed = timed_row_of(one)
    who = name_of(one.get("speaker", one.get("speaker_id", "")))
    return (who or speaker, timed.text, *timed.span(out, where))


def add_words(
    out: Collected,
    rows: Sequence[Any],
    speaker: str,
    where: str,
    span: tuple[float | None, float | None] | None = None,
) -> None:
    """Add words; those without times (WhisperX gives numbers none, Gentle what it did not find) share what is
    between their neighbours. span: when the first begins and the last ends at the latest. Raises FileError.
    """
    read = [_word(out, row, speaker, f"{where}[{n}]") for n, row in enumerate(rows)]
    timed = [r for r in read if r[2] is not None and r[3] is not None]
    if read and not timed and (span is None or None in span):
        raise out.fail(phrase("no word has a start and an end"), where, _REMEDY)
    first = span[0] if span is not None and span[0] is not None else timed[0][2] if timed else 0.0
    last = span[1] if span is not None and span[1] is not None else timed[-1][3] if timed else 0.0
    n = 0
    while n < len(read):
        who, text, start, end = read[n]
        if start is not None and end is not None:
            out.add(who, text, start, end, f"{where}[{n}]")
            n += 1
            continue
        behind = n
        while behind < len(read) and (read[behind][2] is None or read[behind][3] is None):
            behind += 1
        begin = (read[n - 1][3] if n else first) or 0.0
        until = (read[behind][2] if behind < len(read) else last) or begin
        step = max(until - begin, 0.0) / (behind - n)
        for m in range(n, behind):
            out.add(
                read[m][0], read[m][1], begin + step * (m - n), begin + step * (m - n + 1), f"{where}[{m}]"
            )
        out.spread += behind - n
        n = behind


# --- whisper.cpp, Transformers, Vosk


def is_whisper_cpp(source: TranscriptSource) -> bool:
    return isinstance(source.data, dict) and isinstance(source.data.get("transcription"), list)


def read_whisper_cpp(source: TranscriptSource) -> Transcript:
    """Read `transcription`, whose `offsets` are milliseconds. Raises FileError."""
    out = Collected(source.path)
    for where, row in list_row_dicts(out, source.data, "transcription"):
        at = require_dict(out, row.get("offsets") or {}, f"{where}.offsets")
        start, end = (parse_json_seconds(out, at.get(key), where, 1e-3) for key in ("from", "to"))
        if start is None or end is None:
            raise out.fail(phrase("has no start and end"), where, _REMEDY)
        speaker = name_of(row.get("speaker", ""))
        out.add(speaker, parse_text(row.get("text")), start, end, where)
    return out.finished()


def is_transformers(source: TranscriptSource) -> bool:
    return isinstance(source.data, dict) and isinstance(source.data.get("chunks"), list)


def read_transformers(source: TranscriptSource) -> Transcript:
    """Read `chunks`, each with its `timestamp`: start and end in seconds, the last end perhaps null. Raises
    FileError.
    """
    out = Collected(source.path)
    for where, row in list_row_dicts(out, source.data, "chunks"):
        at = list_of(out, row.get("timestamp"), f"{where}.timestamp")
        start = parse_json_seconds(out, at[0] if at else None, where)
        end = parse_json_seconds(out, at[1] if len(at) > 1 else None, where)
        if start is None:
            raise out.fail(phrase("has no start and end"), where, _REMEDY)
        out.add(
            name_of(row.get("speaker", "")), parse_text(row.get("text")), start, start if end is None else end
        )
    return out.finished()


def is_nemo(source: TranscriptSource) -> bool:
    stamps = source.data.get("timestamp") if isinstance(source.data, dict) else None
    return isinstance(stamps, dict) and bool({"word", "segment"} & set(stamps))


def read_nemo(source: TranscriptSource) -> Transcript:
    """Read `timestamp`: its words, or else its segments. Raises FileError."""
    out = Collected(source.path)
    stamps = source.data["timestamp"]
    key = "word" if stamps.get("word") else "segment"
    rows = [
        {**row, "word": parse_text(row.get("word", row.get("segment")))} if isinstance(row, dict) else row
        for row in list_of(out, stamps.get(key) or [], f"timestamp.{key}")
    ]
    add_words(out, rows, "", f"timestamp.{key}")
    return out.finished()


def is_vosk(source: TranscriptSource) -> bool:
    return "result" in source.keys and "text" in source.keys


def read_vosk(source: TranscriptSource) -> Transcript:
    """Read `result`, one object a line or a list of them; seconds. Raises FileError."""
    out = Collected(source.path)
    several = source.data if isinstance(source.data, list) else [source.data]
    for n, item in enumerate(several):
        one = require_dict(out, item, f"[{n}]")
        if one.get("result"):
            add_words(out, list_of(out, one["result"], f"[{n}].result"), "", f"[{n}].result")
    return out.finished()


# --- IBM


def is_ibm(source: TranscriptSource) -> bool:
    return "results" in source.keys


def read_ibm(source: TranscriptSource) -> Transcript:
    """results[].alternatives[0].timestamps: [word, start, end]; speaker_labels[]: from, to, speaker."""
    out, data = Collected(source.path), source.data
    if isinstance(data, list):
        data = {
            "results": [r for _, x in _objects(out, data) for r in list_of(out, x.get("results"), "results")],
            "speaker_labels": [
                s
                for _, x in _objects(out, data)
                for s in list_of(out, x.get("speaker_labels") or [], "speaker_labels")
            ],
        }
    labels: dict[float, str] = {}
    for where, row in list_row_dicts(out, data, "speaker_labels"):
        at = parse_json_seconds(out, row.get("from"), where)
        if at is not None:
            labels[round(at, 2)] = name_of(row.get("speaker", ""))
    words = untimed = 0
    for n, row in enumerate(list_of(out, data["results"], "results")):
        where = f"results[{n}]"
        one = require_dict(out, row, where)
        tries = list_of(out, one.get("alternatives") or [], f"{where}.alternatives")
        if one.get("final") is False or not tries:
            continue
        best = require_dict(out, tries[0], f"{where}.alternatives[0]")
        stamps = list_of(out, best.get("timestamps") or [], f"{where}.timestamps")
        untimed += not stamps and bool(parse_text(best.get("transcript")).strip())
        for m, stamp in enumerate(stamps):
            place = f"{where}.timestamps[{m}]"
            if not isinstance(stamp, list) or len(stamp) < 3 or not isinstance(stamp[0], str):
                raise out.fail(phrase("is not a word with its start and end"), place, _REMEDY)
            start, end = parse_json_seconds(out, stamp[1], place), parse_json_seconds(out, stamp[2], place)
            if start is None or end is None:
                raise out.fail(phrase("is not a word with its start and end"), place, _REMEDY)
            out.add(labels.get(round(start, 2), next(iter(labels.values()), "")), stamp[0], start, end, place)
            words += 1
    if untimed and not words:
        raise out.fail(
            phrase("its words have no times"),
            "'results'",
            phrase("Request timestamps from the service (timestamps=true)."),
        )
    if untimed:
        out.notes.append(phrase("skipped {untimed} results without times", untimed=untimed))
    return out.finished()


def _objects(out: Collected, data: Sequence[Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for n, item in enumerate(data):
        yield f"[{n}]", require_dict(out, item, f"[{n}]")
