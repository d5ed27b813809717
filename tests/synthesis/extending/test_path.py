"""A path that is extended while it plays: what was shown stays, and there is always an answer."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.clips import read_clips
from metagraph.research.motion_graph.extending_evaluation import extend_by_windows, list_speech_news
from metagraph.synthesis.constraints import HeardStates
from metagraph.synthesis.extending.path import (
    NODES,
    SEEN,
    DriverGraph,
    ExtendingRules,
    PathExtender,
    make_driver_graph,
    replay_path,
)
from metagraph.synthesis.extending.speech_so_far import MOST, SpeechNews
from metagraph.synthesis.graph import build_graph
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.path_quality import measure_quality
from metagraph.synthesis.search.ruled_search import FREE, JumpRules
from metagraph.synthesis.states import SynthesisError, read_states
from tests.synthesis.talking import speech, talkers_graph
from tests.synthesis.test_search import graph_of
from tests.thorough import many

REAL = FilePath(__file__).resolve().parents[4] / "shared" / "data" / "smartbody-brad"


@pytest.fixture(scope="module")
def graph() -> DriverGraph:
    return talkers_graph()


def silent(frames: int) -> HeardStates:
    return HeardStates(np.ones(frames, np.uint8), np.zeros(frames, bool), np.zeros(frames, bool))


def shown(extender: PathExtender, frames: int, *news: SpeechNews) -> list[int]:
    out = []
    for _ in range(frames):
        extender.step(news)
        news = ()
        out.append(extender.at(extender.frame))
    return out


def leads(graph: DriverGraph, a: int, b: int) -> bool:
    """Whether a graph leads from a state to another."""
    links = graph.ruled
    return (b == a + 1 and b < graph.stops[a]) or b in links.targets[links.starts[a] : links.starts[a + 1]]


NEWS = st.builds(
    SpeechNews,
    st.sampled_from(["begins", "ends", "stress", "comes", "comes", "hush"]),
    st.floats(0, 6),
    st.floats(0, 8),
    st.none() | st.floats(0, 8),
    st.sampled_from(["clause", "clause", "response", "hesitation"]),
)


@settings(max_examples=many(8, 400), deadline=None)
@given(st.lists(st.tuples(st.integers(0, 150), NEWS), max_size=25), st.integers(0, 2**32 - 1))
def test_what_was_shown_and_what_is_locked_never_changes(
    told: list[tuple[int, SpeechNews]], seed: int
) -> None:
    graph = talkers_graph()
    extender, fixed, lock = PathExtender(graph, seed), dict[int, int](), graph.rules.lock
    told = sorted(told, key=lambda x: x[0])
    for frame in range(160):
        extender.step([news for at, news in told if at == frame])
        assert extender.frame == frame and extender.end > frame + lock
        for ahead in range(frame, frame + lock + 1):
            assert fixed.setdefault(ahead, extender.at(ahead)) == extender.at(ahead)
        assert extender.spent <= graph.rules.work + 60 * 64
    way = [fixed[frame] for frame in range(160)]
    assert all(leads(graph, a, b) for a, b in pairwise(way))
    again = replay_path(graph, told, 160, seed)
    assert again.states.tolist() == way


def test_strokes_meet_stresses_that_are_announced_and_cannot_meet_those_that_are_heard(
    graph: DriverGraph,
) -> None:
    said = speech(60.0, 50)
    strokes = {}
    for ahead in (None, 1.0):
        path, _ = extend_by_windows(graph, said, 60.0, ahead)
        at = np.flatnonzero(graph.heard.peaks[path.states]) / 30
        near = [np.abs(at - s.peak).min() <= 0.117 for s in said if s.peak is not None]
        strokes[ahead] = np.mean(near)
    assert strokes[1.0] > 0.9 and strokes[None] < 0.5


def test_speech_that_ends_at_once_leaves_no_gesture_waiting(graph: DriverGraph) -> None:
    extender = PathExtender(graph)
    clauses = [SpeechNews("comes", 1.0 + n, 1.9 + n, 1.5 + n) for n in range(5)]
    shown(extender, 75, *clauses)
    way = shown(extender, 90, SpeechNews("ends", 2.5), SpeechNews("hush", 2.5))
    strokes = graph.heard.peaks[way]
    assert not strokes[10:].any() and (graph.heard.kinds[way[45:]] == 1).mean() > 0.8


def test_silence_rests_no_longer_than_the_takes_and_does_not_repeat(graph: DriverGraph) -> None:
    way = np.array(shown(PathExtender(graph), 900))
    looks = measure_quality(graph.states, Path(way, 0.0, np.flatnonzero(np.diff(way) != 1) + 1))
    assert not looks.stands_still and looks.repeated < 0.1 and looks.jumps < 2


def test_a_flood_of_news_is_searched_for_no_more_often_than_it_may_be(graph: DriverGraph) -> None:
    extender, chance = PathExtender(graph), np.random.default_rng(1)
    for frame in range(90):
        at = frame / 30 + chance.uniform(0, 3, 100)
        extender.step(SpeechNews("comes", float(x), float(x) + 0.5, float(x) + 0.2) for x in at)
    assert extender.found <= 90 // graph.rules.every + 1 and len(extender.speech.segments) <= MOST


def test_ten_minutes_keep_as_much_as_one(graph: DriverGraph) -> None:
    extender = PathExtender(replace(graph, rules=replace(graph.rules, every=20, work=5_000)))
    news, place, kept = list_speech_news(speech(600.0, 70), 0.5), 0, 0
    for frame in range(18_000):
        first = place
        while place < len(news) and news[place][0] * 30 <= frame:
            place += 1
        extender.step(one for _, one in news[first:place])
        if frame % 300 == 0:
            kept = max(kept, len(extender._way) + len(extender.speech.segments))
    assert place == len(news) > 300
    assert kept < SEEN * 30 + 30 + graph.rules.lock + graph.rules.horizon + 20


def test_a_take_that_leads_nowhere_goes_on_with_what_is_most_alike() -> None:
    graph = make_driver_graph(graph_of(80, [0, 40, 80], {}), silent(80))  # no transitions at all
    way = shown(PathExtender(graph), 300)
    jumps = [(a, b) for a, b in pairwise(way) if b != a + 1]
    assert jumps and all(a in (39, 79) for a, _ in jumps)
    assert all(a != b for a, b in pairwise(way))  # it never stands still


def test_a_run_that_ends_too_soon_is_left_before_the_least_time() -> None:
    links = {(9, 30): 0.01, (34, 2): 0.01}  # five frames of the second take, less than a run has to last
    graph = graph_of(40, [0, 10, 35, 40], links)
    rules = ExtendingRules(jumps=JumpRules(run=1.0, apart=0.0, price=0.0, recent=0.0, again=0.0))
    way = shown(PathExtender(make_driver_graph(graph, silent(40), rules)), 120)
    assert len(way) == 120 and all(0 <= x < 40 for x in way)


@pytest.mark.skipif(not REAL.is_dir(), reason="the recordings of others are not there")
def test_somebody_elses_clips_go_on_for_a_minute_without_standing_still() -> None:
    clips = [read_clips(path)[0] for path in sorted(REAL.glob("*Idle*.bvh"))[:8]]
    states = read_states(clips)
    sound = HeardStates(np.ones(len(states), np.uint8), np.zeros(len(states), bool))
    way = np.array(shown(PathExtender(make_driver_graph(build_graph(states), sound)), 1800))
    looks = measure_quality(states, Path(way, 0.0, np.flatnonzero(np.diff(way) != 1) + 1))
    assert not looks.stands_still and looks.repeated < 0.2 and (np.diff(way) != 0).all()


def test_states_that_were_cut_away_are_not_gone_through(graph: DriverGraph) -> None:
    kept = np.ones(100, bool)
    kept[20:30] = False
    links = {(19, 60): 0.01, (99, 5): 0.01, (70, 31): 0.01, (10, 40): 0.01}
    some = replace(graph_of(100, [0, 50, 100], links), kept=kept)
    way = shown(PathExtender(make_driver_graph(some, silent(100))), 600)
    assert not set(way) & set(range(20, 30))


def test_another_seed_moves_otherwise_and_the_same_moves_alike(graph: DriverGraph) -> None:
    one, two, again = (shown(PathExtender(graph, seed), 240) for seed in (1, 2, 1))
    assert one == again and one != two


def test_the_work_of_a_search_is_bounded_and_there_is_an_answer_after_any(graph: DriverGraph) -> None:
    said = speech(30.0, 51)
    for work in (50, 5_000):
        less = replace(graph, rules=replace(graph.rules, work=work))
        path, searches = extend_by_windows(less, said, 30.0, 1.0)
        assert max(spent for spent, _ in searches) <= work + 60 * 64 and len(path.states) == 900
    assert NODES >= 1000


def test_graphs_without_anything_to_go_between_are_refused() -> None:
    with pytest.raises(SynthesisError, match="longer takes"):
        make_driver_graph(replace(graph_of(4, [0, 4], {}), kept=np.zeros(4, bool)), silent(4))
    with pytest.raises(SynthesisError, match="of 4 frames"):
        make_driver_graph(graph_of(4, [0, 4], {}), silent(5))


def test_without_rules_for_jumps_it_jumps_too() -> None:
    graph = graph_of(60, [0, 60], {(n, (n + 31) % 60): 0.1 for n in range(60)})
    free = make_driver_graph(graph, silent(60), ExtendingRules(jumps=FREE))
    assert len(shown(PathExtender(free), 200)) == 200
