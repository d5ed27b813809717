"""Poses by compiled loops: the same as without them."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from metagraph import compiling, object_code
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Life, Project
from metagraph.graph.touch import Touch
from metagraph.motion.skeleton import Pose
from metagraph.playback import laid_plan, laying, loops
from metagraph.playback.composer import rig
from metagraph.playback.contacts import contact_rig, goals_at, solved
from metagraph.playback.crowd import Crowd
from metagraph.playback.life.evaluate import enliven
from metagraph.playback.life.schedule import Schedule, schedule
from metagraph.playback.life.track import LookAt, MoodFrom, Speech, track_of
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import extend, make_plan
from metagraph.playback.player import layered, layers_at, pose_at
from metagraph.playback.weight import weighed
from tests import kernels

ROOT = Path(__file__).parents[2]
LAYERS_ALONE = 1e-6  # how far a pose of the layers may be off
GUARDED = 2e-4  # and one whose hands were pushed out of the body, which widens that


class Switch:
    """The loops, loaded, to be taken away and given back."""

    def __init__(self) -> None:
        assert loops.load()
        self.all = [(x, x.now) for x in loops.LOOPS]

    def off(self) -> None:
        for x, _ in self.all:
            x.now = None

    def on(self) -> None:
        for x, module in self.all:
            x.now = module


@pytest.fixture
def switch() -> Iterator[Switch]:
    found = Switch()
    yield found
    found.off()


def without(switch: Switch, work: Any) -> Any:
    switch.off()
    try:
        return work()
    finally:
        switch.on()


def apart(a: Pose, b: Pose) -> float:
    assert a.rotations.shape == b.rotations.shape and a.rotations.dtype == b.rotations.dtype
    assert a.translations.shape == b.translations.shape and a.translations.dtype == b.translations.dtype
    return float(max(np.abs(a.rotations - b.rotations).max(), np.abs(a.translations - b.translations).max()))


def busy(toy: Any) -> tuple[Project, Plan]:
    """Weights, masks, seams, early exits, sizes and a missing clip, in one plan."""
    project = toy.project()
    project = edits.update_actions(project, [toy.id(project, "rest loop")], timing={"blend_in": 0.4})
    project = edits.update_actions(
        project, [toy.id(project, "rest long")], timing={"earliest_exit": 0.5, "blend_out": 0.3}
    )
    project = edits.update_actions(project, [toy.id(project, "rest scratch")], joints=("Head", "LeftHand"))
    project = edits.set_weight(edits.set_weight(project, "arms", "arms", 0.5), "arms", "legs", 1.7)
    missing = project.action(toy.id(project, "rest short")).clip
    project = replace(project, clips={**project.clips, missing: replace(project.clips[missing], motion=None)})
    asks = [
        MetaRequest(
            f"r{n}", "arms", ("gesture", "fidget", "transition")[n % 3], n * 1.1, 0.4, arousal=n % 3 - 1
        )
        for n in range(30)
    ]
    return project, make_plan(project, 40, asks, 3)


def test_no_times_are_no_poses(switch: Switch, toy: Any) -> None:
    project = toy.project()
    assert pose_at(make_plan(project, 5), project, np.zeros(0)).rotations.shape == (0, 16, 4)
    assert pose_at(Plan(1, 0.0), project, 1.0).rotations.shape == (16, 4)


def test_layers_agree_at_each_time_and_at_many(switch: Switch, toy: Any) -> None:
    project, plan = busy(toy)
    times = np.random.default_rng(1).uniform(-2, 44, 300)
    wanted = without(switch, lambda: layered(plan, project, times))
    assert apart(layered(plan, project, times), wanted) < LAYERS_ALONE
    for n, time in enumerate(times):
        assert apart(layered(plan, project, np.array([time]))[0], wanted[n]) < LAYERS_ALONE, time
    backwards = np.sort(times)[::-1]  # a view, not in one piece
    assert apart(layered(plan, project, backwards)[::-1], layered(plan, project, np.sort(times))) == 0


def test_a_time_is_posed_the_same_whatever_was_looked_at_before(switch: Switch, toy: Any) -> None:
    project, plan = busy(toy)
    first = layered(plan, project, np.array([20.0]))
    for time in (0.0, 39.0, 3600.0, -5.0, 20.0):
        layered(plan, project, np.array([time]))
    laid_plan._lately.clear()
    layered(plan, project, np.array([0.0, 40.0]))
    assert apart(layered(plan, project, np.array([20.0])), first) == 0


def test_of_an_hour_little_is_laid_out(switch: Switch, toy: Any) -> None:
    project = toy.project()
    plan = make_plan(project, 3600)
    laid_plan._lately.clear()
    for time in np.arange(0.0, 3600.0, 50.0):
        layered(plan, project, np.array([time]))
    (kept,) = laid_plan._lately
    assert kept.last - kept.first <= laid_plan.MOST
    assert (
        sum(len(layer[2]) for layer in kept.given[0]) < sum(len(of.cues) for of in plan.layers.values()) / 10
    )


def test_plans_that_were_let_go_are_not_kept(switch: Switch, toy: Any) -> None:
    project = toy.project()
    for seed in range(12):
        layered(make_plan(project, 5, seed=seed), project, np.array([1.0]))
    assert len(laid_plan._lately) <= laid_plan.KEPT


def test_an_edited_project_and_a_plan_that_goes_on_are_seen_at_once(switch: Switch, toy: Any) -> None:
    project, plan = busy(toy)
    at = np.array([12.0, 30.0])
    before = layered(plan, project, at)
    turned = edits.set_weight(project, "arms", "arms", 1.0)
    assert apart(layered(plan, turned, at), without(switch, lambda: layered(plan, turned, at))) < LAYERS_ALONE
    assert apart(layered(plan, turned, at), before) > 1e-3
    later = extend(project, plan, 10.0, [MetaRequest("new", "arms", "gesture", 11.0)], 60.0)
    wanted = without(switch, lambda: layered(later, project, at))
    assert apart(layered(later, project, at), wanted) < LAYERS_ALONE


def test_clips_are_laid_out_once_and_go_with_their_project(switch: Switch, toy: Any) -> None:
    project, plan = busy(toy)
    layered(plan, project, np.array([1.0, 35.0]))
    of = laying.layout(rig(project))
    rows = {layer: of._clips[layer].rows for layer in LAYERS}
    layered(make_plan(project, 40, seed=9), project, np.array([1.0]))
    again = make_plan(project, 40, seed=3)
    layered(again, project, np.array([1.0, 35.0]))
    assert of._clips["body"].rows >= rows["body"] and of._clips["body"].rows <= 2 * max(rows.values())


def test_tables_begin_anew_when_most_of_their_clips_are_gone(switch: Switch, toy: Any) -> None:
    project = toy.project()
    table = laying._Clips(rig(project), "arms", laying._Blocks(rig(project)))
    for n in range(40):
        table.add(rig(project), toy.clip(f"passing {n}", 2.0, 0.0, 0.5))
    assert table.rows > laying.ROWS and not len(table.known)
    table.tidy()
    assert table.rows == 0 and table.add(rig(project), toy.clip("new", 2.0, 0.0, 0.5)) == 0


@pytest.mark.parametrize("alive", [False, True])
def test_the_sample_agrees_with_life_guard_and_weight(switch: Switch, sample: Project, alive: bool) -> None:
    plan = make_plan(sample, 60, seed=4)
    times = np.random.default_rng(2).uniform(-1, 62, 240)
    wanted = without(switch, lambda: pose_at(plan, sample, times, alive))
    found = pose_at(plan, sample, times, alive)
    assert apart(found, wanted) < GUARDED
    assert float(np.median(np.abs(found.rotations - wanted.rotations).max((1, 2)))) < LAYERS_ALONE
    one = pose_at(plan, sample, float(times[7]), alive)
    assert one.rotations.shape == (61, 4) and apart(one, wanted[7]) < GUARDED


def test_who_talks_looks_about_and_feels_agrees(switch: Switch, sample: Project) -> None:
    text = "Well, I think that we should go there tomorrow, because the weather will be fine."
    said = [Speech(f"s{n}", 9.0 * n, 9.0 * n + 7.5, None, text) for n in range(6)]
    looks = [LookAt(f"l{n}", 7.0 * n, 7.0 * n + 4.0, (np.sin(n), 1.5, 1.0)) for n in range(8)]
    feels = [MoodFrom("m", 20.0, 40.0, -0.8, 0.7, 1.0)]
    times = np.random.default_rng(5).uniform(0, 60, 200)
    dull = Life(gaze=0.0, breathing=0.0, blinks=0.0)
    for life in (sample.life, Life(stillness=0.5, lips=0.3, gaze=0.4), dull):
        project = replace(sample, life=life)
        track = track_of([*said, *looks, *feels])
        lives = schedule(life, track, {}, 1, 60.0, Schedule(), 0.0)
        layers = rig(project).compose(layers_at(make_plan(project, 60), project, times), len(times))
        words = project, lives, track
        wanted = without(switch, partial(enliven, layers, *words, times))
        found = enliven(layers, *words, times)
        assert apart(found, wanted) < LAYERS_ALONE
        assert apart(enliven(layers[:1], *words, times[:1]), found[:1]) == 0


def test_bodies_that_lack_much_live_the_same(switch: Switch, toy: Any) -> None:
    project = toy.project()
    plan = make_plan(project, 30)
    times = np.random.default_rng(6).uniform(0, 30, 100)
    for roles in ({}, {"head": "nowhere"}, {"head": "nowhere", "left_shoulder": "nowhere"}):
        lacking = replace(project, roles=roles)
        wanted = without(switch, lambda lacking=lacking: pose_at(plan, lacking, times))
        assert apart(pose_at(plan, lacking, times), wanted) < LAYERS_ALONE


def test_hands_that_are_held_and_pushed_out_are_the_same_to_the_bit(switch: Switch, sample: Project) -> None:
    plan, body = make_plan(sample, 120, seed=4), contact_rig(sample)
    assert body is not None and body.guard and body.capsules
    times = np.random.default_rng(3).uniform(0, 120, 300)
    pose = rig(sample).compose(layers_at(plan, sample, times), len(times))
    goals = [goals_at(plan, sample, body, time) for time in times.tolist()]
    assert any(goals)
    found, wanted = solved(pose, body, goals), without(switch, lambda: solved(pose, body, goals))
    assert wanted is not pose and apart(found, wanted) == 0
    none = solved(pose[:1], body, [[]])
    assert apart(none, without(switch, lambda: solved(pose[:1], body, [[]]))) == 0
    assert solved(pose, replace(body, guard=False), [[] for _ in times]) is pose


def test_bodies_that_answer_and_feet_that_stay_are_the_same(switch: Switch, sample: Project) -> None:
    plan = make_plan(sample, 120, seed=4)
    times = np.random.default_rng(4).uniform(0, 120, 300)
    pose = rig(sample).compose(layers_at(plan, sample, times), len(times))
    wanted = without(switch, lambda: weighed(pose, plan, sample, times))
    assert wanted is not pose and apart(weighed(pose, plan, sample, times), wanted) < 1e-7
    shown = np.linspace(0, 1, len(times))
    half = without(switch, lambda: weighed(pose, plan, sample, times, shown))
    assert apart(weighed(pose, plan, sample, times, shown), half) < 1e-7
    still = replace(sample, life=Life(stillness=1.0, planted_feet=0.0))
    assert weighed(pose, plan, still, times) is pose


def test_poses_of_other_numbers_are_left_to_numpy(switch: Switch, sample: Project) -> None:
    body = contact_rig(sample)
    assert body is not None
    plan = make_plan(sample, 20, seed=4)
    times = np.arange(0, 20, 0.5)
    pose = rig(sample).compose(layers_at(plan, sample, times), len(times))
    exact = Pose(pose.rotations.astype(float), pose.translations.astype(float))
    nothing: list[Any] = [[] for _ in times]
    assert solved(exact, body, nothing).rotations.dtype == np.float64
    model = sample.skeleton.globals(exact)
    assert np.abs(model[1] - sample.skeleton.globals(pose)[1]).max() < 1e-5


def test_where_no_object_code_is_kept_none_is_loaded() -> None:
    assert not loops.load_kept() and not loops.loaded()


def test_without_numba_nothing_is_loaded_and_numpy_answers(monkeypatch: Any, sample: Project) -> None:
    monkeypatch.setattr(loops, "there", lambda: False)
    assert not loops.load() and not loops.loaded()
    monkeypatch.setattr(loops, "_begun", [])
    loops.load_soon()
    assert not loops._begun
    quiet = replace(sample, touch=Touch(False, False))
    assert pose_at(make_plan(quiet, 5), quiet, 1.0).rotations.shape == (61, 4)


@pytest.mark.parametrize("status, there", [(0, True), (1, False)])
def test_loading_soon_waits_for_who_compiles(monkeypatch: Any, status: int, there: bool) -> None:
    told: list[Any] = []
    done: list[int] = []
    monkeypatch.setattr(
        loops,
        "run",
        lambda words: told.append(words[-1]) or (status, ""),
    )
    monkeypatch.setattr(loops, "_begun", [])
    monkeypatch.setattr(loops, "load", lambda: done.append(1))
    loops.load_soon()
    loops.load_soon()
    loops._begun[0].join(30)
    assert told == ["metagraph.keep_loops"] and bool(done) == there


def test_kept_object_code_gives_the_poses_of_numba_but_for_the_last_digit(
    monkeypatch: pytest.MonkeyPatch, switch: Switch, sample: Project
) -> None:
    """Where products may be fused with sums, which of them are is up to each compilation."""
    if not object_code.usable():
        pytest.skip("object code is for Linux on x86-64")
    kept = str(kernels.make() / kernels.LOOPS)
    switch.off()
    monkeypatch.setenv("METAGRAPH_LOOP_CACHE", "")
    assert loops.load() and all(isinstance(known.now, ModuleType) for known in loops.LOOPS)
    plan = make_plan(sample, 20, seed=6)
    times = np.arange(0, 20, 0.1)

    def poses() -> list[Any]:
        whole = pose_at(plan, sample, times)
        single = [pose_at(plan, sample, float(time)) for time in times[:40]]
        crowd = Crowd(sample, [plan, plan]).globals([1.0, 7.3])
        model = sample.skeleton.globals(whole)
        return [*model, *crowd, whole.translations, whole.rotations, *(one.rotations for one in single)]

    expected = poses()
    switch.off()
    monkeypatch.setenv("METAGRAPH_LOOP_CACHE", kept)
    assert loops.load_kept() and not any(isinstance(known.now, ModuleType) for known in loops.LOOPS)
    for one, other in zip(poses(), expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=3e-7)


def test_who_compiles_says_whether_it_could_be_kept() -> None:
    made = subprocess.run([sys.executable, "-m", "metagraph.keep_loops"], cwd=ROOT, timeout=600)
    assert made.returncode == 0 and not compiling.unkept


def test_importing_the_player_does_not_load_numba() -> None:
    code = (
        "import sys; import metagraph.playback.player, metagraph.playback.loops, metagraph.playback.solving;"
        "assert not {'numba', 'scipy'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=300)
