"""Words that know their template: English for everybody who does not ask, another language for who does."""

from __future__ import annotations

import copy
import json
import pickle

import pytest

from metagraph.common.wording import Phrase, change_quoted, phrase, plural_phrase, translate_phrase
from metagraph.errors import FileError

GERMAN = {
    "{who} has {count:d} legs": "{who} hat {count:d} Beine",
    "a cow": "eine Kuh",
    "{count} cows": "{count} Kühe",
}


def german(words: Phrase) -> str:
    template = words.plural if words.plural and words.values["count"] != 1 else words.template
    return GERMAN.get(template, template)


def test_words_are_english_text_wherever_they_go() -> None:
    words = phrase("{who} has {count:d} legs", who="Ann", count=2)
    assert words == "Ann has 2 legs" and {words: 1}["Ann has 2 legs"] == 1
    assert f"{words}." == "Ann has 2 legs." and json.dumps([words]) == '["Ann has 2 legs"]'
    assert type(str(words)) is str


def test_a_count_chooses_between_one_and_many() -> None:
    one, two = (plural_phrase("one cow", "{count} cows", count) for count in (1, 2))
    assert (one, two) == ("one cow", "2 cows")
    assert translate_phrase(two, german) == translate_phrase(copy.copy(two), german) == "2 Kühe"
    assert translate_phrase(pickle.loads(pickle.dumps(one)), german) == "one cow"


def test_words_are_said_again_in_another_language_and_so_are_those_within() -> None:
    words = phrase("{who} has {count:d} legs", who=phrase("a cow"), count=4)
    assert translate_phrase(words, german) == "eine Kuh hat 4 Beine"
    assert translate_phrase("a cow", german) == "a cow", "they do not know their template"
    assert translate_phrase(phrase("no such thing"), german) == "no such thing"


def test_braces_without_values_are_braces_and_a_value_that_lacks_is_an_error() -> None:
    assert phrase("{} and {x}") == "{} and {x}"
    with pytest.raises(KeyError):
        phrase("{a} {b}", a=1)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
def test_words_are_copied_and_sent_to_other_processes_as_they_are(again) -> None:
    words = again(phrase("{who} has {count:d} legs", who=phrase("a cow"), count=4))
    assert isinstance(words, Phrase) and translate_phrase(words, german) == "eine Kuh hat 4 Beine"


def test_a_file_error_of_another_process_keeps_its_words() -> None:
    error = pickle.loads(pickle.dumps(FileError("a.bvh", phrase("a cow"), "line 3")))
    assert (
        str(error) == "a.bvh, line 3: a cow."
        and translate_phrase(error.args[0], german) == "a.bvh, line 3: eine Kuh."
    )


def test_what_a_file_says_is_still_made_fit_for_a_message() -> None:
    error = FileError("a.bvh", phrase("field '{field}' is odd", field="x\ny"))
    assert str(error) == "a.bvh: field 'x\ufffdy' is odd."


def test_what_stands_in_quotes_is_changed_and_nothing_else() -> None:
    inner = phrase("name says '{words}' to {words}", words="arms cross")
    whole = phrase('{inner}; begins at "{stance}"', inner=inner, stance="arms cross")
    changed = change_quoted(whole, str.title)
    assert changed == "name says 'Arms Cross' to Arms Cross; begins at \"arms cross\""
    assert isinstance(changed, Phrase) and changed.template == whole.template
    assert (
        change_quoted(whole, str.title, '"')
        == "name says 'arms cross' to arms cross; begins at \"Arms Cross\""
    )
    assert change_quoted("words that 'know' nothing", str.upper) == "words that 'know' nothing"
    assert change_quoted(phrase("{count} '{count}'", count=3), str) == "3 '3'"
