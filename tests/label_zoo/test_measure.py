"""Measuring labels: what counts as right, what a flag is worth, what a person's looks change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from metagraph.graph.model import Project
from metagraph.suggest.estimate import Belief
from metagraph.suggest.proposal import Proposal, Proposals, StancePlace
from tests.label_zoo.measure import LabelSet, Tally, looked, measured, others
from tests.label_zoo.sets import MadeSet, Recipe, make

ROW = {"kind": "gesture", "layer": "arms", "stance": "a", "end_stance": None, "limb": "left"}
NONE = dict.fromkeys(ROW)


@cache
def small() -> MadeSet:
    return make("small", Recipe(("hands_at_sides", "arms_crossed"), steps=1, clips=4), 0)


def told(
    made: MadeSet, change: Callable[[str, dict[str, Any]], None] = lambda n, r: None, sure: float = 0.99
) -> Any:
    """Return a proposer that says the truth, except for what `change` does to its row, as sure as told."""

    def propose(project: Project, clips: Any = None, **_: Any) -> Proposals:
        out, places = {}, {}
        for ident, entry in project.clips.items():
            row = {**made.truth[entry.name]}
            row = {**ROW, "stance": "hands at sides"} if row["kind"] is None else row
            change(entry.name, row)
            for name in (row["stance"], row["end_stance"]):
                if name is not None:
                    places[f"new {name}"] = StancePlace(f"new {name}", "arms", name)
            end = Belief(f"new {row['end_stance']}", sure, "") if row["end_stance"] else None
            stance = Belief(f"new {row['stance']}", sure, "") if row["stance"] else None
            limb = Belief(row["limb"] or "both", sure, "")
            kind, layer = Belief(row["kind"], sure, ""), Belief(row["layer"], sure, "")
            if clips is None or ident in clips:
                out[ident] = Proposal(ident, kind, layer, stance, end, limb)
        return Proposals(out, places)

    return propose


def tally(made: MadeSet, propose: Any) -> Tally:
    return measured(made.project, made.truth, propose(made.project))


def test_the_truth_is_all_right_but_for_what_is_none_of_the_four() -> None:
    found = tally(small(), told(small()))
    assert all(found.right[f] == found.there[f] for f in ("kind", "layer", "stance", "end_stance", "clip"))
    assert found.there["clip"] == len(small().truth) - 1
    assert (found.right["none"], found.there["none"]) == (0, 1)
    assert found.flags["wrong"] == 1 and found.flags["both"] == 0  # it was said so surely


def test_one_wrong_kind_is_one_wrong_clip_and_one_wrong_field() -> None:
    made = small()
    name = next(n for n, row in made.truth.items() if row["kind"] == "gesture")

    def change(n: str, row: dict[str, Any]) -> None:
        if n == name:
            row["kind"] = "fidget"

    found = tally(made, told(made, change))
    assert found.there["kind"] - found.right["kind"] == 1 == found.there["clip"] - found.right["clip"]
    assert found.right["stance"] == found.there["stance"]


def test_a_stance_by_another_name_is_right_and_two_in_one_are_not() -> None:
    made = small()

    def renamed(_: str, row: dict[str, Any]) -> None:
        row["stance"] = f"my {row['stance']}"
        row["end_stance"] = f"my {row['end_stance']}" if row["end_stance"] else None

    def merged(_: str, row: dict[str, Any]) -> None:
        row["stance"] = "one"

    assert tally(made, told(made, renamed)).right["stance"] == tally(made, told(made)).there["stance"]
    stances = [row["stance"] for row in made.truth.values() if row["stance"]]
    assert tally(made, told(made, merged)).right["stance"] == max(stances.count(s) for s in set(stances))


def test_all_that_is_unsure_is_flagged_and_counts_in_its_bin() -> None:
    made = small()
    found = tally(made, told(made, sure=0.65))
    assert found.flags["flagged"] == found.flags["clips"] == found.flags["unsure"] == len(made.truth)
    assert found.flags["both"] == found.flags["wrong"] == 1
    count, right, said = found.sure["kind"][2]
    assert count == right == found.there["kind"] and said == pytest.approx(0.65 * count)
    assert found.calibration("kind") == pytest.approx(0.35)


def test_tallies_add_up() -> None:
    one, both = tally(small(), told(small())), Tally()
    both += one
    both += one
    assert both.there["kind"] == 2 * one.there["kind"] and both.clips == 2 * one.clips
    assert both.sure["kind"][-1][0] == 2 * one.sure["kind"][-1][0]


def test_looking_at_everything_makes_everything_right() -> None:
    made = small()

    def change(_: str, row: dict[str, Any]) -> None:
        if row["kind"] == "gesture":
            row["kind"] = "fidget"

    count = sum(row["kind"] == "gesture" for row in made.truth.values())
    states = looked(made.project, made.truth, (0, 1, 99), told(made, change))
    assert states[0]["all"] == states[0]["rest"] == len(made.truth) - 1
    assert states[0]["all right"] == states[0]["all"] - count and states[0]["told"] == 0
    assert states[99]["all right"] == states[99]["all"] and states[99]["rest"] == 0
    assert states[99]["told"] == count


def test_what_is_learned_from_leaves_out_the_set_and_its_kin() -> None:
    def named(name: str, *made_from: str) -> LabelSet:
        return LabelSet(name, (), {}, made_from=made_from)

    sets = [named("a"), named("b"), named("a1", "a"), named("a2", "a"), named("b1", "b")]
    names = {one.name: [s.name for s in others(sets, one)] for one in sets}
    assert names["a"] == ["b", "b1"] and names["a1"] == ["b", "b1"] and names["b"] == ["a", "a1", "a2"]
    assert [s.name for s in others(sets, sets[2], siblings=True)] == ["b", "a2", "b1"]
    assert replace(sets[2]).family == {"a", "a1"}
