"""How often studies find what is planted, by simulation."""

from __future__ import annotations

import json

import pytest

from app.cli.parser import main
from metagraph.research.study.plan.simulated_power import simulate_study_power
from metagraph.research.study.simulation.people import Truth
from tests.thorough import many


def test_more_people_find_more_and_intervals_hold_the_truth() -> None:
    few, more = simulate_study_power(Truth(ratio=1.4, spread=0.4), (6, 24), many(60, 400))
    assert few.found.value < more.found.value and few.factor > more.factor > 1
    assert more.found.value > 0.8 and more.held.value > 0.85 and more.false.value < 0.15


def test_without_a_ratio_what_is_found_is_false() -> None:
    (one,) = simulate_study_power(Truth(ratio=1.0, spread=0.4), (8,), 40)
    assert one.false.value < 0.2 and one.held.value == 1 - one.false.value
    with pytest.raises(ValueError, match="4 people"):
        next(simulate_study_power(Truth(), (3,), 1))


def test_the_command_prints_a_table(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["study", "plan", "--ratio", "2", "--spread", "0.3", "--studies", "10", "--people", "8", "12"]
    assert main(words) == 0
    assert "| 12 | " in capsys.readouterr().out
    assert main([*words, "--json"]) == 0
    assert [row["people"] for row in json.loads(capsys.readouterr().out)["simulated"]] == [8, 12]
