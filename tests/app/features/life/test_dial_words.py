"""What the panel shows of dials is given by the domain in English, and marked here for translation."""

from __future__ import annotations

import pytest

from app import translation
from app.features.life.dial_words import put_in_sentence
from metagraph.graph.life import DIALS, MANNER_DIALS
from tests.app.catalogue_texts import catalogue_texts


def test_every_dial_can_be_said_in_german() -> None:
    words = catalogue_texts("de")
    for dial in (*DIALS[1:], *MANNER_DIALS):
        assert {dial.group, dial.label, dial.tip} <= words.keys(), dial.name
    assert {DIALS[0].label, DIALS[0].tip} <= words.keys()


def test_a_label_is_small_in_an_english_sentence_alone(request: pytest.FixtureRequest) -> None:
    assert put_in_sentence(DIALS[0]) == "stillness"
    request.addfinalizer(lambda: translation.choose("en"))
    translation.choose("de")
    assert put_in_sentence(DIALS[0]) == "Ruhe"
