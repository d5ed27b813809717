"""What was asked of the life layers, kept in order."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.playback.life.track import (
    BlinkAt,
    Item,
    LookAt,
    ModeFrom,
    PlaceFrom,
    Speech,
    Track,
    cut,
    track_of,
)
from metagraph.playback.life.wanted import targets_between

starts = st.integers(0, 12).map(float)
names = st.sampled_from("abcdef")
items = st.lists(
    st.one_of(
        st.builds(lambda i, s, n: LookAt(i, s, s + n, "user"), names, starts, st.integers(1, 5)),
        st.builds(
            lambda i, s, n, p: Speech(i, s, s + n, None, "x", p),
            names,
            starts,
            st.integers(1, 5),
            st.integers(0, 2),
        ),
        st.builds(ModeFrom, names, starts, st.just("idle")),
        st.builds(lambda i, s: PlaceFrom(i, s, "user", (0.0, 0.0, s)), names, starts),
        st.builds(BlinkAt, names, starts),
    ),
    max_size=8,
)


def test_an_empty_track_stays_as_it_is() -> None:
    track = Track()
    assert track.plus([]) is track
    assert track.without(["a"]) is track


@given(items, items)
def test_what_is_added_lies_where_it_would_have_lain_from_the_start(old: list[Item], new: list[Item]) -> None:
    track = track_of(old)
    assert track.plus(new) == track_of((*track.items, *new))


@given(items, st.sets(names), starts)
def test_what_is_taken_out_is_gone_from_then_on(old: list[Item], gone: set[str], now: float) -> None:
    track = track_of(old)
    left = track.without(gone, now)
    assert left.items == track_of(left.items).items
    assert [i for i in left.items if i.id not in gone] == [i for i in track.items if i.id not in gone]
    for item in left.items:
        if item.id in gone:
            assert item.start < now
            assert getattr(item, "end", now) <= now or isinstance(item, ModeFrom | PlaceFrom | BlinkAt)
    kept = {i for i in track.items if i.id in gone and i.start < now}
    ended = {
        cut(i, now)
        if isinstance(i, Speech)
        else replace(i, end=min(i.end, now))
        if isinstance(i, LookAt)
        else i
        for i in kept
    }
    assert {i for i in left.items if i.id in gone} == ended


INF = 1e9
lookings = st.lists(
    st.builds(
        lambda i, s, n, to, p: LookAt(i, s, s + n, to, priority=p),
        names,
        starts,
        st.sampled_from((1.0, 2.0, 5.0, INF)),
        st.sampled_from(("user", "door", (0.0, 1.0, 1.0))),
        st.integers(0, 3),
    ),
    max_size=8,
)
puttings = st.lists(st.builds(lambda i, s: PlaceFrom(i, s, "user", (0.0, 0.0, s)), names, starts), max_size=3)


@given(lookings, puttings, starts)
def test_the_gaze_is_the_same_after_what_no_time_needs_was_forgotten(
    looks: list[Item], places: list[Item], seconds: float
) -> None:
    track = track_of((*looks, *places))
    assert list(targets_between(track.since(seconds), seconds, 30.0)) == list(
        targets_between(track, seconds, 30.0)
    )


@given(st.lists(st.integers(0, 3), min_size=600, max_size=600))
@settings(max_examples=5)
def test_looks_without_an_end_are_forgotten_once_others_have_replaced_them(priorities: list[int]) -> None:
    whole = track = Track()
    for second, priority in enumerate(priorities):
        look = LookAt(f"#{second}", float(second), INF, "user" if second % 2 else "door", priority=priority)
        whole, track = whole.plus([look]), track.plus([look])
        if second % 15 == 0:
            track = track.since(second - 30.0)
        assert len(track.looks) <= 45 + 4  # what has come since the cut, and one of each importance
    assert list(targets_between(track.since(599.0), 599.0, 700.0)) == list(
        targets_between(whole, 599.0, 700.0)
    )
