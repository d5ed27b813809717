"""Looks at the edges of turns, and nods of who listens."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, degrees

import msgspec
import pytest

from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.speech.turn_cues import APART, AWAY, BACK, NODS, look_at_turns, place_clause_nods

HEAD = (0.0, 1.6, 1.3)


def talk(turns: int = 40, length: float = 6.0, seed: int = 1) -> Conversation:
    """Two who take turns of three clauses each."""
    sides: tuple[list[Segment], list[Segment]] = ([], [])
    for n in range(turns):
        at = n * (length + 1.0)
        step = length / 3
        sides[n % 2].extend(
            Segment("clause", at + k * step, at + (k + 1) * step, text=f"{n} {k}") for k in range(3)
        )
    return Conversation(
        name="t",
        length=turns * (length + 1.0),
        seed=seed,
        sides=tuple(Side(name=str(n), segments=tuple(s)) for n, s in enumerate(sides)),
    )


def test_most_long_turns_begin_with_a_look_away_and_end_with_one_at_the_other() -> None:
    found = [x for seed in range(5) for x in look_at_turns(talk(seed=seed), 0, "partner", HEAD)]
    away, back = [x for x in found if x.to != "partner"], [x for x in found if x.to == "partner"]
    assert len(away) / 100 == pytest.approx(AWAY, abs=0.12)
    assert len(back) / 100 == pytest.approx(BACK, abs=0.12)
    assert all(x.strict for x in back) and not any(x.strict for x in away)


def test_the_look_away_goes_to_either_side_of_the_other_and_begins_before_the_turn() -> None:
    away = [x for x in look_at_turns(talk(), 0, "partner", HEAD) if not isinstance(x.to, str)]
    sides = [degrees(atan2(x.to[0], x.to[2])) for x in away if not isinstance(x.to, str)]
    assert {round(abs(a)) for a in sides} == {18} and min(sides) < 0 < max(sides)
    turns = [n * 14.0 for n in range(20)]
    assert all(any(0 <= t - (x.at or 0.0) <= 0.31 for t in turns) for x in away)


def test_short_turns_have_no_looks_of_their_own() -> None:
    assert list(look_at_turns(talk(length=1.5), 0, "partner", HEAD)) == []


def test_who_listens_nods_after_some_of_the_others_clauses_and_never_while_speaking() -> None:
    nods = list(place_clause_nods(talk(), 1, True))
    clauses = talk().sides[0].segments
    assert 0.2 * len(clauses) < len(nods) <= NODS * 1.3 * len(clauses)
    assert all((b.at or 0) - (a.at or 0) >= APART for a, b in pairwise(nods))
    own = [(s.start, s.end) for s in talk().sides[1].segments]
    assert not any(a - 1.0 < (x.at or 0) < b + 0.3 for x in nods for a, b in own)
    assert all(any(0.0 < (x.at or 0) - s.end < 0.8 for s in clauses) for x in nods)
    assert {x.tags for x in nods} == {("listen",)}
    assert {x.tags for x in place_clause_nods(talk(), 1, False)} == {()}


def test_changing_a_clause_leaves_the_nods_to_others_as_they_were() -> None:
    one = talk()
    first = msgspec.structs.replace(one.sides[0].segments[0], text="another")
    other = msgspec.structs.replace(
        one,
        sides=(
            msgspec.structs.replace(one.sides[0], segments=(first, *one.sides[0].segments[1:])),
            one.sides[1],
        ),
    )
    assert list(place_clause_nods(one, 1, True)) == list(place_clause_nods(other, 1, True))
