"""There is an answer always, and what it gives up and misses is said."""

from __future__ import annotations

from itertools import pairwise

import pytest

from metagraph.graph.conversation.model import SOUNDS, Segment
from metagraph.synthesis.constraints import find_heard_at
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.relaxing import (
    Constraints,
    answer_speech,
    describe_given_up,
    find_misses,
    list_relaxations,
)
from metagraph.synthesis.search.ruled_search import FREE, JUMP_RULES
from metagraph.synthesis.states import SynthesisError
from tests.synthesis.test_search import graph_of

CLAUSE = Segment("clause", 1.0, 2.0, 1.5)


def test_what_goes_with_everything_gives_up_nothing() -> None:
    graph = graph_of(120, [0, 120], {})
    found = answer_speech(graph, find_heard_at(graph.states, [[CLAUSE]]), [CLAUSE], 3.0)
    assert found.given_up == () and found.misses == () and found.words() == ""
    assert found.kept == Constraints()


def test_exactness_is_given_up_first_and_by_how_much_is_told() -> None:
    graph = graph_of(75, [0, 75], {})
    spoken = find_heard_at(graph.states, [[Segment("clause", 1.0, 2.0, 1.66)]])
    found = answer_speech(graph, spoken, [CLAUSE], 2.5)
    assert found.given_up == ("exact timing (0.2 s allowed)",)
    (miss,) = found.misses
    assert (miss.what, miss.kind, miss.at) == ("stress", "clause", 1.5)
    assert miss.off == pytest.approx(0.17, abs=0.02)
    assert found.words().endswith("stress of the clause at 1.5 s: 0.17 s off")


def test_what_no_take_has_ever_heard_is_given_up_alone() -> None:
    graph = graph_of(120, [0, 120], {})
    response = Segment("response", 2.5, 3.0)
    found = answer_speech(graph, find_heard_at(graph.states, [[CLAUSE]]), [CLAUSE, response], 3.5)
    assert found.given_up == ("responses",)
    assert [(m.what, m.kind, m.off) for m in found.misses] == [
        ("start", "response", 0.5),
        ("end", "response", 1.0),
    ]
    assert found.words().startswith("dropped: responses; start of the response at 2.5 s: 0.50 s off")


def test_takes_too_short_for_what_is_asked_are_the_only_thing_refused() -> None:
    graph = graph_of(30, [0, 30], {})
    with pytest.raises(SynthesisError, match="for 3 s"):
        answer_speech(graph, find_heard_at(graph.states, [[]]), [CLAUSE], 3.0)


def test_each_step_gives_up_one_thing_more_and_the_last_constrains_nothing() -> None:
    asked = Constraints()
    tried = list(list_relaxations(asked))
    assert tried[0] == asked and asked.rules == JUMP_RULES and asked.use == SOUNDS
    lengths = [len(describe_given_up(asked, c)) for c in tried]
    assert lengths[0] == 0 and all(a < b for a, b in pairwise(lengths))
    last = tried[-1]
    assert last.use == () and not last.peaks and not last.edges and last.rules == FREE
    few = Constraints(use=("clause",), peaks=False, edges=False, rules=FREE)
    assert [describe_given_up(few, c) for c in list_relaxations(few)] == [
        (),
        ("exact timing (0.2 s allowed)",),
        ("clauses", "exact timing (0.2 s allowed)"),
    ]


def test_words_that_have_to_be_met_are_given_up_last_but_one() -> None:
    tried = list(list_relaxations(Constraints(words=True)))
    assert [c.words for c in tried] == [True] * (len(tried) - 2) + [False] * 2
    assert tried[-2].use == ("clause",) and tried[-1].use == ()
    assert any("words" in what for what in describe_given_up(tried[0], tried[-1]))


def test_what_was_not_asked_for_is_not_missed() -> None:
    graph = graph_of(90, [0, 90], {})
    spoken = find_heard_at(graph.states, [[]])
    path = Path(graph.keys[:90], 0.0, graph.keys[:0])
    every = find_misses(spoken, path, [CLAUSE], Constraints())
    assert [m.what for m in every] == ["start", "stress", "end"] and all(m.off is None for m in every)
    assert [m.what for m in find_misses(spoken, path, [CLAUSE], Constraints(edges=False))] == ["stress"]
    assert find_misses(spoken, path, [CLAUSE], Constraints(use=("response",))) == ()
