"""Which language words are in: told, undecided, or of none that is known."""

from __future__ import annotations

import unicodedata

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.speech.language_detection import SpokenLanguage, detect_language
from metagraph.speech.language_packs import list_language_packs
from tests.speech.dialogues import MIXED, OTHERS, TALKS, written

PACKS = tuple(list_language_packs().values())


def detected(text: str) -> SpokenLanguage:
    return detect_language(text.split(), PACKS)


def code(found: SpokenLanguage) -> str:
    return found.language.code if found.language is not None else found.how


@pytest.mark.parametrize("text", ["", "...", "12 34 5", "[laughter]", "%", "--", "♪"])
def test_nothing_said_is_undecided(text: str) -> None:
    assert code(detected(text)) == "undecided"
    assert code(detect_language(["the"], ())) == "undecided"


@pytest.mark.parametrize(
    "text",
    [
        "ja",
        "ok ok ok",
        "mhm oh ah mm",  # of many languages
        "ja okay",  # German or Dutch
        "no no no no",
        "Anna Berlin Schmidt",
        "The quick brown fox 001 " * 50,  # few words, often
        "a b c d e f g h i j",
    ],
)
def test_too_few_words_are_undecided(text: str) -> None:
    assert code(detected(text)) == "undecided"


@pytest.mark.parametrize("language", TALKS)
@pytest.mark.parametrize("form", ["NFC", "NFD"])
def test_a_conversation_tells_its_language(language: str, form: str) -> None:
    for words in written(TALKS[language], form).words:
        assert code(detect_language([w.text for w in words], PACKS)) == language


@pytest.mark.parametrize("language", ["ja", "zh"])
def test_it_does_not_matter_how_writing_without_blanks_is_parted(language: str) -> None:
    for words in written(TALKS[language], letters=True).words:
        assert code(detect_language([w.text for w in words], PACKS)) == language
        assert code(detect_language(["".join(w.text for w in words)], PACKS)) == language


@pytest.mark.parametrize("language", ["fr", "es", "pt", "it"])
def test_accents_may_be_left_out(language: str) -> None:
    apart = unicodedata.normalize("NFD", TALKS[language])
    bare = "".join(c for c in apart if not unicodedata.combining(c))
    assert code(detect_language([w.text for w in written(bare).words[0]], PACKS)) == language


@pytest.mark.parametrize("name", MIXED)
def test_words_of_another_language_are_borne(name: str) -> None:
    language, text = MIXED[name]
    assert code(detect_language([w.text for w in written(text).words[0]], PACKS)) == language


@pytest.mark.parametrize("name", OTHERS)
def test_a_language_without_a_pack_is_unknown(name: str) -> None:
    assert code(detect_language([w.text for w in written(OTHERS[name]).words[0]], PACKS)) == "unknown"


@pytest.mark.parametrize(
    "text",
    [
        "i går tog jeg med min mor på markedet og der var så mange mennesker fordi der var fest i landsbyen",
        "igar akte jag med min mamma till marknaden och det var sa mycket folk eftersom det var fest i byn",
        "ahir vam anar al mercat amb la meva mare i hi havia molta gent perquè era la festa del poble",
        "ieri am fost la piață cu mama și era multă lume pentru că era sărbătoare în sat așa că nu am găsit",
        "dün annemle birlikte pazara gittik ve köyde bayram olduğu için çok kalabalıktı o yüzden arabayı",
        "вчера мы с мамой ходили на рынок и там было очень много народу потому что в деревне был праздник",
        "काल मी आईसोबत बाजारात गेलो होतो आणि तिथे खूप गर्दी होती कारण गावाची जत्रा होती त्यामुळे आम्हाला गाडी",
        "琴日我同媽咪去街市，因為係條村嘅節日，所以好多人，我哋搵咗好耐都搵唔到位泊車，最後唯有返屋企",
    ],
)
def test_a_neighbour_of_a_known_language_is_not_taken_for_it(text: str) -> None:
    assert code(detected(text)) == "unknown"


@pytest.mark.parametrize(
    "text", ["да конечно правда", "네 그래요 맞아요", "ναι βέβαια έτσι είναι", "نعم صحيح طبعا"]
)
def test_a_writing_that_no_pack_has_is_known_by_a_few_words(text: str) -> None:
    assert code(detected(text)) == "unknown"


def test_half_in_another_writing_is_not_unknown() -> None:
    text = (
        "how do you read this このリンゴおいしいね what does it mean it means this apple is good 新しい語彙"
    )
    assert code(detected(text)) in ("en", "ja", "undecided")


def test_names_do_not_tell() -> None:
    assert code(detected("and then I told Um Er Hans Müller that Jürgen was not at the office")) == "en"


@settings(max_examples=100, deadline=None)
@given(st.lists(st.text(max_size=8), max_size=40))
def test_any_words_have_an_answer(words: list[str]) -> None:
    found = detect_language(words, PACKS)
    assert (found.language is not None) == (found.how == "sure")
    assert found.known >= 0 and found.words >= 0
