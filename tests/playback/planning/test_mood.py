"""Moods: what is likelier, larger and faster in them, and what life, posture and face make of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph import anatomy
from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.graph.touch import Touch
from metagraph.graph.words import FEELINGS
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.extend_performance import answer_ask, drop_ended, hear_asks
from metagraph.playback.planning.mood import (
    FADE,
    MOODS,
    Mood,
    MoodFrom,
    Moods,
    bearing,
    distance,
    extent,
    favour,
    lasting,
    life_of,
    made_for,
    mood_at,
    mood_edges,
    shown,
    shut_in,
    tempo,
    turn_extent,
)
from metagraph.playback.planning.running_plan import list_kept_asks, plan_performance
from metagraph.playback.planning.vigour import _speed_of, measure_vigour, measure_vigours
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from tests.posing import pose_at

STEPS = (-1.0, -0.5, 0.0, 0.5, 1.0)


def feeling(project: Project, valence: float = 0.0, arousal: float = 0.0, intensity: float = 1.0) -> Project:
    life = msgspec.structs.replace(project.life, valence=valence, arousal=arousal, intensity=intensity)
    return replace(project, life=life)


def free(project: Project) -> Project:
    """The project without contacts and guard, which keep hands where they are whatever the mood."""
    for graph in project.graphs.values():
        bare = {i: replace(x, contacts=()) for i, x in graph.actions.items()}
        project = project.with_graph(replace(graph, actions=bare))
    return replace(project, touch=Touch(False, False))


def performed(project: Project, *asks: dict[str, Any], end: float = 20.0, idle: bool = False) -> Plan:
    return plan_performance(project, [a.make_request(ask) for ask in asks], end, 1, idle=idle)


def stroke_of(project: Project, cue: Cue) -> float:
    """Return when a cue's stroke comes."""
    from metagraph.playback.timing.phases import find_phases

    times = np.linspace(cue.start, cue.end, 20001)
    return float(np.interp(find_phases(project, cue.action).stroke, cue.clip_seconds(times), times))


def test_the_words_are_those_the_table_has() -> None:
    assert tuple(MOODS) == FEELINGS


def test_the_neutral_mood_changes_nothing_to_the_last_digit() -> None:
    mood, life, bears = Mood(), life_of(Mood()), bearing(Mood())
    assert mood.neutral and (extent(mood), tempo(mood)) == (1.0, 1.0)
    assert {getattr(life, name) for name in life.__slots__} == {1.0}
    assert all(getattr(bears, name) == 0 for name in bears.__slots__)
    assert [favour(mood, ("positive", "sad"), v) for v in STEPS] == [1.0] * 5


@pytest.mark.parametrize("what", [extent, tempo, lambda m: favour(m, (), 1.0), lambda m: life_of(m).blinks])
def test_size_speed_likelihood_and_rates_rise_with_arousal(what: Any) -> None:
    found = [what(Mood(0.0, arousal)) for arousal in STEPS]
    assert found == sorted(found) and found[0] < found[2] < found[-1]


def test_intensity_makes_gestures_larger_within_bounds() -> None:
    found = [extent(Mood(0, 0, intensity)) for intensity in (0.0, 0.5, 1.0, 1.5, 2.0)]
    assert found == pytest.approx([0.6, 0.8, 1.0, 1.125, 1.25])
    every = [extent(Mood(v, x, i)) for v in STEPS for x in STEPS for i in (0, 1, 2)]
    assert min(every) >= 0.6 and max(every) <= 1.25


def test_sadness_bows_and_joy_lifts() -> None:
    assert bearing(Mood(*MOODS["sad"])).droop > 0.5 and bearing(Mood(*MOODS["happy"])).droop < -0.3
    assert bearing(Mood(*MOODS["happy"])).smile > 0.7 and bearing(Mood(*MOODS["sad"])).frown > 0.6
    assert bearing(Mood(*MOODS["sad"], 0.0)) == bearing(Mood()), "with no intensity nothing shows"


def test_fear_draws_back_small_and_wide_eyed_where_anger_goes_ahead_and_large() -> None:
    angry, afraid = (Mood(*MOODS[name]) for name in ("angry", "afraid"))
    assert bearing(angry).thrust > 0.8 and bearing(afraid).thrust < -0.4
    assert extent(angry) > 1.1 and extent(afraid) < 0.8 and tempo(afraid) > 1.1 and tempo(angry) > 1.1
    assert bearing(afraid).lift > 2 * bearing(angry).lift and bearing(afraid).closed > 0.4
    assert bearing(afraid).lids < -0.4 and bearing(afraid).brow_up > 0.7 and bearing(afraid).brows > 0.5
    assert bearing(angry).brow_down > 0.9 and bearing(angry).brow_up < 0.1 and bearing(angry).brows == 0
    assert bearing(afraid).brow_down < 0.1


