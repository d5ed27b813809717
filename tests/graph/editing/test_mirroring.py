"""Left/right twins of actions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from metagraph.formats.clips import digest, read_clips
from metagraph.formats.gltf.writer import write_glb
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.mirroring import make_twin_clips, name_twin, place_twins
from metagraph.graph.edits import add_clips
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip


def with_twins(project: Project, actions: list[str]) -> Project:
    """Make and place the twins of actions, as a caller does that has written the files."""
    made = make_twin_clips(project, actions)
    ids = {}
    for twin in made:
        project = add_clips(project, [(f"{twin.name}.glb", 0, "", twin.motion)])
        new = next(e.id for e in project.clips.values() if e.path == f"{twin.name}.glb")
        ids.update(dict.fromkeys(twin.actions, new))
    return place_twins(project, ids)


def new_actions(before: Project, after: Project) -> list[Any]:
    return [a for a in after.actions() if before.action(a.id) is None]


def test_nothing_to_mirror_is_said(toy: Any) -> None:
    with pytest.raises(EditError, match="nothing to mirror"):
        make_twin_clips(toy.project(), [])


def test_an_action_that_is_gone_is_said(toy: Any) -> None:
    project = toy.project()
    with pytest.raises(EditError, match="no longer"):
        make_twin_clips(project, ["a999"])
    with pytest.raises(EditError, match="no longer"):
        place_twins(project, {"a999": "c1"})


def test_a_motion_that_is_the_same_on_both_sides_has_no_twin(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest beat lf")
    rest = toy.skeleton.rest
    still = Clip(
        "still", toy.skeleton, 30, np.stack([rest.rotations] * 4), np.stack([rest.translations[:1]] * 4)
    )
    action = project.action(ident)
    assert action is not None
    project = edits.with_motions(project, {action.clip: still})
    with pytest.raises(EditError, match=r"'rest beat lf' .*0\.0 cm"):
        make_twin_clips(project, [ident])


def test_a_clip_whose_file_is_missing_is_said(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest wave rt")
    clip = project.action(ident).clip  # type: ignore[union-attr]
    project = replace(project, clips={**project.clips, clip: replace(project.clips[clip], motion=None)})
    with pytest.raises(EditError, match=r"'rest wave rt' .*missing"):
        make_twin_clips(project, [ident])


def test_a_character_that_is_not_the_same_on_both_sides_is_said(toy: Any) -> None:
    from metagraph.motion.skeleton import Skeleton

    project = toy.project()
    offsets = toy.skeleton.rest_translations.copy()
    offsets[toy.skeleton.index("LeftHand")] *= 2
    lopsided = Skeleton(toy.skeleton.names, toy.skeleton.parents, toy.skeleton.rest_rotations, offsets)
    clips = {
        i: replace(e, motion=replace(e.motion, skeleton=lopsided))
        for i, e in project.clips.items()
        if e.motion
    }
    project = replace(project, clips=clips, skeleton=lopsided)
    with pytest.raises(EditError, match="differ in length"):
        make_twin_clips(project, [toy.id(project, "rest wave rt")])


def test_a_twin_stands_beside_its_original_with_sides_exchanged(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest wave rt")
    project = edits.update_actions(
        project,
        [ident],
        tags=("greeting", "right hand"),
        likelihood=2.5,
        joints=("RightUpperArm", "RightHand", "Head"),
        joint_weights=(("RightUpperArm", 0.5), ("Head", 0.25)),
        cooldown=3.0,
    )
    project = edits.update_actions(project, [ident], timing={"start": 0.1, "stroke": 0.5, "blend_in": 0.05})
    after = with_twins(project, [ident])
    original = project.action(ident)
    (twin,) = new_actions(project, after)
    assert original is not None and after.action(ident) == original
    assert twin == replace(
        original,
        id=twin.id,
        clip=twin.clip,
        name="rest wave lf",
        limb="left",
        tags=("greeting", "left hand"),
        joints=("LeftUpperArm", "LeftHand", "Head"),
        joint_weights=(("LeftUpperArm", 0.5), ("Head", 0.25)),
    )
    assert after.clips[twin.clip].name == "rest wave lf" and twin.id not in {a.id for a in project.actions()}


def test_the_motion_of_the_twin_is_the_mirror_image(toy: Any) -> None:
    project = toy.project()
    (twin,) = make_twin_clips(project, [toy.id(project, "rest beat lf")])
    clip = project.clips[project.action(toy.id(project, "rest beat lf")).clip].motion  # type: ignore[union-attr]
    assert clip is not None and twin.name == "rest beat rt" == twin.motion.name
    _, before = clip.skeleton.globals(clip.poses())
    _, after = clip.skeleton.globals(twin.motion.poses())
    left, right = clip.skeleton.index("LeftHand"), clip.skeleton.index("RightHand")
    np.testing.assert_allclose(after[:, right], before[:, left] * [-1, 1, 1], atol=1e-5)


def test_two_actions_of_one_clip_share_one_mirrored_clip(toy: Any) -> None:
    project = toy.project()
    one = toy.id(project, "rest wave rt")
    action = project.action(one)
    assert action is not None
    stance = toy.id(project, "up")
    project = edits.place_clips(project, [action.clip], "arms", "gesture", stance)
    two = next(a.id for a in project.actions() if a.clip == action.clip and a.id != one)
    made = make_twin_clips(project, [one, two, one])
    assert [(t.name, t.actions) for t in made] == [("rest wave lf", (one, two))]


def test_a_name_that_says_no_side_or_is_taken_stays_unique(toy: Any) -> None:
    project = toy.project()
    after = with_twins(project, [toy.id(project, "rest scratch")])
    assert [a.name for a in new_actions(project, after)] == ["rest scratch mirrored"]
    again = make_twin_clips(after, [toy.id(project, "rest scratch")])
    assert again[0].name == "rest scratch mirrored 2"


def test_stances_that_are_twins_by_name_are_exchanged_and_others_kept(toy: Any) -> None:
    project = toy.project()
    project = edits.rename_stance(project, toy.id(project, "rest"), "weight left")
    project = edits.rename_stance(project, toy.id(project, "up"), "weight right")
    left, right = toy.id(project, "weight left"), toy.id(project, "weight right")
    lean = toy.id(project, "rest beat lf")
    away = toy.id(project, "up to far")
    after = with_twins(project, [lean, away])
    ends = {(a.stance, a.end_stance) for a in new_actions(project, after)}
    assert ends == {(right, None), (left, toy.id(project, "far"))}


def test_a_transition_into_its_own_mirror_image_is_refused(toy: Any) -> None:
    project = toy.project()
    project = edits.rename_stance(project, toy.id(project, "rest"), "lean left")
    ident = toy.id(project, "rest to up")
    action = project.action(ident)
    assert action is not None
    project = edits.rename_stance(project, toy.id(project, "up"), "lean right")
    twin = make_twin_clips(project, [ident])[0]
    project = add_clips(project, [("t.glb", 0, "", twin.motion)])
    clip = next(e.id for e in project.clips.values() if e.path == "t.glb")
    after = place_twins(project, {ident: clip})
    (made,) = new_actions(project, after)
    assert (made.stance, made.end_stance) == (action.end_stance, action.stance)


def test_a_clip_that_is_missing_the_original_or_of_another_length_is_refused(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest wave rt")
    action = project.action(ident)
    assert action is not None
    for clip, words in (
        ("c999", "not in the project"),
        (action.clip, "its own twin"),
        (toy.id(project, "up beat"), None),
    ):
        clip = clip if words else project.action(clip).clip  # type: ignore[union-attr]
        with pytest.raises(EditError, match=words or "differ in length"):
            place_twins(project, {ident: clip})


@pytest.mark.nightly
@given(st.data())
@hypothesis_settings(max_examples=15)
def test_the_twin_of_a_twin_is_the_original_but_for_its_ids(sample: Project, data: Any) -> None:
    actions = sorted((a for a in sample.actions() if a.limb != "both"), key=lambda a: a.id)
    action = data.draw(st.sampled_from(actions))
    once = with_twins(sample, [action.id])
    (twin,) = new_actions(sample, once)
    twice = with_twins(once, [twin.id])
    (again,) = new_actions(once, twice)
    assert again.contacts == (), "they are to be found anew"
    assert replace(again, id=action.id, clip=action.clip, contacts=action.contacts) == action
    a, b = sample.clips[action.clip].motion, twice.clips[again.clip].motion
    assert a is not None and b is not None
    np.testing.assert_allclose(a.skeleton.globals(a.poses())[1], b.skeleton.globals(b.poses())[1], atol=1e-5)


def test_names_keep_their_case() -> None:
    assert [name_twin(n) for n in ("Wave_L", "wave_lf_01", "RightPoint", "nod")] == [
        "Wave_R",
        "wave_rt_01",
        "LeftPoint",
        "nod mirrored",
    ]


def test_a_mirrored_clip_can_be_written_and_read_back(sample: Project, tmp_path: Path) -> None:
    action = next(a for a in sample.actions() if a.limb == "left")
    (twin,) = make_twin_clips(sample, [action.id])
    path = tmp_path / f"{twin.name}.glb"
    write_glb(path, [twin.motion])
    (read,) = read_clips(path)
    project = place_twins(*_added(sample, path, read, action.id))
    assert new_actions(sample, project)[0].limb == "right"


def _added(project: Project, path: Path, clip: Clip, action: str) -> tuple[Project, dict[str, str]]:
    project = add_clips(project, [(path.as_posix(), 0, digest(path), clip)])
    return project, {action: next(e.id for e in project.clips.values() if e.path == path.as_posix())}
