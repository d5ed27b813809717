"""The records of a journal as bytes and back: each with its number and a checksum, so that a damaged one is
known, and what stands behind it is read all the same.

A record is a line of JSON, a tab, its number, a tab and a CRC-32 of all before; two ends of line stand
between records, so that one damaged byte never costs more than one of them. Journals from before there were
checksums are lines of JSON alone.
"""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Literal
from zlib import crc32

import msgspec

from metagraph.formats.project.fields import Data

HEAD, FOUNDATION = 0, 1  # the numbers of what a journal begins with: whose it is, what its edits build on
_FRAMED = re.compile(rb"(\{.*\})\t(\d{1,15})\t([0-9a-f]{8})")
_NUMBER = re.compile(rb"\t(\d{1,15})\t[^\t]{8}\Z")
_STEP = re.compile(rb'"step":("(?:[^"\\]|\\.)*")')
_TIME = re.compile(rb'"at":(\d{1,12})[,}]')


@dataclass(frozen=True)
class JournalRecord:
    """A whole record. number: how many stand before it; None in a journal without checksums."""

    data: Data
    number: int | None = None


@dataclass(frozen=True)
class LostEdit:
    """An edit that a journal cannot give back. step: what was done, "" if nobody knows; at: when, seconds
    since 1970. why: its record is damaged, or it does not fit what could be read before it.
    """

    step: str = ""
    at: int | None = None
    why: Literal["damaged", "unfit"] = "damaged"


@dataclass(frozen=True)
class Records:
    """What a journal's bytes hold, in order. head, foundation: the first two lines where they are damaged."""

    entries: tuple[JournalRecord | LostEdit, ...]
    head: bytes = b""
    foundation: bytes = b""

    @property
    def whole(self) -> tuple[JournalRecord, ...]:
        return tuple(entry for entry in self.entries if isinstance(entry, JournalRecord))


def encode_record(record: Data, number: int) -> bytes:
    """Return a record as it is written."""
    body = b"%s\t%d" % (_encoded(record), number)
    return b"%s\t%08x\n\n" % (body, crc32(body))


def _encoded(record: Data) -> bytes:
    try:
        return msgspec.json.encode(record)  # ten times as fast, for long conversations
    except UnicodeEncodeError:  # a path that is no text
        return json.dumps(record, separators=(",", ":"), allow_nan=False).encode()


def read_records(content: bytes) -> Records:
    """Return what a journal's bytes hold. A last line that was cut off while it was written is none."""
    *lines, last = content.split(b"\n")
    found = [(line, parse_record(line)) for line in lines if line]
    if last and (parse_record(last) is not None or not last.startswith(b"{")):
        found.append((last, parse_record(last)))
    if any(record is not None for _, record in found):
        return _numbered(found)
    return _unnumbered([line for line, _ in found])


def parse_record(line: bytes) -> JournalRecord | None:
    """Return the record of a line, None if its checksum does not fit."""
    match = _FRAMED.match(line)
    if match is None or crc32(line[: match.start(3) - 1]) != int(match[3], 16):
        return None
    data = _decoded(match[1])
    return JournalRecord(data, int(match[2])) if data is not None else None


def _numbered(found: list[tuple[bytes, JournalRecord | None]]) -> Records:
    entries: list[JournalRecord | LostEdit] = []
    damaged: list[bytes] = []
    head = foundation = b""
    following = HEAD
    for line, record in found:
        if record is None or record.number is None:
            damaged.append(line)
            continue
        if following == HEAD < record.number:
            head, damaged, following = damaged[0] if damaged else b"?", damaged[1:], FOUNDATION
        if following == FOUNDATION < record.number:
            rest = max(0, len(damaged) - (record.number - 1 - FOUNDATION))
            foundation, damaged, following = (
                b"\n".join(damaged[:rest]) or b"?",
                damaged[rest:],
                1 + FOUNDATION,
            )
        entries += _lost(damaged, record.number - following)
        entries.append(record)
        damaged, following = [], max(following, record.number + 1)
    if following == FOUNDATION and damaged:
        foundation, damaged = damaged[0], damaged[1:]
    numbers = {match[1] for match in map(_NUMBER.search, damaged) if match}
    entries += _lost(damaged, len(numbers) or len(damaged))
    return Records(tuple(entries), head, foundation)


def _lost(damaged: list[bytes], count: int) -> list[LostEdit]:
    """Return the edits that are lost where `count` records are missing, of which damaged lines are left; the
    mark of a saving is none.
    """
    edits = [line for line in damaged if b'"mark":' not in line[:12]]
    lost = [_described(line) for line in edits]
    lost = [edit for edit in lost if edit.step or edit.at] or lost  # a line may be in two pieces
    count = max(0, count - (len(damaged) - len(edits)))
    return [*lost[:count], *[LostEdit()] * (count - len(lost))]


def _described(line: bytes) -> LostEdit:
    step, at = _STEP.search(line), _TIME.search(line)
    text = ""
    if step is not None:
        with suppress(ValueError):
            text = json.loads(step[1])
    return LostEdit(text, int(at[1]) if at is not None else None)


def _unnumbered(lines: list[bytes]) -> Records:
    """Read a journal from before there were checksums."""
    entries: list[JournalRecord | LostEdit] = []
    for line in lines:
        data = _decoded(line)
        entries.append(JournalRecord(data) if data is not None else _described(line))
    return Records(tuple(entries))


def _decoded(line: bytes) -> Data | None:
    try:
        data: Any = json.loads(line)
    except (ValueError, RecursionError):
        return None
    return data if isinstance(data, dict) else None
