"""Temperaments: one choice that sets rests, variety, mood and gaze."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph.model import Project
from metagraph.graph.temperaments import TEMPERAMENTS, find_temperament, set_temperament
from metagraph.playback.planning.markov import DEFAULTS

PLAIN = Project()


@pytest.mark.parametrize("name", TEMPERAMENTS)
def test_a_temperament_is_found_again_and_neutral_takes_all_of_it_back(name: str) -> None:
    made = set_temperament(PLAIN, name, DEFAULTS)
    assert find_temperament(made, DEFAULTS) == name
    assert set_temperament(made, "neutral", DEFAULTS) == PLAIN


def test_rests_are_scaled_and_variety_is_set() -> None:
    calm = set_temperament(PLAIN, "presenter", DEFAULTS)
    assert calm.markov["arms"].gap == pytest.approx(1.5 * DEFAULTS["arms"].gap)
    assert calm.settings.variety == 1.5 and calm.life.aversion_rate < PLAIN.life.aversion_rate


def test_a_learned_model_stays_as_it_is() -> None:
    learned = replace(DEFAULTS["arms"], gap=3.4, matrix=DEFAULTS["arms"].matrix[::-1])
    project = replace(PLAIN, markov={"arms": learned})
    for name in TEMPERAMENTS:
        assert set_temperament(project, name, DEFAULTS).markov["arms"] == learned


def test_a_name_that_is_none_is_refused() -> None:
    with pytest.raises(KeyError):
        set_temperament(PLAIN, "grumpy", DEFAULTS)
