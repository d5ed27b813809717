"""Gestures from a text's words alone: which, when, and that they are performed."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import Say, make_request
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import answer_asks, hear_asks
from metagraph.speech.text_gestures import (
    TextStream,
    find_gesture_words,
    list_lexicon_languages,
    load_gesture_words,
    make_gesture_requests,
    propose_gestures,
    read_gesture_words,
    timed_words,
)
from metagraph.speech.word_gestures import APART, GestureRule, GestureWords, ProposedGesture

TEXTS = (
    "Hello! How are you? It is really great to see you here.",
    "I think this is a big idea, but maybe we should wait a little. First, we talk to everyone. Second, we "
    "look at the details. And then, perhaps, we decide.",
    "No, I don't know. It is not my problem, honestly, and it never was.",
    "The weather in the north was mild that year, and people went out to the lakes, because there was "
    "nothing else to do in the evenings.",
)


def tags_of(project: Project) -> dict[Layer, set[str]]:
    return {
        layer: {tag for action in graph.actions.values() if action.kind == "gesture" for tag in action.tags}
        for layer, graph in project.graphs.items()
    }


EVERY: dict[Layer, set[str]] = {
    "arms": {tag for rule in load_gesture_words().rules for tag in rule.tags} | {"beat", "question"},
    "head": {"positive"},
}


def found(
    text: str, tags: dict[Layer, set[str]] = EVERY, lexicon: GestureWords | None = None
) -> list[tuple[str, str]]:
    return [
        (one.do if one.do != "gesture" else one.tags[0], one.word)
        for one in propose_gestures(timed_words(text), tags, lexicon)
    ]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("Hello everybody.", ("greeting", "Hello")),
        ("That is not what happened yesterday.", ("negative", "not")),
        ("That is not what happened yesterday.", ("shake", "not")),
        ("Yes, that will do.", ("nod", "Yes")),
        ("It was a HUGE success.", ("big", "HUGE")),
        ("The plan is good, but nobody follows it.", ("negative", "nobody")),
        ("We could go; on the other hand it rains.", ("contrast", "hand")),
        ("I don’t know what they want.", ("unsure", "know")),
        ("What is the capital of this country?", ("question", "country")),
        ("They painted houses, boats and bridges!", ("emphasis", "bridges")),
    ],
)
def test_words_propose_what_goes_with_them(text: str, wanted: tuple[str, str]) -> None:
    assert wanted in found(text)


def test_a_phrase_wins_over_its_words_and_ends_at_a_pause() -> None:
    assert found("Hold on a moment") == [("stop", "on")]
    assert ("stop", "on") not in found("Hold, on the table")


def test_a_character_without_a_tag_does_the_next_best_or_nothing() -> None:
    assert found("Hello everybody.", {"arms": {"open"}, "head": set()}) == [("open", "Hello")]
    assert found("Hello everybody.", {"arms": set(), "head": set()}) == []
    assert found("No.", {"arms": set(), "head": {"positive"}}) == [("shake", "No")]


def test_times_are_those_that_are_told_else_as_long_as_lips_take() -> None:
    told = [("Well", 0.1, 0.4), ("hello", 2.0, 2.6)]
    (one,) = propose_gestures(timed_words("Well, hello there", told), EVERY)
    assert one.word == "hello" and one.at == pytest.approx(2.1)
    guessed = timed_words("Well, hello there")
    assert [w.text for w in guessed] == ["Well", "hello", "there"] and guessed[0].mark == ","
    slow = timed_words("Well, hello there", seconds=10.0)
    assert slow[-1].end == pytest.approx(10.0, abs=0.5) and slow[1].start > 2 * guessed[1].start
    assert all(a.end <= b.start < b.end for a, b in pairwise(guessed))


@given(st.text(max_size=120), st.integers(0, 9))
def test_whatever_the_text_none_is_in_anothers_way_and_nothing_depends_on_when_it_is_asked(
    text: str, seed: int
) -> None:
    words = timed_words(text)
    made = propose_gestures(words, EVERY, seed=seed)
    assert made == propose_gestures(words, EVERY, seed=seed)
    for layer in LAYERS:
        times = [one.at for one in made if one.layer == layer]
        assert all(b - a >= APART[layer] for a, b in pairwise(times))
    for request in make_gesture_requests(made, 1.0, "x"):
        make_request(json.loads(json.dumps(request)))


def _letters(text: str) -> str:
    return "".join(letter for letter in text if letter.isalnum())


@given(st.lists(st.sampled_from(["Hello", " you", ". ", "3.", "5 ", "\n", "!", "? ", " no"]), max_size=12))
def test_a_text_that_comes_in_pieces_is_said_as_a_whole_in_order(pieces: list[str]) -> None:
    stream = TextStream(EVERY)
    requests = [x for n, piece in enumerate(pieces) for x in stream.take(piece, n / 10)]
    requests += stream.take("", len(pieces) / 10, over=True)
    said = [x for x in requests if x["do"] == "say"]
    assert _letters("".join(x["text"] for x in said)) == _letters("".join(pieces))
    assert [x["at"] for x in said] == sorted(x["at"] for x in said)
    assert len({x["id"] for x in requests}) == len(requests)


def test_numbers_with_a_point_do_not_end_a_sentence() -> None:
    stream = TextStream(EVERY)
    assert stream.take("It weighs 3.", 0.0) == []
    assert [x["text"] for x in stream.take("5 tons. Really", 0.1) if x["do"] == "say"] == [
        "It weighs 3.5 tons."
    ]


def test_most_of_what_words_propose_is_performed_on_its_word(sample: Project) -> None:
    """Of what four texts propose for the sample's character, in its plan, as it would be live."""
    wanted = played = 0
    for number, text in enumerate(TEXTS):
        stream = TextStream(tags_of(sample), seed=number)
        asks = [make_request(x) for x in stream.take(text, 0.0, over=True)]
        plan = hear_asks(sample, Plan(number, 0.0), 0.0, asks, stream.free + 4, idle=False)
        gestures = [ask.id for ask in asks if not isinstance(ask, Say)]
        became = answer_asks(plan, gestures)
        wanted += len(gestures)
        played += sum(became[ident].state in ("planned", "late") for ident in gestures)
    assert wanted >= 14 and played >= 0.85 * wanted, (played, wanted)


