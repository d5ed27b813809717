"""What an hour delivers beside what was asked for."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph.model import Action, Kind, Limb, Project
from metagraph.research.exhibits.keeping_rates import exhibit_delivery
from metagraph.research.exhibits.material import ExhibitMaterial

LIMBS: tuple[Limb, ...] = ("left", "right", "both")
KINDS: tuple[Kind, ...] = ("gesture", "fidget", "transition")


@pytest.fixture(scope="module")
def whole(sample: Project) -> Project:
    """The sample with two stances of the arms, each of which has every kind with every limb, three times, so
    that what was played last is never in the way.
    """
    graph = sample.graphs["arms"]
    first, second = tuple(graph.stances)[:2]
    clip = next(a for a in graph.actions.values() if a.kind == "gesture")
    actions: dict[str, Action | None] = dict.fromkeys(graph.actions)
    for stance, other in ((first, second), (second, first)):
        loop = graph.of(stance, "stance")[0]
        actions[loop.id] = loop
        for kind in KINDS:
            end = other if kind == "transition" else None
            for limb in LIMBS:
                for n in range(3):
                    one = replace(
                        clip, id=f"{stance} {kind} {limb} {n}", stance=stance, kind=kind, limb=limb,
                        end_stance=end, tags=(), cooldown=0.0, spacing=None, likelihood=1.0,
                    )  # fmt: skip
                    actions[one.id] = one
    return sample.with_graph(graph.with_actions(actions))


@pytest.mark.nightly
def test_with_every_limb_in_every_stance_an_hour_keeps_to_the_matrix_as_it_is_performed(
    whole: Project,
) -> None:
    arms = next(
        r for r in exhibit_delivery(ExhibitMaterial(whole)).numbers["improvised"] if r["layer"] == "arms"
    )
    near, of = arms["performed near"]
    assert arms["limb"] == arms["performed"] == arms["written"]
    assert near >= 0.85 * of and arms["near"] == arms["performed near"]


@pytest.mark.nightly
def test_the_samples_rates_are_performed_within_sampling_error(sample: Project) -> None:
    shown = exhibit_delivery(ExhibitMaterial(sample))
    arms = next(r for r in shown.numbers["improvised"] if r["layer"] == "arms")
    assert 0.99 * arms["written"] <= arms["performed"] <= arms["written"], "but what longer clips cover"
    assert arms["limb"] < arms["performed"], "not every stance has every limb, and that is told"
    assert len(shown.numbers["conversation"]) == 6
    assert "6 of 6 rates" in shown.says[1]
