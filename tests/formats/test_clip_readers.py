"""The registry of clip readers: each is one line, as the recipe in docs/contributing says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats import clip_readers
from metagraph.formats.clip_readers import READERS, ClipReader, list_clip_suffixes
from metagraph.formats.clips import find_clip_files, import_clips, read_clips
from tests.recipes import code_of


@pytest.fixture
def points(monkeypatch: pytest.MonkeyPatch) -> None:
    """The reader of the recipe, registered."""
    made: dict[str, Any] = {}
    exec(code_of("Add a reader of clips"), made)
    line = ClipReader(
        "a file of points", (".points",), lambda head, text: text.startswith(b"points"), made["read_points"]
    )
    monkeypatch.setattr(clip_readers, "READERS", [*READERS, line])


def test_no_ending_is_read_by_two() -> None:
    endings = list_clip_suffixes()
    assert len(set(endings)) == len(endings) and all(ending == ending.lower() for ending in endings)


@pytest.mark.usefixtures("points")
def test_a_reader_that_is_added_reads_files_alone_and_in_folders(tmp_path: Path) -> None:
    path = tmp_path / "walk.points"
    path.write_text("points\n0 1 0\n0 1 0.5\n")
    (clip,) = read_clips(path)
    np.testing.assert_array_equal(clip.translations[:, 0], [[0, 1, 0], [0, 1, 0.5]])
    assert find_clip_files(tmp_path) == [path]
    (tmp_path / "bad.points").write_text("points\n0 1\n")
    report = import_clips(find_clip_files(tmp_path))
    assert [clip.name for _, _, clip in report.clips] == ["walk"]
    assert "three numbers" in str(report.failures[0])


@pytest.mark.usefixtures("points")
def test_content_and_ending_must_agree_with_one_reader(tmp_path: Path) -> None:
    path = tmp_path / "walk.bvh"
    path.write_text("points\n0 1 0\n")
    with pytest.raises(FileError, match="a file of points"):
        read_clips(path)
    path = tmp_path / "walk.points"
    path.write_text("HIERARCHY\n")
    with pytest.raises(FileError, match="a BVH file"):
        read_clips(path)
