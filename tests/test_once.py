"""What a process reads once is as it was for all who read it."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.store import open_project
from metagraph.speech.sound import read_recording
from tests.once import SAMPLES, read_once

HELLO = SAMPLES / "lines" / "hello.flac"


def test_a_samples_sound_is_decoded_once_wherever_it_lies_and_nobody_spoils_it_for_others(
    tmp_path: Path,
) -> None:
    asked: list[Path] = []

    def read(path: str | Path, *options: float) -> object:
        asked.append(Path(path))
        return read_recording(path, *options)

    once = read_once(read)
    first = once(HELLO)
    whole = first.samples.copy()
    first.samples[:] = 0
    again = once(shutil.copy(HELLO, tmp_path))
    assert asked == [HELLO] and np.array_equal(again.samples, whole)
    once(HELLO, 60.0)
    assert asked == [HELLO] * 2, "asked for otherwise it is read"


def test_a_file_that_differs_in_a_byte_is_read(tmp_path: Path) -> None:
    once = read_once(lambda path: Path(path).read_bytes())
    other = Path(shutil.copy(HELLO, tmp_path))
    assert once(other) == HELLO.read_bytes()
    other.write_bytes(b"other")
    assert once(other) == b"other"
    other.unlink()
    with pytest.raises(FileNotFoundError):
        once(other)


def test_the_samples_clips_are_the_same_objects_each_time_and_those_that_differ_are_others(
    few: Path, tmp_path: Path
) -> None:
    first, again = open_project(few).project, open_project(few).project
    assert first.skeleton is again.skeleton and first.clips
    for ident, entry in first.clips.items():
        assert entry.motion is not None and again.clips[ident].motion is entry.motion
    other = Path(shutil.copytree(few.parent, tmp_path / "other")) / few.name
    changed = next(iter(first.clips.values()))
    motion = changed.motion
    assert motion is not None
    rotations = motion.rotations.copy()
    rotations[:, 1] = [0.6, 0, 0, 0.8]
    write_glb(other.parent / changed.path, [replace(motion, rotations=rotations)])
    told = open_project(other).project.clips[changed.id].motion
    assert told is not None and told is not motion
    assert not np.allclose(told.rotations[:, 1], motion.rotations[:, 1], atol=0.1)
