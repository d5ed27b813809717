"""Values of JSON transcripts, checked as they are taken out: lists, objects, times, texts and names."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.words import Collected

REMEDY_JSON = phrase("Save the transcript again as the service returns it, with the times of its words.")
_CLOCK = re.compile(r"(?:(\d{1,4}):)?(\d{1,2}):(\d{1,2}(?:[.,]\d{1,9})?)$")
_SECONDS = re.compile(r"([0-9]{1,12}(?:\.[0-9]{1,12})?)s$")
_ISO = re.compile(r"PT(?:(\d{1,4})H)?(?:(\d{1,5})M)?(?:(\d{1,9}(?:\.\d{1,9})?)S)?$")


def list_of(out: Collected, value: Any, where: str) -> Sequence[Any]:
    """Return a list. Raises FileError for anything else."""
    if not isinstance(value, list):
        raise out.fail(phrase("is {kind}, not a list", kind=_kind(value)), f"'{where}'", REMEDY_JSON)
    return value


def require_dict(out: Collected, value: Any, where: str) -> Mapping[str, Any]:
    """Return an object. Raises FileError for anything else."""
    if not isinstance(value, dict):
        raise out.fail(phrase("is {kind}, not an object", kind=_kind(value)), f"'{where}'", REMEDY_JSON)
    return value


def list_row_dicts(
    out: Collected, data: Mapping[str, Any], key: str, where: str = ""
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the place and the value of each object in a list that an object holds; nothing where it holds
    none. Raises FileError.
    """
    place = f"{where}.{key}" if where else key
    for n, row in enumerate(list_of(out, data.get(key) or [], place)):
        yield f"{place}[{n}]", require_dict(out, row, f"{place}[{n}]")


def parse_json_seconds(out: Collected, value: Any, where: str, unit: float | None = None) -> float | None:
    """Return seconds; None if there are none. unit: seconds of one of the value's units, None for the
    file's. Texts may be numbers, "1.5s", "00:00:01,500" or "PT1.5S"; an object has `seconds` and `nanos`.
    Raises FileError.
    """
    if value is None:
        return None
    if isinstance(value, dict) and {"seconds", "nanos"} & set(value):
        whole = parse_json_seconds(out, value.get("seconds", 0), where, 1.0) or 0.0
        return whole + (parse_json_seconds(out, value.get("nanos", 0), where, 1e-9) or 0.0)
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise out.fail(phrase("a time is {kind}", kind=_kind(value)), where)
    if isinstance(value, str) and (said := _said(value)) is not None:
        return said
    try:
        seconds = float(value)
    except (ValueError, OverflowError):
        raise out.fail(phrase("a time is '{value}'", value=str(value)[:30]), where) from None
    if not math.isfinite(seconds):
        raise out.fail(phrase("a time is {seconds:g}", seconds=seconds), where)
    return seconds * (out.unit if unit is None else unit)


def _said(text: str) -> float | None:
    """Return the seconds of a text that names its unit."""
    text = text.strip()
    if (seconds := _SECONDS.match(text)) is not None:
        return float(seconds[1])
    if (clock := _CLOCK.match(text)) is not None:
        return int(clock[1] or 0) * 3600 + int(clock[2]) * 60 + float(clock[3].replace(",", "."))
    if (iso := _ISO.match(text)) is not None and any(iso.groups()):
        return int(iso[1] or 0) * 3600 + int(iso[2] or 0) * 60 + float(iso[3] or 0)
    return None


def parse_json_number(value: Any) -> float | None:
    """Return a number, also one that is written as text; None for anything else."""
    if isinstance(value, int | float | str) and not isinstance(value, bool):
        with suppress(ValueError, OverflowError):
            number = float(value)
            return number if math.isfinite(number) else None
    return None


def parse_text(value: Any) -> str:
    """Return a text; "" for anything else."""
    return value if isinstance(value, str) else ""


def name_of(value: Any) -> str:
    """Return a speaker's name; a number is one, too. "" for anything else."""
    return str(value).strip() if isinstance(value, str | int | float) and not isinstance(value, bool) else ""


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


# How starts, ends, lengths and texts of a word or a segment are called where no service says it.
_TEXTS = ("punctuated_word", "word", "text", "token", "content", "alignedWord", "value", "label")
_STARTS = (
    "start",
    "start_time",
    "startTime",
    "begin",
    "from",
    "onset",
    "ts",
    "offset",
    "begin_time",
    "start_ts",
)
_ENDS = ("end", "end_time", "endTime", "stop", "to", "end_ts", "offset_end", "finish")
_LENGTHS = ("duration", "dur", "length")
_THOUSANDTHS = ("_ms", "Ms", "_millis", "Millis", "_milliseconds", "Milliseconds")


@dataclass(frozen=True)
class TimedRow:
    """A word or a segment as an object has it: its text, and its start and end, or its start and length, as
    they stand there. milliseconds: whether the names of the times say that they are.
    """

    text: str
    start: Any
    end: Any
    length: Any
    milliseconds: bool

    def span(self, out: Collected, where: str) -> tuple[float | None, float | None]:
        """Return start and end in seconds, None for what is not said. Raises FileError."""
        unit = 1e-3 if self.milliseconds else None
        start, end = (
            parse_json_seconds(out, self.start, where, unit),
            parse_json_seconds(out, self.end, where, unit),
        )
        if end is None and start is not None and self.length is not None:
            end = start + (parse_json_seconds(out, self.length, where, unit) or 0.0)
        return start, end


def timed_row_of(one: Mapping[str, Any]) -> TimedRow:
    """Return the text and the times of an object, however they are called."""
    text = next((parse_text(one[key]) for key in _TEXTS if parse_text(one.get(key))), "")
    for ending in ("", *_THOUSANDTHS):
        start, end, length = (
            next((one[key + ending] for key in keys if one.get(key + ending) is not None), None)
            for keys in (_STARTS, _ENDS, _LENGTHS)
        )
        if start is not None or end is not None:
            return TimedRow(text, start, end, length, bool(ending))
    return TimedRow(text, None, None, None, False)
