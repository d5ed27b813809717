"""Curves of a face that programs export frame by frame: NVIDIA Audio2Face (JSON of its export, CSV of
Audio2Face-3D) and the blend shapes of Azure's speech events (JSON).

The clip is on the skeleton of a face alone, like one of Live Link Face, with the head still.
"""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CLIP_SECONDS, FRAMES, TEXT_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError, clean_text
from metagraph.formats.takes import guess_frame_rate
from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.takes import FACE_SKELETON
from metagraph.motion import rotation
from metagraph.motion.clip import Clip

Array = NDArray[Any]

AZURE_RATE = 60.0  # frames a second of Azure's events
SPARSE = 20  # frames for each that a file has, in all
MOST = 10.0  # the largest weight that could be
_REMEDY = phrase(
    "Export the weights of ARKit's 52 blend shapes: from Audio2Face as JSON or CSV, from Azure with its "
    "events."
)
_KNOWN = {name.casefold(): name for name in ARKIT}
_JSON_MARKS = (b'"facsNames"', b'"weightMat"', b'"exportFps"', b'"BlendShapes"')


def is_face_table(head: bytes) -> bool:
    """Whether a file that begins so is a CSV of Audio2Face-3D."""
    line = head.lstrip(b"\xef\xbb\xbf \t\r\n").split(b"\n", 1)[0].lower()
    return line.count(b"blendshapes.") > 2 and b"timecode" in line


