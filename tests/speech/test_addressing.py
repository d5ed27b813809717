"""Who speaks to whom, and who holds the floor."""

from __future__ import annotations

from itertools import pairwise

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.conversation.model import EVERYBODY, Conversation, Segment, Side
from metagraph.speech.addressing import find_floor_holders, list_addressed_turns, list_side_roles
from tests.speech.group import group, made_up, said


def to(conversation: Conversation) -> list[int]:
    return [turn.to for turn in list_addressed_turns(conversation)]


def test_where_nobody_speaks_all_are_idle_all_the_time() -> None:
    assert list_addressed_turns(group(3)) == ()
    assert [(r.start, r.end, r.part) for r in list_side_roles(group(3), 1)] == [(0.0, 30.0, "idle")]


def test_two_speak_to_each_other() -> None:
    assert to(group(2, said(0, 1, 2), said(1, 3, 4), said(1, 20, 21))) == [1, 0, 0]


def test_who_answers_was_spoken_to_and_answers_to_that_one() -> None:
    assert to(group(3, said(0, 1, 2), said(2, 2.5, 4), said(1, 15, 16))) == [2, 0, EVERYBODY]


def test_who_begins_long_after_answers_nobody() -> None:
    assert to(group(3, said(0, 1, 2), said(2, 10, 11))) == [EVERYBODY, EVERYBODY]


def test_who_is_called_by_name_is_spoken_to_and_answers_to_that_one() -> None:
    talk = group(4, said(0, 1, 2, "what about you, Ben?"), said(1, 2.5, 3, "well"), said(3, 3.2, 4, "no"))
    assert to(talk) == [1, 0, 1], "Ben answers Ann, who chose him, and not Dora, who speaks next"


def test_a_name_counts_whole_or_by_its_first_word_where_no_other_is_called_so() -> None:
    sides = [Side(name=name) for name in ("Ann", "Ben Ali", "Ben Oz", "Cleo Dee")]
    talk = Conversation(name="t", length=9.0, sides=tuple(sides))

    def chosen(text: str) -> tuple[int, bool]:
        ann = msgspec.structs.replace(sides[0], segments=(said(0, 1, 2, text)[1],))
        (turn,) = list_addressed_turns(msgspec.structs.replace(talk, sides=(ann, *sides[1:])))
        return turn.to, turn.chosen

    assert chosen("tell us, ben oz") == (2, True)
    assert chosen("tell us, Ben") == (EVERYBODY, False)
    assert chosen("Cleo tell us") == (3, True)
    assert chosen("the benches are full, Clea") == (EVERYBODY, False)


def test_what_somebody_said_of_a_segment_is_above_all_that_is_inferred() -> None:
    talk = group(3, said(0, 1, 2, "you, Ben", to=2), said(1, 2.2, 3), said(2, 4, 5, to=EVERYBODY))
    assert to(talk) == [2, 2, EVERYBODY]


def test_a_turn_is_parted_where_it_is_said_to_somebody_else() -> None:
    talk = group(3, said(0, 1, 2, to=1), said(0, 2, 3, to=2), said(0, 3.1, 4, to=2))
    assert [(t.start, t.end, t.to) for t in list_addressed_turns(talk)] == [(1, 2, 1), (2, 4, 2)]


def test_responses_alone_take_no_turn() -> None:
    talk = group(3, said(0, 1, 4), (1, Segment("response", 2, 2.4, None, "yeah")))
    assert [t.side for t in list_addressed_turns(talk)] == [0]
    assert {r.part for r in list_side_roles(talk, 1)} == {"idle", "addressed"}


def test_turns_of_one_with_a_pause_are_said_to_the_same() -> None:
    assert to(group(3, said(0, 1, 2), said(0, 4, 5), said(1, 5.2, 6))) == [1, 1, 0]


def test_who_talks_into_a_turn_gets_the_floor_when_that_ends() -> None:
    talk = group(3, said(0, 1, 4), said(1, 3, 6))
    assert [(a, b, t.side) for a, b, t in find_floor_holders(list_addressed_turns(talk))] == [
        (1, 4, 0),
        (4, 6, 1),
    ]
    assert [(r.start, r.end, r.part, r.whom) for r in list_side_roles(talk, 2)] == [
        (0, 1, "idle", None),
        (1, 4, "aside", 0),
        (4, 6, "aside", 1),
        (6, 30, "idle", None),
    ]


def test_said_to_all_addresses_each() -> None:
    talk = group(3, said(0, 1, 4, to=EVERYBODY))
    assert [list_side_roles(talk, n)[1].part for n in range(3)] == ["speaks", "addressed", "addressed"]


@pytest.mark.parametrize("to", [0, 3, 7])
def test_nobody_speaks_to_oneself_or_to_who_is_not_there(to: int) -> None:
    with pytest.raises(ValueError, match="said to"):
        group(3, said(0, 1, 2, to=to))


@given(st.integers(2, 8), st.integers(0, 99))
def test_everyone_has_a_role_all_the_time_and_one_at_a_time(count: int, seed: int) -> None:
    talk = made_up(count, seed, 40.0)
    for side in range(count):
        roles = list_side_roles(talk, side)
        assert roles[0].start == 0 and roles[-1].end == talk.length
        assert all(a.end == b.start for a, b in pairwise(roles)) and all(r.start < r.end for r in roles)
        assert all(r.whom != side for r in roles)
        speaks = sum(r.end - r.start for r in roles if r.part == "speaks")
        assert speaks == pytest.approx(
            sum(t.end - t.start for t in list_addressed_turns(talk) if t.side == side)
        )
