"""Clips of other skeletons on their way into a project: left out, asked about, or retargeted; and again when
it is opened.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.imports import bring_over, find_strangers, import_files
from metagraph.formats.project.clip_loading import relocate
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.journal import find_changes
from metagraph.formats.project.replay import apply_change
from metagraph.formats.store import open_project, save_project
from metagraph.graph.check import check_project
from metagraph.graph.editing.retargeting import Bringing
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import JointMap, RetargetError, make_fingerprint, propose_joint_map
from metagraph.motion.skeleton import Skeleton


@pytest.fixture
def folder(toy: Any, sample: Any, tmp_path: Path) -> Path:
    """Two clips of the toy and two of the sample's mannequin."""
    for name in ("rest", "wave"):
        write_glb(tmp_path / f"{name}.glb", [toy.clip(name, 0.6, swing=0.3)])
    theirs = [e.motion for e in sample.clips.values()][:2]
    for n, clip in enumerate(theirs):
        write_glb(tmp_path / f"other{n}.glb", [clip.trimmed(0, 20).renamed(f"other{n}")])
    return tmp_path


def start(folder: Path) -> Project:
    return import_files(Project(), folder, [folder / "rest.glb", folder / "wave.glb"]).into(Project())


def others(folder: Path) -> list[Path]:
    return [folder / "other0.glb", folder / "other1.glb"]


def stranger(name: str) -> Clip:
    names = tuple(f"bone{n}" for n in range(9))
    skeleton = Skeleton(
        names, np.arange(-1, 8), np.tile([0, 0, 0, 1.0], (9, 1)), np.tile([0, 0.2, 0], (9, 1))
    )
    return Clip(
        name,
        skeleton,
        30,
        np.tile(skeleton.rest_rotations, (5, 1, 1)),
        np.tile(skeleton.rest_translations[:1], (5, 1, 1)),
    )


def test_without_a_word_they_are_left_out_and_the_remedy_is_named(folder: Path) -> None:
    result = import_files(start(folder), folder, others(folder))
    assert not result.loaded and not result.strangers and not result.joint_maps
    assert len(result.failures) == 2
    assert result.failures[0].startswith("other0.glb: 1 clip belongs to another character")
    assert result.failures[0].endswith(
        "Retarget it (import it with --retarget), or import it into a separate project."
    )


def test_asked_for_they_come_in_one_group_a_skeleton_with_a_proposed_map(folder: Path, sample: Any) -> None:
    project = start(folder)
    result = import_files(project, folder, others(folder), retarget="ask")
    assert not result.loaded and not result.failures
    (group,) = result.strangers
    assert len(group.clips) == 2 and not group.remembered and not group.joint_map.missing
    assert group.fingerprint == make_fingerprint(sample.skeleton) == group.joint_map.source
    assert len(group.failures) == 2


def test_said_yes_they_are_retargeted_and_the_map_is_kept(folder: Path, sample: Any) -> None:
    project = start(folder)
    result = import_files(project, folder, others(folder), retarget="yes")
    assert not result.failures and result.retargeted == 2
    assert any("2 clips (other0.glb …)" in note for note in result.notes)
    after = result.into(project)
    assert after.skeleton is project.skeleton and set(after.joint_maps) == {make_fingerprint(sample.skeleton)}
    new = [e for e in after.clips.values() if e.id not in project.clips]
    assert all(
        e.brought_from == make_fingerprint(sample.skeleton) and e.motion.skeleton is project.skeleton
        for e in new
    )  # type: ignore[union-attr]
    assert all("brought over" in " ".join(e.motion.notes) for e in new)  # type: ignore[union-attr]
    assert not [p for p in check_project(after) if p.code == "other-skeleton"]


def test_once_the_project_has_a_map_the_next_ones_are_retargeted_unasked_but_told(folder: Path) -> None:
    project = start(folder)
    first, second = others(folder)
    project = import_files(project, folder, [first], retarget="yes").into(project)
    result = import_files(project, folder, [second], retarget="no")
    assert len(result.loaded) == 1 and not result.failures
    assert any(note.startswith("other1.glb: ") and "retargeted" in note for note in result.notes)


