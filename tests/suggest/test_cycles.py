"""One cycle of a wave, a clap, a nod: a gesture that repeats, with and without its name; an idle is none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.suggest.proposal import Proposal, Proposals
from metagraph.suggest.propose import accept, propose
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

SKELETON = mannequin_skeleton()
Turns = Mapping[str, tuple[float, float, float]]  # joint -> degrees about X, Y, Z
DOWN: Turns = {"LeftUpperArm": (0, 0, -42), "RightUpperArm": (0, 0, 42)}
UP: Turns = {"RightUpperArm": (0, 0, -60), "RightLowerArm": (0, 0, -50)}
BOTH_UP: Turns = {"RightUpperArm": (0, 0, -70), "LeftUpperArm": (0, 0, 70)}
AHEAD: Turns = {"LeftUpperArm": (-60, 30, -30), "RightUpperArm": (-60, -30, 30)}
CYCLES: Mapping[str, tuple[Turns, Turns, float]] = {  # name: where it is, how far it swings, seconds
    "Waving": (UP, {"RightLowerArm": (0, 0, 25)}, 0.57),
    "Clapping": (AHEAD, {"LeftUpperArm": (0, 20, 0), "RightUpperArm": (0, -20, 0)}, 0.5),
    "Cheering": (BOTH_UP, {"LeftUpperArm": (0, 0, 20), "RightUpperArm": (0, 0, -20)}, 0.8),
    "Nod": (DOWN, {"Neck": (9, 0, 0), "Head": (9, 0, 0)}, 0.6),
    "Head shake": (DOWN, {"Neck": (0, 12, 0), "Head": (0, 12, 0)}, 0.7),
}
ARMS = ("Waving", "Clapping", "Cheering")


def moved(name: str, seconds: float, turns: Any, fps: float = 30.0) -> Clip:
    """Return a clip; turns: joint -> degrees, at a share of the clip."""
    frames = round(seconds * fps) + 1
    rotations = np.tile(SKELETON.rest_rotations, (frames, 1, 1))
    for n, share in enumerate(np.linspace(0.0, 1.0, frames)):
        for joint, degrees in turns(share).items():
            rotations[n, SKELETON.index(joint)] = rotation.exp(np.radians(np.array(degrees, float)))
    return Clip(name, SKELETON, fps, rotations, np.tile(SKELETON.rest_translations[:1], (frames, 1, 1)))


def added(base: Turns, more: Turns, weight: float) -> dict[str, Any]:
    out = {**DOWN, **base}
    for joint, degrees in more.items():
        out[joint] = tuple(np.array(out.get(joint, (0, 0, 0))) + weight * np.array(degrees))
    return out


def cycle(name: str, cut: float = 0.0, seconds: float | None = None) -> Clip:
    """Return one cycle, cut a share of it after its middle."""
    base, swing, usual = CYCLES[name]
    return moved(name, seconds or usual, lambda x: added(base, swing, np.sin(2 * np.pi * (x + cut))))


def idle(name: str = "Idle", seconds: float = 4.0, degrees: float = 0.7) -> Clip:
    return moved(name, seconds, lambda x: added({}, {"Chest": (degrees, 0, 0)}, np.sin(2 * np.pi * x)))


def gesture(name: str, seconds: float = 2.0) -> Clip:
    """Return a gesture that goes out of the stance and back to it."""
    there = {"RightUpperArm": (-40, 0, 0), "RightLowerArm": (-30, 0, 0)}
    return moved(name, seconds, lambda x: added({}, there, np.sin(np.pi * x) ** 2))


def labelled(*clips: Clip, named: bool = True) -> tuple[Project, Proposals]:
    added_ = [
        (f"{n}.glb", 0, "", c)
        for n, c in enumerate((idle(), gesture("Talking"), gesture("Telling", 2.6), *clips))
    ]
    project = edits.add_clips(Project(skeleton=SKELETON), added_)
    return project, propose(project, sources=("name", "motion") if named else ("motion",))


def proposal(project: Project, found: Proposals, name: str) -> Proposal:
    return next(p for c, p in found.proposals.items() if project.clips[c].name == name)


@pytest.mark.parametrize("named", [True, False], ids=["named", "unnamed"])
@pytest.mark.parametrize("cut", [0.0, 0.1, 0.25])
@pytest.mark.parametrize("name", CYCLES)
def test_one_cycle_is_a_gesture_that_repeats_wherever_it_is_cut(name: str, cut: float, named: bool) -> None:
    project, found = labelled(cycle(name, cut), named=named)
    p = proposal(project, found, name)
    assert (p.kind.value, p.cycle) == ("gesture", True)
    assert 1.5 <= p.timing["repeat"] <= 3.0 and p.timing["end"] is None and p.timing["start"] == 0.0
    length = project.clips[p.clip].duration
    assert p.timing["repeat"] / length == pytest.approx(round(p.timing["repeat"] / length), abs=0.01)
    assert "cycle" in str(p.details["repeat"].reason)
    assert p.layer.value == ("arms" if name in ARMS else "head")


@pytest.mark.parametrize("cut", [0.2, 0.23, 0.27])
@pytest.mark.parametrize("name", ARMS)
def test_one_cycle_that_is_cut_near_its_turn_repeats_if_named(name: str, cut: float) -> None:
    project, found = labelled(cycle(name, cut, 0.5))
    p = proposal(project, found, name)
    assert (p.kind.value, p.cycle) == ("gesture", True)


def test_a_name_that_says_a_gesture_makes_a_small_movement_one() -> None:
    small = moved("Clapping", 0.77, lambda x: added(AHEAD, {"RightHand": (9, 0, 0)}, np.sin(6.283 * x)))
    project, found = labelled(small)
    assert proposal(project, found, "Clapping").cycle
    project, found = labelled(small, named=False)
    assert not proposal(project, found, "Clapping").cycle


@pytest.mark.parametrize("named", [True, False], ids=["named", "unnamed"])
def test_all_of_them_together_are_seen_when_they_play(named: bool) -> None:
    project, found = labelled(*(cycle(name) for name in CYCLES), named=named)
    taken = accept(project, found)
    assert not taken.left
    wrong = [p for p in check_project(taken.project) if p.code in ("hardly-seen", "blend", "far-start")]
    assert not wrong
    repeats = [a.name for a in taken.project.actions() if a.timing.repeat > 0]
    assert sorted(repeats) == sorted(CYCLES)


@pytest.mark.parametrize("name", ["Idle", "Breathing", "Take 3"])
@pytest.mark.parametrize("seconds", [0.8, 1.2])
def test_a_short_idle_stays_a_stance(name: str, seconds: float) -> None:
    project, found = labelled(idle(name + " short", seconds))
    p = proposal(project, found, name + " short")
    assert (p.kind.value, p.cycle, "repeat" in p.timing) == ("stance", False, False)


def test_what_a_name_calls_an_idle_is_one_however_it_moves() -> None:
    project, found = labelled(moved("Idle 02", 0.5, lambda x: added({}, UP, 0.1 * np.sin(6.283 * x))))
    p = proposal(project, found, "Idle 02")
    assert not p.cycle and "repeat" not in p.timing


@pytest.mark.parametrize("seconds", [0.6, 0.9, 1.2])
def test_a_short_gesture_that_comes_from_its_stance_plays_once(seconds: float) -> None:
    project, found = labelled(gesture("Point", seconds))
    p = proposal(project, found, "Point")
    assert (p.cycle, "repeat" in p.timing) == (False, False)


def test_several_cycles_in_one_clip_play_once() -> None:
    base, swing, _ = CYCLES["Waving"]
    clip = moved("Waving", 2.3, lambda x: added(base, swing, np.sin(8 * np.pi * x)))
    project, found = labelled(clip)
    assert "repeat" not in proposal(project, found, "Waving").timing


def test_steps_in_place_do_not_repeat() -> None:
    legs = {"LeftUpperLeg": (25, 0, 0), "RightUpperLeg": (-25, 0, 0), "LeftUpperArm": (15, 0, 0)}
    _, found = labelled(moved("March", 0.9, lambda x: added({}, legs, np.sin(2 * np.pi * x))))
    assert not any("repeat" in p.timing for p in found.proposals.values())
