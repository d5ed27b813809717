"""Layers on which nothing plays are named, with the modes and what would help; others are not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.playback.quiet_layers import find_quiet_layers
from metagraph.playback.rehearsal import rehearse


def told(project: Project) -> dict[str | None, str]:
    return {p.layer: f"{p.message} {p.remedy}" for p in find_quiet_layers(project)}


def test_of_a_character_that_has_everything_nothing_is_said(sample: Project) -> None:
    assert told(sample) == {} and told(Project("empty")) == {}


def test_a_set_of_whole_bodies_on_one_layer_lacks_nods_and_is_told_what_moves_it(toy: Any) -> None:
    alone = toy.project("arms")
    assert "Fidget node of the layer 'body'" in told(alone)["body"]
    found = told(edits.set_weight(alone, "arms", "legs", 1.0))
    assert "nods" in found["head"] and "moves only with clips of the arms" in found["head"]
    assert "Fidget node of the arms" in found["body"], "another layer for the legs would add up"


def test_a_head_that_nods_and_does_nothing_else_is_quiet_in_no_mode_in_which_it_nods(sample: Project) -> None:
    fidgets = [a.id for a in sample.graphs["head"].actions.values() if a.kind == "fidget"]
    assert "head" not in told(sample)
    without = edits.remove_actions(sample, fidgets) if fidgets else sample
    assert "listens" not in told(without).get("head", "")
    nods = [a.id for a in sample.graphs["head"].actions.values() if a.kind in ("gesture", "fidget")]
    silent = told(edits.remove_actions(sample, nods))
    assert "nothing plays on the head" in silent["head"] and "listens" in silent["head"]


def test_arms_without_fidgets_are_quiet_while_the_character_idles(sample: Project) -> None:
    fidgets = [a.id for a in sample.graphs["arms"].actions.values() if a.kind == "fidget"]
    found = told(edits.remove_actions(sample, fidgets))
    assert "idles" in found["arms"] and "talks" not in found["arms"] and "Fidget node" in found["arms"]


def test_a_rehearsal_tells_it_as_a_hint(toy: Any) -> None:
    project = toy.project("arms")
    hints = [p for p in rehearse(project, 5.0) if p.code == "play-nothing"]
    assert {p.layer for p in hints} == {"body", "head"} and {p.severity for p in hints} == {"hint"}
    assert not [p for p in rehearse(replace(project, skeleton=None), 5.0) if p.code == "play-nothing"]
