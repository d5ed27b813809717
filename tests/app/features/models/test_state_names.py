"""Models' states are named as the domain names them, and in German."""

from __future__ import annotations

from itertools import product

import pytest

from app import translation
from app.features.models.state_names import name_state, name_state_in_sentence
from metagraph.graph.words import KINDS, LAYERS, LIMBS
from metagraph.playback.learning.learn import describe_state
from tests.app.catalogue_texts import catalogue_texts


def test_english_names_are_the_domains() -> None:
    for limb, kind, tags, layer in product(LIMBS, KINDS, ("", "positive", "negative big"), LAYERS):
        assert name_state((limb, kind, tags), layer) == describe_state((limb, kind, tags), layer)


def test_a_sentence_has_tags_before_and_both_arms_behind() -> None:
    assert name_state_in_sentence(("left", "gesture", "positive"), "arms") == "a positive left gesture"
    assert name_state_in_sentence(("both", "fidget", ""), "arms") == "a fidget of both arms"
    assert name_state_in_sentence(("both", "fidget", ""), "head") == "a fidget"


def test_no_state_is_left_in_english(request: pytest.FixtureRequest) -> None:
    words = catalogue_texts("de")
    assert {f"{limb} {kind}" for limb, kind in product(LIMBS, KINDS)} | {*KINDS, *LIMBS} <= words.keys()
    request.addfinalizer(lambda: translation.choose("en"))
    translation.choose("de")
    assert name_state_in_sentence(("left", "gesture", "positive"), "arms") == "„Geste links, positiv“"
    assert name_state(("both", "fidget", "negative"), "head") == "Fidget, negativ"
