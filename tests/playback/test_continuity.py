"""The law of continuity: what is added to clips moves no joint more than 3 cm or 8 degrees in a sixtieth of a
second beyond what they do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from math import cos, sin
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import AnyRequest, Feel, Go, Look, Play
from metagraph.motion import rotation
from metagraph.playback.continuity import (
    MOST_TURN,
    MOST_WAY,
    RATE,
    ContinuityLaw,
    find_blending,
    find_moved_joints,
    measure_added_moves,
)
from metagraph.playback.evaluator import CONTACTS, STAGES, Evaluator
from metagraph.playback.plan import Cue, LayerPlan, Plan, Rest
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.mood import MOODS
from metagraph.playback.planning.running_plan import plan_performance
from tests.thorough import many

SEED = 11
NEARLY = 1.01  # one of all rounds is at 1.002 of what the law allows
CHANGES, SECONDS = 2.0, 5.5  # when everything changes, and how long is looked at


def globals_(*turns: tuple[float, float, float], at: list[list[float]]) -> tuple[Any, Any]:
    """One joint's rotations `[N, 1, 4]` and positions `[N, 1, 3]`."""
    return rotation.exp(np.array(turns, float))[:, None], np.array(at, float)[:, None]


def still(count: int) -> list[tuple[float, float, float]]:
    return [(0.0, 0.0, 0.0)] * count


def test_what_the_clips_do_themselves_is_not_added() -> None:
    moving = globals_(*still(3), at=[[0, 0, 0], [0.2, 0, 0], [0.5, 0, 0]])
    found = measure_added_moves(moving, moving)
    assert found.breaks.max() == 0


def test_a_joint_may_do_less_than_its_clip_and_may_be_elsewhere() -> None:
    clip = globals_(*still(3), at=[[0, 0, 0], [0.2, 0, 0], [0.5, 0, 0]])
    held = globals_(*still(3), at=[[1, 0, 0], [1.1, 0, 0], [1.1, 0, 0]])
    assert_allclose(measure_added_moves(clip, held).ways, 0, atol=1e-12)


def test_a_joint_that_goes_another_way_or_farther_breaks_the_law() -> None:
    clip = globals_(*still(3), at=[[0, 0, 0], [0.02, 0, 0], [0.04, 0, 0]])
    other = globals_(*still(3), at=[[0, 0, 0], [0.02, 0.031, 0], [0.08, 0.031, 0]])
    found = measure_added_moves(clip, other)
    assert_allclose(found.ways[:, 0], [0.031, 0.04], atol=1e-9)
    assert (found.breaks > 1).all()


def test_turns_count_and_so_does_the_size_of_the_figure() -> None:
    clip = globals_((0, 0, 0), (0, 0.1, 0), at=[[0, 0, 0], [0, 0, 0]])
    turned = globals_((0, 0, 0), (0, 0.1 + MOST_TURN, 0), at=[[0, 0, 0], [2 * MOST_WAY, 0, 0]])
    found = measure_added_moves(clip, turned, size=2.0)
    assert_allclose([found.turns[0, 0] / MOST_TURN, found.ways[0, 0] / MOST_WAY], 1, atol=1e-6)


def test_the_face_is_not_looked_at(sample: Project) -> None:
    assert sample.skeleton is not None
    names = {sample.skeleton.names[j] for j in find_moved_joints(sample)}
    assert {"Head", "LeftHand", "LeftIndex3", "RightFoot"} <= names
    assert not any("Lid" in name or "Eye" in name for name in names)


def test_a_project_without_a_skeleton_has_no_law() -> None:
    with pytest.raises(ValueError, match="skeleton"):
        ContinuityLaw(Project())


def test_the_last_stage_leaves_the_poses_that_are_drawn(sample: Project) -> None:
    evaluator = Evaluator(make_plan(sample, 20.0, seed=SEED), sample)
    times = np.arange(4.0, 12.0, 0.5)
    stages = dict(evaluator.stages(times))
    drawn = evaluator.at(times)
    assert tuple(stages) == STAGES
    assert_allclose(stages[STAGES[-1]].rotations, drawn.rotations, atol=1e-6)
    assert_allclose(stages[STAGES[-1]].translations, drawn.translations, atol=1e-6)


