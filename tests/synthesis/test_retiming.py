"""Motion is played faster and slower where that shows least, so that it comes when it is heard."""

from __future__ import annotations

from pathlib import Path as Folder
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from metagraph.formats.clips import read_clips
from metagraph.graph.conversation.model import Segment
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.synthesis.assemble import assemble
from metagraph.synthesis.constraints import HeardStates, WantedSegment, find_heard_at, list_wanted
from metagraph.synthesis.graph import BLEND
from metagraph.synthesis.retiming import find_retimable, keeps_constraints, make_timing_cost, retime
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.relaxing import Constraints, Searching, answer_speech, find_misses
from metagraph.synthesis.soft_constraints import SoftConstraints, SoftWish
from metagraph.synthesis.standing_feet import find_standing
from metagraph.synthesis.states import SynthesisError, read_states
from tests.synthesis.talking import speech, talking
from tests.synthesis.test_search import graph_of

Array = NDArray[Any]
NONE = np.zeros(0, int)


def clause(start: float, peak: float, end: float) -> Segment:
    return Segment("clause", start, end, peak)


def made(take: list[Segment], new: list[Segment], seconds: float = 5.0) -> tuple[HeardStates, WantedSegment]:
    """What is heard in a take, and what is wanted of it."""
    graph = graph_of(round(30 * seconds), [0, round(30 * seconds)], {})
    return find_heard_at(graph.states, [take]), list_wanted(new, seconds)


def test_what_is_early_and_late_comes_when_it_is_heard() -> None:
    spoken, want = made([clause(1.6, 2.1, 3.1)], [clause(1.5, 2.1, 3.2)])
    way = np.arange(150)
    found = retime(way, NONE, spoken, want, np.ones(150, bool))
    assert found is not None and found.events == 3
    assert found.was == pytest.approx(0.1 * np.sqrt(2 / 3)) and found.off < 0.5 * found.was
    assert found.moments[0] == 0 and found.moments[-1] == pytest.approx(149)
    assert abs(found.shown[48] - 45) < 1.5 and abs(found.shown[93] - 96) < 1.5, "they come nearer"
    assert "3 starts, ends and stresses" in found.words()


def test_where_all_is_in_time_or_nothing_may_change_nothing_is_retimed() -> None:
    same = [clause(1.5, 2.1, 3.2)]
    spoken, want = made(same, same)
    assert retime(np.arange(150), NONE, spoken, want, np.ones(150, bool)) is None
    spoken, want = made([clause(1.6, 2.1, 3.1)], same)
    assert retime(np.arange(150), NONE, spoken, want, np.zeros(150, bool)) is None
    assert retime(np.arange(150), NONE, spoken, want, np.ones(150, bool), 0.0) is None
    assert retime(np.arange(150), NONE, spoken, list_wanted([], 5.0), np.ones(150, bool)) is None
    for most in (-0.1, 0.51):
        with pytest.raises(SynthesisError, match="0 to 50%"):
            retime(np.arange(150), NONE, spoken, want, np.ones(150, bool), most)
        with pytest.raises(SynthesisError, match="speed may change"):
            SoftWish(retime=most)


