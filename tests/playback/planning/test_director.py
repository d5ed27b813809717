"""What keeps a performance from repeating itself: intervals, postures, what the model does by itself."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.requests import make_request
from metagraph.playback.life.track import HUSHED
from metagraph.playback.plan import Cue, MetaRequest
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.director import (
    APART,
    ENDS_BURST,
    GOES_HOME,
    LEAST_LULL,
    LONG_REST,
    MOST_LULL,
    SHORTER,
    STALE,
    STANDS_OUT,
    beat_interval,
    find_lull,
    freshness,
    posture,
    repeat_interval,
)
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.planning.running_plan import RunningPlan, improvise, plan_performance

LENGTH = 900.0


def cues(project: Project, layer: Any, mode: Any, seed: int = 2) -> tuple[Cue, ...]:
    return improvise(project, LENGTH, seed, mode).layers[layer].cues


def test_a_beat_comes_again_in_seconds_and_what_stands_out_in_minutes() -> None:
    assert repeat_interval("gesture", 0.0, 18.0) == 18
    assert repeat_interval("gesture", 1.0, 18.0) == pytest.approx(360) == repeat_interval("gesture", 1.0, 180)
    assert repeat_interval("fidget", 0.0, 18.0) == 300
    assert repeat_interval("fidget", 1.0, 18.0) == pytest.approx(600)
    assert repeat_interval("gesture", 0.3, 18.0) < 60 < 150 < repeat_interval("gesture", 0.75, 18.0)


def test_the_more_gestures_the_arms_have_the_later_a_beat_comes_again() -> None:
    assert beat_interval("arms", 0) == beat_interval("arms", 2) == beat_interval("head", 50) == 18.0
    assert beat_interval("arms", 10) == 70.0 and beat_interval("arms", 50) == 180.0


def test_what_has_just_been_played_is_hardly_likely_and_what_is_rested_is_as_likely_as_ever() -> None:
    assert freshness(0.0, 100.0) == freshness(4.9, 100.0) == STALE
    assert freshness(50.0, 100.0) == 0.5 and freshness(100.0, 100.0) == freshness(1e9, 100.0) == 1.0


@pytest.mark.parametrize("mode", ["talking", "listening", "idle"])
def test_nothing_written_comes_again_before_its_time(sample: Project, mode: Any) -> None:
    for layer in LAYERS:
        actions = sample.graphs[layer].actions.values()
        beats = beat_interval(layer, sum(a.kind == "gesture" for a in actions))
        last: dict[str, float] = {}
        free = 0.0
        for cue in cues(sample, layer, mode):
            if cue.action.kind != "transition":
                shows = measure_prominence(sample, cue.action)
                needed = repeat_interval(cue.action.kind, shows, beats)
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


def test_nobody_looks_at_the_watch_in_a_conversation(sample: Project) -> None:
    def shown(mode: Any) -> int:
        fidgets = [
            c for seed in range(3) for c in cues(sample, "arms", mode, seed) if c.action.kind == "fidget"
        ]
        assert len(fidgets) > 10
        return sum(measure_prominence(sample, c.action) >= STANDS_OUT for c in fidgets)

    assert shown("idle") > 3 and shown("talking") == shown("listening") == 0


def test_a_fidget_that_is_asked_for_in_a_conversation_is_one_that_hardly_shows(sample: Project) -> None:
    def shown(name: Any, **more: Any) -> list[bool]:
        asks = [make_request({"do": "mode", "mode": name, "id": "mode", "at": 0.0})]
        for n in range(30):
            asked = {"do": "fidget", "layer": "arms", "id": f"f{n}", "at": 8.0 * n, **more}
            asks.append(make_request(asked))
        played = plan_performance(sample, asks, 250.0, 1, idle=False).layers["arms"].cues
        assert len(played) == 30
        return [measure_prominence(sample, c.action) >= STANDS_OUT for c in played]

    assert any(shown("idle")) and not any(shown("listening"))
    tags = next(
        a.tags
        for a in sample.graphs["arms"].of(sample.graphs["arms"].start or "", "fidget")
        if a.tags and measure_prominence(sample, a) >= STANDS_OUT
    )
    assert any(shown("listening", tags=list(tags))), "what is asked for by a tag is done"


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


CHIN = "hand to chin"
TEXT = "this is a long sentence about nothing that somebody says slowly and on and on until the end of it "


def mode(name: str | None, at: float) -> Any:
    return make_request({"do": "mode", "mode": name, "id": f"mode{at}", "at": at})


def chin_moves(project: Project, asks: list[Any], end: float, seed: int) -> list[tuple[float, bool]]:
    """When the arms go to the chin (True) or leave it."""
    names = {ident: stance.name for ident, stance in project.graphs["arms"].stances.items()}
    plan = plan_performance(project, asks, end, seed)
    moves = [c for c in plan.layers["arms"].cues if CHIN in (names[c.stance], names[c.then])]
    return [(c.start, names[c.then] == CHIN) for c in moves if c.action.kind == "transition"]


@pytest.mark.parametrize("seed", range(6))
def test_a_long_thought_brings_a_hand_to_the_chin_and_its_end_takes_it_away(
    sample: Project, seed: int
) -> None:
    asks = [mode("listening", 0.0), mode("thinking", 1.0), mode("talking", 25.0)]
    moves = chin_moves(sample, asks, 40.0, seed)
    assert [there for _, there in moves[:2]] == [True, False], "it goes there, stays, and goes away"
    assert 1.0 <= moves[0][0] < 12.0 and 25.0 <= moves[1][0] < 35.0


def test_a_short_thought_brings_no_hand_to_the_chin(sample: Project) -> None:
    for seed in range(6):
        asks = [mode("reacting", 0.0), *(mode(m, t) for t in (5.0, 15.0) for m, t in
                (("thinking", t), ("reacting", t + 1.5)))]  # fmt: skip
        assert not any(5.0 <= t < 6.5 or 15.0 <= t < 16.5 for t, _ in chin_moves(sample, asks, 20.0, seed))


def test_a_hand_stays_where_a_request_keeps_it_in_thought(sample: Project) -> None:
    stance = next(i for i, s in sample.graphs["arms"].stances.items() if s.name == "on hips")
    held = make_request({"do": "stance", "stance": stance, "stay": True, "id": "held", "at": 0.0})
    assert chin_moves(sample, [held, mode("thinking", 5.0)], 40.0, 3) == []


@pytest.mark.parametrize("seed", range(4))
def test_nothing_of_its_own_begins_soon_after_an_interruption(sample: Project, seed: int) -> None:
    """Also not what was written for before, and had to wait."""
    running = RunningPlan(sample, seed)
    begun = 0
    for n in range(8):
        at = 20.0 * n + 2.0
        running.reach(at)
        said = make_request({"do": "say", "text": TEXT * 4, "id": f"say{n}", "at": at})
        running.hear(at, [said])
        cut = at + 5.0 + 0.7 * n
        running.reach(cut)
        running.hear(cut, [make_request({"do": "interrupt", "id": f"cut{n}"})])
        running.hear(cut + 0.02, [mode("listening", cut + 0.1)])
        running.reach(cut + 5.0)
        for layer in LAYERS:
            own = [c for c in running.plan.layers[layer].cues if c.meta.startswith("auto/")]
            assert not [c for c in own if cut + 0.1 <= c.start < cut + HUSHED - 0.05]
            begun += sum(cut + HUSHED <= c.start < cut + 10.0 for c in own)
            gestures = [c for c in own if c.action.kind == "gesture" and c.start < cut]
            assert all(c.end <= cut + 0.6 for c in gestures), "and what it does is left"
    assert begun > 10, "later it does"


def test_while_it_talks_the_arms_go_where_gestures_are_rested(sample: Project) -> None:
    graph = sample.graphs["arms"]
    rich = next(i for i, s in graph.stances.items() if s.name == "hands at sides")
    moves = [c for seed in range(4) for c in cues(sample, "arms", "talking", seed) if c.then != c.stance]
    chances = [c for c in moves if any(a.end_stance == rich for a in graph.of(c.stance, "transition"))]
    assert sum(c.then == rich for c in chances) > 0.35 * len(chances), "it has half of all gestures"


def test_one_who_talks_ends_a_quarter_of_the_acts_with_a_rest_of_5_to_30_seconds() -> None:
    lulls = [find_lull(Bits(1), f"auto/arms/{n}", True, 1.0) for n in range(2000)]
    rests = [x for x in lulls if x > 0]
    assert len(rests) / len(lulls) == pytest.approx(ENDS_BURST, abs=0.03)
    assert min(rests) == LEAST_LULL and max(rests) == MOST_LULL
    assert all(find_lull(Bits(1), f"auto/arms/{n}", False, 1.0) >= LEAST_LULL for n in range(200))
    assert max(find_lull(Bits(1), f"auto/arms/{n}", False, 4.0) for n in range(200)) == MOST_LULL
    assert find_lull(Bits(1), "auto/arms/1", False, 0.0) == 0.0


@pytest.mark.parametrize("mode", ["listening", "idle"])
def test_who_does_not_talk_rests_after_each_act_of_the_arms(sample: Project, mode: Any) -> None:
    found = cues(sample, "arms", mode)
    assert len(found) > 10
    assert all(b.start - a.end >= LEAST_LULL for a, b in pairwise(found))


def test_who_talks_gestures_in_bursts_and_changes_the_stance_only_after_a_rest(sample: Project) -> None:
    found = cues(sample, "arms", "talking")
    rests = [b.start - a.end for a, b in pairwise(found)]
    assert sum(rest < 3.0 for rest in rests) > 0.2 * len(rests), "within bursts"
    assert sum(rest >= LEAST_LULL for rest in rests) > 0.35 * len(rests), "between them"
    moved = [b.start - a.end for a, b in pairwise(found) if b.action.kind == "transition"]
    assert len(moved) > 5 and min(moved) >= LEAST_LULL