def test_blends_are_told_from_clips_that_play(sample: Project) -> None:
    cue = make_plan(sample, 20.0, seed=SEED).layers["arms"].cues[0]
    empty: dict[Layer, LayerPlan] = {layer: LayerPlan(layer) for layer in LAYERS}
    plan = Plan(SEED, 20.0, {**empty, "arms": LayerPlan("arms", cues=(cue,))})
    times = np.array([cue.start + 0.01, (cue.start + cue.end) / 2, cue.end - 0.01])
    assert find_blending(sample, plan, times).tolist() == [True, False, True]


def test_seams_of_loops_and_of_what_repeats_are_blends(toy: Any) -> None:
    project = toy.project()
    loop = next(a for a in project.actions() if a.kind == "stance")
    project = edits.update_actions(project, [loop.id], timing={"start": 0.0, "end": 1.0, "blend_in": 0.2})
    loop = project.action(loop.id)
    rest = Rest(loop.stance, loop, 0.0, 0.0, 0.0)
    empty: dict[Layer, LayerPlan] = {layer: LayerPlan(layer) for layer in LAYERS}
    plan = Plan(SEED, 4.0, {**empty, loop.layer: LayerPlan(loop.layer, rests=(rest,))})
    times = np.array([0.1, 0.5, 0.85, 0.95, 1.1, 1.7, 1.9])  # its second round begins at 0.8 s
    assert find_blending(project, plan, times).tolist() == [False, False, True, True, False, True, False]
    cue = Cue(loop, 0.0, 3.0, 0.0, 0.0, 0.0, "", "", "", cycle_from=0.0, cycle_to=1.0)
    plan = Plan(SEED, 4.0, {**empty, loop.layer: LayerPlan(loop.layer, cues=(cue,))})
    assert find_blending(project, plan, times + 0.5).tolist() == [False, True, True, False, False, True, True]


def blended(project: Project, plan: Plan) -> float:
    """Return by how much blends break the law at most."""
    times = np.arange(round(plan.end * RATE)) / RATE
    shown = Evaluator(plan, project).layered(times)
    return float(ContinuityLaw(project).blended(plan, times, shown).breaks.max())


@pytest.mark.nightly
def test_a_blend_that_throws_a_hand_breaks_the_law_and_a_fast_clip_does_not(sample: Project) -> None:
    plan = make_plan(sample, 40.0, seed=SEED)
    assert blended(sample, plan) < 1
    arms = plan.layers["arms"]
    hasty = tuple(replace(cue, entry=cue.entry + 0.6, blend_in=1 / 30) for cue in arms.cues)
    thrown = replace(plan, layers={**plan.layers, "arms": replace(arms, cues=hasty)})
    assert blended(sample, thrown) > 2
    ids = [cue.action.clip for cue in arms.cues]
    sped = {  # one of many: the clips' own 99th percentile stays where it is
        ident: replace(entry, motion=replace(entry.motion, fps=3 * entry.motion.fps))
        for ident, entry in sample.clips.items()
        if ident == ids[0] and entry.motion is not None
    }
    fast = replace(sample, clips={**sample.clips, **sped})
    cue = replace(arms.cues[0], tempo=1.0)
    alone = replace(plan, layers={**plan.layers, "arms": replace(arms, cues=(cue,))})
    assert blended(fast, alone) < 1


def broken(law: ContinuityLaw, evaluator: Evaluator, start: float, end: float) -> Iterator[str]:
    """Yield what breaks the law, in words, of what is added to blends."""
    times = np.arange(round(start * RATE), round(end * RATE)) / RATE
    for name, moves in law.added(evaluator.stages(times)).items():
        ways, turns, breaks, joints = moves.worst(law.joints)
        n = int(np.argmax(breaks))
        if breaks[n] > NEARLY:
            joint, far, turn = law.skeleton.names[int(joints[n])], 100 * ways[n], np.degrees(turns[n])
            yield f"{name}: {joint} {far:.1f} cm, {turn:.0f} degrees at {times[n + 1]:.2f} s"


