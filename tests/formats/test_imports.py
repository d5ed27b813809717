"""Importing files and folders into a project."""

from __future__ import annotations

import os
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.imports import gather, import_files
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from tests.projects import SKELETON, clip

pytestmark = pytest.mark.usefixtures("numbered_ids")


def stranger(name: str, joints: int = 9) -> Clip:
    """A clip of a character with other joints."""
    names = tuple(f"bone{n}" for n in range(joints))
    skeleton = Skeleton(
        names,
        np.arange(-1, joints - 1),
        np.tile([0, 0, 0, 1.0], (joints, 1)),
        np.tile([0, 0.2, 0], (joints, 1)),
    )
    return Clip(
        name,
        skeleton,
        30,
        np.tile(skeleton.rest_rotations, (5, 1, 1)),
        np.tile(skeleton.rest_translations[:1], (5, 1, 1)),
    )


def face(name: str) -> Clip:
    """A clip of the head alone, on its own small skeleton."""
    keep = [0, 1, 2]
    skeleton = Skeleton(
        SKELETON.names[:3],
        SKELETON.parents[:3],
        SKELETON.rest_rotations[keep],
        SKELETON.rest_translations[keep],
    )
    return Clip(
        name,
        skeleton,
        30,
        np.tile(skeleton.rest_rotations, (8, 1, 1)),
        np.tile(skeleton.rest_translations[:1], (8, 1, 1)),
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("a", "b", "c"):
        write_glb(tmp_path / f"{name}.glb", [clip(name)])
    return tmp_path


def test_one_bad_file_fails_alone_with_its_reason(folder: Path) -> None:
    (folder / "b2.glb").write_bytes(b"noise")
    (folder / "empty.bvh").write_bytes(b"")
    result = import_files(Project(), folder, [folder])
    assert [name for name, *_ in result.loaded] == ["a.glb", "b.glb", "c.glb"]
    assert [f.split(",")[0] for f in result.failures] == ["b2.glb", "empty.bvh"]
    assert not result.cancelled
    assert len(result.into(Project()).clips) == 3


def test_a_file_that_is_not_there_or_no_clip_is_told(folder: Path) -> None:
    (folder / "notes.txt").write_text("hello")
    result = import_files(Project(), folder, [folder / "none.glb", folder / "notes.txt", folder / "a.glb"])
    assert len(result.loaded) == 1
    assert "cannot be read" in result.failures[0]
    assert "notes.txt" in result.failures[1] and "extension" in result.failures[1]


def test_nothing_is_nothing(tmp_path: Path) -> None:
    result = import_files(Project(), tmp_path, [])
    assert result.loaded == () and result.failures == ()
    project = Project()
    assert result.into(project) == project
    assert import_files(Project(), tmp_path, [tmp_path]).loaded == ()


def test_a_stopped_import_keeps_what_was_read(folder: Path) -> None:
    seen: list[str] = []
    result = import_files(
        Project(), folder, [folder], lambda done, total, path: seen.append(path.name), lambda: len(seen) == 2
    )
    assert result.cancelled
    assert [name for name, *_ in result.loaded] == ["a.glb", "b.glb"]


def test_progress_counts_up_to_the_number_of_files(folder: Path) -> None:
    told: list[tuple[int, int]] = []
    import_files(Project(), folder, [folder], lambda done, total, path: told.append((done, total)))
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]


def test_clips_of_another_character_are_left_out_with_the_reason(folder: Path) -> None:
    project = import_files(Project(), folder, [folder]).into(Project())
    write_glb(folder / "odd.glb", [stranger("x"), stranger("y")])
    result = import_files(project, folder, [folder / "odd.glb", folder / "a.glb"])
    assert len(result.loaded) == 1
    assert result.failures == (
        "odd.glb: 2 clips belong to another character: its joints have other names (it has 'bone0', the "
        "project has 'Hips'). "
        "Import it into a separate project.",
    )


def test_in_an_empty_project_the_character_of_most_clips_counts(folder: Path) -> None:
    write_glb(folder / "0 first.glb", [stranger("more joints", 30)])
    result = import_files(Project(), folder, [folder])
    assert len(result.loaded) == 3
    assert len(result.failures) == 1
    assert result.into(Project()).skeleton == SKELETON


def test_clips_of_a_part_of_the_skeleton_are_fitted_in_whatever_comes_first(tmp_path: Path) -> None:
    write_glb(tmp_path / "0.glb", [face("blink"), face("smile")])
    write_glb(tmp_path / "1.glb", [clip("stand")])
    project = import_files(Project(), tmp_path, [tmp_path]).into(Project())
    assert len(project.clips) == 3
    assert project.skeleton == SKELETON
    assert all(e.motion is not None and e.motion.skeleton is project.skeleton for e in project.clips.values())