def test_a_lexicon_of_ones_own_is_read_and_a_broken_one_is_told(tmp_path: Path) -> None:
    own = tmp_path / "own.json"
    own.write_text(json.dumps({"rules": [{"words": ["ahoy"], "tags": ["greeting"], "strength": 2}]}))
    lexicon = read_gesture_words(own)
    assert lexicon.rules == (GestureRule(("ahoy",), ("greeting",), "", 2.0),)
    assert found("Ahoy sailors", lexicon=lexicon) == [("greeting", "Ahoy")]
    for broken in ("{", "[]", '{"rules": [{"wrods": []}]}', '{"rules": [{"head": "bow"}]}'):
        own.write_text(broken)
        with pytest.raises(FileError, match="no lexicon of gestures"):
            read_gesture_words(own)
    with pytest.raises(FileError):
        read_gesture_words(tmp_path / "none.json")


def test_every_words_phrase_of_the_lexicon_is_as_words_are_read() -> None:
    for rule in load_gesture_words().rules:
        assert rule.tags and rule.strength > 0
        for phrase in rule.words:
            assert [w.plain for w in timed_words(phrase)] == phrase.split(), phrase
    assert isinstance(propose_gestures(timed_words("hello"), EVERY)[0], ProposedGesture)


SPOKEN = {
    "de": (
        "Hallo! Das ist wirklich eine tolle Idee, aber ich weiß nicht, ob wir genug Zeit haben. Vielleicht "
        "sollten wir zuerst mit allen reden, weil es so wichtig ist.",
        {"greeting", "unsure"},
    ),
    "fr": (
        "Bonjour! C'est une idée géniale, mais je ne sais pas si nous avons le temps. Peut-être qu'il faut "
        "d'abord parler avec tout le monde, parce que c'est important.",
        {"greeting", "unsure"},
    ),
    "es": (
        "¡Hola! Es una idea maravillosa, pero no sé si tenemos tiempo. Quizás hay que hablar primero con "
        "todo el mundo, porque es muy importante para nosotros.",
        {"greeting", "unsure"},
    ),
}


@pytest.mark.parametrize("language", SPOKEN)
def test_other_languages_have_lexicons_of_their_own_found_by_the_words(language: str) -> None:
    text, least = SPOKEN[language]
    lexicon = find_gesture_words(text)
    assert lexicon.language == language
    assert least <= {what for what, _ in found(text, lexicon=lexicon)}


def test_every_lexicon_says_the_same_things_in_its_language() -> None:
    english = [rule.tags for rule in load_gesture_words("en").rules]
    for language in list_lexicon_languages():
        lexicon = load_gesture_words(language)
        assert lexicon.language == language
        assert [rule.tags for rule in lexicon.rules] == english
        every = [phrase for rule in lexicon.rules for phrase in rule.words]
        assert len(every) == len(set(every)), "a phrase proposes one thing"
        for phrase in every:  # each is found as it is written
            assert " ".join(w.plain for w in timed_words(phrase)) == phrase


def test_a_language_without_a_lexicon_and_none_that_is_told_have_the_english_one() -> None:
    assert load_gesture_words("xx") == find_gesture_words("") == load_gesture_words("en")


def test_a_stream_goes_on_in_the_language_it_has_been_in() -> None:
    stream = TextStream(EVERY, seed=3)
    text, _ = SPOKEN["de"]
    stream.take(text, 0.0)
    out = stream.take("Nein, das geht so nicht.\n", 5.0)
    assert any(request["do"] == "shake" for request in out)


def test_after_an_interruption_the_rest_is_forgotten_and_what_follows_is_said_at_once() -> None:
    stream = TextStream({"arms": set(), "head": set()})
    first = stream.take("It rains all day, so take a coat with you. And then", now=1.0)
    assert first[0]["at"] == pytest.approx(1.35) and stream.free > 2.0
    assert stream.interrupt() == {"do": "interrupt"}
    (again,) = stream.take("Yes?", now=2.0, over=True)
    assert (again["text"], again["at"]) == ("Yes?", pytest.approx(2.35)), "nothing of 'And then'"
