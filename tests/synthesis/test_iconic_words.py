"""Words that want motion get it from where a take says them, in any language."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.conversation.model import Word
from metagraph.synthesis.constraints import HeardStates, list_wanted
from metagraph.synthesis.iconic_words import (
    AROUND,
    WordWish,
    describe_words,
    find_phrase_spans,
    find_states_of_words,
    find_unsaid_wishes,
    find_word_places,
    find_words_shown,
    measure_word_cost,
    parse_word_wish,
)
from metagraph.synthesis.prosody_costs import SpokenTake
from metagraph.synthesis.search.frame_costs import join_costs
from metagraph.synthesis.search.relaxing import Constraints, answer_speech
from metagraph.synthesis.search.ruled_search import FREE, find_path
from metagraph.synthesis.soft_constraints import SoftConstraints
from metagraph.synthesis.states import SynthesisError
from tests.synthesis.test_search import graph_of


def words(*said: tuple[str, float, float]) -> SpokenTake:
    return SpokenTake((), tuple(Word(text=t, start=a, end=b) for t, a, b in said))


def test_wishes_are_written_as_people_write_lists() -> None:
    assert parse_word_wish("big") == WordWish(("big",))
    assert parse_word_wish(" big, huge ") == WordWish(("big", "huge"))
    assert parse_word_wish("big = huge, really tall") == WordWish(("big",), ("huge", "really tall"))
    for text in ("", " , ", "= huge", "big =", "big = ,", "…"):
        with pytest.raises(ValueError, match="names no word"):
            parse_word_wish(text)


def test_words_are_found_however_they_are_written() -> None:
    said = words(("Very", 0.0, 0.2), ("BIG,", 0.2, 0.5), ("big-ish", 0.6, 1.0), ("bigger", 1, 2)).words
    assert find_phrase_spans(said, ["big"]) == [(0.2, 0.5, "BIG,")]
    assert find_phrase_spans(said, ["big", "very big"]) == [(0.0, 0.5, "Very BIG,")]
    assert find_phrase_spans(words(("とても", 0, 1), ("大き", 1, 1.5), ("い", 1.5, 2)).words, ["大きい"]) == [
        (1.0, 2.0, "大き い")
    ]
    assert find_phrase_spans(words(("größer", 0, 1), ("बड़ा", 1, 2)).words, ["GRÖSSER", "बड़ा"]) != []
    assert find_phrase_spans((), ["big"]) == [] and find_phrase_spans(said, []) == []


def test_motion_comes_from_around_the_word_in_the_take() -> None:
    graph = graph_of(300, [0, 150, 300], {(9, 200): 0.1, (9, 100): 0.1})
    takes = [words(("small", 3.0, 3.4)), words(("huge", 2.0, 2.4))]  # huge: states 210 to 221
    new = words(("a", 0.0, 0.3), ("big", 0.6, 1.0))
    places = find_word_places([parse_word_wish("big=huge")], graph.states, takes, new, 0.0, 2.0)
    assert [(p.text, p.known, p.frames) for p in places] == [("big", True, (18 - AROUND, 30 + AROUND))]
    charged = join_costs([measure_word_cost(places, 60, 2.0, 1.0)])
    anything = HeardStates(np.ones(300, np.uint8), np.zeros(300, bool))
    for search in ("exact", "greedy"):
        path = find_path(
            graph,
            anything,
            list_wanted([], 2.0),
            search,  # type: ignore[arg-type]
            FREE,
            charged=charged,
        )
        assert charged is not None and charged.paid(path.states) == {"words": 0.0}
        (shown,) = find_words_shown(places, graph.states, path.states)
        assert shown.met and shown.take == 1 and shown.there == pytest.approx(2.2, abs=0.15)
    elsewhere = np.arange(60)
    assert charged is not None and charged.paid(elsewhere)["words"] == pytest.approx(2.0)
    assert not places[0].met(elsewhere)


def test_words_beyond_the_window_and_words_no_take_says_want_nothing() -> None:
    graph = graph_of(90, [0, 90], {})
    new = words(("big", 0.2, 0.4), ("round", 1.0, 1.3), ("big", 5.0, 5.2))
    wishes = [parse_word_wish("big"), parse_word_wish("round")]
    places = find_word_places(wishes, graph.states, [words(("round", 1.0, 1.3))], new, 0.0, 2.0)
    assert [(p.text, p.known) for p in places] == [("big", False), ("round", True)]
    assert set(find_states_of_words(places)) == set(range(30 - AROUND, 39 + AROUND))
    told = describe_words(find_words_shown(places, graph.states, np.arange(60)))
    assert told.startswith("1 of 2 words ") and "'big'" in told
    assert measure_word_cost(places[:1], 60, 2.0, 1.0) is None and describe_words(()) == ""
    begins = find_word_places([parse_word_wish("big")], graph.states, [new], new, 0.3, 1.0)
    assert [p.frames for p in begins] == [(0, 3 + AROUND)]
    assert find_unsaid_wishes([*wishes, parse_word_wish("ball, cube")], new, 0.0, 2.0) == ("ball",)
    assert find_unsaid_wishes(wishes, new, 4.0, 2.0) == ("round",)
    assert describe_words((), ("ball",)) == "not in this speech: 'ball'"
    assert describe_words((), [str(n) for n in range(7)]).endswith("'4' and 2 more")
    close = words(("big", 1.0, 1.2), ("round", 1.3, 1.5), ("round", 1.5, 1.7))
    beside = find_word_places(wishes, graph.states, [new], close, 0.0, 2.0)
    assert [p.frames for p in beside] == [(30 - AROUND, 38), (38, 45), (45, 51 + AROUND)]
    twice = find_word_places(
        [parse_word_wish("big"), parse_word_wish("big")], graph.states, [new], close, 0.0, 2.0
    )
    assert len(twice) == 1, "one moment wants one motion"
    with pytest.raises(SynthesisError, match="the new speech"):
        find_word_places(wishes, graph.states, [new], words(), 0.0, 2.0)
    with pytest.raises(SynthesisError, match="of the takes"):
        find_word_places(wishes, graph.states, [words()], new, 0.0, 2.0)


def test_words_that_must_be_met_are_and_are_given_up_last_but_one() -> None:
    graph = graph_of(300, [0, 150, 300], {(9, 200): 50.0})
    takes = [words(("small", 3.0, 3.4)), words(("huge", 2.0, 2.4))]
    anything = HeardStates(np.ones(300, np.uint8), np.zeros(300, bool))

    def found(new: SpokenTake, hard: bool) -> tuple[bool, tuple[str, ...]]:
        places = find_word_places([parse_word_wish("big=huge")], graph.states, takes, new, 0.0, 2.0)
        charged = join_costs([measure_word_cost(places, 60, 2.0, 1.0)])
        soft = SoftConstraints(charged, places, hard)
        made = answer_speech(graph, anything, [], 2.0, Constraints(rules=FREE), soft=soft)
        (shown,) = find_words_shown(places, graph.states, made.path.states)
        return shown.met, made.given_up

    once = words(("big", 0.6, 1.0))
    # The takes go on to the word by themselves: one second before the word is one before it there.
    assert found(once, False) == found(once, True) == (True, ())
    small = graph_of(300, [0, 150, 300], {})
    late = words(("big", 1.2, 1.6))
    places = find_word_places([parse_word_wish("big=small")], small.states, takes, late, 0.0, 4.0)
    soft = SoftConstraints(None, places, True)
    made = answer_speech(small, anything, [], 4.0, Constraints(use=(), rules=FREE), soft=soft)
    (given_up,) = made.given_up
    assert "words" in given_up and given_up in made.words(), "no take goes on so long after the word"
