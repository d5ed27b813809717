"""What was asked of the life layers, kept in order."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.life.track import BlinkAt, Item, LookAt, ModeFrom, PlaceFrom, Speech, Track, cut, track_of

starts = st.integers(0, 12).map(float)
names = st.sampled_from("abcdef")
items = st.lists(
    st.one_of(
        st.builds(lambda i, s, n: LookAt(i, s, s + n, "user"), names, starts, st.integers(1, 5)),
        st.builds(lambda i, s, n, p: Speech(i, s, s + n, None, "x", p), names, starts, st.integers(1, 5), st.integers(0, 2)),
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
    ended = {cut(i, now) if isinstance(i, Speech) else replace(i, end=min(i.end, now)) if isinstance(i, LookAt) else i for i in kept}
    assert {i for i in left.items if i.id in gone} == ended
