"""Listeners take up the posture of who speaks, as in a mirror, a moment later (LaFrance and Broadbent 1976;
Yang et al. name it as future work).

Which of one's own stances is most like the other's is given by where head, hands, chest and feet are, seen
from the hips, so two characters of other studios with other names mirror each other too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.model import Project
from metagraph.graph.requests import Go
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.choice import uniform
from metagraph.speech.addressing import list_side_roles

Array = NDArray[Any]

DELAY = (1.0, 2.0)  # seconds after the other stands so: at least, and what chance adds to it
SEEN = ("head", "chest", "left_hand", "right_hand", "left_foot", "right_foot")
OTHER = (0, 1, 3, 2, 5, 4)  # their places in a mirror
NEARER = 0.8  # of how unlike the present stance is: one that is no more like is not taken up


@dataclass(frozen=True, slots=True)
class Mover:
    """A side with the project whose graph moves it, and its plan."""

    side: int
    project: Project
    plan: Plan


def list_mirrored_stances(conversation: Conversation, own: Mover, others: Sequence[Mover]) -> Iterator[Go]:
    """Yield the stances of the body that a side takes up while it listens: of several others, of whose turn
    it is. Nothing where either has no stances to tell apart, or bodies cannot be compared.
    """
    side, plan = own.side, own.plan.layers["body"]
    share, shapes = conversation.sides[side].rates.mirror, measure_stance_shapes(own.project)
    if share <= 0 or len(shapes) < 2:
        return
    taken: tuple[float, str] | None = None
    speaks = [(s.start, s.end) for s in conversation.sides[side].segments]
    theirs = {o.side: measure_stance_shapes(o.project) for o in others}
    for cue, other, key, at in sorted(_seen(conversation, side, others), key=lambda x: x[3]):
        shown = theirs[other]
        if len(shown) < 2 or cue.then == cue.stance or cue.then not in shown or at >= conversation.length:
            continue
        if any(start <= at < end for start, end in speaks):
            continue
        if uniform(conversation.seed, str(side), key) >= share:
            continue
        wanted = shown[cue.then][OTHER, :] * (-1, 1, 1)
        apart = {stance: float(np.linalg.norm(shape - wanted)) for stance, shape in shapes.items()}
        best, now = min(apart, key=lambda s: apart[s]), plan.stance_at(at)
        if taken is not None and plan.stance_at(taken[0]) == now:
            now = taken[1]  # nothing else has changed it since
        if best != now and apart[best] < NEARER * apart.get(now or "", np.inf):
            taken = at, best
            yield Go(id=key, at=round(at, 3), layer="body", stance=best, priority=1)


def _seen(
    conversation: Conversation, side: int, others: Sequence[Mover]
) -> Iterator[tuple[Cue, int, str, float]]:
    """Yield what others' bodies do, whose it is, its key, and when it would be taken up, seconds."""
    listens = [r for r in list_side_roles(conversation, side) if r.part in ("addressed", "aside")]
    for other in others:
        for n, cue in enumerate(other.plan.layers["body"].cues):
            key = f"mirror {n}" if len(others) == 1 else f"mirror {other.side + 1} {n}"
            at = cue.end + DELAY[0] + DELAY[1] * uniform(conversation.seed, str(side), key, "when")
            if len(others) == 1 or any(r.whom == other.side and r.start <= cue.end < r.end for r in listens):
                yield cue, other.side, key, at


def measure_stance_shapes(project: Project) -> dict[str, Array]:
    """Return where `SEEN` is in each stance of the body `[6, 3]`, x to the left, from the hips, in units of
    the hips' height; none if that cannot be told.
    """
    roles = anatomy.project_roles(project)
    if project.skeleton is None or not {"hips", *SEEN} <= roles.keys():
        return {}
    graph, out = project.graphs["body"], {}
    for stance in graph.stances:
        loop = next(iter(graph.of(stance, "stance")), None)
        entry = project.clips.get(loop.clip) if loop is not None else None
        if loop is None or entry is None or entry.motion is None or entry.motion.skeleton != project.skeleton:
            continue
        pose = entry.motion.pose_at(project.span(loop)[0])
        places = project.skeleton.globals(pose)[1]
        hips = places[roles["hips"]]
        out[stance] = (places[[roles[r] for r in SEEN]] - hips) / max(float(abs(hips[1])), 1e-3)
    return out
