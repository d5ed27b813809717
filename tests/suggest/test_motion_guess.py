"""Clips that are given from their motion by a rule of their own: walks, short loops, clips of the face, clips
that end nowhere.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.suggest.clip_measures import is_walk
from metagraph.suggest.motion_guess import _passing, guess
from metagraph.suggest.propose import accept, propose
from metagraph.suggest.stances.known import Shape, list_known_stances
from metagraph.suggest.traits import list_known_traits, measure_all_traits

RATE = 30.0


def turned(
    skeleton: Skeleton, turns: dict[str, tuple[tuple[float, float, float], Any]], name: str = "x"
) -> Clip:
    """A clip whose joints turn about axes by angles `[F]`, radians."""
    frames = len(next(iter(turns.values()))[1])
    rotations = np.tile(skeleton.rest_rotations, (frames, 1, 1))
    for joint, (axis, angles) in turns.items():
        rotations[:, skeleton.index(joint)] = rotation.from_axis_angle(
            np.array(axis), np.asarray(angles, float)
        )
    return Clip(name, skeleton, RATE, rotations, np.tile(skeleton.rest_translations[:1], (frames, 1, 1)))


def cycle(seconds: float, count: int = 1) -> Any:
    """`[F]` sines of a cycle that begins where it ends, and goes on as it began."""
    return np.sin(2 * np.pi * count * np.linspace(0, 1, round(seconds * RATE) + 1))


def test_a_cycle_of_steps_is_a_stance_of_the_body(toy: Any) -> None:
    swing = 0.6 * cycle(1.0)
    steps = turned(toy.skeleton, {"LeftUpperLeg": ((1, 0, 0), swing), "RightUpperLeg": ((1, 0, 0), -swing)})
    t = measure_all_traits([steps])["x"]
    assert t.stride > 0.05 and is_walk(t)
    g = guess(t, {})
    assert (g.kind.value, g.layer.value, g.loop.value) == (
        "stance",
        "body",
        True,
    ) and "feet pass each other" in g.kind.reason


def test_a_step_and_a_kick_are_no_walk(toy: Any) -> None:
    once = 0.6 * np.sin(np.pi * np.linspace(0, 1, 31)) ** 2
    assert not is_walk(measure_all_traits([turned(toy.skeleton, {"LeftUpperLeg": ((1, 0, 0), once)})])["x"])
    half = 0.6 * np.linspace(0, 1, 31)
    assert not is_walk(
        measure_all_traits(
            [turned(toy.skeleton, {"LeftUpperLeg": ((1, 0, 0), half), "RightUpperLeg": ((1, 0, 0), -half)})]
        )["x"]
    )


def test_a_short_loop_that_flows_rests_and_one_that_stops_at_its_ends_does_not(toy: Any) -> None:
    small = {
        "LeftUpperArm": ((0, 0, 1), 0.012 * cycle(1.1)),
        "RightUpperArm": ((0, 0, 1), -0.012 * cycle(1.1)),
    }
    assert guess(measure_all_traits([turned(toy.skeleton, small)])["x"], {}).kind.value == "stance"
    wide = 0.8 * np.sin(np.pi * np.linspace(0, 1, 34)) ** 2
    assert (
        guess(
            measure_all_traits([turned(toy.skeleton, {"LeftUpperArm": ((0, 0, 1), wide)})])["x"], {}
        ).kind.value
        != "stance"
    )


def faced(skeleton: Skeleton) -> Skeleton:
    """The skeleton with a jaw and a lid beneath the head."""
    head = skeleton.index("Head")
    return Skeleton(
        (*skeleton.names, "Jaw", "LeftLid"),
        np.append(skeleton.parents, [head, head]),
        np.vstack([skeleton.rest_rotations, [[0, 0, 0, 1.0]] * 2]),
        np.vstack([skeleton.rest_translations, [[0, 0.02, 0.06], [0.03, 0.08, 0.08]]]),
    )


def test_a_clip_of_the_face_is_of_the_head_and_masked_to_what_moves(toy: Any) -> None:
    skeleton = faced(toy.skeleton)
    talk = turned(skeleton, {"Jaw": ((1, 0, 0), 0.2 * np.abs(cycle(1.5, 3)))}, "talk")
    wave = turned(skeleton, {"LeftUpperArm": ((0, 0, 1), np.abs(cycle(1.5)))}, "wave")
    t = measure_all_traits([talk, wave])
    assert t["talk"].face > 0.05 and t["wave"].face == 0
    g = guess(t["talk"], {})
    assert g.layer.value == "head" and g.layer.confidence > 0.9 and g.layer.reason == "only the face moves"
    project = edits.add_clips(Project(), [("talk.glb", 0, "", talk), ("wave.glb", 0, "", wave)])
    found = propose(project, sources=("motion",))
    masks = {project.clips[c].name: p.details["mask"] for c, p in found.proposals.items()}
    assert (
        masks["talk"].value == ("Jaw",) and "1 joint of" in masks["talk"].reason and masks["wave"].value == ()
    )
    taken = accept(project, found)
    assert [
        a.joints for a in taken.project.actions() if project.clips[a.clip].name == "talk" and not a.timing.end
    ][:1] == [("Jaw",)]


def test_what_moves_nothing_is_of_no_layer_that_is_known(toy: Any) -> None:
    skeleton = faced(toy.skeleton)
    g = guess(measure_all_traits([turned(skeleton, {"Jaw": ((1, 0, 0), np.zeros(6))})])["x"], {})
    assert g.layer.confidence < 0.5 and g.layer.reason == "nothing moves"


@pytest.mark.parametrize("degrees", [8.0, 15.0])
def test_a_gesture_that_ends_a_little_elsewhere_but_in_no_stance_is_no_transition(
    sample: Project, degrees: float
) -> None:
    action = next(
        a for a in sample.actions() if a.kind == "gesture" and a.layer == "arms" and "wave" in a.name
    )
    clip = sample.clips[action.clip].motion
    assert clip is not None
    rotations = clip.rotations.astype(float).copy()
    arm = anatomy.project_roles(sample)["left_upper_arm"]
    ramp = np.radians(degrees) * np.linspace(0, 1, clip.frames)
    rotations[:, arm] = rotation.multiply(
        rotations[:, arm], rotation.from_axis_angle(np.array([1.0, 0, 0]), ramp)
    )
    cut = Clip(clip.name, clip.skeleton, clip.fps, rotations, clip.translations, clip.translated)
    g = guess(measure_all_traits([cut])[cut.name], list_known_stances(sample, measure_all_traits(sample)))
    assert g.kind.value == "gesture" and g.end_stance is None


def test_the_layer_that_others_know_is_where_it_is_looked_for(sample: Project) -> None:
    found = measure_all_traits(sample)
    stances = list_known_stances(sample, found)
    action = next(a for a in sample.actions() if a.kind == "gesture" and a.layer == "arms")
    g = guess(found[action.clip], stances, "body")
    assert g.layer.value == "body" and g.stance is not None and g.stance.value.layer == "body"


def test_what_was_looked_at_before_is_known_at_once(sample: Project) -> None:
    fresh = {
        i: replace(c, motion=c.motion.trimmed(0, c.motion.frames))
        for i, c in sample.clips.items()
        if c.motion is not None
    }
    assert list_known_traits(replace(sample, clips=fresh)) == {}
    measure_all_traits(sample)
    assert set(list_known_traits(sample)) == set(sample.clips)


def test_where_stances_are_close_a_clip_that_comes_back_passes_to_none() -> None:
    one, two = (Shape("", n, "arms", (), np.zeros((1, 0, 3)), (), n, 0.0, 1.0) for n in "ab")
    begins, ends = [(0.65, one), (0.35, two)], [(0.6, one), (0.4, two)]
    unknown, back, on = (_passing(begins, ends, z) for z in (0.0, -20.0, 20.0))
    assert back < 0.05 < unknown == pytest.approx(on) and 0.4 < unknown < 0.6
    surely = _passing([(1.0, one)], [(1.0, two)], -20.0)
    assert surely == pytest.approx(1.0), "what ends in another stance passes, however it got there"


@pytest.mark.parametrize("seconds", [4.0, 6.0])
@pytest.mark.parametrize(
    "turns",
    [{"Neck": (0, 20, 0), "Head": (0, 20, 0)}, {"Chest": (0, 0, 8), "Spine": (0, 0, 8)}],
    ids=["a look round", "a lean"],
)
def test_an_idle_that_looks_round_or_leans_is_a_fidget_and_no_stance(seconds: float, turns: Any) -> None:
    from tests.suggest.test_cycles import added, labelled, moved, proposal

    clip = moved("var", seconds, lambda x: added({}, turns, np.sin(np.pi * x) ** 2))
    project, found = labelled(clip, named=False)
    assert proposal(project, found, "var").kind.value == "fidget"


def test_claps_that_go_on_for_seconds_are_a_gesture_and_no_stance() -> None:
    from tests.suggest.test_cycles import AHEAD, added, labelled, moved, proposal

    swing = {"LeftUpperArm": (0, 20, 0), "RightUpperArm": (0, -20, 0)}
    for seconds, claps in ((1.5, 3), (3.0, 6)):
        clip = moved("var", seconds, lambda x, n=claps: added(AHEAD, swing, np.sin(2 * np.pi * n * x)))
        project, found = labelled(clip, named=False)
        p = proposal(project, found, "var")
        assert p.kind.value == "gesture" and p.kind.confidence > 0.6
