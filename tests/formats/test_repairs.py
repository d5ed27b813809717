"""What readers repair, and leaving it out one by one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.bvh.file import read_bvh, write_bvh
from metagraph.formats.clips import read_clips
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.imports import import_files
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.fields import DataError
from metagraph.formats.repairs import Repaired, list_repairs, reread
from metagraph.formats.store import open_project, save_project
from metagraph.formats.takes import BIND_POSE, NAME, ONE_FRAME, UNIT, UP
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip

pytestmark = pytest.mark.usefixtures("numbered_ids")


def bound(toy: Any, name: str) -> Clip:
    """A clip with a bind pose left on its first frame."""
    clip = toy.clip(name, 1.0, 1.3)
    rotations = clip.rotations.copy()
    rotations[0] = toy.skeleton.rest_rotations
    return replace(clip, rotations=rotations)


def still(clip: Clip, name: str) -> Clip:
    """A bind pose of one frame."""
    rest = clip.skeleton.rest_rotations[None]
    return replace(clip.trimmed(0, 1), rotations=rest, name=name)


def imported(folder: Path, *names: str) -> Project:
    result = import_files(Project(), folder, [folder / name for name in names])
    assert not result.failures
    return result.into(Project())


def by_name(project: Project, name: str) -> Repaired:
    return next(r for r in list_repairs(project, project.clips) if r.repair.name == name)


def turned(project: Project, folder: Path, name: str, made: bool = False) -> Project:
    found = reread(project, folder, [(by_name(project, name), made)])
    assert not found.failures
    return found.into(project)


@pytest.fixture
def bind(toy: Any, tmp_path: Path) -> Path:
    write_glb(tmp_path / "a.glb", [bound(toy, "a")])
    write_glb(tmp_path / "b.glb", [toy.clip("b", 0.5)])
    return tmp_path


def test_a_clip_without_repairs_has_none_to_leave_out(bind: Path) -> None:
    project = imported(bind, "b.glb")
    assert list_repairs(project, project.clips) == []
    assert reread(project, bind, []).count == 0
    assert reread(project, bind, []).into(project) == project


def test_a_dropped_bind_pose_comes_back_and_goes_again(bind: Path) -> None:
    project = imported(bind, "a.glb", "b.glb")
    before = project.clips["c1"]
    assert before.motion is not None and "bind pose" in before.motion.notes[-1]
    back = turned(project, bind, BIND_POSE)
    entry = back.clips["c1"]
    assert entry.as_is == (BIND_POSE,) and entry.frames == before.frames + 1 and entry.name == before.name
    assert entry.motion is not None and "left as it is" in entry.motion.notes[-1]
    assert not by_name(back, BIND_POSE).repair.made
    assert back.clips["c2"] is project.clips["c2"]
    again = turned(back, bind, BIND_POSE, True)
    assert again == project


def test_what_was_left_out_is_saved_and_stays_so_when_the_file_is_read_again(bind: Path) -> None:
    project = turned(imported(bind, "a.glb", "b.glb"), bind, BIND_POSE)
    path = bind / "p.metagraph.yaml"
    save_project(project, path, path)
    assert "as_is: [bind_pose]" in path.read_text()
    opened = open_project(path)
    assert not opened.notes and opened.project == project
    assert opened.project.clips["c1"].motion.frames == project.clips["c1"].frames  # type: ignore[union-attr]
    result = import_files(opened.project, bind, [bind / "a.glb"])
    assert result.into(opened.project) == project


def test_an_unknown_repair_in_a_project_file_is_refused_with_its_place(bind: Path) -> None:
    data = to_data(imported(bind, "a.glb"))
    data["clips"][0]["as_is"] = ["everything"]
    with pytest.raises(DataError, match="bind_pose") as error:
        from_data(data)
    assert error.value.where == "clips[0].as_is"


def test_a_skipped_take_is_brought_in_keeps_the_others_numbers_and_can_go_again(
    toy: Any, tmp_path: Path
) -> None:
    walk, nod = toy.clip("walk", 0.5), toy.clip("nod", 0.4)
    write_glb(tmp_path / "a.glb", [still(walk, "Take 001"), walk, still(walk, "default"), nod])
    project = imported(tmp_path, "a.glb")
    assert [e.name for e in project.clips.values()] == ["walk", "nod"]
    found = list_repairs(project, project.clips)
    assert [r.repair.words.split("'")[1] for r in found] == ["a", "a_2"]
    after = reread(project, tmp_path, [(found[1], False)]).into(project)
    assert [(e.name, e.take) for e in after.clips.values()] == [("walk", 0), ("nod", 1), ("a_2", 3)]
    path = tmp_path / "p.metagraph.yaml"
    save_project(after, path, path)
    assert open_project(path).project == after
    assert [r.repair.made for r in list_repairs(after, project.clips)] == [True, False]
    gone = reread(after, tmp_path, [(list_repairs(after, project.clips)[1], True)])
    assert gone.into(after).clips == project.clips
    placed = edits.add_stance(after, "arms", "rest", [list(after.clips)[-1]])
    with pytest.raises(EditError, match="'a_2' is placed"):
        gone.into(placed)


def test_poses_of_one_frame_with_a_name_or_a_pose_of_their_own_are_kept_behind_the_others(
    toy: Any, tmp_path: Path
) -> None:
    walk = toy.clip("walk", 0.5)
    sitting = replace(toy.clip("Take 001", 0.5, 1.3).trimmed(5, 6))
    write_glb(tmp_path / "a.glb", [still(walk, "T-Pose"), sitting, walk, still(walk, "Take 002")])
    result = import_files(Project(), tmp_path, [tmp_path / "a.glb"])
    project = result.into(Project())
    assert [(e.name, e.take, e.frames) for e in project.clips.values()] == [
        ("walk", 0, 16),
        ("T-Pose", 1, 1),
        ("a", 2, 1),
    ]
    skipped, kept = (n for n in result.notes if "one frame" in n)
    assert "skipped 'a_2'" in skipped and kept.startswith("a.glb: 'T-Pose', 'a': ")


def test_a_skipped_take_brought_in_is_refreshed_with_its_file(toy: Any, tmp_path: Path) -> None:
    walk = toy.clip("walk", 0.5)
    write_glb(tmp_path / "a.glb", [still(walk, "Take 001"), walk])
    project = imported(tmp_path, "a.glb")
    project = reread(project, tmp_path, [(by_name(project, ONE_FRAME), False)]).into(project)
    write_glb(tmp_path / "a.glb", [still(walk, "Take 001"), toy.clip("walk", 0.9)])
    result = import_files(project, tmp_path, [tmp_path / "a.glb"])
    assert len(result.loaded) == 2
    after = result.into(project)
    assert [e.frames for e in after.clips.values()] == [28, 1]
    assert [e.as_is for e in after.clips.values()] == [(), (ONE_FRAME,)]


def test_a_name_from_the_file_gives_way_to_the_takes_own_unless_it_was_renamed(
    toy: Any, tmp_path: Path
) -> None:
    write_glb(tmp_path / "walk.glb", [toy.clip("Take 001", 0.5)])
    project = imported(tmp_path, "walk.glb")
    assert project.clips["c1"].name == "walk"
    assert "'Take 001'" in by_name(project, NAME).repair.words
    back = turned(project, tmp_path, NAME)
    assert back.clips["c1"].name == "Take 001"
    assert turned(back, tmp_path, NAME, True) == project
    mine = edits.rename_clip(project, "c1", "my name")
    assert turned(mine, tmp_path, NAME).clips["c1"].name == "my name"


def test_a_guessed_unit_can_be_centimetres_when_all_clips_change_alike(toy: Any, tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_bvh(toy.clip(name, 0.5), tmp_path / f"{name}.bvh")
        text = (tmp_path / f"{name}.bvh").read_text()
        assert read_bvh(tmp_path / f"{name}.bvh").repairs == ()
        (tmp_path / f"{name}.bvh").write_text(metres(text))
    project = imported(tmp_path, "a.bvh", "b.bvh")
    assert [r.repair.name for r in list_repairs(project, project.clips)] == [UNIT, UNIT]
    one = reread(project, tmp_path, [(list_repairs(project, ["c1"])[0], False)])
    assert one.count == 0 and [words[:4] for words in one.failures] == ["'a' "]
    every = reread(project, tmp_path, [(r, False) for r in list_repairs(project, project.clips)])
    after = every.into(project)
    assert not every.failures and after.skeleton is not None and project.skeleton is not None
    assert after.skeleton.height == pytest.approx(project.skeleton.height / 100, rel=1e-3)
    assert all(e.motion is not None and e.motion.skeleton is after.skeleton for e in after.clips.values())


def metres(text: str) -> str:
    """The BVH with lengths a hundredth."""
    head, motion = text.split("MOTION\n")
    lines = []
    for line in head.splitlines():
        if line.strip().startswith("OFFSET"):
            indent = line[: len(line) - len(line.lstrip())]
            line = f"{indent}OFFSET {' '.join(str(float(x) / 100) for x in line.split()[1:])}"
        lines.append(line)
    channels = [word for line in head.splitlines() if "CHANNELS" in line for word in line.split()[2:]]
    rows = motion.splitlines()
    for n, row in enumerate(rows[2:], 2):
        values = [
            float(x) / (100 if c.endswith("position") else 1)
            for x, c in zip(row.split(), channels, strict=True)
        ]
        rows[n] = " ".join(map(str, values))
    return "\n".join([*lines, "MOTION", *rows]) + "\n"


def test_a_turned_axis_can_be_left_as_it_is(toy: Any, tmp_path: Path) -> None:
    clip = toy.clip("a", 0.5)
    turn = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
    rotations, translations = clip.rotations.copy(), clip.translations.copy()
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0].astype(float))
    translations[:, 0] = rotation.rotate_vectors(turn, translations[:, 0].astype(float))
    write_bvh(replace(clip, rotations=rotations, translations=translations), tmp_path / "a.bvh")
    write_bvh(toy.clip("b", 0.5), tmp_path / "b.bvh")
    project = imported(tmp_path, "a.bvh", "b.bvh")
    after = turned(project, tmp_path, UP)
    motion = after.clips["c1"].motion
    assert motion is not None and after.clips["c1"].as_is == (UP,)
    head = motion.skeleton.globals(motion.poses())[1][0, motion.skeleton.index("Head")]
    assert head[2] > abs(head[1])
    assert turned(after, tmp_path, UP, True) == project


def test_several_repairs_of_a_clip_are_left_out_one_by_one(toy: Any, tmp_path: Path) -> None:
    write_glb(tmp_path / "walk.glb", [bound(toy, "Take 001")])
    project = imported(tmp_path, "walk.glb")
    assert {r.repair.name for r in list_repairs(project, ["c1"])} == {NAME, BIND_POSE}
    one = turned(project, tmp_path, NAME)
    assert one.clips["c1"].as_is == (NAME,) and one.clips["c1"].frames == project.clips["c1"].frames
    both = turned(one, tmp_path, BIND_POSE)
    assert both.clips["c1"].as_is == (BIND_POSE, NAME) and both.clips["c1"].name == "Take 001"


def test_a_file_that_is_gone_is_told_and_nothing_changes(bind: Path) -> None:
    project = imported(bind, "a.glb", "b.glb")
    (bind / "a.glb").unlink()
    found = reread(project, bind, [(by_name(project, BIND_POSE), False)])
    assert found.failures == ("'a.glb' is missing",)
    assert found.into(project) == project


def test_readers_tell_a_repair_they_were_told_to_leave(bind: Path) -> None:
    (clip,) = read_clips(bind / "a.glb", (BIND_POSE,))
    assert [(r.name, r.made) for r in clip.repairs] == [(BIND_POSE, False)]
    assert clip.frames == read_clips(bind / "a.glb")[0].frames + 1


def test_a_retargeted_clip_stays_retargeted_without_a_repair(toy: Any, sample: Any, tmp_path: Path) -> None:
    motion = next(iter(sample.clips.values())).motion
    write_glb(tmp_path / "own.glb", [motion])
    write_glb(tmp_path / "walk.glb", [toy.clip("Take 001", 0.5)])
    project = imported(tmp_path, "own.glb")
    project = import_files(project, tmp_path, [tmp_path / "walk.glb"], retarget="yes").into(project)
    after = turned(project, tmp_path, NAME)
    entry = after.clips["c2"]
    assert entry.name == "Take 001" and entry.brought_from and entry.motion is not None
    assert entry.motion.skeleton is after.skeleton