def rounds(project: Project) -> list[dict[str, Any]]:
    """All there is to be tried: from each stance of the arms to each other, on each stance of the body, with
    changes of the head; targets all round and moods go along in turn.
    """
    of = {layer: list(project.graphs[layer].stances) for layer in LAYERS}
    arms = [(a, b) for a, b in product(of["arms"], repeat=2) if a != b]
    heads = [(a, b) for a, b in product(of["head"], repeat=2) if a != b]
    ways = np.arange(0, 2 * np.pi, np.pi / 6).tolist()
    targets = [(1.5 * sin(a), y, 1.5 * cos(a)) for a in ways for y in (0.6, 1.5, 2.2)]
    moods = list(MOODS)
    out = []
    for n, ((a, b), (h, i), body) in enumerate(product(arms, heads, of["body"])):
        out.append(
            {
                "stances": {"arms": a, "head": h, "body": body},
                "to": {"arms": b, "head": i, "body": of["body"][n % len(of["body"])]},
                "looks": (targets[7 * n % len(targets)], targets[(7 * n + 17) % len(targets)]),
                "mood": moods[n % len(moods)],
            }
        )
    return out


def tried(project: Project, one: dict[str, Any]) -> Evaluator:
    to: dict[Layer, str] = one["to"]
    asks: list[AnyRequest] = [
        Go(id=f"go {layer}", layer=layer, stance=stance, at=CHANGES) for layer, stance in to.items()
    ]
    asks.append(Feel(id="feel", mood=one["mood"], at=CHANGES))
    asks += [Look(id=f"look {n}", to=place, at=CHANGES + n) for n, place in enumerate(one["looks"])]
    return Evaluator(plan_performance(project, asks, SECONDS, SEED, one["stances"], idle=False), project)


def test_nothing_that_is_added_jumps_whatever_changes(sample: Project) -> None:
    law = ContinuityLaw(sample)
    every = rounds(sample)
    chance = np.random.default_rng(SEED)
    chosen = chance.choice(len(every), many(24, len(every)), replace=False)
    found = {n: list(broken(law, tried(sample, every[n]), CHANGES - 0.2, SECONDS)) for n in chosen.tolist()}
    assert {n: words for n, words in found.items() if words} == {}


@pytest.mark.nightly
def test_nothing_that_is_added_jumps_in_ten_minutes(sample: Project) -> None:
    law, evaluator = ContinuityLaw(sample), Evaluator(make_plan(sample, 600.0, seed=SEED), sample)
    found = [list(broken(law, evaluator, start, start + 30.0)) for start in range(0, 600, 30)]
    assert [words for words in found if words] == []


@pytest.mark.parametrize(
    ("name", "start", "end"), [("point_me_rt_01", 1.25, 2.27), ("shrug_bt_01", 0.23, 1.2)]
)
def test_contacts_of_an_action_that_repeats_go_over_the_seam_with_its_pose(
    sample: Project, name: str, start: float, end: float
) -> None:
    """Contacts began again with the clip's time at each seam, and threw a hand 41 cm in a sixtieth."""
    action = next(a for a in sample.graphs["arms"].actions.values() if a.name.endswith(name) and a.contacts)
    timing = {"start": start, "end": end, "repeat": 6.0, "earliest_exit": None, "stroke": None}
    project = edits.update_actions(sample, [action.id], timing=timing)
    plan = plan_performance(project, [Play(id="p", action=action.id, at=3.0)], 14.0, idle=False)
    evaluator, law = Evaluator(plan, project), ContinuityLaw(project)
    cue = next(c for c in plan.layers["arms"].cues if c.action.id == action.id)
    assert cue.repeats
    times = np.arange(round((cue.end - cue.start) * RATE)) / RATE + cue.start
    added = law.added(evaluator.stages(times))[CONTACTS]
    assert added.breaks.max() <= 1.0