@given(st.data())
@settings(max_examples=40, deadline=None)
def test_speed_stays_within_its_bounds_is_smooth_and_changes_only_where_it_may(data: st.DataObject) -> None:
    frames, most = data.draw(st.integers(30, 240)), data.draw(st.sampled_from([0.05, 0.15, 0.3]))
    chance = np.random.default_rng(data.draw(st.integers(0, 1000)))
    new, take, at = [], [], 0.4
    while at < frames / 30 - 1.2:
        a, p, b = at, at + 0.4, at + 0.9
        new.append(clause(a, p, b))
        take.append(clause(*(x + float(chance.uniform(-0.1, 0.1)) for x in (a, p, b))))
        at = b + float(chance.uniform(0.3, 1.0))
    spoken, want = made(take, new, frames / 30)
    free = np.repeat(chance.random(frames // 8 + 1) < 0.7, 8)[:frames]
    jumps = np.sort(chance.integers(1, frames, data.draw(st.integers(0, 2))))
    way = np.arange(frames)
    found = retime(way, jumps, spoken, want, free, most)
    if found is None:
        return
    speed = np.diff(found.moments)
    assert (np.abs(speed - 1) <= most + 1e-3).all() and (speed > 0).all()
    assert (np.abs(np.diff(speed)) <= 2 * most * np.pi / 2 / 5 + 1e-3).all(), "by a cosine over five frames"
    steady = ~free
    for jump in jumps.tolist():
        steady[max(0, jump - BLEND) : jump + BLEND] = True
    whole = np.flatnonzero(steady[:-1] & steady[1:])
    slowness = np.diff(found.shown)
    assert slowness[whole] == pytest.approx(1.0, abs=0.01)
    assert found.off <= found.was + 1e-9
    assert len(found.moments) == frames and (found.frames >= 0).all() and (found.frames < frames).all()


def test_strokes_and_steps_keep_their_speed() -> None:
    said = [clause(1.0, 1.6, 2.4), clause(4.0, 4.5, 5.2)]
    take = talking("take", said, 7.0)
    free = find_retimable([take])
    assert len(free) == 210 and not free[48] and not free[135], "the hand is fastest at the stresses"
    assert free[:20].all() and 0.6 < free.mean() < 0.95
    moved = take.translations.copy()
    moved[:, take.translated.index(0), 2] += np.linspace(0, 7, 210)
    walks = Clip("walk", take.skeleton, 30.0, take.rotations, moved, take.translated)
    assert not find_retimable([walks]).any(), "whose feet go does not stand"
    assert len(find_retimable([take, talking("slow", said, 7.0, fps=24.0)])) == len(
        read_states([take, talking("slow", said, 7.0, fps=24.0)])
    )


def test_a_path_is_found_where_there_is_none_without() -> None:
    graph = graph_of(150, [0, 150], {})
    spoken = find_heard_at(graph.states, [[clause(1.65, 2.1, 3.05)]])
    new = [clause(1.5, 2.1, 3.2)]
    soft = SoftConstraints(free=np.ones(150, bool), most=0.15)
    with pytest.raises(SynthesisError):
        answer_speech(graph, spoken, new, 5.0, searching=Searching(strict=True))
    without = answer_speech(graph, spoken, new, 5.0)
    assert without.given_up == ("exact timing (0.2 s allowed)",) and without.misses
    for strict in (True, False):
        found = answer_speech(graph, spoken, new, 5.0, searching=Searching(strict=strict), soft=soft)
        assert found.retiming is not None and found.given_up == () and found.misses == ()
        assert found.kept == Constraints()
        assert find_misses(spoken, found.path, new, Constraints(), found.retiming) == ()
        assert find_misses(spoken, found.path, new, Constraints()), "it is the speed that does it"
    with pytest.raises(SynthesisError):  # too far for what speed can do
        slow = SoftConstraints(free=soft.free, most=0.02)
        answer_speech(graph, spoken, new, 5.0, searching=Searching(strict=True), soft=slow)


def test_what_a_path_keeps_to_is_not_lost_by_retiming() -> None:
    spoken, want = made([clause(1.5, 2.1, 3.2)], [clause(1.5, 2.1, 3.2)])
    way = np.arange(150)
    assert keeps_constraints(way, np.arange(150.0), spoken, want)
    late = np.clip(np.arange(150.0) - 8, 0, 149)
    assert not keeps_constraints(way, late, spoken, want)
    silent = graph_of(150, [0, 150], {})
    assert not keeps_constraints(way, np.arange(150.0), find_heard_at(silent.states, [[]]), want)


def test_events_in_time_cost_nothing_and_late_ones_their_square() -> None:
    spoken, want = made([clause(1.6, 2.1, 3.2)], [clause(1.5, 2.1, 3.2)])
    cost = make_timing_cost(spoken, want, 2.0, 0.1)
    assert cost is not None
    assert cost.paid(np.arange(150)) == pytest.approx(0.2)  # one event, three frames of three late
    assert make_timing_cost(spoken, list_wanted([], 5.0), 2.0) is None
    assert make_timing_cost(spoken, list_wanted([clause(1.5, 2.1, 3.2)], 5.0, 0.0), 2.0) is None


def test_retimed_motion_has_its_stroke_at_the_stress_and_its_feet_where_they_stood() -> None:
    said = [clause(1.0, 1.6, 2.4), clause(4.1, 4.6, 5.3)]
    take = talking("take", said, 7.0)
    takes = [take, talking("other", speech(7, 3), 7.0, 3)]
    states = read_states(takes)
    spoken = find_heard_at(states, [said, speech(7, 3)])
    way = np.concatenate([np.arange(150), np.arange(210 + 150, 210 + 210)])
    jumps = np.array([150])
    new = [clause(1.1, 1.7, 2.4), clause(4.0, 4.5, 5.3)]
    found = retime(way, jumps, spoken, list_wanted(new, 7.0, 0.1), find_retimable(takes), reach=3)
    assert found is not None and found.off < found.was
    plain, moved = (assemble(states, takes, Path(way, 0.0, jumps), retiming=r) for r in (None, found))
    assert plain.frames == moved.frames == 210 and moved.fps == 30.0
    roles = find_roles(take.skeleton)

    def at(clip: Clip, role: str) -> Array:
        return np.asarray(clip.skeleton.globals(clip.poses())[1][:, roles[role]])

    def fastest(clip: Clip) -> int:
        return int(np.linalg.norm(np.diff(at(clip, "right_hand")[20:80], axis=0), axis=-1).argmax()) + 20

    assert abs(fastest(moved) - 51) < abs(fastest(plain) - 51), "the stroke comes nearer to the stress"
    for foot in ("left_foot", "right_foot"):
        place = at(moved, foot)[:, [0, 2]]
        assert np.linalg.norm(place - place[0], axis=-1).max() < 0.01
    assert np.abs(np.linalg.norm(moved.rotations, axis=-1) - 1).max() < 1e-4


def test_feet_of_other_studios_takes_stay_where_they_stood_when_they_are_retimed(shared_data: Folder) -> None:
    names = ("bow_active", "bow_angry")
    takes = [read_clips(shared_data / "bandai-namco-1" / f"dataset-1_{name}_001.bvh")[0] for name in names]
    states = read_states(takes)
    jump, there = 110, int(states.starts[1])
    way = np.concatenate([np.arange(jump), there + np.arange(10, int(len(states) - there))])
    said: list[list[Segment]] = [[clause(1.9, 2.1, 2.5)], []]  # while the bow is held
    wants = list_wanted([clause(1.97, 2.17, 2.57)], len(way) / 30)
    found = retime(way, np.array([jump]), find_heard_at(states, said), wants, find_retimable(takes), 0.3)
    assert found is not None and found.off < found.was
    made = assemble(states, takes, Path(way, 0.0, np.array([jump])), retiming=found)
    roles, standing_there = find_roles(made.skeleton), find_standing(made.skeleton, made.poses())
    for side, there_it_stands in standing_there.items():
        place = made.skeleton.globals(made.poses())[1][:, roles[f"{side}_foot"]][:, [0, 2]]
        both = there_it_stands[1:] & there_it_stands[:-1]
        slide = 30 * np.linalg.norm(np.diff(place, axis=0), axis=-1)[both]
        assert np.quantile(slide, 0.9) < 0.05, "metres a second"
