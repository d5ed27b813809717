"""Weights of joints while they are chosen: every change is a step, and what is kept says the same."""

from __future__ import annotations

from typing import Any

import pytest

from app.widgets.mask_weights import MaskWeights
from metagraph.graph import edits
from metagraph.graph.model import Project


def test_a_project_without_a_skeleton_has_no_weights() -> None:
    weights = MaskWeights(Project(), None)
    weights.change({"Head": 0.5})
    weights.soften(3)
    weights.undo()
    weights.redo()
    assert not weights.now and weights.empty and weights.fields() == {} and not weights.can_undo


def test_a_change_that_changes_nothing_is_no_step(toy: Any) -> None:
    weights = MaskWeights(toy.project(), None)
    weights.change({"Head": 1.0, "Nowhere": 0.5})
    assert not weights.can_undo and "Nowhere" not in weights.now


def test_weights_stay_between_nothing_and_all(toy: Any) -> None:
    weights = MaskWeights(toy.project(), None)
    weights.add(["Head"], 0.3)
    assert weights.now["Head"] == 1
    weights.add(["Head"], -5)
    assert weights.now["Head"] == 0 and not weights.empty
    weights.change(dict.fromkeys(weights.now, -1.0))
    assert weights.empty


def test_steps_are_taken_back_one_by_one_and_a_new_one_forgets_those_taken_back(toy: Any) -> None:
    weights = MaskWeights(toy.project(), None)
    for weight in (0.75, 0.5):
        weights.change({"Head": weight})
    weights.undo()
    assert weights.now["Head"] == 0.75 and weights.can_redo
    weights.change({"Neck": 0.5})
    assert not weights.can_redo
    weights.undo()
    weights.undo()
    assert weights.now["Head"] == 1 and not weights.can_undo


@pytest.mark.parametrize("mask", [{}, {"Head": 0.5}, {"Head": 0.0, "Neck": 0.25}])
def test_what_is_kept_is_shown_again(toy: Any, mask: dict[str, float]) -> None:
    project = toy.project()
    weights = MaskWeights(project, None)
    weights.change(mask)
    ident = toy.id(project, "rest long")
    project = edits.update_actions(project, [ident], **weights.fields())
    assert MaskWeights(project, project.action(ident)).now == weights.now
