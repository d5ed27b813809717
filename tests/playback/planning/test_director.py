"""What keeps a performance from repeating itself: intervals, postures, what the model does by itself."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.plan import Cue, MetaRequest
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.director import (
    APART,
    GOES_HOME,
    LONG_REST,
    SHORTER,
    STALE,
    STANDS_OUT,
    freshness,
    posture,
    repeat_interval,
)
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.planning.running_plan import improvise

LENGTH = 900.0


def cues(project: Project, layer: Any, mode: Any, seed: int = 2) -> tuple[Cue, ...]:
    return improvise(project, LENGTH, seed, mode).layers[layer].cues


def test_a_beat_comes_again_in_seconds_and_what_stands_out_in_minutes() -> None:
    assert repeat_interval("gesture", 0.0) == 18 and repeat_interval("gesture", 1.0) == pytest.approx(360)
    assert repeat_interval("fidget", 0.0) == 240 and repeat_interval("fidget", 1.0) == pytest.approx(600)
    assert repeat_interval("gesture", 0.3) < 60 < 150 < repeat_interval("gesture", 0.75)


def test_what_has_just_been_played_is_hardly_likely_and_what_is_rested_is_as_likely_as_ever() -> None:
    assert freshness(0.0, 100.0) == freshness(4.9, 100.0) == STALE
    assert freshness(50.0, 100.0) == 0.5 and freshness(100.0, 100.0) == freshness(1e9, 100.0) == 1.0


@pytest.mark.parametrize("mode", ["talking", "listening", "idle"])
def test_nothing_written_comes_again_before_its_time(sample: Project, mode: Any) -> None:
    for layer in LAYERS:
        last: dict[str, float] = {}
        free = 0.0
        for cue in cues(sample, layer, mode):
            if cue.action.kind != "transition":
                needed = repeat_interval(cue.action.kind, measure_prominence(sample, cue.action))
                needed *= 1.0 if cue.start < free + LONG_REST else SHORTER
                assert cue.start >= last.get(cue.action.id, -1e9) + needed - 1e-6
                last[cue.action.id] = cue.end
            free = cue.end


def test_what_stands_out_is_not_followed_by_another_that_does(sample: Project) -> None:
    shown = [
        c
        for c in cues(sample, "arms", "talking")
        if c.action.kind != "transition" and measure_prominence(sample, c.action) >= STANDS_OUT
    ]
    assert len(shown) > 5 and all(b.start >= a.end + APART - 1e-6 for a, b in pairwise(shown))


def test_a_stance_is_kept_before_the_model_leaves_it(sample: Project) -> None:
    for layer in LAYERS:
        moves = [c for c in cues(sample, layer, "idle") if c.action.kind == "transition"]
        assert len(moves) > 3 and all(b.start >= a.end + posture(layer) - 1e-6 for a, b in pairwise(moves))


def test_a_tilted_head_goes_back_more_often_than_on(sample: Project) -> None:
    start = sample.graphs["head"].start
    moves = [
        c
        for seed in range(4)
        for c in cues(sample, "head", "idle", seed)
        if c.action.kind == "transition" and c.stance != start
    ]
    back = sum(c.then == start for c in moves)
    assert back / len(moves) == pytest.approx(GOES_HOME + (1 - GOES_HOME) / 2, abs=0.12)


def test_variety_multiplies_every_time_and_none_turns_it_off(sample: Project) -> None:
    def count(variety: float) -> int:
        return len(cues(edits.set_settings(sample, variety=variety), "arms", "talking"))

    assert count(0.0) > 1.15 * count(1.0) > 1.15 * count(4.0)


def test_requests_are_not_held_back_but_draw_what_is_rested(sample: Project) -> None:
    asked = [MetaRequest(f"r{n}", "arms", "gesture", 4.0 * n) for n in range(60)]
    plan = make_plan(sample, 250.0, asked, idle=False)
    played = [c.action.id for c in plan.layers["arms"].cues]
    assert len(played) > 50
    plain = make_plan(edits.set_settings(sample, variety=0.0), 250.0, asked, idle=False)
    again = [c.action.id for c in plain.layers["arms"].cues]

    def soon(ids: list[str]) -> int:
        return sum(ident in ids[max(0, n - 6) : n] for n, ident in enumerate(ids))

    assert soon(played) < soon(again)


def test_one_certain_action_plays_as_often_as_it_is_asked_for(sample: Project) -> None:
    wave = next(a for a in sample.graphs["arms"].actions.values() if "wave_hello" in a.name)
    asked = [MetaRequest(f"r{n}", "arms", "gesture", 6.0 * n, action=wave.id) for n in range(5)]
    plan = make_plan(sample, 40.0, asked, idle=False)
    assert [c.action.id for c in plan.layers["arms"].cues] == [wave.id] * 5