def test_the_sad_are_slower_and_smaller_and_the_happy_livelier_than_others() -> None:
    sad, happy = Mood(*MOODS["sad"]), Mood(*MOODS["happy"])
    assert 0.8 <= tempo(sad) <= 0.9 and extent(sad) < 0.75 and favour(sad, (), 1.0) < 0.5
    assert tempo(happy) > 1.1 and extent(happy) > 1.1 and favour(happy, (), 1.0) > 1.5


def test_the_excited_are_wide_eyed_where_the_happy_smile_more() -> None:
    excited, happy = bearing(Mood(*MOODS["excited"])), bearing(Mood(*MOODS["happy"]))
    assert excited.lids < happy.lids - 0.2 and excited.brows > happy.brows + 0.3
    assert happy.smile > excited.smile > 0.5


@pytest.mark.parametrize("blink", [0.0, 0.4, 1.0])
def test_a_blink_shuts_eyes_that_are_open_wide_and_those_that_hang(blink: float) -> None:
    assert shut_in(blink, 0.0) == blink and shut_in(1.0, -0.5) == 1.0
    assert shut_in(blink, 0.3) == max(blink, 0.3) and shut_in(0.0, -0.5) == -0.5


def test_actions_made_for_a_mood_are_preferred_in_it_and_rarer_in_others() -> None:
    sad, excited = Mood(*MOODS["sad"]), Mood(*MOODS["excited"])
    assert favour(sad, ("sad",), 0.0) > 4 and favour(excited, ("sad",), 0.0) < 0.25
    assert made_for(sad, ("beat", "sad")) and not made_for(excited, ("sad",)) and not made_for(sad, ("beat",))
    assert distance(sad, "sad") == 0


def test_what_lasts_comes_back_when_what_was_laid_over_it_is_over() -> None:
    over = MoodFrom("b", 5.0, arousal=1.0, end=8.0)
    moods = Moods(Mood(0.1), (MoodFrom("a", 2.0, -1.0, -0.5), over, MoodFrom("c", 6.0, intensity=0.5)))
    found = [mood_at(moods, x) for x in (1.0, 2.0, 5.5, 6.0, 8.0)]
    assert found == [Mood(0.1), Mood(-1, -0.5), Mood(-1, 1), Mood(-1, 1, 0.5), Mood(-1, -0.5, 0.5)]
    assert mood_edges(moods, 4.0, 8.0) == [4.0, 5.0, 6.0]


def test_what_was_replaced_for_ever_or_is_over_is_forgotten_once_it_has_faded() -> None:
    told = (MoodFrom("a", 0.0, 1.0, 0.0), MoodFrom("b", 1.0, intensity=2.0), MoodFrom("c", 5.0, 0.0, 0.0))
    assert [m.id for m in lasting(told, 6.0)] == ["a", "b", "c"]
    assert [m.id for m in lasting(told, 5.0 + FADE)] == ["b", "c"]
    assert lasting((MoodFrom("d", 0.0, 1.0, end=2.0),), 2.0 + FADE) == []


def test_what_shows_goes_from_one_mood_to_the_next_without_a_jump() -> None:
    starts, values = [0.0, 4.0, 4.5], [[0.0, 0.0, 1.0], [1.0, -1.0, 2.0], [-1.0, 0.0, 1.0]]
    times = np.linspace(-1, 8, 4001)
    found = np.array([[m.valence, m.arousal, m.intensity] for m in (shown(starts, values, x) for x in times)])
    assert np.abs(np.diff(found, axis=0)).max() < 0.01
    assert shown(starts, values, -1.0) == Mood() and shown(starts, values, 6.1) == Mood(-1.0, 0.0, 1.0)
    assert shown([], [], 1.0) == Mood()


def test_turns_of_half_a_circle_are_left_alone_so_that_none_flips() -> None:
    assert turn_extent(0.6, 1.0) == 0.6 and turn_extent(1.25, 0.05) == 1.0
    assert turn_extent(0.6, 0.3) == turn_extent(0.6, -0.3)


@pytest.mark.parametrize("word", ["sad", "excited", "tired", "angry"])
def test_strokes_stay_on_time_in_every_mood(sample: Project, word: str) -> None:
    asks = [{"do": "gesture", "id": f"g{n}", "stroke": 3.0 + 6 * n} for n in range(6)]
    plan = performed(sample, {"do": "mood", "id": "m", "at": 0.0, "mood": word}, *asks, end=45.0)
    cues = {cue.meta: cue for cue in plan.layers["arms"].cues}
    scaled = [cue for cue in cues.values() if cue.tempo != 1]
    assert scaled, "some is played faster or slower than made"
    for n in range(6):
        assert stroke_of(sample, cues[f"g{n}"]) == pytest.approx(3.0 + 6 * n, abs=2e-3)


