"""What a viewer would see go wrong: each kind of fault is planted in a small project, and found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.playback import continuity
from metagraph.playback.own_moves import find_body_joints
from metagraph.playback.rehearsal import LEAST_MINUTES, rehearse

SECONDS = 40.0


def changed(project: Project, change: Callable[[Clip], Clip], *names: str) -> Project:
    """Return the project with the motion of some clips changed, of all where none is named."""
    clips = {
        ident: replace(entry, motion=change(entry.motion))
        if entry.motion is not None and (not names or entry.name in names)
        else entry
        for ident, entry in project.clips.items()
    }
    return replace(project, clips=clips)


def lifted(metres: float) -> Callable[[Clip], Clip]:
    def change(clip: Clip) -> Clip:
        places = clip.translations.copy()
        places[:, 0, 1] += metres
        return replace(clip, translations=places)

    return change


def travelling(metres: float) -> Callable[[Clip], Clip]:
    def change(clip: Clip) -> Clip:
        places = clip.translations.copy()
        places[:, 0, 2] += metres * np.linspace(0, 1, clip.frames)
        return replace(clip, translations=places)

    return change


def aside(metres: float) -> Callable[[Clip], Clip]:
    def change(clip: Clip) -> Clip:
        places = clip.translations.copy()
        places[:, 0, 0] += metres
        return replace(clip, translations=places)

    return change


def jumping(clip: Clip) -> Clip:
    """The clip with its arms at rest for three frames in the middle."""
    turns, middle = clip.rotations.copy(), clip.frames // 2
    turns[middle : middle + 3] = clip.skeleton.rest_rotations
    return replace(clip, rotations=turns)


def codes(project: Project) -> set[str]:
    return {p.code for p in rehearse(project, SECONDS) if p.severity != "hint"}


@pytest.fixture(scope="module")
def sound(toy: Any) -> Project:
    project: Project = toy.project("body")
    return project


def test_less_than_a_frame_is_nothing_to_look_at(sound: Project) -> None:
    assert rehearse(sound, 0.004) is not None


def test_nothing_plays_in_a_project_without_clips() -> None:
    assert rehearse(Project(), SECONDS) == []


def test_of_a_sound_project_nothing_is_reported(sound: Project) -> None:
    assert codes(sound) == set()


def test_a_figure_above_or_under_the_floor_is_an_error_with_its_moment(sound: Project) -> None:
    for metres, code in ((0.6, "play-in-air"), (-0.6, "play-under-floor")):
        found = [p for p in rehearse(changed(sound, lifted(metres)), SECONDS) if p.code == code]
        assert found and found[0].severity == "error" and "100 %" in found[0].message
        assert found[0].moment is not None and 0 <= found[0].moment < SECONDS


def test_a_figure_without_legs_is_not_said_to_float(toy: Any) -> None:
    legs = tuple(n for n in toy.skeleton.names if "Leg" in n or "Foot" in n)
    keep = [j for j, name in enumerate(toy.skeleton.names) if name not in legs]
    upper = Skeleton(
        tuple(toy.skeleton.names[j] for j in keep),
        np.array([keep.index(p) if p >= 0 else -1 for p in toy.skeleton.parents[keep].tolist()]),
        toy.skeleton.rest_rotations[keep],
        toy.skeleton.rest_translations[keep],
    )
    project = changed(
        toy.project(), lambda clip: replace(clip, skeleton=upper, rotations=clip.rotations[:, keep])
    )
    project = replace(project, skeleton=upper)
    assert not [p for p in rehearse(project, 10) if p.code == "play-in-air"]


def test_a_control_joint_under_the_floor_is_no_part_of_the_figure(toy: Any) -> None:
    from metagraph.motion.roles import find_roles
    from metagraph.motion.skeleton import Skeleton

    bones = toy.skeleton
    control = Skeleton(
        (*bones.names, "elbowIK"),
        np.append(bones.parents, 0),
        np.vstack([bones.rest_rotations, [0, 0, 0, 1]]),
        np.vstack([bones.rest_translations, [0, -5.0, 0]]),
    )
    body = find_body_joints(control, find_roles(control))
    assert len(bones) not in body and set(find_roles(control).values()) <= set(body)
    assert find_body_joints(bones, {}) == list(range(len(bones)))


def test_what_a_clip_in_place_still_does_gets_another_advice(sound: Project, toy: Any) -> None:
    project = changed(sound, travelling(2.0), "rest to up")
    clip = next(a.clip for a in project.actions() if a.name == "rest to up")
    held = replace(project, clips={**project.clips, clip: replace(project.clips[clip], in_place=True)})
    found = [
        p
        for p in rehearse(held, SECONDS)
        if p.code in ("play-slide", "play-sway") and "rest to up" in p.message
    ]
    assert found and {p.code for p in found} == {"play-sway"}
    assert all("Keep" not in p.remedy for p in found)


def test_a_body_that_slides_a_hand_s_breadth_in_a_short_blend_is_a_warning(sound: Project) -> None:
    fast = changed(sound, aside(0.1), "rest to up")
    ways = [a.id for a in fast.actions() if a.name == "rest to up"]
    fast = edits.update_actions(fast, ways, timing={"blend_in": 0.3, "blend_out": 0.3})
    found = [p for p in rehearse(fast, SECONDS) if p.code == "play-sway"]
    assert found and {p.severity for p in found} == {"warning"}
    assert "the body slides" in found[0].message and found[0].action in ways
    slow = edits.update_actions(
        changed(sound, aside(0.02), "rest to up"), ways, timing={"blend_in": 0.3, "blend_out": 0.3}
    )
    assert "play-sway" not in codes(slow)


def standing_aside(toy: Any, metres: float) -> Project:
    """Two stances that stand still, some metres apart, and short blends from one to the other."""
    clips = [toy.clip("here", 3.0, 0.0, swing=0.0), aside(metres)(toy.clip("there", 3.0, 0.0, swing=0.0))]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    here, there = project.clips
    for name, clip in (("here", here), ("there", there)):
        project = edits.add_stance(project, "body", name, [clip])
    a, b = project.graphs["body"].stances
    project = edits.place_clips(project, [there], "body", "transition", a, b)
    project = edits.place_clips(project, [here], "body", "transition", b, a)
    ways = [x.id for x in project.actions() if x.kind == "transition"]
    return edits.update_actions(project, ways, timing={"end": 1.0, "blend_in": 0.3, "blend_out": 0.3})


def test_a_standing_foot_that_slides_in_a_blend_is_reported_unless_it_steps(toy: Any) -> None:
    project = standing_aside(toy, 0.12)
    glides = replace(project, life=Life(on=True, planted_feet=0.0))
    found = [p for p in rehearse(glides, SECONDS) if p.code == "play-skate"]
    assert found and "foot slides" in found[0].message and "Planted feet" in found[0].remedy
    assert found[0].action in {x.id for x in project.actions() if x.kind == "transition"}
    assert "play-skate" not in codes(replace(project, life=Life(on=True)))
    assert "play-skate" not in codes(
        replace(standing_aside(toy, 0.005), life=Life(on=True, planted_feet=0.0))
    )


def test_a_transition_that_travels_slides_back_and_is_named(sound: Project, toy: Any) -> None:
    project = changed(sound, travelling(2.0), "rest to up")
    found = [p for p in rehearse(project, SECONDS) if p.code == "play-slide"]
    assert found and found[0].severity == "error"
    assert toy.id(project, "rest to up") in {p.action for p in found}


def test_a_stance_that_walks_jumps_back_and_is_reported_once(sound: Project) -> None:
    walks = next(a for a in sound.graphs["body"].actions.values() if a.kind == "stance")
    project = changed(sound, travelling(2.0), sound.clips[walks.clip].name)
    found = [p for p in rehearse(project, SECONDS) if p.severity != "hint" and p.action == walks.id]
    assert [(p.severity, p.code, p.remedy) for p in found if "jumps" in p.message] == [
        ("error", "play-slide", "Keep the clip in place.")
    ]
    assert "the body jumps" in found[0].message


def test_a_jump_within_a_clip_is_named_with_the_clip_s_action(toy: Any) -> None:
    project = changed(toy.project("arms"), jumping, "up point")
    found = [p for p in rehearse(project, SECONDS) if p.code == "clip-jump"]
    assert {p.action for p in found} == {toy.id(project, "up point")}
    assert all("in the clip itself" in p.message and p.severity == "warning" for p in found)
    assert all("up point" in p.message and "trim" in p.remedy for p in found)


def test_a_throw_that_the_clip_makes_is_a_hint_and_no_blend_is_blamed(toy: Any) -> None:
    project = changed(
        toy.project("arms"), lambda clip: toy.clip(clip.name, 0.2, 0.0, swing=2.8, fps=60), "rest short"
    )
    found = [p for p in rehearse(project, SECONDS) if p.action == toy.id(project, "rest short")]
    assert {(p.code, p.severity) for p in found} == {("clip-jump", "hint")}


def test_a_stance_that_is_never_reached_is_a_hint(sound: Project, toy: Any) -> None:
    graph = sound.graphs["body"]
    actions = {i: a for i, a in graph.actions.items() if a.name != "up to far"}
    project = replace(sound, graphs={**sound.graphs, "body": replace(graph, actions=actions)})
    (hint,) = [p for p in rehearse(project, 60 * LEAST_MINUTES) if p.code == "play-never"]
    assert hint.stance == toy.id(project, "far") and hint.severity == "hint" and "far" in hint.message


def test_progress_is_told_and_a_cancelled_rehearsal_ends(sound: Project) -> None:
    told: list[tuple[int, int]] = []
    rehearse(sound, SECONDS, lambda done, of: told.append((done, of)))
    assert [done for done, _ in told] == list(range(1, told[0][1] + 1)) and told[-1][0] == told[-1][1]
    assert rehearse(changed(sound, lifted(1.0)), SECONDS, cancelled=lambda: True) == []


@pytest.mark.nightly
def test_what_is_added_to_clips_is_reported_where_it_breaks_the_law_of_continuity(
    sound: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(continuity, "MOST_TURN", 1e-5)
    alive = replace(sound, life=Life())
    assert not [p for p in rehearse(sound, SECONDS) if p.code == "play-added"]
    found = [p for p in rehearse(alive, SECONDS) if p.code == "play-added"]
    assert found and all("beyond what the clips do" in p.message for p in found)
    assert any("gaze" in p.message and "Gaze" in p.remedy and p.moment is not None for p in found)


def test_who_sits_above_the_floor_lacks_a_seat_and_is_not_said_to_float(sound: Project) -> None:
    def seated(clip: Clip) -> Clip:
        raised = lifted(0.6)(clip)
        turns = raised.rotations.copy()
        for side in ("Left", "Right"):
            j = clip.skeleton.index(f"{side}UpperLeg")
            bent = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(-85.0))
            turns[:, j] = rotation.multiply(bent, turns[:, j].astype(float))
        return replace(raised, rotations=turns)

    found = {p.code: p for p in rehearse(changed(sound, seated), SECONDS)}
    assert "play-in-air" not in found and found["play-no-seat"].severity == "hint"
    assert "sits with its feet" in found["play-no-seat"].message and "seat" in found["play-no-seat"].remedy


def test_an_arm_inside_the_body_is_remedied_by_what_is_not_done_yet(sound: Project) -> None:
    def crossing(clip: Clip) -> Clip:
        turns = clip.rotations.copy()
        for side, angle in (("Left", -1.4), ("Right", 1.4)):
            turns[:, clip.skeleton.index(f"{side}UpperArm")] = rotation.from_axis_angle(
                np.array((0.0, 0, 1.0)), np.full(clip.frames, angle)
            )
            turns[:, clip.skeleton.index(f"{side}LowerArm")] = rotation.from_axis_angle(
                np.array((0.0, 0, 1.0)), np.full(clip.frames, angle)
            )
        return replace(clip, rotations=turns)

    inside = changed(sound, crossing)
    for guard, words in ((False, "Turn on *Keep hands out of the body*"), (True, "Skip the action")):
        project = replace(inside, touch=msgspec.structs.replace(inside.touch, guard=guard))
        found = [p for p in rehearse(project, 12.0) if p.code == "play-arm-inside"]
        assert all(p.remedy.startswith(words) for p in found) and (found or guard)
