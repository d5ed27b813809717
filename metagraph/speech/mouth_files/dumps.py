"""Dumps of how much each mouth shape shows, frame by frame: OVRLipSync's 15 visemes as CSV, as JSON, or as a
sequence that Unity saved.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from metagraph.common.budgets import MARKS
from metagraph.common.wording import phrase
from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.line_timing import OCULUS
from metagraph.speech.mouth_files.model import LONGEST, MouthFile, MouthShapes, parse_mouth_number

# The order in which OVRLipSync counts visemes; its ih, oh and ou are our I, O and U.
ORDER = ("sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou")
BUFFER = 1024 / 48000  # seconds of a frame where nothing says them: OVRLipSync's buffer at 48 kHz
_TIMES = ("time", "t", "seconds", "timestamp", "timecode", "ms", "milliseconds")
_SPLIT = re.compile(r"[,;\t]")
_ENTRY = re.compile(r"^\s*Visemes:\s*(.*)$")
_ITEM = re.compile(r"^\s*-\s*([-+.\deE]+)\s*$")
_LENGTH = re.compile(r"^\s*length:\s*([\d.eE+-]+)\s*$", re.MULTILINE)


def _names(cells: list[str]) -> list[str | None]:
    plain = {name.casefold(): name for name in OCULUS}
    return [
        plain.get(re.sub(r"^(viseme|ovr|lipsync)[_. ]?", "", c.strip().strip('"').casefold())) for c in cells
    ]


def is_viseme_table(file: MouthFile) -> bool:
    head = _SPLIT.split(file.head.split("\n", 1)[0])
    return sum(n is not None for n in _names(head)) >= 10 or _bare(head)


def _bare(cells: list[str]) -> bool:
    return len(cells) in (15, 16) and all(parse_mouth_number(c.strip()) is not None for c in cells)


def read_viseme_table(file: MouthFile) -> MouthShapes:
    """Read a table: a head with the names of visemes, and perhaps a time; or 15 numbers a line, of which a
    16th, before them, is the time. With semicolons between columns, commas are decimal points. Raises
    FileError.
    """
    lines = [(n, x) for n, x in enumerate(file.text.lstrip("\ufeff").split("\n"), 1) if x.strip()]
    split = ";" if ";" in lines[0][1] else "\t" if "\t" in lines[0][1] else ","
    head = [c.strip() for c in lines[0][1].split(split)]
    names = _names(head)
    time = next((k for k, c in enumerate(head) if c.strip('"').casefold() in _TIMES), None)
    if _bare(head):
        names = [*([None] * (len(head) - 15)), *ORDER]
        time = 0 if len(head) == 16 else None
    else:
        lines = lines[1:]
    if len(lines) > MARKS:
        raise file.fail(phrase("has more than {most:,} shapes", most=MARKS))
    columns = [(k, VISEMES.index(OCULUS[name])) for k, name in enumerate(names) if name is not None]
    rows, times = np.zeros((len(lines), len(VISEMES))), []
    for row, (number, line) in zip(rows, lines, strict=True):
        cells = [(c.replace(",", ".") if split == ";" else c).strip() for c in line.split(split)]
        where = phrase("line {n}", n=number)
        for k, place in columns:
            value = parse_mouth_number(cells[k]) if k < len(cells) else None
            if value is None:
                raise file.fail(phrase("has no number for '{name}'", name=str(names[k])), where)
            row[place] = value
        if time is not None:
            at = parse_mouth_number(cells[time]) if time < len(cells) else None
            if at is None:
                raise file.fail(phrase("has no time"), where)
            times.append(at)
    counted = _bare(head) and len(times) > 1 and times[0] in (0, 1) and bool((np.diff(times) == 1).all())
    if counted:  # numbers of frames, which say nothing of when they are
        times, time = [], None
    return _shapes(file, rows, times, head[time].casefold() if time is not None else "")


def is_viseme_json(file: MouthFile) -> bool:
    rows = _entries(file.data)
    return bool(rows) and _weights(rows[0]) is not None


def _entries(data: Any) -> list[Any]:
    if isinstance(data, dict):
        data = next(
            (data[k] for k in ("entries", "frames", "visemes") if isinstance(data.get(k), list)), None
        )
    return data if isinstance(data, list) else []


def _weights(row: Any) -> list[Any] | None:
    if isinstance(row, dict):
        row = next((row[k] for k in ("Visemes", "visemes", "weights") if k in row), row)
    if isinstance(row, dict):
        found = [row.get(name) for name in ORDER]
        return found if sum(v is not None for v in found) >= 10 else None
    return row if isinstance(row, list) and len(row) == 15 else None


def read_viseme_json(file: MouthFile) -> MouthShapes:
    """Read frames of 15 weights, with their times where they have some. Raises FileError."""
    entries = _entries(file.data)[: MARKS + 1]
    rows, times = np.zeros((len(entries), len(VISEMES))), []
    for n, entry in enumerate(entries):
        where = phrase("frame {number}", number=n)
        weights = _weights(entry)
        values = (
            None if weights is None else [parse_mouth_number(v) if v is not None else 0.0 for v in weights]
        )
        if values is None or any(v is None for v in values):
            raise file.fail(phrase("does not have 15 numbers, one for each viseme"), where)
        rows[n, [VISEMES.index(OCULUS[name]) for name in ORDER]] = values
        if isinstance(entry, dict):
            at = next((parse_mouth_number(entry[k]) for k in _TIMES if k in entry), None)
            if at is not None:
                times.append(at)
    length = parse_mouth_number(file.data.get("length")) if isinstance(file.data, dict) else None
    return _shapes(file, rows, times if len(times) == len(rows) else [], "", length)


def is_viseme_sequence(file: MouthFile) -> bool:
    return "entries:" in file.text and "Visemes:" in file.text and file.head.startswith("%YAML")


def read_viseme_sequence(file: MouthFile) -> MouthShapes:
    """Read an OVRLipSyncSequence that Unity saved as text: its frames lie evenly over its length. Raises
    FileError.
    """
    found: list[list[float]] = []
    for n, line in enumerate(file.text.split("\n"), 1):
        if _ENTRY.match(line):
            found.append([])
        elif found and len(found[-1]) < 15 and (item := _ITEM.match(line)) is not None:
            value = parse_mouth_number(item[1])
            if value is None:
                raise file.fail(phrase("a time is '{value}'", value=item[1][:30]), phrase("line {n}", n=n))
            found[-1].append(value)
    odd = next((k for k, row in enumerate(found) if len(row) != 15), None)
    if odd is not None or len(found) > MARKS:
        raise file.fail(
            phrase("does not have 15 numbers, one for each viseme"), phrase("frame {number}", number=odd or 0)
        )
    rows = np.zeros((len(found), len(VISEMES)))
    if found:
        rows[:, [VISEMES.index(OCULUS[name]) for name in ORDER]] = found
    said = _LENGTH.search(file.text)
    return _shapes(file, rows, [], "", parse_mouth_number(said[1]) if said is not None else None)


def _shapes(
    file: MouthFile, rows: Any, times: list[float], column: str, length: float | None = None
) -> MouthShapes:
    """Return frames at their times: those they say, else evenly over their length, or the sound's."""
    notes: list[str] = []
    if not len(rows):
        raise file.fail(phrase("it has no mouth shapes"))
    if not (np.abs(rows) <= 1000).all():
        raise file.fail(phrase("a weight is not from 0 to 1"))
    if rows.max() > 1.5:
        notes.append(phrase("its weights are read as percent"))
        rows = rows / 100
    if times:
        at = np.array(times, float)
        step = float(np.median(np.diff(at))) if len(at) > 1 else 0.0
        if column in ("ms", "milliseconds") or step > 1.5:
            notes.append(phrase("its times are read as milliseconds"))
            at = at * 1e-3
        if not (np.diff(at) > 0).all():
            raise file.fail(phrase("its times do not ascend"))
        at = at - min(at[0], 0.0)
    else:
        last = length if length is not None and 0 < length <= LONGEST else file.sound
        if last is None:
            last = len(rows) * BUFFER
            notes.append(phrase("it has no times: {rate:.1f} frames a second were assumed", rate=1 / BUFFER))
        else:
            notes.append(phrase("it has no times: its frames lie evenly over {last:.2f} s", last=last))
        at = np.arange(len(rows)) * (last / len(rows))
    if not at[-1] <= LONGEST:
        raise file.fail(
            phrase(
                "a shape is at {begin:.3g} s, not from 0 to {most:.0f} s", begin=float(at[-1]), most=LONGEST
            )
        )
    rows = np.clip(rows, 0.0, 1.0)
    whole = rows.sum(1, keepdims=True)
    rows = np.where(whole > 1, rows / np.maximum(whole, 1e-9), rows)
    rows[:, 0] += np.maximum(1 - rows.sum(1), 0.0)  # what nothing shows, the mouth at rest does
    return MouthShapes((), at, rows.astype(np.float32), float(at[-1]), tuple(notes))
