"""Stances in which only one arm has gestures or fidgets: a request for the other is not met."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from metagraph.common.wording import Phrase, phrase, plural_phrase
from metagraph.graph.model import Limb, Project
from metagraph.graph.problem import Problem

SIDES: tuple[Limb, ...] = ("left", "right")


@dataclass(frozen=True, slots=True)
class OneSided:
    """A stance of the arms. lacks: the arm that its gestures, or its fidgets, never are of. actions: ids of
    those of the other arm, whose twins would be.
    """

    stance: str
    name: str
    lacks: Limb
    actions: tuple[str, ...]


def list_one_sided(project: Project) -> list[OneSided]:
    """Return the stances whose gestures, or whose fidgets, are of one arm and not of the other, in the
    project's order. Actions of both arms count for neither.
    """
    graph = project.graphs["arms"]
    out = []
    for stance in graph.stances.values():
        for lacks, other in (SIDES, SIDES[::-1]):
            found: list[str] = []
            for kind in ("gesture", "fidget"):
                mine = graph.of(stance.id, kind)
                limbs = Counter(a.limb for a in mine)
                if limbs[other] and not limbs[lacks]:
                    found += [a.id for a in mine if a.limb == other]
            if found:
                out.append(OneSided(stance.id, stance.name, lacks, tuple(found)))
    return out


def describe_one_sided(one: OneSided) -> Phrase:
    """Return a sentence on what a stance lacks, and how many twins would add it."""
    if one.lacks == "left":
        return plural_phrase(
            "'{name}' has {count:,} action of the right arm and none of the left",
            "'{name}' has {count:,} actions of the right arm and none of the left",
            len(one.actions),
            name=one.name,
        )
    return plural_phrase(
        "'{name}' has {count:,} action of the left arm and none of the right",
        "'{name}' has {count:,} actions of the left arm and none of the right",
        len(one.actions),
        name=one.name,
    )


def check_limbs(project: Project) -> list[Problem]:
    """Return a hint for each stance of the arms in which only one arm has gestures or fidgets."""
    remedy = phrase("Make mirrored twins, so that requests for the other arm are met, too.")
    return [
        Problem("hint", "one-arm", describe_one_sided(one), remedy, "arms", one.stance)
        for one in list_one_sided(project)
    ]
