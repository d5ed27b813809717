"""Feet that stand stay where they are while poses blend, and step where those have them elsewhere."""

from dataclasses import replace
from functools import cache
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Play
from metagraph.playback.continuity import RATE, ContinuityLaw
from metagraph.playback.evaluator import WEIGHT, Evaluator
from metagraph.playback.plan import Cue, LayerPlan, MetaRequest, Plan, Rest
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.playback.posing.planted_feet import FootTrack, foot_goals
from metagraph.playback.posing.weight import find_foot_rows
from sample_clips.make.conformance_projects import stepping
from tests.posing import pose_at, weight_of

FPS = 60
LEGS = [[f"{side}_{part}" for part in ("upper_leg", "lower_leg", "foot")] for side in ("left", "right")]
Array = Any


@cache
def project(planted: float = 1.0) -> Project:
    made = stepping()
    sway = next(a.id for a in made.graphs["body"].actions.values() if a.name == "sway")
    made = edits.update_actions(made, [sway], likelihood=1e-9)  # its own feet move
    return replace(made, life=msgspec.structs.replace(made.life, planted_feet=planted))


def named(name: str, of: Project | None = None) -> str:
    actions = (of or project()).graphs["body"].actions.values()
    return next(a.id for a in actions if a.name == name)


@cache
def asked(name: str) -> Plan:
    wish = MetaRequest("r", "body", "gesture", 2.0, action=named(name))
    return make_plan(project(), 8.0, [wish], idle=False)


def joints(plan: Plan, of: Project, times: Array) -> Array:
    """Return hips, knees and ankles `[N, 2, 3, 3]`."""
    assert of.skeleton is not None
    at = of.skeleton.globals(pose_at(plan, of, times))[1].astype(float)
    roles = anatomy.project_roles(of)
    return at[:, [[roles[r] for r in leg] for leg in LEGS]]


def cue_times(plan: Plan) -> Array:
    (cue,) = plan.layers["body"].cues
    return np.arange(cue.start - 0.1, cue.end + 0.1, 1 / FPS)