def is_face_json(head: bytes) -> bool:
    """Whether a file that begins so is JSON of Audio2Face or of Azure's blend shapes."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] in (b"{", b"[") and any(m in head for m in _JSON_MARKS)


@guard_reader
def read_face_export(path: str | Path) -> Clip:
    """Return the curves as a clip at a constant rate, on `FACE_SKELETON`. Raises FileError."""
    path = Path(path)
    text = read_file(path, TEXT_FILE).decode("utf-8-sig", "replace")
    notes: list[str] = []
    if text.lstrip()[:1] in ("{", "["):
        names, rows, rate = _from_json(path, text, notes)
    else:
        names, rows, rate = _from_table(path, text, notes)
    if not 1 <= rate <= 1000 or len(rows) / rate > CLIP_SECONDS:
        raise FileError(path, phrase("its frame rate is {rate:g}", rate=rate), "", _REMEDY)
    kept = [(k, _KNOWN[n.casefold()]) for k, n in enumerate(names) if n.casefold() in _KNOWN]
    others = [n for n in names if n.casefold() not in _KNOWN]
    if not kept:
        some = ", ".join(repr(clean_text(n[:30])) for n in others[:4])
        raise FileError(
            path, phrase("its shapes are named {some}; these are not ARKit's names", some=some), "", _REMEDY
        )
    if others:
        some = ", ".join(clean_text(n[:30]) for n in others[:6])
        notes.append(phrase("unknown columns were left out: {some}", some=some))
    if not len(rows):
        raise FileError(path, phrase("it has no frames"), "", _REMEDY)
    order = sorted(kept, key=lambda one: ARKIT.index(one[1]))
    weights = rows[:, [k for k, _ in order]]
    if not (np.abs(weights) <= MOST).all():  # also what is no number
        raise FileError(path, phrase("a weight is not from 0 to 1"), "", _REMEDY)
    shapes = tuple(name for _, name in order)
    still = rotation.make_identity_rotations((len(rows), len(FACE_SKELETON)))
    return Clip(
        path.stem,
        FACE_SKELETON,
        rate,
        still,
        np.zeros((len(rows), 1, 3)),
        (0,),
        shapes,
        weights,
        tuple(notes),
    )


def _from_json(path: Path, text: str, notes: list[str]) -> tuple[list[str], Array, float]:
    """Return names of shapes, weights `[F, K]` and frames a second."""
    try:
        data = json.loads(text)
    except (RecursionError, ValueError):
        try:
            data = [json.loads(line) for line in text.split("\n") if line.strip()]
        except (RecursionError, ValueError) as error:
            raise FileError(path, phrase("is not JSON ({msg})", msg=str(error)[:80]), "", _REMEDY) from None
    if isinstance(data, dict) and "weightMat" in data:
        names = data.get("facsNames")
        if not isinstance(names, list) or not all(isinstance(n, str) for n in names):
            raise FileError(path, phrase("'facsNames' is not a list of names"), "", _REMEDY)
        rate = data.get("exportFps")
        if not isinstance(rate, int | float) or isinstance(rate, bool):
            raise FileError(path, phrase("'exportFps' is not a number"), "", _REMEDY)
        return names, _matrix(path, data["weightMat"], len(names)), float(rate)
    parts = data if isinstance(data, list) else [data]
    chunks: list[tuple[int | None, Array]] = []
    for part in parts:
        some = part.get("BlendShapes") if isinstance(part, dict) else None
        if not isinstance(some, list):
            raise FileError(path, phrase("holds neither 'weightMat' nor 'BlendShapes'"), "", _REMEDY)
        first = part.get("FrameIndex")
        known = isinstance(first, int) and not isinstance(first, bool) and 0 <= first <= FRAMES
        chunks.append((first if known else None, _matrix(path, some, len(ARKIT) + 3)[:, : len(ARKIT)]))
    notes.append(
        phrase("it does not give its frame rate: {rate:g} frames a second were assumed", rate=AZURE_RATE)
    )
    notes.append(phrase("the roll of the head and the eyes was left out"))
    return list(ARKIT), _in_order(path, chunks, notes), AZURE_RATE


def _in_order(path: Path, chunks: list[tuple[int | None, Array]], notes: list[str]) -> Array:
    """Return frames `[F, K]` where the `FrameIndex` of their events puts them, which counts the frames before
    them; those that no event has are filled in. An index of 0 that comes again begins another utterance,
    which follows the one before. Raises FileError.
    """
    placed: list[tuple[int, Array]] = []
    begin = after = said = 0
    for first, rows in chunks:
        if first == 0 and placed and any(start == begin for start, _ in placed):
            begin, said = after, said + 1
        start = after if first is None else begin + first
        placed.append((start, rows))
        after = max(after, start + len(rows))
    if after > FRAMES:
        raise FileError(path, phrase("it has no frames, or too many"), "", _REMEDY)
    if after > SPARSE * sum(len(rows) for _, rows in placed) + 600:
        raise FileError(path, phrase("its times lie too far apart"), "", _REMEDY)
    out, known = np.zeros((after, len(ARKIT))), np.zeros(after, bool)
    for start, rows in placed:
        out[start : start + len(rows)], known[start : start + len(rows)] = rows, True
    if said:
        notes.append(phrase("its {count} utterances follow each other without a pause", count=said + 1))
    if not known.all() and known.any():
        notes.append(phrase("{count} frames without an event were filled in", count=int((~known).sum())))
        at = np.arange(after)
        out = np.stack([np.interp(at, at[known], column[known]) for column in out.T], 1)
    return out


def _matrix(path: Path, rows: Any, width: int) -> Array:
    if not isinstance(rows, list) or len(rows) > FRAMES:
        raise FileError(path, phrase("it has no frames, or too many"), "", _REMEDY)
    odd = next((n for n, r in enumerate(rows) if not isinstance(r, list) or len(r) != width), None)
    if odd is not None:
        raise FileError(
            path,
            phrase("does not have {width} numbers", width=width),
            phrase("frame {number}", number=odd),
            _REMEDY,
        )
    try:
        return np.array(rows, float).reshape(-1, width)
    except (ValueError, TypeError, OverflowError):
        raise FileError(path, phrase("a weight is not a number"), "", _REMEDY) from None


def _from_table(path: Path, text: str, notes: list[str]) -> tuple[list[str], Array, float]:
    """Return names of shapes, weights `[F, K]` and frames a second, from the times."""
    first = text.lstrip().split("\n", 1)[0]
    split = ";" if first.count(";") > first.count(",") else ","
    try:
        lines = [r for r in csv.reader(io.StringIO(text.replace("\0", "")), delimiter=split) if r]
    except csv.Error as error:
        raise FileError(
            path, phrase("is not a table with commas: {error}", error=error), "", _REMEDY
        ) from None
    head = [c.strip() for c in lines[0]]
    time = next((k for k, c in enumerate(head) if c.casefold().endswith("timecode")), None)
    columns = [k for k, c in enumerate(head) if c.casefold().startswith("blendshapes.")]
    if time is None or not columns:
        raise FileError(path, phrase("has no columns for a time and for blend shapes"), "line 1", _REMEDY)
    if len(lines) < 2:
        raise FileError(path, phrase("it has no frames"), "", _REMEDY)
    times, rows = np.zeros(len(lines) - 1), np.zeros((len(lines) - 1, len(columns)))
    for n, cells in enumerate(lines[1:]):
        try:
            values = [float(c.replace(",", ".") if split == ";" else c) for c in cells]
            times[n], rows[n] = values[time], [values[k] for k in columns]
        except (ValueError, IndexError):
            raise FileError(
                path, phrase("does not have a number in each column"), phrase("line {n}", n=n + 2), _REMEDY
            ) from None
    if split == ";":
        notes.append(phrase("semicolons separate its columns; its decimal commas were read as points"))
    if not (np.isfinite(times).all() and (np.diff(times) > 0).all()):
        raise FileError(path, phrase("its times do not ascend"), "", _REMEDY)
    rate = guess_frame_rate([times]) if len(times) > 1 else 30.0
    count = round((times[-1] - times[0]) * rate) + 1
    if not 0 <= count <= min(FRAMES, SPARSE * len(times) + 600):
        raise FileError(path, phrase("its times lie too far apart"), "", _REMEDY)
    grid = times[0] + np.arange(count) / rate
    even = [np.interp(grid, times, column) for column in rows.T]
    return [head[k].split(".", 1)[1] for k in columns], np.stack(even, 1), rate
