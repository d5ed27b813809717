"""What a process reads once is as it was for all who read it."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

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
