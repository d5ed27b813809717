"""How far an action's clip is, moment by moment, from the stance it leaves and the one it enters, and where
that shows: what is drawn in a strip, by the measures that the problems go by.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.graph.checks import end_gaps
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import Action, Project
from metagraph.suggest.jumps.seen_jumps import SeenJumps

Array = NDArray[Any]

RATE = 30.0  # moments a second


@dataclass(frozen=True, eq=False)
class StanceDistance:
    """times, metres, shows `[F]`: seconds of the clip, how far the farthest joint is, whether beginning or
    ending there would show; infinite metres if nothing can be measured. pivot: from which moment on it is the
    stance it enters that is measured to. limits: metres that its blends hide, at its beginning and its end.
    names: of both stances.
    """

    times: Array
    metres: Array
    shows: Array
    pivot: int
    limits: tuple[float, float]
    names: tuple[str, str]

    def words(self, seconds: float) -> str:
        """Return how far the pose at a moment is from its stance, such as "12 cm from 'on hips'"."""
        if not len(self.times):
            return ""
        at = int(np.argmin(np.abs(self.times - seconds)))
        name = self.names[0 if at < self.pivot else 1]
        if not np.isfinite(self.metres[at]):
            return ""
        far = 100 * float(self.metres[at])
        if self.shows[at]:
            return phrase("{far:.0f} cm from '{name}', a visible jump", far=far, name=name)
        return phrase("{far:.0f} cm from '{name}', no visible jump", far=far, name=name)


def measure_stance_distances(
    project: Project, action: Action, seen: SeenJumps | None, both: tuple[Array, Array, Array] | None = None
) -> StanceDistance:
    """Return an action's distances. seen: what is known of its jumps, which decides what shows. both: what
    `measured` returned for the same action, if that is known.
    """
    times, into, left = measure_stance_distance(project, action) if both is None else both
    motion = end_gaps.get_action_motion(project, action)
    height = motion.skeleton.height if motion is not None else end_gaps.TALL
    t = action.timing
    limits = (
        end_gaps.measure_hidden_gap(height, t.blend_in),
        end_gaps.measure_hidden_gap(height, t.blend_out),
    )
    pivot = _pivot(action, times, into, left, seen)
    first = np.arange(len(times)) < pivot
    metres = np.where(first, into, left)
    shows = np.isfinite(metres) & (metres > np.where(first, *limits))
    if seen is not None and len(seen.times):
        nearest = np.clip(np.searchsorted(seen.times, times - 1e-6), 0, len(seen.times) - 1)
        shows = seen.curve()[nearest] > 1
    stances = (project.stance(action.stance), project.stance(find_end_stance(action)))
    names = tuple(s.name if s is not None else "?" for s in stances)
    return StanceDistance(times, metres, shows, pivot, limits, (names[0], names[1]))


def measure_stance_distance(project: Project, action: Action) -> tuple[Array, Array, Array]:
    """Return moments of an action's clip `[F]` and how far it is at each from both stances, metres."""
    motion = end_gaps.get_action_motion(project, action)
    if motion is None:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    times = np.linspace(0, motion.duration, max(2, round(motion.duration * RATE) + 1))
    return (times, *end_gaps.measure_distances_to_stance(project, action, times))


def _pivot(action: Action, times: Array, into: Array, left: Array, seen: SeenJumps | None) -> int:
    if seen is not None and len(seen.times):
        return int(np.searchsorted(times, seen.times[min(seen.pivot, len(seen.times) - 1)] - 1e-6))
    if action.kind == "stance" or not len(times):
        return 0
    if action.kind == "transition":
        return int(np.argmax(left <= into)) or len(times) // 2
    return int(np.argmax(into))
