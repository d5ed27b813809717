"""How likely a proposal is wrong, and what that says of a look at it."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.suggest.estimate import Belief
from metagraph.suggest.flags import LOOK, estimate_chance_wrong, estimate_gain, explain_doubt, needs_look
from metagraph.suggest.proposal import Proposal

SURE = Proposal(
    "c",
    Belief("gesture", 0.99, "name says 'shrug'"),
    Belief("arms", 0.95, "the arms move"),
    Belief("s", 0.99, "begins 0.0 cm from it"),
    None,
    Belief("both", 0.9, "both move"),
    said=True,
)


def test_what_is_sure_throughout_needs_no_look_and_what_was_not_placed_does() -> None:
    assert not needs_look(SURE) and estimate_chance_wrong(SURE) < 0.1
    assert needs_look(SURE, {"c": "nothing says where it ends"})


@given(st.floats(0.02, 0.98), st.floats(0.02, 0.98))
def test_the_less_sure_a_kind_is_the_likelier_it_is_wrong(one: float, other: float) -> None:
    less, more = sorted((one, other))
    chances = [
        estimate_chance_wrong(replace(SURE, kind=replace(SURE.kind, confidence=x))) for x in (less, more)
    ]
    assert 0 <= chances[1] <= chances[0] <= 1


@given(st.floats(0.02, 0.98), st.floats(0.02, 0.98))
def test_the_less_sure_a_layer_is_the_likelier_it_is_wrong(one: float, other: float) -> None:
    less, more = sorted((one, other))
    chances = [
        estimate_chance_wrong(replace(SURE, layer=replace(SURE.layer, confidence=x))) for x in (less, more)
    ]
    assert 0 <= chances[1] <= chances[0] <= 1


def test_what_the_motion_says_alone_and_how_far_a_batch_disagrees_count() -> None:
    unsure = replace(SURE, kind=replace(SURE.kind, confidence=0.8), seen=0.9)
    assert estimate_chance_wrong(unsure) < estimate_chance_wrong(replace(unsure, seen=0.1))
    assert estimate_chance_wrong(unsure) < estimate_chance_wrong(replace(unsure, disputed=0.3))


def test_sources_that_disagree_are_told() -> None:
    told = replace(SURE, conflicts=("name says 'idle 2', but begins 0.1 cm from \"idle 1\"",))
    assert re.match(r"wrong with a probability of \d+ %: .* but begins 0.1 cm", explain_doubt(told))


@pytest.mark.parametrize(
    ("field", "word"),
    [
        ("kind", "its kind is 30 % certain"),
        ("layer", "its layer is 30 % certain"),
        ("stance", "its stance is 30 % certain"),
    ],
)
def test_a_doubt_names_what_is_least_sure(field: str, word: str) -> None:
    assert word in explain_doubt(replace(SURE, **{field: replace(getattr(SURE, field), confidence=0.3)}))


def test_a_transition_that_nothing_says_the_end_of_is_told_so() -> None:
    p = replace(SURE, kind=Belief("transition", 0.97, "name says 'to'"))
    assert explain_doubt(p).endswith("there is no evidence of its end")


def test_a_look_gains_more_where_others_are_called_alike() -> None:
    alike = replace(SURE, details={"likelihood": Belief(0.25, 0.8, "one of 4 of 'shrug'")})
    assert estimate_gain(alike) > estimate_gain(SURE) > 0 and 0 < LOOK < 1


@pytest.mark.parametrize(("sure", "look"), [(0.57, True), (0.62, False)])
def test_a_clip_whose_stance_nobody_is_sure_of_needs_a_look_whatever_else_is_certain(
    sure: float, look: bool
) -> None:
    assert needs_look(replace(SURE, stance=Belief("s", sure, "begins 40 cm from it"))) == look
    passing = replace(SURE, kind=Belief("transition", 0.99, "name says 'to'"))
    assert needs_look(replace(passing, end_stance=Belief("t", sure, "ends 40 cm from it"))) or not look


@pytest.mark.parametrize(("sure", "look"), [(0.55, True), (0.64, False)])
def test_a_clip_whose_layer_nobody_is_sure_of_needs_a_look(sure: float, look: bool) -> None:
    assert needs_look(replace(SURE, layer=Belief("arms", sure, "its arms move"))) == look


@pytest.mark.parametrize(("sure", "look"), [(0.63, True), (0.84, False)])
def test_a_clip_that_would_jump_in_its_stance_has_to_be_more_certain_of_it(sure: float, look: bool) -> None:
    jumping = replace(SURE, good=False, stance=Belief("s", sure, "nearest"))
    assert needs_look(jumping) == look and not needs_look(replace(jumping, good=True))
