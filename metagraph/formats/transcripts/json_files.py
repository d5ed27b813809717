"""JSON transcripts: those of Whisper and its kin (openai-whisper, faster-whisper, WhisperX, the API's verbose
JSON), of IBM Speech to Text, and what `metagraph speech` writes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from statistics import median
from typing import Any

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.transcripts.words import Collected, Transcript

_REMEDY = phrase(
    "Whisper writes 'segments', with 'words' if word timestamps were "
    "requested; IBM writes 'results' with 'timestamps'."
)
_SLOWEST = 3.0  # seconds a letter: the slowest speech has a fifth of that, a word in milliseconds 20 or more
_FASTEST = 0.015  # seconds a letter: hurried speech has twice that


def read_json(path: Path, text: str) -> Transcript:
    """Read a JSON transcript. Raises FileError."""
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise FileError(
            path,
            phrase("is not JSON ({msg})", msg=error.msg),
            phrase("line {lineno}, column {colno}", lineno=error.lineno, colno=error.colno),
            phrase("Save the transcript again."),
        ) from None
    except (RecursionError, ValueError):
        raise FileError(
            path, phrase("its lists are nested too deep, or its numbers are too long"), "", _REMEDY
        ) from None
    out = Collected(path)
    if isinstance(data, dict) and "sides" in data:
        return _ours(out, text)
    if _in_milliseconds(data):
        out.unit = 0.001
        out.notes.append(phrase("its times are whole numbers too large for seconds: read as milliseconds"))
    if isinstance(data, list):
        if all(isinstance(x, dict) and "results" in x for x in data) and data:
            data = {
                "results": [r for x in data for r in _list(out, x["results"], "results")],
                "speaker_labels": [
                    s for x in data for s in _list(out, x.get("speaker_labels") or [], "speaker_labels")
                ],
            }
        else:
            data = (
                {"segments": data}
                if any(isinstance(x, dict) and "text" in x for x in data)
                else {"words": data}
            )
    if "results" in data:
        _ibm(out, data)
    elif "segments" in data:
        _whisper(out, data)
    elif "word_segments" in data or "words" in data:
        key = "word_segments" if "word_segments" in data else "words"
        _words(out, _list(out, data[key], key), "", key, None)
    else:
        names = ", ".join(f"'{str(k)[:30]}'" for k in list(data)[:6]) or "nothing"
        raise FileError(
            path,
            phrase("is JSON, but not of a known transcript format; it contains {names}", names=names),
            "",
            _REMEDY,
        )
    return out.finished()


def _ours(out: Collected, text: str) -> Transcript:
    import msgspec

    from metagraph.graph.conversation.model import Conversation

    try:
        read = msgspec.json.decode(text, type=Conversation)
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


def _list(out: Collected, value: Any, where: str) -> Sequence[Any]:
    if not isinstance(value, list):
        raise out.fail(phrase("is {kind}, not a list", kind=_kind(value)), f"'{where}'", _REMEDY)
    return value


def _dict(out: Collected, value: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise out.fail(phrase("is {kind}, not an object", kind=_kind(value)), f"'{where}'", _REMEDY)
    return value


def _kind(value: Any) -> str:
    names = {
        dict: phrase("an object"),
        list: phrase("a list"),
        str: phrase("a text"),
        bool: phrase("true or false"),
        int: phrase("a number"),
        float: phrase("a number"),
    }
    return names.get(type(value), phrase("nothing"))


def _time(out: Collected, value: Any, where: str) -> float | None:
    """Return seconds; None if there are none."""
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise out.fail(phrase("a time is {kind}", kind=_kind(value)), where)
    try:
        seconds = float(value)
    except (ValueError, OverflowError):
        raise out.fail(phrase("a time is '{value}'", value=str(value)[:30]), where) from None
    if not math.isfinite(seconds):
        raise out.fail(phrase("a time is {seconds:g}", seconds=seconds), where)
    return seconds * out.unit


def _in_milliseconds(data: Any) -> bool:
    """Return whether every time of a text is a whole number, and half of the texts would last over
    `_SLOWEST` seconds a letter if these were seconds, and no less than `_FASTEST` if they are milliseconds.
    """
    lengths = []
    for start, end, text in _timed_texts(data):
        if not (float(start).is_integer() and float(end).is_integer()):
            return False
        letters = sum(c.isalnum() for c in text)
        if letters:
            lengths.append((end - start) / letters)
    return bool(lengths) and median(lengths) > max(_SLOWEST, 1000 * _FASTEST)


def _timed_texts(data: Any) -> Iterator[tuple[float, float, str]]:
    """Yield starts, ends and texts of all objects that have them, however deep they lie."""
    waiting = [data]
    while waiting:
        value = waiting.pop()
        if isinstance(value, list):
            waiting.extend(value)
        elif isinstance(value, dict):
            waiting.extend(value.values())
            start, end = (_number(value.get(key)) for key in ("start", "end"))
            text = _text(value.get("word", value.get("text", value.get("punctuated_word"))))
            if start is not None and end is not None and abs(start) + abs(end) < 1e15:
                yield start, end, text


def _number(value: Any) -> float | None:
    """Return a number, also one that is written as text."""
    if isinstance(value, int | float | str) and not isinstance(value, bool):
        with suppress(ValueError, OverflowError):
            return float(value)
    return None


def _text(value: Any) -> str:
    return value if isinstance(value, str) else ""


def _name(value: Any) -> str:
    return str(value).strip() if isinstance(value, str | int | float) and not isinstance(value, bool) else ""


# --- Whisper


def _whisper(out: Collected, data: Mapping[str, Any]) -> None:
    rows = _list(out, data["segments"], "segments")
    inside = any(isinstance(r, dict) and r.get("words") for r in rows)
    beside = data.get("word_segments") or data.get("words")
    if not inside and beside:  # the API's verbose JSON lists words apart
        _words(out, _list(out, beside, "words"), "", "words", None)
        return
    for n, row in enumerate(rows):
        where = f"segments[{n}]"
        one = _dict(out, row, where)
        speaker = _name(one.get("speaker", one.get("channel", "")))
        start, end = _time(out, one.get("start"), where), _time(out, one.get("end"), where)
        if one.get("words"):
            _words(out, _list(out, one["words"], f"{where}.words"), speaker, f"{where}.words", (start, end))
        elif start is None or end is None:
            raise out.fail(phrase("has no start and end"), where)
        else:
            out.add(speaker, _text(one.get("text")), start, end, where)


def _words(
    out: Collected,
    rows: Sequence[Any],
    speaker: str,
    where: str,
    span: tuple[float | None, float | None] | None,
) -> None:
    """Add words; those without times (WhisperX gives numbers none) share what is between their neighbours."""
    read: list[tuple[str, str, float | None, float | None]] = []
    for n, row in enumerate(rows):
        one = _dict(out, row, f"{where}[{n}]")
        text = _text(one.get("word", one.get("text", one.get("punctuated_word"))))
        place = f"{where}[{n}]"
        read.append(
            (
                _name(one.get("speaker", "")) or speaker,
                text,
                _time(out, one.get("start"), place),
                _time(out, one.get("end"), place),
            )
        )
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


# --- IBM


def _ibm(out: Collected, data: Mapping[str, Any]) -> None:
    """results[].alternatives[0].timestamps: [word, start, end]; speaker_labels[]: from, to, speaker."""
    labels: dict[float, str] = {}
    for n, row in enumerate(_list(out, data.get("speaker_labels") or [], "speaker_labels")):
        one = _dict(out, row, f"speaker_labels[{n}]")
        at = _time(out, one.get("from"), f"speaker_labels[{n}]")
        if at is not None:
            labels[round(at, 2)] = _name(one.get("speaker", ""))
    words = untimed = 0
    for n, row in enumerate(_list(out, data["results"], "results")):
        where = f"results[{n}]"
        one = _dict(out, row, where)
        tries = _list(out, one.get("alternatives") or [], f"{where}.alternatives")
        if one.get("final") is False or not tries:
            continue
        best = _dict(out, tries[0], f"{where}.alternatives[0]")
        stamps = _list(out, best.get("timestamps") or [], f"{where}.timestamps")
        untimed += not stamps and bool(_text(best.get("transcript")).strip())
        for m, stamp in enumerate(stamps):
            place = f"{where}.timestamps[{m}]"
            if not isinstance(stamp, list) or len(stamp) < 3 or not isinstance(stamp[0], str):
                raise out.fail(phrase("is not a word with its start and end"), place, _REMEDY)
            start, end = _time(out, stamp[1], place), _time(out, stamp[2], place)
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
