"""Ten minutes of the sample project with no requests: what the paper promises, counted and measured."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.motion import rotation
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.planning import drawing, sampling
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.mood import Mood
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from tests.posing import pose_at, rig

LENGTH = 600.0
SEEDS = range(1, 11)
FPS = 60


@dataclass
class Performance:
    """A plan, and each draw that made it: the weights it was made with and what was drawn."""

    plan: Plan
    draws: list[tuple[str, Mapping[str, float], str]] = field(default_factory=list)


@pytest.fixture(scope="module")
def performances(sample: Project) -> list[Performance]:
    choose, draw = drawing.pick, sampling.draw_action
    made = []
    for seed in SEEDS:
        draws: list[tuple[str, Mapping[str, float], str]] = []

        def watch(seed: int, key: str, purpose: str, weights: Mapping[str, float], draws: Any = draws) -> str:
            chosen = choose(seed, key, purpose, weights)
            if purpose == "action":
                draws.append((key, dict(weights), chosen))
            return chosen

        def watch_all(
            state: LayerState,
            candidates: list[Action],
            key: str,
            now: float,
            mood: Mood,
            draws: Any = draws,
        ) -> Action:
            left = drawing.keep_spaced(state, candidates)
            if len(left) == 1:  # which is not drawn for
                weight = left[0].likelihood / max(drawing.count_uses(state, left[0].id, now), 1)
                draws.append((key, {left[0].id: weight}, left[0].id))
            return draw(state, candidates, key, now, mood)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(drawing, "pick", watch)
            patch.setattr(sampling, "draw_action", watch_all)
            made.append(Performance(make_plan(plan_as_in_paper(sample), LENGTH, seed=seed), draws))
    return made


def lanes(performances: list[Performance]) -> list[tuple[Layer, tuple[Cue, ...], Performance]]:
    return [(layer, p.plan.layers[layer].cues, p) for p in performances for layer in LAYERS]


@pytest.mark.nightly
def test_every_layer_has_something_to_do(performances: list[Performance]) -> None:
    least = {"body": 40, "arms": 100, "head": 80}
    assert all(len(cues) >= least[layer] for layer, cues, _ in lanes(performances))


def test_no_two_cues_of_a_layer_overlap(performances: list[Performance]) -> None:
    for _, cues, _ in lanes(performances):
        assert all(a.end <= b.start for a, b in pairwise(cues))


def test_every_action_starts_and_ends_in_its_stance(performances: list[Performance], sample: Project) -> None:
    for layer, cues, performance in lanes(performances):
        stance = performance.plan.layers[layer].rests[0].stance
        assert stance == sample.graphs[layer].start
        for cue in cues:
            assert cue.stance == stance == cue.action.stance
            stance = cue.then
            assert stance == (cue.action.end_stance if cue.action.kind == "transition" else cue.action.stance)
            lane = performance.plan.layers[layer]
            assert lane.stance_at(cue.end) == stance
            assert [r.stance for r in lane.rests if r.fade_start <= cue.end][-1] == stance, (
                "and the loop below is the new stance's"
            )


def test_every_action_plays_from_its_start_to_its_end(
    performances: list[Performance], sample: Project
) -> None:
    for _, cues, _ in lanes(performances):
        for cue in cues:
            start, end = sample.span(cue.action)
            assert cue.entry == start and cue.end - cue.start == pytest.approx(end - start)


def test_no_clip_plays_twice_in_a_row_where_there_is_a_choice(
    performances: list[Performance], sample: Project
) -> None:
    for layer, cues, _ in lanes(performances):
        last: dict[tuple[str, str], str] = {}
        for before, after in pairwise(cues):
            assert (
                before.action.clip != after.action.clip
                or len(sample.graphs[layer].of(after.stance, after.action.kind)) == 1
            )
        for cue in cues:  # nor among what its node plays, whatever lies between
            node = (cue.stance, cue.action.kind)
            assert last.get(node) != cue.action.id or len(sample.graphs[layer].of(*node)) == 1
            last[node] = cue.action.id


def test_every_draw_was_made_with_the_formula(performances: list[Performance], sample: Project) -> None:
    """p_k ~ likelihood_k / max(c_k, 1), c_k += 4 with each use: counted again from the cues alone."""
    for performance in performances:
        for layer in LAYERS:
            uses: dict[str, float] = defaultdict(float)
            made = {
                key: (weights, chosen)
                for key, weights, chosen in performance.draws
                if key.startswith(f"auto/{layer}/")
            }
            for cue in performance.plan.layers[layer].cues:
                weights, chosen = made[cue.meta]
                assert chosen == cue.action.id
                for ident, weight in weights.items():
                    assert weight == pytest.approx(sample.action(ident).likelihood / max(uses[ident], 1))
                uses[chosen] += 4


def test_observed_frequencies_are_within_sampling_error_of_the_formula(
    performances: list[Performance], sample: Project
) -> None:
    """Each draw has known chances, so how often an action was drawn has a known mean and, draws being apart,
    a known variance.
    """
    mean: dict[str, float] = defaultdict(float)
    variance: dict[str, float] = defaultdict(float)
    seen: dict[str, int] = defaultdict(int)
    for performance in performances:
        for _, weights, chosen in performance.draws:
            total = sum(weights.values())
            seen[chosen] += 1
            for ident, weight in weights.items():
                p = weight / total
                mean[ident] += p
                variance[ident] += p * (1 - p)
    z = np.array([(seen[i] - mean[i]) / np.sqrt(variance[i]) for i in mean if variance[i] > 3])
    print(
        f"\n{sum(seen.values())} draws of {len(mean)} actions: largest deviation {np.abs(z).max():.2f} "
        f"sigma, z has variance {z.var():.2f}"
    )
    assert len(z) > 90
    assert np.abs(z).max() < 4.5  # of some 140 actions: beyond 4.5 once in a thousand runs
    assert 0.6 < (z**2).mean() < 1.4


# --- no pops


def speeds(rotations: np.ndarray, translations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radians a second `[F-1, J]` and metres a second `[F-1, J]` from poses at FPS."""
    return rotation.measure_angle_between(rotations[:-1], rotations[1:]) * FPS, np.linalg.norm(
        np.diff(translations, axis=0), axis=-1
    ) * FPS