def test_a_request_has_a_mood_of_its_own(sample: Project) -> None:
    plan = performed(
        sample,
        {"do": "gesture", "id": "loud", "at": 1.0, "mood": "excited", "intensity": 2.0},
        {"do": "gesture", "id": "plain", "at": 10.0},
    )
    loud, plain = plan.layers["arms"].cues[:2]
    assert loud.tempo > 1.1 and (plain.extent, plain.tempo) == (1.0, 1.0)


def test_a_line_is_said_in_its_mood_and_what_it_asks_for_with_it(sample: Project) -> None:
    line = a.Line(text="I am so tired of it.", asks=(a.Gesture(stroke=1.0),), mood="tired", intensity=0.5)
    project = replace(sample, lines={**sample.lines, "t": line})
    plan = performed(project, {"do": "say", "id": "s", "at": 5.0, "line": "t"})
    said = plan.track.speeches[0]
    assert plan.track.moods == (MoodFrom("s", said.start, -0.03, -0.8, 0.5, said.end),)
    assert [c.tempo for c in plan.layers["arms"].cues] == [pytest.approx(0.7955)]
    louder = performed(project, {"do": "say", "id": "s", "at": 5.0, "line": "t", "mood": "angry"})
    assert louder.track.moods[0].arousal == 0.79, "what is asked for goes before the line's own"


def test_a_performance_has_a_mood_beneath_all_others() -> None:
    kept = a.Performance(name="p", asks=(a.Blink(at=1.0),), mood=(0.2, 0.4), intensity=1.5)
    first, second, *rest = list_kept_asks(kept)
    assert second == a.Behave(id="performance-mode", at=0.0, mode="talking"), "while the models fill gaps"
    assert isinstance(first, a.Feel) and (first.at, first.mood, first.intensity) == (0.0, (0.2, 0.4), 1.5)
    plain = a.Performance(name="q", asks=kept.asks, idle=False)
    assert tuple(rest) == kept.asks and list_kept_asks(plain) == kept.asks


def test_body_and_transitions_keep_their_size_and_what_touches_too(sample: Project) -> None:
    project = feeling(plan_as_in_paper(free(sample)), 0.0, -1.0)
    plan = make_plan(project, 120.0, seed=2)
    assert {c.extent for c in plan.layers["body"].cues} == {1.0}, "feet stay where they are"
    arms = plan.layers["arms"].cues
    assert {c.extent for c in arms if c.action.kind == "transition"} == {1.0}
    assert {c.extent for c in arms if c.action.kind == "gesture" and "tired" not in c.action.tags} == {0.6}
    graph = project.graphs["arms"]
    held = {i: replace(x, tags=(*x.tags, "contact")) for i, x in graph.actions.items()}
    touching = make_plan(project.with_graph(replace(graph, actions=held)), 60.0, seed=2)
    assert {c.extent for c in touching.layers["arms"].cues} == {1.0}
    found = make_plan(feeling(sample, 0.0, -1.0), 240.0, seed=2).layers["arms"].cues
    assert {c.extent for c in found if c.action.contacts} == {1.0} != {c.extent for c in found}


def test_smaller_gestures_keep_hands_nearer_their_stance_and_begin_and_end_in_it(sample: Project) -> None:
    plan = performed(sample, {"do": "gesture", "id": "g", "at": 2.0, "tags": []}, end=12.0)
    cue = plan.layers["arms"].cues[0]
    arms = plan.layers["arms"]
    small = replace(plan, layers={**plan.layers, "arms": replace(arms, cues=(replace(cue, extent=0.6),))})
    still = replace(plan, layers={**plan.layers, "arms": replace(arms, cues=())})
    times = np.linspace(cue.start, cue.end - 1e-6, 60)
    roles = anatomy.project_roles(sample)
    hands = [roles["left_hand"], roles["right_hand"]]
    assert sample.skeleton is not None
    places = [
        sample.skeleton.globals(pose_at(p, sample, times, False))[1][:, hands] for p in (plan, small, still)
    ]
    away = [np.linalg.norm(x - places[2], axis=-1).max() for x in places[:2]]
    assert 0.4 * away[0] < away[1] < 0.85 * away[0]
    assert np.abs(places[1][[0, -1]] - places[2][[0, -1]]).max() < 1e-3
    assert np.abs(np.diff(places[1], axis=0)).max() < 0.2, "nothing jumps"


