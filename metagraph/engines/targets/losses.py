"""What all state machines lose of a meta-graph; each target adds its own."""

from __future__ import annotations

from metagraph.common.wording import phrase
from metagraph.engines.targets.target import Loss
from metagraph.graph.model import Project


def _varied(project: Project) -> int:
    """Count the stances with several loops."""
    return sum(len(g.of(s, "stance")) > 1 for g in project.graphs.values() for s in g.stances)


def _ways(project: Project) -> int:
    """Count the transitions that are not the only one between two stances."""
    seen: set[tuple[str, str | None]] = set()
    again = 0
    for action in project.actions():
        if action.kind == "transition":
            again += (action.stance, action.end_stance) in seen
            seen.add((action.stance, action.end_stance))
    return again


def _masked(project: Project) -> int:
    return sum(1 for a in project.actions() if a.limb != "both" or a.joints or a.joint_weights)


def _soft(project: Project) -> int:
    return sum(1 for a in project.actions() if a.joint_weights)


def _seams(project: Project) -> int:
    return sum(1 for a in project.actions() if a.kind == "stance" and a.timing.blend_in > 0)


def _weighted(project: Project) -> int:
    return sum(1 for g in project.graphs.values() for w in g.weights.values() if w not in (0.0, 1.0))


MACHINE: tuple[Loss, ...] = (
    Loss(
        phrase(
            "no planner: nothing is drawn by tags, limb or likelihood, nothing is scheduled ahead, "
            "no stroke is timed; each action is asked for"
        )
    ),
    Loss(phrase("no statistics: nobody performs when nothing is asked")),
    Loss(phrase("no life layers: breathing, gaze, blinks and lips are not played")),
    Loss(phrase("holds play as they were made, and preparations are not skipped")),
    Loss(phrase("of the loops of {n} stances the first plays of itself, the others when asked for"), _varied),
    Loss(
        phrase(
            "{n} transitions that are not the first between their stances play only when asked for "
            "by themselves"
        ),
        _ways,
    ),
    Loss(
        phrase(
            "{n} actions that move part of their layer hold the rest as their stance begins, instead "
            "of letting it play on"
        ),
        _masked,
    ),
    Loss(
        phrase(
            "soft weights of joints in {n} actions are part of their clips, as far from how the "
            "stance begins, and cannot be changed there"
        ),
        _soft,
    ),
    Loss(phrase("{n} loops that play with a seam jump where they repeat"), _seams),
)
WEIGHTS = Loss(phrase("{n} weights of layers on body parts other than 0 and 1 count as 1"), _weighted)
CROSSFADE = Loss(phrase("blends are plain crossfades: a clip is held back and hurried while it blends"))
