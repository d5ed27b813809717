"""Paths that a project names are made relative and absolute."""

from __future__ import annotations

from pathlib import Path

from metagraph.formats.project.paths import make_path_relative, make_paths_absolute
from metagraph.graph.model import ClipEntry, Project


def test_relative_paths_use_slashes_and_go_up(tmp_path: Path) -> None:
    assert make_path_relative(tmp_path / "a" / "b c.glb", tmp_path / "x") == "../a/b c.glb"
    assert make_path_relative(tmp_path / "a.glb", tmp_path) == "a.glb"


def test_paths_are_made_absolute_as_each_by_itself_would_be(tmp_path: Path) -> None:
    there = tmp_path / "there"
    (there / "clips").mkdir(parents=True)
    (there / "clips" / "a.bvh").write_text("")
    try:
        (tmp_path / "linked").symlink_to(there, target_is_directory=True)
        (there / "clips" / "b.bvh").symlink_to(there / "clips" / "a.bvh")
    except OSError:  # where links are not for everybody
        pass
    folder = tmp_path / "linked"
    names = [
        "clips/a.bvh",
        "clips/b.bvh",
        "clips/../clips/a.bvh",
        "../x.bvh",
        "gone/c.bvh",
        "clips/..",
        ".",
        "a/",
    ]
    names += [(there / "clips" / "a.bvh").as_posix(), "/top.bvh", "clips//a.bvh", "./clips/a.bvh"]
    clips = {str(n): ClipEntry(str(n), "", name) for n, name in enumerate(names)}
    found = make_paths_absolute(Project(clips=clips), folder)
    assert [e.path for e in found.clips.values()] == [(folder / n).resolve().as_posix() for n in names]