def test_the_same_file_twice_is_refreshed_in_place(folder: Path) -> None:
    project = import_files(Project(), folder, [folder]).into(Project())
    project = edits.rename_clip(project, "c1", "my name")
    project = edits.add_stance(project, "arms", "rest", ["c1"])
    write_glb(folder / "a.glb", [clip("a", 77)])
    again = import_files(project, folder, [folder / "a.glb", folder, folder / "a.glb"])
    assert len(again.loaded) == 3
    refreshed = again.into(project)
    assert list(refreshed.clips) == ["c1", "c2", "c3"]
    assert (refreshed.clips["c1"].name, refreshed.clips["c1"].frames) == ("my name", 77)
    assert refreshed.clips["c1"].digest != project.clips["c1"].digest
    assert refreshed.graphs == project.graphs


def test_paths_are_relative_to_the_project_or_absolute_without_one(folder: Path) -> None:
    deep = folder / "deep"
    deep.mkdir()
    assert [n for n, *_ in import_files(Project(), deep, [folder / "a.glb"]).loaded] == ["../a.glb"]
    assert [n for n, *_ in import_files(Project(), None, [folder / "a.glb"]).loaded] == [
        (folder / "a.glb").resolve().as_posix()
    ]


def test_a_file_named_in_several_ways_is_gathered_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    assert len(gather(["a.glb", folder / "a.glb", folder, "."])) == 3


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
def test_a_linked_clip_keeps_the_name_of_the_link(folder: Path) -> None:
    (folder / "store").mkdir()
    shutil.move(folder / "a.glb", folder / "store" / "x7f3.glb")
    (folder / "a.glb").symlink_to(folder / "store" / "x7f3.glb")
    assert [n for n, *_ in import_files(Project(), folder, [folder / "a.glb"]).loaded] == ["a.glb"]


@pytest.mark.skipif(
    os.name == "nt" or os.uname().sysname == "Darwin", reason="file names are always text there"
)
def test_a_file_whose_name_is_no_text_is_left_out_since_it_could_not_be_saved(folder: Path) -> None:
    shutil.copy(folder / "a.glb", os.fsencode(folder / "b") + b"\xff.glb")
    result = import_files(Project(), folder, [folder])
    assert len(result.loaded) == 3
    assert "not text" in result.failures[0]


@pytest.mark.nightly
def test_what_is_true_of_many_files_is_said_once(shared_data: Path) -> None:
    result = import_files(Project(), None, [shared_data / "bandai-namco-1"])
    assert len(result.notes) == 1
    assert result.notes[0].startswith("63 files (dataset-1_bow_active_001.bvh …): units read as centimetres")


def test_a_bvh_and_a_glb_of_one_character_go_together(tmp_path: Path) -> None:
    straight = Skeleton(
        SKELETON.names, SKELETON.parents, np.tile([0, 0, 0, 1.0], (4, 1)), SKELETON.rest_translations
    )
    motion = Clip(
        "a",
        straight,
        30,
        np.tile(straight.rest_rotations, (9, 1, 1)),
        np.tile(straight.rest_translations[:1], (9, 1, 1)),
    )
    write_bvh(motion, tmp_path / "a.bvh")
    write_glb(tmp_path / "b.glb", [motion.renamed("b")])
    result = import_files(Project(), tmp_path, [tmp_path])
    assert len(result.loaded) == 2
    assert result.failures == ()


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("name", "pattern", "clips", "joints"),
    [("sumerian-hosts", "alien", 60, 93), ("kaykit-rogue", "", 76, 0), ("bandai-namco-1", "", 63, 22)],
)
def test_real_characters_come_in_whole(
    shared_data: Path, name: str, pattern: str, clips: int, joints: int
) -> None:
    files = [p for p in gather([shared_data / name]) if pattern in p.as_posix()]
    result = import_files(Project(), None, files)
    project = result.into(Project())
    assert len(project.clips) == clips, result.failures
    assert project.skeleton is not None
    if joints:
        assert len(project.skeleton) == joints
    assert all(e.motion is not None and e.motion.skeleton is project.skeleton for e in project.clips.values())


def test_bones_of_another_length_are_told_once_with_a_count(tmp_path: Path) -> None:
    offsets = SKELETON.rest_translations.copy()
    offsets[-3:] *= 1.08
    longer = Skeleton(SKELETON.names, SKELETON.parents, SKELETON.rest_rotations, offsets)
    write_glb(tmp_path / "a.glb", [clip("one", 20), clip("two", 20), clip("three", 20)])
    write_glb(tmp_path / "b.glb", [replace(clip(n, 20), skeleton=longer) for n in ("long", "longer")])
    result = import_files(Project(), tmp_path, [tmp_path])
    assert len(result.loaded) == 5
    (told,) = (n for n in result.notes if "bones" in n)
    assert told.startswith("2 clips ('long' …) keep their bones, which are up to 8 %")


def test_a_files_prefix_on_the_joints_names_makes_no_stranger(tmp_path: Path) -> None:
    names = tuple(f"mixamorig7:{n}" for n in SKELETON.names)
    other = Skeleton(names, SKELETON.parents, SKELETON.rest_rotations, SKELETON.rest_translations)
    write_glb(tmp_path / "a.glb", [clip("one", 20), clip("two", 20)])
    write_glb(tmp_path / "b.glb", [replace(clip("three", 20), skeleton=other)])
    result = import_files(Project(), tmp_path, [tmp_path])
    assert not result.failures and len({c.skeleton.fingerprint for _, _, _, c in result.loaded}) == 1