def test_moods_planned_tick_by_tick_are_those_planned_at_once(sample: Project) -> None:
    asks = [
        a.Feel(id="m", at=3.0, mood="excited"),
        a.Feel(id="n", at=9.0, mood="sad", duration=4.0),
        a.Gesture(id="g", at=10.0),
    ]
    whole = hear_asks(sample, Plan(1, 0.0), 0.0, asks, 30.0)
    ticked = hear_asks(sample, Plan(1, 0.0), 0.0, asks, 2.0)
    for now in range(1, 30):
        ticked = hear_asks(sample, ticked, float(now), [], min(now + 8.0, 30.0))
    assert [c.extent for c in ticked.layers["arms"].cues] == [c.extent for c in whole.layers["arms"].cues]
    assert ticked.layers["arms"].cues == whole.layers["arms"].cues and ticked.life == whole.life


def test_a_mood_taken_back_is_over_and_forgetting_keeps_what_lasts(sample: Project) -> None:
    plan = hear_asks(sample, Plan(1, 0.0), 0.0, [a.Feel(id="m", at=0.0, mood="tired")], 20.0)
    assert answer_ask(plan, "m").what == ("mood",)
    kept = drop_ended(plan, 15.0)
    assert [m.id for m in kept.track.moods] == ["m"] and list(kept.life.moods.rows[-1]) == [-0.03, -0.8, 1.0]
    after = hear_asks(sample, plan, 8.0, [a.Withdraw(id="w", what="m")], 20.0)
    assert [round(m.end, 3) for m in after.track.moods] == [round(8.0 + sample.settings.lookahead, 3)]
    assert list(after.life.moods.rows[-1]) == [0.0, 0.0, 1.0]


def test_energetic_actions_are_those_whose_hands_move_fast(sample: Project) -> None:
    gestures = [x for x in sample.graphs["arms"].actions.values() if x.kind == "gesture"]
    found = sorted(measure_vigour(sample, x) for x in gestures)
    assert -1 <= found[0] < -0.1 and 0.1 < found[-1] <= 1
    assert abs(found[len(found) // 2]) < 0.1, "the middle one is as fast as the middle one"


def test_how_energetic_all_actions_are_is_what_each_is(sample: Project) -> None:
    lacking = {ident: replace(x, motion=None) for ident, x in list(sample.clips.items())[::3]}
    for project in (sample, replace(sample, clips={**sample.clips, **lacking})):
        for graph in project.graphs.values():
            again = replace(graph)  # which remembers nothing
            one_by_one = project.with_graph(again)
            speeds = {ident: _speed_of(project, x) for ident, x in graph.actions.items()}
            known = {ident: speed for ident, speed in speeds.items() if speed is not None}
            found = measure_vigours(project, replace(graph), known)
            assert [found.get(x, 0.0) for x in again.actions] == [
                measure_vigour(one_by_one, x) for x in again.actions.values()
            ]


def test_hands_are_faster_and_farther_out_the_more_aroused(sample: Project) -> None:
    """What `tests/benchmarks/bench_moods.py` measures, of the same gestures in three moods."""
    roles = anatomy.project_roles(sample)
    assert sample.skeleton is not None
    sample = free(sample)
    actions = [x.id for x in sample.graphs["arms"].of(sample.graphs["arms"].start or "", "gesture")][:5]
    speeds, extents = [], []
    for arousal in (-1.0, 0.0, 1.0):
        project = feeling(sample, 0.0, arousal)
        asks = [
            {"do": "action", "id": f"g{n}", "action": x, "at": 1.0 + 8 * n} for n, x in enumerate(actions)
        ]
        plan = performed(project, *asks, end=42.0)
        at = sample.skeleton.globals(pose_at(plan, project, np.arange(0, 42, 1 / 30), False))[1]
        hands = at[:, [roles["left_hand"], roles["right_hand"]]] - at[:, [roles["chest"]]]
        speed = np.linalg.norm(np.diff(hands, axis=0), axis=-1) * 30
        speeds.append(float(speed[speed > 0.1].mean()))
        # Faster gestures are out for less time: of all moments the farthest are looked at.
        extents.append(float(np.percentile(np.linalg.norm(hands - hands[0], axis=-1), 98)))
    assert speeds == sorted(speeds) and speeds[0] < 0.8 * speeds[2]
    assert extents == sorted(extents) and extents[0] < 0.85 * extents[2]


def test_heads_hang_in_sadness_and_life_slows_with_arousal(sample: Project) -> None:
    roles = anatomy.project_roles(sample)
    assert sample.skeleton is not None
    ahead, breaths = [], []
    for valence, arousal in ((-1.0, -0.6), (0.0, 0.0), (1.0, 0.6)):
        project = feeling(sample, valence, arousal)
        plan = make_plan(project, 60.0, seed=1, idle=False)
        pose = pose_at(plan, project, np.arange(5.0, 60.0, 0.5))
        places = sample.skeleton.globals(pose)[1]
        ahead.append((places[:, roles["head"], 2] - places[:, roles["hips"], 2]).mean())
        breaths.append(len(plan.life.breaths))
    assert ahead == sorted(ahead, reverse=True) and breaths == sorted(breaths) and breaths[0] < breaths[2]
