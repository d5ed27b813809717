"""Language packs: what comes with the program is whole and says what it rests on; words are found however
they are written; what is wrong with a pack is said.
"""

from __future__ import annotations

import json
import unicodedata

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.conversation.model import HESITATIONS, RESPONSES, Word
from metagraph.graph.vocabulary import make_word_vocabularies, split_tokens
from metagraph.speech.clauses import find_segments
from metagraph.speech.language_packs import (
    FOLDER,
    LanguagePack,
    PackError,
    PackFile,
    list_language_packs,
    list_pack_words,
    make_language,
    read_english_pack,
)
from metagraph.speech.pitch import Pitch
from metagraph.speech.sound import analyse_sound

PACKS = list(list_language_packs().values())
HEARD = analyse_sound(0.001 * np.random.default_rng(0).standard_normal(16000 * 6), 16000)
VOICELESS = Pitch(HEARD.times, np.full(len(HEARD.times), np.nan))


def pack(**fields: object) -> LanguagePack:
    data = {"code": "xx", "name": "Test", "responses": "jup", **fields}
    return make_language(msgspec.convert(data, PackFile), list_language_packs())


@pytest.mark.parametrize(
    ("fields", "where", "words"),
    [
        ({"responses": ()}, "responses", "has no words"),
        ({"responses": "ja, ..."}, "responses", "no letters"),
        ({"small": "in the"}, "small", "more than one word"),
        ({"hesitations": "x" * 201}, "hesitations", "longer"),
        ({"lexical": [f"w{n}" for n in range(5001)]}, "lexical", "5,001"),
        ({"borrows": ["tlh"]}, "borrows", "'tlh'"),
    ],
)
def test_what_a_pack_cannot_say_is_said_with_its_field(
    fields: dict[str, object], where: str, words: str
) -> None:
    with pytest.raises(PackError, match=words) as told:
        pack(**fields)
    assert told.value.where == where


@pytest.mark.parametrize("code", ["", "DE", "d", "deutsch land", "de_CH", "../en"])
def test_a_code_is_one_of_a_language(code: str) -> None:
    with pytest.raises(msgspec.ValidationError):
        pack(code=code)
    assert pack(code="pt-br").code == "pt-br"


def test_lists_are_texts_with_commas_or_lists_of_them() -> None:
    assert (
        list_pack_words("ja,  genau ,,ja") == list_pack_words(["ja", "genau, ja"]) == ("ja", "genau")
        and list_pack_words(()) == ()
    )
    assert list_pack_words("はい、うん") == ("はい", "うん")
    assert pack(responses=["jup, joop", "yo"]).responses == ("jup", "joop", "yo")


def test_the_packs_are_ten_and_say_what_they_rest_on() -> None:
    assert list(list_language_packs()) == ["en", "de", "es", "fr", "hi", "it", "ja", "nl", "pt", "zh"]
    for path in FOLDER.glob("*.json"):
        data = json.loads(path.read_text(encoding="utf-8"))
        assert data["code"] == path.stem
    for one in PACKS:
        assert one.rests_on and one.sure and one.own
        assert len(one.responses) >= 25 and len(one.hesitations) >= 15 and len(one.small) >= 100


def test_english_is_what_projects_mean_that_say_nothing() -> None:
    assert (read_english_pack().responses, read_english_pack().hesitations) == (RESPONSES, HESITATIONS)
    assert not read_english_pack().elided and not read_english_pack().closing


def test_no_answer_or_sound_of_hesitation_is_a_small_word() -> None:
    """A hesitation that is a small word, German "er", would part every sentence it is in."""
    for one in PACKS:
        for phrase in one.hesitations:
            if len(said := split_tokens(phrase)) == 1 and said[0] in one.small:
                assert one.lexical.is_plainly(said), (one.code, phrase)


def test_words_that_lose_their_vowel_are_words() -> None:
    fr, en = list_language_packs()["fr"], read_english_pack()
    assert fr.parted(("l'eau",)) == ("l", "eau") and fr.parted(("qu'l'eau",)) == ("qu", "l", "eau")
    assert fr.parted(("aujourd'hui",)) == ("aujourd'hui",) and en.parted(("i'm",)) == ("i'm",)


def test_words_of_a_writing_without_blanks_count_by_their_letters() -> None:
    ja, en = list_language_packs()["ja"], read_english_pack()
    assert ja.is_small("ですけど") and not ja.is_small("学校") and ja.is_small("は")
    assert ja.size(("学校",)) == pytest.approx(2 / 2.2) and ja.size(("ok",)) == 1 and ja.size(()) == 1
    assert en.size(("anything",)) == 1


WORDS = [(one.code, kind, phrase) for one in PACKS for kind in ("response", "hesitation") for phrase in (
    one.responses if kind == "response" else one.hesitations)]  # fmt: skip


@pytest.mark.nightly
@settings(max_examples=400, deadline=None)
@given(
    st.sampled_from(WORDS),
    st.sampled_from(["NFC", "NFD", "NFKC", "NFKD"]),
    st.sampled_from([str, str.upper, str.title, str.capitalize]),
    st.sampled_from(["", ".", "!", "…", "...", "。", "।"]),
)
def test_a_packs_words_are_always_found(
    word: tuple[str, str, str], form: str, case: object, end: str
) -> None:
    one, (_, kind, phrase) = list_language_packs()[word[0]], word
    text = unicodedata.normalize(form, case(phrase)) + end  # type: ignore[operator]
    parts = text.split()
    said = [
        Word(text=p, start=2 + 0.3 * n, end=2.3 + 0.3 * n) for n, p in enumerate(parts)
    ]  # alone between pauses
    found = find_segments(said, VOICELESS, HEARD, language=one)
    answers, _, _, _ = make_word_vocabularies(one.responses, one.hesitations)
    expected = "response" if answers.made_of([split_tokens(p) for p in parts]) else "hesitation"
    assert [s.kind for s in found] == [expected], (one.code, text, found)
    assert kind == expected or answers.made_of([split_tokens(phrase)])
