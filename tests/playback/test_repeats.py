"""One cycle of a clip that goes on for as long as it is wanted: when it plays, and what shows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.engine_machine import (
    count_unrepeated,
    list_machines,
    make_animations,
    make_clip_as_played,
)
from metagraph.engines.export import write_project_files
from metagraph.engines.reading import read_export
from metagraph.formats.project.data import decode_action, encode_action
from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Play, make_request
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Cue, MetaRequest, Plan
from metagraph.playback.planner import extend_plan, make_plan
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.playback.posing.cue_times import cue_seconds
from metagraph.playback.timing.phases import find_phases

RATE = 120.0
CYCLE = 0.4  # seconds of the toy's clip that repeat here: from 0.3 on, amid its swing


@pytest.fixture
def project(toy: Any) -> Project:
    project = toy.project()
    timing = {"start": 0.3, "end": 0.3 + CYCLE, "blend_in": 0.3, "blend_out": 0.3, "repeat": 2.0}
    return edits.update_actions(project, [toy.id(project, "rest wave rt")], timing=timing)


@pytest.fixture
def wave(project: Project, toy: Any) -> str:
    return str(toy.id(project, "rest wave rt"))


def planned(project: Project, *requests: MetaRequest, end: float = 20.0) -> Plan:
    return make_plan(project, end, requests, 1, idle=False)


def asked(wave: str, **more: Any) -> MetaRequest:
    return MetaRequest("r", "arms", "gesture", 1.0, action=wave, **more)


def played(plan: Plan, n: int = 0) -> Cue:
    return plan.layers["arms"].cues[n]


def hand(project: Project, plan: Plan, times: Any) -> Any:
    pose = Evaluator(plan, project).at(times, False)
    assert project.skeleton is not None
    _, at = project.skeleton.globals(Pose(pose.rotations.astype(float), pose.translations.astype(float)))
    return at[:, anatomy.project_roles(project)["right_hand"]]


# --- when it plays


@pytest.mark.parametrize(("duration", "cycles"), [(None, 5), (3.0, 8), (0.1, 1), (0.0, 1)])
def test_it_plays_whole_cycles_for_as_long_as_asked(
    project: Project, wave: str, duration: float | None, cycles: int
) -> None:
    cue = played(planned(project, asked(wave, duration=duration)))
    assert [cue.start, cue.end] == pytest.approx([1.0, 1.0 + cycles * CYCLE])
    assert [cue.cycle_from, cue.cycle_to] == pytest.approx([0.3, 0.7])


@pytest.mark.parametrize(("hold", "duration", "cycles"), [(3.0, None, 8), (0.0, None, 1), (3.0, 1.2, 3)])
def test_a_hold_makes_it_go_on_where_no_duration_is_asked_for(
    project: Project, wave: str, hold: float, duration: float | None, cycles: int
) -> None:
    cue = played(planned(project, asked(wave, hold=hold, duration=duration)))
    assert cue.end - cue.start == pytest.approx(cycles * CYCLE) and cue.hold == 0


def test_a_request_for_an_action_says_how_long(project: Project, wave: str) -> None:
    ask = make_request({"do": "action", "action": wave, "at": 1.0, "duration": 4.0})
    cue = played(plan_performance(project, [ask], 9.0, idle=False))
    assert cue.end - cue.start == pytest.approx(10 * CYCLE)


def test_an_action_that_plays_once_keeps_its_length_whatever_is_asked(project: Project, wave: str) -> None:
    project = edits.update_actions(project, [wave], timing={"repeat": 0.0})
    plans = [
        plan_performance(project, [Play(action=wave, at=1.0, duration=seconds)], 9.0, idle=False)
        for seconds in (None, 4.0)
    ]
    assert played(plans[0]) == played(plans[1])
    assert played(plans[0]).end == pytest.approx(1.0 + CYCLE)


def test_its_first_stroke_lands_as_asked(project: Project, wave: str) -> None:
    action = project.action(wave)
    assert action is not None
    cue = played(planned(project, asked(wave, stroke=5.0)))
    stroke = find_phases(project, action).stroke
    assert cue.start + stroke - cue.entry == pytest.approx(5.0)
    assert cue.clip_seconds(5.0) == pytest.approx(stroke)


def test_after_its_first_cycle_it_is_left_for_what_is_asked_next(
    project: Project, wave: str, toy: Any
) -> None:
    other = MetaRequest("s", "arms", "gesture", 2.0, action=toy.id(project, "rest beat lf"))
    plan = planned(project, asked(wave), other)
    assert [(c.meta, c.start) for c in plan.layers["arms"].cues] == [("r", 1.0), ("s", 2.0)]


def test_what_cuts_it_leaves_the_rest_of_its_time(project: Project, wave: str, toy: Any) -> None:
    other = MetaRequest("s", "arms", "gesture", 3.0, action=toy.id(project, "rest beat lf"), priority=2)
    plan = planned(project, asked(wave, duration=6.0, resume=True), other)
    metas = [c.meta for c in plan.layers["arms"].cues]
    assert metas == ["r", "s", "r+1"]
    last = played(plan, 2)
    assert last.end == pytest.approx(7.0, abs=CYCLE / 2)


def test_it_plays_for_nothing_more_important_where_not_even_one_cycle_fits(
    project: Project, wave: str, toy: Any
) -> None:
    other = MetaRequest("s", "arms", "gesture", 1.5, action=toy.id(project, "rest beat lf"), priority=2)
    plan = planned(project, asked(wave), other)
    assert [c.meta for c in plan.layers["arms"].cues] == ["s"]


def test_a_plan_made_step_by_step_is_the_same(project: Project, wave: str) -> None:
    requests = (asked(wave, duration=5.0), MetaRequest("t", "arms", "gesture", 9.0, action=wave))
    whole = planned(project, *requests)
    steps = make_plan(project, 2.0, requests, 1, idle=False)
    for now, end in ((1.5, 3.1), (3.0, 7.7), (7.5, 20.0)):
        steps = extend_plan(project, steps, now, (), end, idle=False)
    assert steps.layers["arms"].cues == whole.layers["arms"].cues


# --- what shows


def test_its_cycles_meet_without_a_jump_and_it_ends_at_rest(project: Project, wave: str) -> None:
    plan = planned(project, asked(wave))
    times = np.arange(0.5, 4.5, 1 / RATE)
    far = np.linalg.norm(np.diff(hand(project, plan, times), axis=0), axis=-1)
    entry = project.clips[project.action(wave).clip].motion  # type: ignore[union-attr]
    assert entry is not None
    _, own = entry.skeleton.globals(entry.pose_at(np.arange(0.3, 0.7, 1 / RATE)))
    usual = np.linalg.norm(np.diff(own, axis=0), axis=-1).max()
    away = np.linalg.norm(hand(project, plan, np.array([2.0, 4.4])), axis=-1)
    assert far.max() < 3 * usual, "no jump, though the cycle's ends do not meet"
    assert far[times[:-1] > 3.0][0] < 1e-6 + usual and abs(away[0] - away[1]) > 0.01
    ends = far[np.abs(times[:-1] - played(plan).end) < 0.01]
    assert ends.max() < 0.1 * usual, "it comes to rest, though the clip moves at its end"


def test_the_same_shows_one_cycle_later(project: Project, wave: str) -> None:
    plan = planned(project, asked(wave, duration=4.0))
    times = np.linspace(2.0, 2.0 + CYCLE, 20)
    later = hand(project, plan, times + CYCLE)
    assert later == pytest.approx(hand(project, plan, times), abs=0.02)  # except for what the stance does


def test_plain_numbers_say_the_same_as_arrays(project: Project, wave: str) -> None:
    cue = played(planned(project, asked(wave, stroke=1.2)))
    times = np.linspace(cue.start, cue.end, 97, endpoint=False)
    assert [cue_seconds(cue, float(t)) for t in times] == pytest.approx(cue.clip_seconds(times).tolist())
    assert cue.once.end == pytest.approx(cue.start + cue.cycle_to - cue.entry) and not cue.once.repeats


# --- files


def test_a_gesture_of_an_older_file_that_loops_plays_once(project: Project, wave: str) -> None:
    action = project.action(wave)
    assert action is not None
    data = encode_action(replace(action, timing=replace(action.timing, loop=True, repeat=0.0)))
    assert "repeat" not in data and data["loop"] is True
    old = edits.update_actions(project, [wave], timing=decode_action(data, "arms", "$").timing)
    cue = played(planned(old, asked(wave, duration=3.0)))
    assert cue.end - cue.start == pytest.approx(CYCLE) and not cue.repeats


def test_an_export_says_that_it_repeats_and_nothing_of_what_plays_once(
    project: Project, wave: str, tmp_path: Path
) -> None:
    made = write_project_files(project, tmp_path / "one")
    assert read_export(made.json).action(wave).timing.repeat == 2.0  # type: ignore[union-attr]
    once = edits.update_actions(project, [wave], timing={"repeat": 0.0})
    assert '"repeat"' not in write_project_files(once, tmp_path / "two").json.read_text("utf-8")


def test_engines_that_cannot_repeat_get_an_animation_of_the_usual_length(project: Project, wave: str) -> None:
    built = list_machines(project)
    made = {clip.name: clip for clip in make_animations(project, built)}
    state = next(s for m in built for s in m.states if s.action.id == wave)
    clip = made[state.name]
    assert state.seconds == pytest.approx(2.0) == pytest.approx(clip.duration)
    steps = np.abs(np.diff(clip.rotations, axis=0)).max((1, 2))
    assert steps.max() < 3 * steps[:12].max(), "no jump, though the cycle's ends do not meet"


def test_a_clip_that_is_written_alone_shows_its_movement_as_often_as_it_plays(
    project: Project, wave: str
) -> None:
    entry = project.clips[project.action(wave).clip]  # type: ignore[union-attr]
    shown = make_clip_as_played(project, entry)
    assert shown is not None and shown.duration == pytest.approx(2.0, abs=1 / shown.fps)
    other = next(e for e in project.clips.values() if e.id != entry.id)
    assert other.motion is not None and make_clip_as_played(project, other) is other.motion.dense


def test_a_clip_that_another_action_uses_too_is_written_whole_and_counted(
    project: Project, wave: str, toy: Any
) -> None:
    action = project.action(wave)
    assert action is not None and count_unrepeated(project) == 0
    twice = edits.place_clips(project, [action.clip], "arms", "gesture", toy.id(project, "up"))
    entry = twice.clips[action.clip]
    assert entry.motion is not None and make_clip_as_played(twice, entry) is entry.motion.dense
    assert count_unrepeated(twice) == 1


def test_a_duration_is_for_what_can_repeat_alone(project: Project, toy: Any) -> None:
    """One of a transition, or of a part too short to repeat, kept the layer busy for nothing."""
    way, beat = toy.id(project, "rest to up"), toy.id(project, "up beat")
    odd = edits.update_actions(project, [way], timing={"repeat": 2.0})
    asks = [Play(id="go", action=way, at=1.0, duration=10.0), Play(id="beat", action=beat, at=5.0)]
    plan = plan_performance(odd, asks, 12.0, idle=False)
    assert [cue.action.id for cue in plan.layers["arms"].cues] == [way, beat]
