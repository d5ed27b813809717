"""What a start was given is a project, or clips for a new one."""

from __future__ import annotations

import pytest

from app.project.given_files import sort_paths
from metagraph.errors import FileError


def test_a_project_a_folder_and_files_are_told_apart(tmp_path):
    project, clip = tmp_path / "a.metagraph.yaml", tmp_path / "walk.bvh"
    for path in (project, clip):
        path.touch()
    assert sort_paths([]) == (None, ())
    assert sort_paths([project]) == (project, ())
    assert sort_paths([tmp_path]) == (None, (tmp_path,))
    assert sort_paths([clip, tmp_path]) == (None, (clip, tmp_path))


def test_what_is_not_there_and_a_project_beside_others_are_refused(tmp_path):
    project, clip = tmp_path / "a.metagraph.yaml", tmp_path / "walk.bvh"
    with pytest.raises(FileError, match=r"walk\.bvh.*no such file.*Give a project"):
        sort_paths([clip])
    for path in (project, clip):
        path.touch()
    with pytest.raises(FileError, match="opens alone"):
        sort_paths([project, clip])
