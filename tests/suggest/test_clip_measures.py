"""What is reported about a clip beside the others of its set: the tremble of a recording is not a clip's."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from metagraph.suggest.clip_measures import SEVERAL, TREMBLE, compute_resting_logit, guess_layer, with_tremble
from metagraph.suggest.traits import Traits
from tests.suggest.test_traits import of

STILL = dict.fromkeys(("hips", "legs", "left_arm", "right_arm", "head", "trunk", "fingers"), 0.0)


def moving(toy: Any, **energy: float) -> Traits:
    return replace(of(toy.clip("right_point")), energy=STILL | energy)


def trembling(toy: Any, count: int = SEVERAL, legs: float = 0.018, **energy: float) -> dict[str, Traits]:
    """Calm clips that only tremble, and one, `x`, that does something as well."""
    calm = {f"c{n}": moving(toy, legs=legs, left_arm=0.002) for n in range(count - 1)}
    return calm | {"x": moving(toy, legs=legs, **energy)}


def test_arms_that_move_on_trembling_legs_are_arms(toy: Any) -> None:
    clips = trembling(toy, right_arm=0.06)
    assert guess_layer(clips["x"]).value == "body", "alone it cannot be told"
    assert guess_layer(with_tremble(clips)["x"]).value == "arms"


def test_legs_that_move_beyond_the_tremble_are_the_body(toy: Any) -> None:
    clips = trembling(toy) | {"x": moving(toy, legs=0.2, right_arm=0.06)}
    assert guess_layer(with_tremble(clips)["x"]).value == "body"


def test_of_few_clips_nothing_is_known_of_the_recording(toy: Any) -> None:
    clips = trembling(toy, SEVERAL - 1, right_arm=0.06)
    assert with_tremble(clips) == clips
    assert with_tremble({}) == {}


def test_where_the_calmest_clips_move_that_is_no_tremble(toy: Any) -> None:
    clips = trembling(toy, legs=2 * TREMBLE, right_arm=0.06)
    assert with_tremble(clips)["x"].tremble["legs"] == 0
    assert guess_layer(with_tremble(clips)["x"]).value == "body"


def test_a_clip_that_only_trembles_is_told_by_all_it_has(toy: Any) -> None:
    clips = trembling(toy, 4 * SEVERAL)
    assert guess_layer(with_tremble(clips)["c0"]).value == guess_layer(clips["c0"]).value == "body"


@pytest.mark.parametrize(
    ("measures", "less"),
    [
        ({"sway": 0.032, "shrug": 0.0054}, 0.0),  # of the idles of several studios, at most
        ({"sway": 0.124}, 2.9),  # weight that is shifted in six seconds
        ({"shrug": 0.0276}, 3.0),  # shoulders that are stretched
    ],
)
def test_an_idle_in_which_weight_is_shifted_or_shoulders_rise_is_no_rest(
    toy: Any, measures: dict[str, float], less: float
) -> None:
    calm = replace(of(toy.clip("calm", 6.0, swing=0.02)), sway=0.0, shrug=0.0)
    assert compute_resting_logit(calm) - compute_resting_logit(replace(calm, **measures)) == pytest.approx(
        less, abs=0.1
    )


def test_a_look_round_is_no_rest(toy: Any) -> None:
    calm = of(toy.clip("calm", 6.0, swing=0.02))
    far = replace(calm.layers["head"], extent=0.13)
    assert (
        compute_resting_logit(replace(calm, layers={**calm.layers, "head": far}))
        < compute_resting_logit(calm) - 1.0
    )
