"""Words compared whatever their writing: forms of Unicode, marks, accents, apostrophes, blanks."""

from __future__ import annotations

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.vocabulary import Vocabulary, join_tokens, make_word_vocabularies, split_tokens


def made_of(phrases: list[str], text: str) -> bool:
    return Vocabulary(phrases).made_of([split_tokens(w) for w in text.split()])


@pytest.mark.parametrize("text", ["", " ", "...", "--", "%", "'", "♪", "\u200d", "\u0301", "、。"])
def test_what_has_no_letters_is_no_phrase(text: str) -> None:
    assert not made_of(["ja"], text) and not Vocabulary([text]).made_of([split_tokens("ja")])
    assert Vocabulary(["ja"]).at([split_tokens(text)], 0) == 0


def test_vowel_signs_belong_to_their_letters() -> None:
    assert split_tokens("अच्छा, ठीक है।") == ("अच्छा", "ठीक", "है")
    assert split_tokens("हाँ") != split_tokens("ह") and split_tokens("की") != split_tokens("के")
    assert split_tokens("क्‍या") == split_tokens("क्या")  # a joiner changes what it looks like, not what it is


def test_forms_of_one_letter_are_equal() -> None:
    for text in ("né", "sì", "äh", "हाँ", "が", "ｏｋ", "ﾊｲ"):
        forms = {split_tokens(unicodedata.normalize(f, text)) for f in ("NFC", "NFD", "NFKC", "NFKD")}
        assert len(forms) == 1, text
    assert split_tokens("Weiß") == split_tokens("WEISS") and split_tokens("D’ACCORD") == split_tokens(
        "d'accord"
    )


@pytest.mark.parametrize(
    ("phrase", "text"),
    [
        ("d'accord", "D’accord"),
        ("d'accord", "d' accord"),
        ("d'accord", "d 'accord"),
        ("そうですね", "そう です ね"),
        ("そうですね", "そ う で す ね"),
        ("そうですね", "そうですねー"),
        ("はい", "ハイ"),
        ("はい", "はいっ"),
        ("はい", "はいはい"),
        ("对", "对对对"),
        ("ja", "jaaaa"),
        ("äh", "ääääh"),
        ("えーと", "えーーーと"),
        ("uh-huh", "uh huh"),
        ("ठीक है", "ठीक है।"),
        ("sí", "si"),
        ("né", "NE"),
    ],
)
def test_a_phrase_is_found_however_it_is_written(phrase: str, text: str) -> None:
    assert made_of([phrase], text)


@pytest.mark.parametrize(
    ("phrase", "text"),
    [
        ("er", "e r"),  # letters that are spelled
        ("um", "u m"),
        ("é", "e"),  # "and"
        ("äh", "ah"),  # another letter
        ("うん", "うーん"),  # yes; let me think
        ("ja", "jahr"),
        ("ja", "ja aber"),
        ("はい", "はいから"),
        ("on", "non"),
    ],
)
def test_what_only_looks_like_a_phrase_is_none(phrase: str, text: str) -> None:
    assert not made_of([phrase], text)


def test_left_without_accents_an_answer_is_no_hesitation() -> None:
    answers, pauses, either, both = make_word_vocabularies(("hã-hã", "tá", "eh"), ("ta", "éh"))
    assert not answers.made_of([("ta",)]) and pauses.made_of([("ta",)]) and either.made_of([("tá",)])
    assert not both.made_of([("ta",)]) and not pauses.made_of([("eh",)])
    assert make_word_vocabularies(("嗯", "对"), ("嗯",))[3].made_of([split_tokens("嗯嗯嗯")])


def test_words_are_joined_as_they_are_written() -> None:
    assert join_tokens(["そう", "です", "ね。", "はい"]) == "そうですね。はい"
    assert join_tokens(["我", "用", "Python", "写"]) == "我用 Python 写"
    assert (
        join_tokens(["ja", "genau"]) == "ja genau" and join_tokens([]) == "" and join_tokens(["", "a"]) == "a"
    )


@given(st.text(max_size=30), st.text(max_size=30))
def test_any_text_can_be_compared(text: str, phrase: str) -> None:
    found = Vocabulary([phrase])
    said = [split_tokens(w) for w in text.split()]
    found.made_of(said)
    assert all(0 <= found.at(said, n) <= len(said) - n for n in range(len(said)))
    assert split_tokens(" ".join(split_tokens(text))) == split_tokens(text)


@given(st.text(min_size=1, max_size=20))
def test_a_phrase_is_always_found_in_itself(phrase: str) -> None:
    if split_tokens(phrase):
        assert Vocabulary([phrase]).made_of([split_tokens(phrase)])