def test_what_was_mapped_by_hand_in_another_project_is_offered_again(folder: Path) -> None:
    project = start(folder)
    (group,) = import_files(project, folder, others(folder), retarget="ask").strangers
    mine = group.joint_map.without("LeftHand")
    asked: list[tuple[str, str]] = []

    def remembered(source: str, target: str) -> JointMap:
        asked.append((source, target))
        return mine

    (again,) = import_files(project, folder, others(folder), retarget="ask", remembered=remembered).strangers
    assert again.remembered and again.joint_map == mine
    assert asked == [(group.fingerprint, make_fingerprint(project.skeleton))]  # type: ignore[arg-type]


def test_what_cannot_be_mapped_says_what_is_missing(folder: Path) -> None:
    write_glb(folder / "odd.glb", [stranger("odd")])
    result = import_files(start(folder), folder, [folder / "odd.glb"], retarget="yes")
    assert not result.loaded
    (text,) = result.failures
    assert "odd.glb" in text and "no hips" in text and "separate project" in text
    (group,) = import_files(start(folder), folder, [folder / "odd.glb"], retarget="ask").strangers
    assert group.joint_map.missing and "--retarget" not in group.failures[0]


def test_in_a_folder_of_two_characters_most_clips_decide_and_the_rest_is_retargeted(
    folder: Path, toy: Any
) -> None:
    write_glb(folder / "third.glb", [toy.clip("third", 0.5)])
    result = import_files(Project(), folder, [folder], retarget="yes")
    after = result.into(Project())
    assert after.skeleton == toy.skeleton and len(after.clips) == 5 and result.retargeted == 2


def test_a_saved_project_retargets_the_same_way_when_it_is_opened(folder: Path) -> None:
    project = start(folder)
    project = import_files(project, folder, others(folder), retarget="yes").into(project)
    path = folder / "p.metagraph.yaml"
    save_project(project, path, path)
    opened = open_project(path)
    assert not opened.notes and opened.project == project
    for ident, entry in project.clips.items():
        again = opened.project.clips[ident].motion
        assert entry.motion is not None and again is not None
        np.testing.assert_array_equal(again.rotations, entry.motion.rotations)
        np.testing.assert_array_equal(again.translations, entry.motion.translations)


def test_the_map_and_not_a_new_proposal_is_what_counts_on_opening(folder: Path, sample: Any) -> None:
    project = start(folder)
    bringing = Bringing(project)
    (group,) = import_files(project, folder, others(folder), retarget="ask").strangers
    less = (
        group.joint_map.without("Neck")
        if group.joint_map.of("Neck")
        else group.joint_map.without(group.joint_map.pairs[-1].source)
    )
    project = bring_over(bringing, group, less).into(project)
    path = folder / "p.metagraph.yaml"
    save_project(project, path, path)
    opened = open_project(path).project
    assert opened.joint_maps[group.fingerprint] == less
    new = next(e for e in opened.clips.values() if e.brought_from)
    assert f"{len(less.pairs)} are mapped" in " ".join(new.motion.notes)  # type: ignore[union-attr]


def test_a_source_file_that_has_moved_is_found_and_retargeted(folder: Path) -> None:
    project = start(folder)
    project = import_files(project, folder, others(folder), retarget="yes").into(project)
    path = folder / "p.metagraph.yaml"
    save_project(project, path, path)
    away = folder.parent / f"{folder.name}-away"
    away.mkdir()
    for file in others(folder):
        file.rename(away / file.name)
    opened = open_project(path).project
    lost = [e for e in opened.clips.values() if e.motion is None]
    assert len(lost) == 2 and all(e.brought_from for e in lost)
    found = relocate(opened, folder, away)
    assert all(e.motion is not None and e.motion.skeleton == found.skeleton for e in found.clips.values())


def test_a_broken_map_is_told_with_its_place_and_the_project_still_opens(folder: Path) -> None:
    project = start(folder)
    project = import_files(project, folder, others(folder), retarget="yes").into(project)
    path = folder / "p.metagraph.yaml"
    save_project(project, path, path)
    good = path.read_text()
    key = next(iter(project.joint_maps))
    for old, new, words in (
        ("    pairs:\n", "    pears:\n", f"joint_maps.{key}"),
        (", sure: 1,", ", sure: quite,", f"joint_maps.{key}.pairs["),
    ):
        assert old in good, old
        path.write_text(good.replace(old, new, 1))
        opened = open_project(path)
        assert len(opened.project.clips) == 4
        assert any(words in note and "left out" in note for note in opened.notes), opened.notes
        assert any("import it again" in note for note in opened.notes)


def test_the_journal_keeps_maps_and_what_was_retargeted(folder: Path) -> None:
    project = start(folder)
    after = import_files(project, folder, others(folder), retarget="yes").into(project)
    change = find_changes(project, after)
    assert set(change["joint_maps"]) == set(after.joint_maps)
    assert from_data(apply_change(to_data(project), change)) == after


