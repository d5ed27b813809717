"""Modes and looks as segments in time."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.words import MODES
from metagraph.playback.life.track import LookAt, ModeFrom, PlaceFrom, Speech, Track, cut, track_of
from metagraph.playback.life.wanted import AHEAD, PARTNER, GazeTarget, mode_at, modes_between, targets_between

INF = 1e9


def modes(track: Track, start: float = 0.0, end: float = 100.0) -> list[tuple[float, str]]:
    return [(at, MODES[n]) for at, n in modes_between(track, start, end)]


def looks(track: Track, start: float = 0.0, end: float = 100.0) -> list[tuple[float, object]]:
    return [(t.start, t.to) for t in targets_between(track, start, end)]


# --- modes


def test_who_is_asked_nothing_idles() -> None:
    assert modes(Track()) == [(0.0, "idle")]


def test_who_speaks_talks_until_it_ends() -> None:
    track = track_of([Speech("s", 2, 5), Speech("t", 7, 8)])
    assert modes(track) == [(0.0, "idle"), (2, "talking"), (5, "idle"), (7, "talking"), (8, "idle")]


def test_a_mode_asked_for_holds_whatever_is_said_until_it_is_given_back() -> None:
    track = track_of([Speech("s", 2, 9), ModeFrom("m", 3, "listening"), ModeFrom("n", 6, None)])
    assert modes(track) == [(0.0, "idle"), (2, "talking"), (3, "listening"), (6, "talking"), (9, "idle")]


def test_what_lies_before_the_beginning_counts_at_the_beginning() -> None:
    track = track_of([ModeFrom("m", 3, "listening")])
    assert modes(track, 5, 9) == [(5, "listening")] and mode_at(track, 2.9) == "idle"


# --- looks


def test_who_is_asked_nothing_looks_at_the_partner() -> None:
    assert looks(Track()) == [(0.0, PARTNER)]


def test_a_look_ends_and_the_partner_is_looked_at_again() -> None:
    track = track_of([LookAt("l", 2, 4, "door")])
    assert looks(track) == [(0.0, PARTNER), (2, "door"), (4, PARTNER)]


def test_a_look_without_an_end_holds_until_the_next() -> None:
    track = track_of([LookAt("l", 2, INF, "door"), LookAt("m", 5, INF, AHEAD)])
    assert looks(track) == [(0.0, PARTNER), (2, "door"), (5, AHEAD)]


def test_a_lesser_look_waits_beneath_and_the_look_it_waited_for_does_not_come_back() -> None:
    track = track_of(
        [LookAt("a", 1, 20, "a"), LookAt("b", 2, 6, "b", priority=3), LookAt("c", 3, 30, "c", priority=2)]
    )
    assert looks(track) == [(0.0, PARTNER), (1, "a"), (2, "b"), (6, "c"), (30, PARTNER)]


def test_a_look_beneath_that_is_over_by_then_is_never_seen() -> None:
    track = track_of([LookAt("b", 2, 6, "b", priority=3), LookAt("c", 3, 5, "c")])
    assert looks(track) == [(0.0, PARTNER), (2, "b"), (6, PARTNER)]


def test_the_gaze_follows_a_place_that_moves_without_beginning_anew() -> None:
    track = track_of(
        [LookAt("l", 1, 4, "ball"), *(PlaceFrom(f"p{n}", n, "ball", (n, 1.0, 1.0)) for n in range(6))]
    )
    found = list(targets_between(track, 0, 100))
    assert [(t.start, t.to) for t in found] == [
        (0, PARTNER), (1, (1, 1.0, 1.0)), (2, (2, 1.0, 1.0)), (3, (3, 1.0, 1.0)), (4, PARTNER),
    ]  # fmt: skip
    assert [t.since for t in found] == [0, 1, 1, 1, 4]


def test_the_partner_can_be_put_somewhere() -> None:
    track = track_of([PlaceFrom("p", 3, PARTNER, (1.0, 1.6, 0.5))])
    assert looks(track) == [(0.0, PARTNER), (3, (1.0, 1.6, 0.5))]


def test_a_look_of_no_length_is_none() -> None:
    assert looks(track_of([LookAt("l", 2, 2, "door"), LookAt("m", 3, 1, "door")])) == [(0.0, PARTNER)]


items = st.one_of(
    st.builds(
        LookAt,
        st.just("l"),
        st.integers(0, 20),
        st.integers(0, 25),
        st.sampled_from(["a", "b", PARTNER]),
        priority=st.integers(0, 2),
    ),
    st.builds(
        PlaceFrom,
        st.just("p"),
        st.integers(0, 20),
        st.sampled_from(["a", PARTNER]),
        st.tuples(*[st.integers(0, 2)] * 3),
    ),
)


@given(st.lists(items, max_size=8), st.integers(0, 25))
def test_from_any_time_on_the_same_is_looked_at(asked: list[object], at: int) -> None:
    track = track_of(asked)

    def seen(found: list[GazeTarget], time: float) -> tuple[object, float]:
        last = [t for t in found if t.start <= time][-1]
        return last.to, last.amount

    whole, late = list(targets_between(track, 0, 100)), list(targets_between(track, at, 100))
    for time in range(at, 30):
        assert seen(whole, time + 0.5) == seen(late, time + 0.5)


# --- speech cut short


@pytest.mark.parametrize("again", [4.0, 9.0])
def test_speech_cut_short_remembers_how_long_it_would_have_been(again: float) -> None:
    once = cut(Speech("s", 2, 10), 6.0)
    assert (once.end, once.length) == (6.0, 8.0)
    assert cut(once, again).length == 8.0 and cut(once, again).end == min(6.0, again)


def test_a_later_speech_cuts_the_running_one() -> None:
    first, second = track_of([Speech("a", 0, 10, text="long"), Speech("b", 4, 6)]).speeches
    assert (first.end, first.length, second.length) == (4, 10, None)
