"""Stances in which only one arm has gestures or fidgets: a model that asks for the other is not met."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from metagraph.graph.model import Limb, Project

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


def describe_one_sided(one: OneSided) -> str:
    """Return a sentence on what a stance lacks, and how many twins would add it."""
    count, has = len(one.actions), "right" if one.lacks == "left" else "left"
    actions = "1 action" if count == 1 else f"{count} actions"
    return f"'{one.name}' has {actions} of the {has} arm and none of the {one.lacks}"
