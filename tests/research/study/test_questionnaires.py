"""Questionnaires are scored as those who made them say."""

from __future__ import annotations

import pytest

from metagraph.research.study.questionnaires import (
    SUS,
    TLX,
    TLX_PAIRS,
    TLX_SCALES,
    TLX_WEIGHTED,
    compute_sus_score,
    compute_tlx_raw,
    compute_weighted_tlx,
)


def sus(*values: int) -> dict[str, int]:
    return {f"sus{n}": v for n, v in enumerate(values, 1)}


def test_the_worst_the_middle_and_the_best_are_0_50_and_100() -> None:
    assert compute_sus_score(sus(*[1, 5] * 5)) == 0
    assert compute_sus_score(sus(*[3] * 10)) == 50
    assert compute_sus_score(sus(*[5, 1] * 5)) == 100


def test_brookes_own_example_is_22_contributions_and_55_points() -> None:
    assert compute_sus_score(sus(5, 4, 2, 1, 2, 3, 2, 4, 5, 2)) == 55


@pytest.mark.parametrize("value", [0, 6, None, "3", True])
def test_an_answer_that_is_none_is_named(value: object) -> None:
    answers = sus(*[3] * 10) | {"sus7": value}
    with pytest.raises(ValueError, match="'sus7' is"):
        compute_sus_score(answers)


def test_raw_load_is_the_mean_of_six_scales() -> None:
    assert compute_tlx_raw(dict(zip(TLX_SCALES, (60, 0, 30, 90, 60, 0), strict=True))) == 40
    with pytest.raises(ValueError, match="'effort' is not answered"):
        compute_tlx_raw(dict.fromkeys(("mental", "physical", "temporal", "performance"), 5))


def test_weighted_load_counts_how_often_a_scale_was_chosen() -> None:
    ratings = dict(zip(TLX_SCALES, (100, 0, 0, 0, 0, 50), strict=True))
    first = {f"{a}-{b}": TLX_SCALES[a][0] for a, b in TLX_PAIRS}  # weights 5, 4, 3, 2, 1, 0
    assert compute_weighted_tlx(ratings | first) == pytest.approx(500 / 15)
    last = {f"{a}-{b}": TLX_SCALES[b][0] for a, b in TLX_PAIRS}
    assert compute_weighted_tlx(ratings | last) == pytest.approx(250 / 15)
    with pytest.raises(ValueError, match="pair 'mental-physical'"):
        compute_weighted_tlx(ratings | first | {"mental-physical": "Effort"})


def test_the_instruments_are_whole() -> None:
    assert len(SUS.items) == 10 and len(TLX.items) == 6 and len(TLX_WEIGHTED.items) == 21
    assert all(item.scale and item.scale.points == (1, 2, 3, 4, 5) for item in SUS.items)
    assert all(item.scale and len(item.scale.points) == 21 for item in TLX.items)
    assert len({i.id for i in TLX_WEIGHTED.items}) == 21
