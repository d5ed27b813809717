"""What a conversation asks of its characters."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.conversation.model import (
    SPOKEN,
    Conversation,
    Rates,
    Segment,
    Side,
    Spoken,
    list_segments_heard_by,
)
from metagraph.graph.model import Project
from metagraph.graph.requests import AnyRequest, Behave, Change, Fidget, Gesture, Nod, Play
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.speech.drive import TOLERANCE, draw_segments, drive, drive_side, find_stroke_times


def said(
    *own: Segment, partner: tuple[Segment, ...] = (), length: float = 60.0, **rates: float
) -> Conversation:
    return Conversation(
        name="talk",
        length=length,
        sides=(Side(name="Left", segments=own, rates=Rates(**rates)), Side(name="Right", segments=partner)),
    )


def clause(start: float, end: float, text: str = "") -> Segment:
    return Segment("clause", start, end, round((start + end) / 2, 3), text)


def clauses(count: int, apart: float = 1.9) -> tuple[Segment, ...]:
    return tuple(
        clause(round(1 + apart * n, 3), round(1 + apart * n + 1.3, 3), f"words {n}") for n in range(count)
    )


def ids(asks: object, kind: type) -> set[str]:
    return {a.id for a in asks if isinstance(a, kind)}  # type: ignore[attr-defined]


def gestures(asks: Iterable[AnyRequest]) -> list[Gesture | Play]:
    return [a for a in asks if isinstance(a, Gesture | Play)]


def tags_of(asks: Iterable[AnyRequest], project: Project) -> list[tuple[str, ...]]:
    """Of gestures by name, those of the action."""
    return [a.tags if isinstance(a, Gesture) else project.action(a.action).tags for a in gestures(asks)]


def test_silence_asks_for_nothing_but_to_look_at_the_partner_and_to_fidget(sample: Project) -> None:
    asks = drive_side(said(), 0, sample)
    assert not ids(asks, Gesture) and not ids(asks, Nod)
    assert [a.mode for a in asks if isinstance(a, Behave)] == ["idle"]


def test_at_a_rate_of_one_every_clause_asks_for_a_gesture_whose_stroke_is_at_its_peak(
    sample: Project,
) -> None:
    some = clauses(5, 2.4)
    asks = gestures(drive_side(said(*some, clause=1.0), 0, sample))
    assert [a.stroke for a in asks] == [s.peak for s in some]


def test_at_a_rate_of_nought_none_does(sample: Project) -> None:
    assert not gestures(drive_side(said(*clauses(9), clause=0.0), 0, sample))


def test_over_many_clauses_as_many_are_drawn_as_the_rate_says() -> None:
    talk = said(*clauses(2000), length=4000, clause=0.62)
    assert len(draw_segments(talk, 0)) / 2000 == pytest.approx(0.62, abs=0.03)


def test_responses_of_ones_own_and_hesitations_of_the_partner_ask_for_nods_but_ones_own_hesitations_do_not(
    sample: Project,
) -> None:
    own = (Segment("response", 2, 2.5, None, "yeah"), Segment("hesitation", 10, 10.4, None, "uh"))
    partner = (Segment("hesitation", 5, 5.4, None, "er"), Segment("response", 20, 20.4, None, "okay"))
    asks = drive_side(said(*own, partner=partner, response=1.0, hesitation=1.0), 0, sample)
    assert sorted(a.at for a in asks if isinstance(a, Nod)) == [2, 5]


def test_the_partner_who_hesitates_while_one_speaks_oneself_is_not_nodded_at(sample: Project) -> None:
    talk = said(clause(4, 7), partner=(Segment("hesitation", 5, 5.4),), hesitation=1.0)
    assert [s.kind for s in list_segments_heard_by(talk, 0)] == ["clause"]
    assert not ids(drive_side(talk, 0, sample), Nod)


def test_what_is_drawn_for_one_segment_does_not_depend_on_the_others() -> None:
    some = clauses(30)
    whole, fewer = (draw_segments(said(*s, clause=0.5), 0) for s in (some, (*some[:7], *some[8:])))
    assert whole - {"clause words 7"} == fewer


def test_a_side_talks_listens_and_idles_in_turn(sample: Project) -> None:
    talk = said(clause(1, 3), clause(3.3, 5), partner=(clause(6, 8),))
    modes = [(a.at, a.mode) for a in drive_side(talk, 0, sample) if isinstance(a, Behave)]
    assert modes == [(0.0, "idle"), (1.0, "talking"), (5.0, "listening")]


def test_strokes_land_on_the_peaks_of_f0(sample: Project) -> None:
    performance, plan = drive(said(*clauses(25), clause=0.75), 0, sample)
    found = find_stroke_times(sample, plan)
    asked = gestures(performance.asks)
    assert len(asked) >= 12
    assert max(abs(found[a.id] - a.stroke) for a in asked if a.stroke is not None) <= TOLERANCE


def test_strokes_are_nearer_to_the_peaks_of_their_own_speech_than_to_those_of_shuffled_speech(
    sample: Project,
) -> None:
    """The margin: at least five times as near, where shuffling turns the peaks round within the
    conversation.
    """
    rng = np.random.default_rng(3)
    starts = np.cumsum(rng.uniform(1.4, 3.2, 40))
    peaks = starts + rng.uniform(0.2, 1.0, 40)
    some = tuple(
        Segment("clause", a, a + 1.2, p, f"w{n}")
        for n, (a, p) in enumerate(zip(starts.tolist(), peaks.tolist(), strict=True))
    )
    length = float(starts[-1]) + 3
    _, plan = drive(said(*some, length=length), 0, sample)
    at = np.array(list(find_stroke_times(sample, plan).values()))

    def apart(turned: float) -> float:
        moved = (peaks + turned) % length
        return float(np.median(np.abs(at[:, None] - moved).min(1)))

    shuffled = [apart(t) for t in rng.uniform(3, length - 3, 50)]
    assert 5 * apart(0.0) < np.median(shuffled)


def test_the_asks_that_are_kept_performed_again_give_the_same_plan(sample: Project) -> None:
    performance, plan = drive(said(*clauses(12)), 0, sample)
    again = plan_performance(
        sample, performance.asks, performance.length, performance.seed, idle=performance.idle
    )
    assert again.layers == plan.layers


def test_a_graph_without_gestures_nods_or_fidgets_is_asked_for_none() -> None:
    talk = said(*clauses(4), Segment("response", 50, 50.5), clause=1.0, response=1.0)
    asks = drive_side(talk, 0, Project())
    assert not ids(asks, Gesture) | ids(asks, Nod) | ids(asks, Fidget)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.floats(0.0, 2.0), st.floats(0.1, 3.0), st.sampled_from(SPOKEN)), max_size=12))
def test_whatever_is_said_every_ask_can_be_written_and_strokes_meet_their_peaks(
    sample: Project, some: list[tuple[float, float, Spoken]]
) -> None:
    at, segments = 0.0, []
    for gap, length, kind in some:
        start, end = round(at + gap, 3), round(at + gap + length, 3)
        segments.append(Segment(kind, start, end, round((start + end) / 2, 3) if kind == "clause" else None))
        at = end
    talk = said(*segments, partner=(Segment("hesitation", 0.5, 0.9),), length=at + 2)
    performance, plan = drive(talk, 0, sample)
    assert msgspec.json.decode(msgspec.json.encode(performance), type=type(performance)) == performance
    found = find_stroke_times(sample, plan)
    for ask in gestures(performance.asks):
        assert abs(found[ask.id] - (ask.stroke or 0.0)) <= TOLERANCE


def test_words_that_gestures_are_tagged_with_get_such_gestures_and_other_words_plain_ones(
    sample: Project,
) -> None:
    words = ("I told you so", "it was that big", "the dog sat down", "and it went on")
    some = tuple(clause(1 + 3 * n, 2 + 3 * n, text) for n, text in enumerate(words))
    tags = tags_of(drive_side(said(*some, clause=1.0), 0, sample), sample)
    assert "you" in tags[0] and "big" in tags[1]
    assert all({"beat", "explain", "open"} & set(t) for t in tags[2:])


def test_gestures_without_tags_are_asked_for_without(sample: Project) -> None:
    from dataclasses import replace

    graph = sample.graphs["arms"]
    bare = sample.with_graph(graph.with_actions({i: replace(a, tags=()) for i, a in graph.actions.items()}))
    assert {*tags_of(drive_side(said(*clauses(5, 6.0), clause=1.0), 0, bare), bare)} == {()}


def test_the_body_shifts_its_weight_only_where_a_turn_begins(sample: Project) -> None:
    some = tuple(clause(1 + 4 * n, 3 + 4 * n, f"words {n}") for n in range(30))
    asks = [a for a in drive_side(said(*some, length=130), 0, sample) if isinstance(a, Change)]
    starts = {round(s.start - 0.3, 3) for s in some}
    assert {a.layer for a in asks} == {"body"} and {a.at for a in asks} <= starts
    assert 6 <= len(asks) <= 18
    assert not [a for a in drive_side(said(*some, length=130), 0, Project()) if isinstance(a, Change)]
