"""Store the state of a training on disk, in two files by turns, so that one is always complete."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from metagraph.formats.atomic import write_atomically
from metagraph.generation.standing import CHECKPOINTS, TOLD, UNREADABLE, CheckpointNote, read_checkpoint_note

Arrays = dict[str, np.ndarray[Any, Any]]


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """arrays: `net.NAME`, `mean.NAME` (of weights), `first.NAME`, `second.NAME` (moments), `chance`."""

    told: CheckpointNote
    arrays: Arrays = field(repr=False)


def write_checkpoint(folder: Path, point: Checkpoint) -> Path:
    """Write over the older of the two files; return which. Raises FileError, and leaves both as they were."""
    path = folder / f"checkpoint.{_next(folder)}.npz"
    content = io.BytesIO()
    told = np.frombuffer(msgspec.json.encode(point.told), np.uint8)
    np.savez(content, **{TOLD: told, **point.arrays})  # type: ignore[arg-type]
    write_atomically(path, content.getvalue())
    return path


def read_checkpoint(folder: Path, plan: str) -> tuple[Checkpoint | None, list[str]]:
    """Return the latest checkpoint that can be read and belongs to a plan, None if there is none; and what
    was wrong with others, in words.
    """
    found, notes = [], []
    for path in sorted(folder.glob(CHECKPOINTS)):
        try:
            point = _read(path)
        except UNREADABLE as error:
            notes.append(f"{path.name} is damaged ({error}); the one before it is used, if there is one.")
            continue
        if point.told.plan != plan:
            notes.append(f"{path.name} belongs to another training and is left alone.")
            continue
        found.append(point)
    return max(found, key=lambda p: p.told.step, default=None), notes


def _read(path: Path) -> Checkpoint:
    # The file is opened here: NumPy leaves open what it cannot read.
    with path.open("rb") as content, np.load(content, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    told = read_checkpoint_note(arrays.pop(TOLD))
    if any(a.dtype.kind == "f" and not np.isfinite(a).all() for a in arrays.values()):
        raise ValueError("it holds a value that is not a number")
    return Checkpoint(told, arrays)


def _next(folder: Path) -> int:
    """Return the number of the file to write over: one that is missing or cannot be read, else the older."""
    steps = []
    for n in range(2):
        try:
            steps.append(_read(folder / f"checkpoint.{n}.npz").told.step)
        except UNREADABLE:
            return n
    return int(np.argmin(steps))