def test_retargeted_clips_are_read_again_on_their_own_skeleton_to_correct_their_map(
    folder: Path, sample: Any
) -> None:
    project = start(folder)
    assert find_strangers(project, folder) == ()
    project = import_files(project, folder, others(folder), retarget="yes").into(project)
    (group,) = find_strangers(project, folder)
    assert group.skeleton == sample.skeleton and len(group.clips) == 2
    assert group.joint_map == project.joint_maps[group.fingerprint]
    assert len(find_strangers(project, folder, ["c3"])) == 1
    (folder / "other0.glb").unlink()
    (less,) = find_strangers(project, folder)
    assert len(less.clips) == 1


def test_a_map_that_names_unknown_joints_is_told_and_the_project_still_opens(folder: Path) -> None:
    project = start(folder)
    project = import_files(project, folder, others(folder), retarget="yes").into(project)
    key, joint_map = next(iter(project.joint_maps.items()))
    pairs = (replace(joint_map.pairs[0], target="Nowhere"), *joint_map.pairs[1:])
    path = folder / "p.metagraph.yaml"
    save_project(replace(project, joint_maps={key: replace(joint_map, pairs=pairs)}), path, path)
    opened = open_project(path)
    assert any("'Nowhere'" in note for note in opened.notes)
    assert all(e.motion is not None for e in opened.project.clips.values())


def test_where_the_rest_pose_does_not_stand_the_projects_own_clip_says_how_it_does(toy: Any) -> None:
    lying = toy.skeleton.rest_rotations.copy()
    lying[0] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
    skeleton = Skeleton(toy.skeleton.names, toy.skeleton.parents, lying, toy.skeleton.rest_translations)
    own = replace(toy.clip("own", 0.5), skeleton=skeleton)
    project = import_less(own)
    bringing = Bringing(project)
    assert bringing.pose is not None
    out = bringing.bring(toy.clip("c", 0.5), propose_joint_map(toy.skeleton, skeleton))
    wanted = toy.skeleton.globals(toy.clip("c", 0.5).poses())[1]
    np.testing.assert_allclose(skeleton.globals(out.poses())[1], wanted, atol=0.05)


def import_less(clip: Clip) -> Project:
    from metagraph.graph.edits import add_clips

    return add_clips(Project(), [("own.glb", 0, "", clip)])


def test_an_empty_project_has_nothing_to_bring_clips_onto(toy: Any) -> None:
    with pytest.raises(RetargetError, match="no skeleton"):
        Bringing(Project()).propose(toy.skeleton)


def test_a_bvh_in_another_size_with_the_same_joints_is_retargeted_too(folder: Path, toy: Any) -> None:
    project = start(folder)
    large = Skeleton(
        toy.skeleton.names,
        toy.skeleton.parents,
        toy.skeleton.rest_rotations,
        toy.skeleton.rest_translations * 1.5,
    )
    clip = toy.clip("large", 0.5)
    big = replace(clip, skeleton=large, translations=clip.translations * 1.5)
    write_bvh(big, folder / "large.bvh")
    result = import_files(project, folder, [folder / "large.bvh"], retarget="yes")
    assert result.retargeted == 1
    found, wanted = (toy.skeleton.globals(c.poses())[1] for c in (result.loaded[0][3], clip))
    np.testing.assert_allclose(found - found[:, :1], wanted - wanted[:, :1], atol=0.01)


def test_one_that_cannot_be_retargeted_fails_alone(folder: Path) -> None:
    project = start(folder)
    (group,) = import_files(project, folder, others(folder), retarget="ask").strangers
    odd = (*group.clips[:1], ("odd.glb", 0, "", stranger("odd")), *group.clips[1:])
    result = bring_over(Bringing(project), replace(group, clips=odd), group.joint_map)
    assert len(result.loaded) == 2
    assert len(result.failures) == 1 and result.failures[0].startswith("odd.glb: ")


def test_stopped_it_keeps_what_was_retargeted(folder: Path) -> None:
    project = start(folder)
    (group,) = import_files(project, folder, others(folder), retarget="ask").strangers
    seen: list[int] = []
    result = bring_over(
        Bringing(project), group, group.joint_map, lambda n, _: seen.append(n), lambda: len(seen) == 1
    )
    assert result.cancelled and len(result.loaded) == 1
