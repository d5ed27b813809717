"""Checkpoints: one is whole whenever a training is cut short."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError

pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation.training.checkpoint import (
    Checkpoint,
    CheckpointNote,
    read_checkpoint,
    write_checkpoint,
)


def point(step: int, plan: str = "p") -> Checkpoint:
    return Checkpoint(
        CheckpointNote(plan=plan, step=step, seconds=1.5, minutes=0.1), {"net.a": np.full(3000, step, "f4")}
    )


def latest(folder: Path) -> int | None:
    found, _ = read_checkpoint(folder, "p")
    return None if found is None else found.told.step


def test_the_latest_is_read_and_the_one_before_it_kept(tmp_path: Path) -> None:
    assert latest(tmp_path) is None
    for step in (1, 2, 3):
        write_checkpoint(tmp_path, point(step))
        assert latest(tmp_path) == step
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("spoil", ["cut", "flip", "empty", "pickle", "nan"])
def test_a_damaged_one_is_told_and_the_one_before_it_used(tmp_path: Path, spoil: str) -> None:
    write_checkpoint(tmp_path, point(1))
    path = write_checkpoint(tmp_path, point(2))
    content = path.read_bytes()
    if spoil == "cut":
        path.write_bytes(content[: len(content) // 2])
    elif spoil == "flip":
        at = content.index(np.full(40, 2, "f4").tobytes()) + 20
        path.write_bytes(content[:at] + b"\x55" + content[at + 1 :])
    elif spoil == "empty":
        path.write_bytes(b"")
    elif spoil == "pickle":
        np.savez(path, told=np.array([{"a": 1}], object))
    else:
        write_checkpoint(tmp_path, Checkpoint(point(3).told, {"net.a": np.full(3, np.nan, "f4")}))
        write_checkpoint(tmp_path, point(2))
    found, notes = read_checkpoint(tmp_path, "p")
    assert found is not None and found.told.step == (2 if spoil == "nan" else 1)
    assert spoil == "nan" or (len(notes) == 1 and "damaged" in notes[0])
    # The next one is written over what is damaged.
    write_checkpoint(tmp_path, point(9))
    assert latest(tmp_path) == 9 and read_checkpoint(tmp_path, "p")[1] == []


def test_one_of_another_training_is_left_alone_and_told(tmp_path: Path) -> None:
    write_checkpoint(tmp_path, point(5, "other"))
    found, notes = read_checkpoint(tmp_path, "p")
    assert found is None and "another training" in notes[0]


def test_a_full_disk_costs_no_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_checkpoint(tmp_path, point(1))
    write_checkpoint(tmp_path, point(2))

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("metagraph.formats.atomic.os.fsync", full)
    with pytest.raises(FileError, match="space left"):
        write_checkpoint(tmp_path, point(3))
    assert latest(tmp_path) == 2 and len(list(tmp_path.iterdir())) == 2
