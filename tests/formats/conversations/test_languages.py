"""What each of two is read in, and what is reported about it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.formats.conversations.languages import Speaking, choose_languages
from metagraph.formats.conversations.words import TranscribedSide
from metagraph.graph.conversation.model import Segment, Word
from tests.speech.dialogues import OTHERS, TALKS, written


def told(text: str) -> TranscribedSide:
    return TranscribedSide(
        words=tuple(Word(text=w, start=n, end=n + 0.5) for n, w in enumerate(text.split()))
    )


def side(code: str, n: int = 0) -> TranscribedSide:
    return TranscribedSide(words=tuple(written({**TALKS, **OTHERS}[code]).words[n]))


def read(
    a: TranscribedSide, b: TranscribedSide, speaking: Speaking | None = None
) -> tuple[list[str | None], list[str]]:
    notes: list[str] = []
    found = choose_languages(notes, ["Ann", "Ben"], [a, b], speaking or Speaking())
    return [one.code if one is not None else None for one in found], notes


def test_nobody_says_a_word_and_nothing_is_told() -> None:
    assert read(TranscribedSide(), TranscribedSide()) == (["en", "en"], [])
    assert read(TranscribedSide(), TranscribedSide(), Speaking(otherwise="fr")) == (["fr", "fr"], [])


def test_english_is_read_without_a_word_about_it() -> None:
    assert read(side("en"), side("en", 1)) == (["en", "en"], [])


def test_one_language_of_both_is_told_once() -> None:
    codes, notes = read(side("de"), side("de", 1))
    assert codes == ["de", "de"] and len(notes) == 1 and "Both speak German (de)" in notes[0]
    assert "lips" in notes[0] and "Choose another" in notes[0]


def test_each_may_speak_another_language() -> None:
    codes, notes = read(side("de"), side("en", 1))
    assert codes == ["de", "en"] and len(notes) == 1 and notes[0].startswith("Ann: its words are German")
    codes, notes = read(side("ja"), side("hi"))
    assert codes == ["ja", "hi"] and len(notes) == 2


def test_too_few_words_are_undecided_and_read_as_the_others_are() -> None:
    codes, notes = read(side("fr"), told("ok mh"))
    assert codes == ["fr", "fr"]
    assert "only 2 words" in notes[1] and "undecided" in notes[1] and "like the other" in notes[1]
    assert read(side("fr"), TranscribedSide())[0] == ["fr", "fr"]  # the lists are one


def test_too_few_words_of_both_are_read_as_the_project_is_set_to() -> None:
    codes, notes = read(told("ok"), told("mhm oh"), Speaking(otherwise="it"))
    assert codes == ["it", "it"] and all("project" in n for n in notes)
    codes, notes = read(told("ok"), told("mhm oh"))
    assert codes == ["en", "en"] and "1 word;" in notes[0] and "undecided" in notes[0]
    assert read(told("ok"), told("oh"), Speaking(otherwise="xx"))[0] == ["en", "en"]  # a pack not at hand


def test_what_nobody_knows_is_told_and_left_to_sound() -> None:
    codes, notes = read(side("Swedish"), side("en", 1))
    assert codes == [None, "en"] and "for en, de" in notes[0]
    codes, notes = read(side("Korean"), told("네"))
    assert codes == [None, None] and "unknown" in notes[1]


def test_a_choice_is_kept_and_doubted_aloud() -> None:
    codes, notes = read(side("de"), side("de", 1), Speaking("fr"))
    assert codes == ["fr", "fr"] and len(notes) == 2 and "look German (de)" in notes[0]
    assert read(side("de"), told("ok"), Speaking("de")) == (["de", "de"], [])
    assert read(side("Swedish"), told("ok"), Speaking("de")) == (["de", "de"], [])


def test_a_language_there_are_no_words_of_cannot_be_chosen() -> None:
    with pytest.raises(ValueError, match=r"'sv'.*en, de.*your own"):
        Speaking("sv")


def test_segments_that_a_file_holds_need_no_language() -> None:
    kept = (Segment("clause", 0.0, 1.0, None, "hej"),)
    codes, notes = read(replace(side("Swedish"), segments=kept), replace(told("ok"), segments=()))
    assert codes[0] is None and notes == []
