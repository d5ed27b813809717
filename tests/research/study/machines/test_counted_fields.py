"""Labelling field by field without proposals: the steps label what the reference has, in the fewest operators."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.research.study.machines.counted_fields import (
    FromNames,
    SetFound,
    apply_step,
    label_by_fields,
    strip_labels,
)
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import score
from tests.research.study.machines.test_by_hand import reference


@pytest.mark.parametrize("shuffled", range(3))
@pytest.mark.parametrize("from_names", [True, False])
def test_the_steps_make_the_reference_and_nothing_else(shuffled: int, from_names: bool) -> None:
    ref = reference(shuffled)
    found = label_by_fields(ref, from_names)
    assert not found.score.mistakes and found.score.f1 == 1.0 and found.seconds > 0
    assert from_names or not any(isinstance(step, FromNames) for step in found.steps)
    project = strip_labels(ref)
    assert not list(project.actions()) and not any(g.stances for g in project.graphs.values())
    for step in found.steps:
        project = apply_step(project, step)
    assert score(normalize_machines(project, False), normalize_machines(ref, False)).f1 == 1.0


def test_a_pattern_that_would_be_wrong_for_one_clip_is_not_used() -> None:
    ref = reference()
    clips = {
        c: replace(e, name="stand__fool" if e.name == "sit__nod" else e.name) for c, e in ref.clips.items()
    }
    found = label_by_fields(replace(ref, clips=clips))
    assert not found.score.mistakes
    assert not any(isinstance(s, FromNames) and s.pattern == "{stance}__*" for s in found.steps)


def test_names_that_fit_no_pattern_are_labelled_beside_those_that_do() -> None:
    found = label_by_fields(reference())
    assert any(isinstance(step, FromNames) for step in found.steps)
    assert SetFound("odd", "stance", "stand", "stand").value in [
        step.value for step in found.steps if isinstance(step, SetFound)
    ]


def test_clips_of_one_name_cannot_be_told_apart() -> None:
    ref = reference()
    clips = {c: replace(e, name="take") for c, e in ref.clips.items()}
    with pytest.raises(ValueError, match="do not tell"):
        label_by_fields(replace(ref, clips=clips))