def only(plan: Plan, layer: Layer) -> Plan:
    return Plan(
        plan.seed,
        plan.end,
        {name: lane if name == layer else type(lane)(name) for name, lane in plan.layers.items()},
    )


@pytest.mark.nightly
@pytest.mark.parametrize("layer", LAYERS)
def test_at_cue_boundaries_no_joint_is_faster_than_in_the_clips(
    performances: list[Performance], sample: Project, layer: Layer
) -> None:
    """Within 0.1 s of where an action begins, is fully there, begins to leave or ends, each joint of the
    layer alone turns and moves no faster than it does somewhere in the layer's own clips, except for 5 % and
    3 degrees a second: what the loop's swaying adds.
    """
    joints = rig(sample).reach[layer].joints
    turn, move = np.zeros(len(joints)), np.zeros(len(joints))
    for action in sample.graphs[layer].actions.values():
        clip = sample.clips[action.clip].motion
        pose = clip.pose_at(np.arange(0, clip.duration, 1 / FPS))
        w, v = speeds(pose.rotations[:, joints], pose.translations[:, joints])
        turn, move = np.maximum(turn, w.max(0)), np.maximum(move, v.max(0))
    worst = fastest = 0.0
    for performance in performances[:2]:
        plan = only(performance.plan, layer)
        moments = np.array(
            [
                m
                for c in plan.layers[layer].cues
                for m in (c.start, c.start + c.blend_in, c.end - c.blend_out, c.end)
            ]
        )
        ticks = np.unique((moments[:, None] * FPS + np.arange(-6, 7)).astype(int))
        ticks = ticks[ticks >= 0]
        every = pose_at(plan, sample, ticks / FPS)
        for run in np.split(np.arange(len(ticks)), np.flatnonzero(np.diff(ticks) > 1) + 1):
            if len(run) < 2:
                continue
            w, v = speeds(every.rotations[run][:, joints], every.translations[run][:, joints])
            assert (w <= turn * 1.05 + np.radians(3)).all(), np.degrees((w - turn).max())
            assert (v <= move * 1.05 + 0.005).all()
            worst = max(worst, float((w / np.maximum(turn, np.radians(5))).max()))
            fastest = max(fastest, float(w.max()))
    most, own = np.degrees(fastest), np.degrees(turn.max())
    print(
        f"\n{layer}: at boundaries at most {most:.0f} deg/s, in its clips {own:.0f}; worst joint {worst:.3f} "
        "times its own"
    )


@pytest.mark.nightly
def test_composed_no_joint_is_faster_than_the_clips_of_all_layers_together(
    performances: list[Performance], sample: Project
) -> None:
    """In model space, hands and head included: at 60 frames a second, no frame of two minutes jumps."""
    skeleton = sample.skeleton
    limit = np.zeros(len(skeleton))
    for layer in LAYERS:
        reach = rig(sample).reach[layer]
        most = np.zeros(len(skeleton))
        for action in sample.graphs[layer].actions.values():
            clip = sample.clips[action.clip].motion
            r, p = skeleton.globals(clip.pose_at(np.arange(0, clip.duration, 1 / FPS)))
            most = np.maximum(most, speeds(r, p)[1].max(0))
        below = np.zeros(len(skeleton), bool)
        for joint in reach.joints:
            below[list(skeleton.descendants(int(joint)))] = True
        limit += np.where(below, most, 0)
    fastest = 0.0
    for start in range(0, 120, 30):
        r, p = skeleton.globals(pose_at(performances[0].plan, sample, np.arange(start, start + 30, 1 / FPS)))
        v = speeds(r, p)[1]
        assert (v <= limit * 1.05 + 0.01).all()
        fastest = max(fastest, float(v.max()))
    print(
        f"\ncomposed: fastest joint {fastest:.2f} m/s; the clips of the layers together allow "
        f"{limit.max():.2f}"
    )
