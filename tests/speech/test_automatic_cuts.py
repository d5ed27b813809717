"""Cuts that follow who speaks: never too short, never to who is silent, no cut to what is seen anyway."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.graph.model import Project
from metagraph.graph.timeline import Cut, with_cut
from metagraph.graph.timeline_edits import get_timeline
from metagraph.speech import automatic_cuts as c


def talk(*sides, length=40.0):
    made = tuple(
        Side(name=str(n), segments=tuple(Segment(k, a, b) for k, a, b in s)) for n, s in enumerate(sides)
    )
    return Conversation(name="x", length=length, sides=made)


def test_it_begins_with_all_and_cuts_to_who_speaks_a_little_early():
    some = talk([("clause", 3.0, 7.0)], [("clause", 8.0, 12.0)], length=13.0)
    assert [(x.at, x.shot, x.side) for x in c.make_automatic_cuts(some)] == [
        (0.0, "two", 0), (2.88, "over", 0), (7.4, "over", 1),
    ]  # fmt: skip


def test_an_answer_in_passing_is_no_cut():
    some = talk(
        [("clause", 3.0, 6.0), ("clause", 6.5, 9.0)],
        [("response", 5.0, 5.5), ("clause", 7.0, 7.6)],
        length=10.0,
    )
    assert [x.side for x in c.make_automatic_cuts(some)] == [0, 0]


def test_a_listener_who_answers_in_a_long_turn_is_seen_and_then_the_speaker_again():
    some = talk(
        [("clause", 3.0 + 2 * n, 4.9 + 2 * n) for n in range(6)], [("response", 8.0, 8.4)], length=16.0
    )
    assert [(x.at, x.shot, x.side) for x in c.make_automatic_cuts(some)] == [
        (0.0, "two", 0), (2.88, "over", 0), (7.65, "close", 1), (9.45, "close", 0),
    ]  # fmt: skip


def test_a_listener_without_a_word_is_seen_after_a_while():
    some = talk([("clause", 3.0 + 2 * n, 4.9 + 2 * n) for n in range(14)], [], length=32.0)
    assert [(x.shot, x.side) for x in c.make_automatic_cuts(some)] == [
        ("two", 0), ("over", 0), ("close", 0), ("close", 1), ("over", 0), ("close", 0), ("over", 0),
    ]  # fmt: skip


def test_who_answers_between_two_turns_of_one_speaker_is_seen():
    some = talk([("clause", 3.0, 7.0), ("clause", 9.2, 13.0)], [("response", 7.4, 8.0)], length=14.0)
    assert [(x.at, x.shot, x.side) for x in c.make_automatic_cuts(some)] == [
        (0.0, "two", 0), (2.88, "over", 0), (7.28, "over", 1), (8.88, "over", 0),
    ]  # fmt: skip
    near = talk([("clause", 3.0, 7.0), ("clause", 8.3, 13.0)], [("response", 7.6, 8.0)], length=14.0)
    assert {x.side for x in c.make_automatic_cuts(near)} == {0}, "there is no time for it"


def test_who_thinks_before_an_answer_is_seen_thinking():
    some = talk([("clause", 3.0, 7.0)], [("clause", 9.0, 12.0)], length=13.0)
    assert c.make_automatic_cuts(some)[-1].at == 7.8


def test_a_short_answer_that_goes_on_is_seen_from_its_first_word():
    some = talk([("clause", 3.0, 7.0)], [("response", 7.3, 7.6), ("clause", 8.2, 11.0)], length=12.0)
    assert c.make_automatic_cuts(some)[-1].at == 7.18


def test_all_are_shown_again_now_and_then():
    some = talk(
        [("clause", 3.0 + 10 * n, 6.0 + 10 * n) for n in range(6)],
        [("clause", 7.0 + 10 * n, 12.5 + 10 * n) for n in range(6)],
        length=70.0,
    )
    assert [round(x.at) for x in c.make_automatic_cuts(some) if x.shot == "two"] == [0, 43, 64]


def test_a_last_answer_is_seen():
    some = talk([("clause", 3.0, 7.0)], [("response", 7.5, 8.0)], length=10.0)
    assert [(x.at, x.shot, x.side) for x in c.make_automatic_cuts(some)][-1] == (7.38, "over", 1)


def test_a_new_conversation_is_filmed_and_one_voice_alone_is_not():
    some = talk([("clause", 3.0, 7.0)], [("clause", 8.0, 12.0)], length=13.0)
    project, ident = c.keep_filmed_conversation(Project(name="x"), some)
    assert get_timeline(project, ident).cuts == c.make_automatic_cuts(some)
    project, alone = c.keep_filmed_conversation(Project(name="x"), talk([("clause", 3.0, 7.0)], length=9.0))
    assert get_timeline(project, alone).cuts == ()


def test_who_speaks_long_is_seen_closer_and_a_long_silence_shows_all():
    some = talk([("clause", 3.0 + 2 * n, 4.9 + 2 * n) for n in range(8)], [], length=40.0)
    assert [x.shot for x in c.make_automatic_cuts(some)] == ["two", "over", "close", "over", "two"]


@given(
    st.lists(st.tuples(st.floats(0.5, 2.5), st.floats(0.0, 0.8), st.booleans()), min_size=1, max_size=40),
)
def test_who_speaks_is_never_seen_from_one_place_for_long(drawn):
    sides, at, side = [[], []], 0.5, 0
    for length, pause, goes_on in drawn:
        sides[side].append(("clause", at, at + length))
        at += length + pause + (0.0 if goes_on else 1.4)
        side = side if goes_on else 1 - side
    end = at
    cuts = c.make_automatic_cuts(talk(*sides, length=end))
    for x, y in pairwise([*cuts, Cut(at=end, shot="two", side=9)]):
        most = {"close": c.CLOSE, "over": c.LONG}.get(x.shot, 9.0)
        assert y.at - x.at < most + 2.3, "a beginning of words, and a silence, may be waited for"


def test_one_who_goes_on_after_a_pause_has_been_seen_before_it():
    some = talk(
        [("clause", 0.5, 6.3), *(("clause", 9.1 + 2 * n, 11.0 + 2 * n) for n in range(8))], [], length=26.0
    )
    found = [(x.at, x.shot) for x in c.make_automatic_cuts(some)]
    assert found[1] == (2.0, "over") and found[2][1] == "close" and found[2][0] < 9.2


@given(st.lists(st.tuples(st.integers(0, 2), st.floats(0.1, 6), st.floats(0.1, 5)), max_size=25))
def test_no_picture_is_shorter_than_one_can_see(drawn):
    sides, at = [[], [], []], 0.0
    for side, pause, length in drawn:
        start = at + pause / 2
        if not sides[side] or sides[side][-1][2] <= start:
            sides[side].append(("clause", start, start + length))
        at = start + length * 0.8
    cuts = c.make_automatic_cuts(talk(*sides, length=at + 10))
    assert cuts[0] == Cut(at=0.0, shot="two")
    assert all(y.at - x.at >= c.SHORTEST - 0.011 for x, y in pairwise(cuts))
    assert all((x.shot, x.side) != (y.shot, y.side) for x, y in pairwise(cuts))


def test_the_cut_of_a_time_lasts_until_the_next():
    cuts = (Cut(at=1.0, shot="two"), Cut(at=4.0, shot="close", side=1))
    assert c.cut_at(cuts, 0.5) is None and c.cut_at(cuts, 1.0) == (cuts[0], 4.0)
    assert c.cut_at(cuts, 9.0) == (cuts[1], float("inf"))


def test_a_cut_replaces_one_at_its_time_and_says_nothing_twice():
    cuts = (Cut(at=0.0, shot="two"), Cut(at=4.0, shot="over"))
    assert with_cut(cuts, Cut(at=4.03, shot="close")) == (cuts[0], Cut(at=4.03, shot="close"))
    assert with_cut(cuts, Cut(at=2.0, shot="two")) == cuts
    assert with_cut(cuts, Cut(at=2.0, shot="over")) == (cuts[0], Cut(at=2.0, shot="over"))