@pytest.mark.parametrize("name", ["near", "far"])
def test_feet_on_the_ground_do_not_slide_and_one_steps_at_a_time(name: str) -> None:
    plan = asked(name)
    times = cue_times(plan)
    off, on = (joints(plan, project(planted), times)[:, :, 2] for planted in (0.0, 1.0))
    speeds = [np.linalg.norm(np.diff(at, axis=0), axis=-1) * FPS for at in (off, on)]
    ways = np.linalg.norm(off[len(off) // 2] - off[0], axis=-1)
    assert speeds[0].max() > 4 * ways.max()  # it glides without
    steps = speeds[1] > 0.02  # a foot may be off by `NEAR`, which in a frame is 6 mm/s
    assert not steps.all(axis=1).any()
    assert steps.any(axis=0).all()
    window = 15
    held = np.cumsum(steps, axis=0)
    stands = held[window:] == held[:-window]
    slide = np.linalg.norm(on[window + 1 :] - on[1:-window], axis=-1)[stands] * FPS / window
    assert slide.max() < 0.002
    assert (on[..., 1].max(axis=0) > np.maximum(off[0, :, 1], off[len(off) // 2, :, 1])).all()  # lifted


def test_legs_are_not_stretched_farther_than_they_were() -> None:
    plan = asked("far")
    times = cue_times(plan)
    bent = []
    for planted in (0.0, 1.0):
        at = joints(plan, project(planted), times)
        bones = np.linalg.norm(np.diff(at, axis=2), axis=-1).sum(2)
        bent.append(np.linalg.norm(at[:, :, 2] - at[:, :, 0], axis=-1) / bones)
    assert (bent[1] <= np.maximum(bent[0], 0.9951) + 1e-4).all()
    assert bent[1].max() > 0.9


def test_where_nothing_blends_the_pose_is_the_same_to_the_bit() -> None:
    plan = asked("far")
    (cue,) = plan.layers["body"].cues
    times = np.concatenate([np.arange(0.6, cue.start, 0.1), np.arange(cue.start + 0.51, cue.end - 0.51, 0.1)])
    off, on = (pose_at(plan, project(planted), times) for planted in (0.0, 1.0))
    assert (off.rotations == on.rotations).all()
    assert (off.translations == on.translations).all()


def test_what_is_too_far_is_left_alone() -> None:
    plan = asked("too far")
    times = cue_times(plan)
    off, on = (joints(plan, project(planted), times) for planted in (0.0, 1.0))
    np.testing.assert_array_equal(off, on)


@pytest.mark.nightly
def test_nothing_pops() -> None:
    for name in ("near", "far", "of its own"):
        plan = asked(name)
        times = np.arange(1.5, 6.0, 1 / 240)
        off, on = (joints(plan, project(planted), times) for planted in (0.0, 1.0))
        jump = np.abs(np.diff(on - off, axis=0)).max()
        assert jump < 0.025, name  # of a step of 20 cm in a quarter of a second


def test_a_pose_depends_on_plan_and_time_alone() -> None:
    plan, times = asked("far"), np.array([2.1, 2.3, 2.05, 4.2, 2.1])
    at_once = pose_at(plan, project(), times)
    for n in (3, 0, 2, 1, 4):
        one = pose_at(plan, project(), float(times[n]))
        np.testing.assert_allclose(one.rotations, at_once.rotations[n], atol=1e-6)
    assert (at_once.rotations[0] == at_once.rotations[4]).all()


def test_still_feet_need_one_row_and_feet_that_others_move_none() -> None:
    clips = {a.name: a.clip for a in project().graphs["body"].actions.values()}
    assert len(find_foot_rows(weight_of(project()), project(), clips["far"])) == 1
    own = find_foot_rows(weight_of(project()), project(), clips["of its own"])
    assert len(own) > 20
    assert 0.0 in {row[0] for row in own}
    moved = edits.set_weight(project(), "arms", "legs", 0.2)
    assert weight_of(moved).rig is not None
    assert find_foot_rows(weight_of(moved), moved, clips["far"]) == ()


def test_feet_stay_planted_whichever_layer_moves_the_legs() -> None:
    made = stepping("arms")
    near = next(a.id for a in made.graphs["arms"].actions.values() if a.name == "near")
    plan = make_plan(made, 8.0, [MetaRequest("r", "arms", "gesture", 2.0, action=near)], idle=False)
    (cue,) = plan.layers["arms"].cues
    times = np.arange(cue.start - 0.1, cue.end + 0.1, 1 / FPS)
    loose = replace(made, life=msgspec.structs.replace(made.life, planted_feet=0.0))
    slid = [
        np.linalg.norm(np.diff(joints(plan, p, times)[:, :, 2][..., (0, 2)], axis=0), axis=-1)
        for p in (loose, made)
    ]
    moving = [(some * FPS > 0.02).all(1).mean() for some in slid]
    assert moving[0] > 0.1 and moving[1] < 0.5 * moving[0]  # one steps at a time


@pytest.mark.parametrize(("weights", "layer"), [
    ({"arms": 1.0}, "arms"),
    ({"arms": 0.5}, None),
    ({"arms": 0.0}, None),
])  # fmt: skip
def test_a_layer_that_moves_the_legs_in_part_plants_none(
    weights: dict[str, float], layer: str | None
) -> None:
    made = edits.set_weight(stepping("arms"), "arms", "legs", weights["arms"])
    assert weight_of(made).feet_layer == layer


def test_two_layers_that_move_the_legs_plant_none() -> None:
    made = edits.set_weight(project(), "arms", "legs", 1.0)
    assert weight_of(project()).feet_layer == "body" and weight_of(made).feet_layer is None


@pytest.mark.parametrize("name", ["near again", "far again", "too far again"])
@pytest.mark.parametrize("seconds", [0.2, 0.3])
def test_feet_of_a_fidget_that_is_cut_short_glide_rather_than_jump(name: str, seconds: float) -> None:
    """Two steps in 0.3 s moved a knee eight times as far as the law of continuity allows."""
    of = project(1.0)
    stance = next(s.id for s in of.graphs["body"].stances.values() if s.name == "wide")
    asks = [Play(id="p", action=named(name), at=1.0)]
    plan = plan_performance(of, asks, 3.0, 1, {"body": stance}, idle=False)
    layer = plan.layers["body"]
    cue = layer.cues[0]
    blends = min(cue.blend_in, seconds / 2), min(cue.blend_out, seconds / 2)
    cut = replace(cue, end=cue.start + seconds, blend_in=blends[0], blend_out=blends[1])
    plan = replace(plan, layers={**plan.layers, "body": replace(layer, cues=(cut,))})
    times = np.arange(0.9, 1.1 + seconds, 1 / RATE)
    added = ContinuityLaw(of).added(Evaluator(plan, of).stages(times))
    assert added[WEIGHT].breaks.max() < 1.0


def test_a_foot_that_does_not_stand_leaves_the_time_for_a_step_to_the_other() -> None:
    made = stepping()
    body = made.graphs["body"]
    loop = next(a for a in body.actions.values() if a.kind == "stance")
    far = next(a for a in body.actions.values() if a.name == "near")
    stands = [100000.0, 10000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 100000.0]
    lifted = [0.0, -10000.0, 5000.0, 0.0, 0.0, 0.0, 0.0, 100000.0]
    aside = [100000.0, 16000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 100000.0]
    down = [100000.0, -22000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 100000.0]
    rests = (Rest(loop.stance, loop, 0.0, 0.0, 0.0),)
    cue = Cue(far, 2.0, 4.0, 0.0, 0.24, 0.24, loop.stance, loop.stance, "r")
    plan = LayerPlan("body", cues=(cue,), rests=rests)
    tracks = {loop.id: FootTrack([aside + down]), far.id: FootTrack([stands + lifted])}
    lasts = 0.24
    goals = [foot_goals(made, tracks, 1.6, plan, cue, 0, t)[0] for t in np.arange(4.0 - lasts, 4.0, 1 / 240)]
    places = np.array([goal.at[0] for goal in goals])
    assert np.abs(np.diff(places)).max() * 240 < 2.1 * 0.06 / (
        0.85 * lasts
    )  # not in the third that the other's way left
