"""What beginning and ending an action at a moment of its clip would cost, with its blends as they are, and
the one sentence that says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from metagraph.common.wording import join_phrases, phrase
from metagraph.graph.checks import end_gaps
from metagraph.graph.model import Action, Project

if TYPE_CHECKING:
    from metagraph.suggest.jumps.found import Curves


class SeenJumps:
    """An action's curves as its blends are now. times, enter, leave `[F]`; pivot: the frame from which on
    leaving is shown.
    """

    def __init__(self, action: Action, curves: Curves) -> None:
        from metagraph.suggest.jumps.compatibility import measure_visible_difference

        t = action.timing
        self.loops, self.times, self.proposed = action.kind == "stance", curves.times, curves.proposed
        self.enter = np.array(measure_visible_difference(curves.enter, t.blend_in))
        self.leave = np.array(
            measure_visible_difference(curves.leave, t.blend_in if self.loops else t.blend_out)
        )
        if curves.gaps is not None:  # a long blend covers an unhurried pace, none covers what is far
            for cost, gap, blend in zip(
                (self.enter, self.leave), curves.gaps, (t.blend_in, t.blend_out), strict=True
            ):
                covered = end_gaps.find_slow_distances(gap, curves.height, blend)
                cost[covered] = np.minimum(cost[covered], 1.0)
                far = np.isfinite(gap) & (gap > end_gaps.measure_hidden_gap(curves.height, blend))
                cost[far] = np.maximum(
                    cost[far], gap[far] / end_gaps.measure_hidden_gap(curves.height, blend)
                )
        if self.loops:
            self.pivot = 0
        elif action.kind == "transition":
            self.pivot = int(np.argmax(curves.leave <= curves.enter)) or len(self.times) // 2
        else:
            self.pivot = int(np.argmax(curves.enter))

    def at(self, seconds: float) -> int:
        return int(np.argmin(np.abs(self.times - seconds)))

    def cost(self, edge: str, seconds: float) -> float:
        """Return what beginning ("start") or ending ("end") at a moment would cost; up to 1 does not show."""
        return float((self.enter if edge == "start" else self.leave)[self.at(seconds)])

    def curve(self) -> np.ndarray:
        """Return `[F]` what is drawn: entering before the pivot, leaving from there on."""
        return np.where(np.arange(len(self.times)) < self.pivot, self.enter, self.leave)

    def spans(self) -> list[tuple[float, float]]:
        """Return if nothing shows, seconds; from the first such frame to the last."""
        good = self.curve() <= 1
        good_in, good_out = (
            good & (np.arange(len(good)) < self.pivot),
            good & (np.arange(len(good)) >= self.pivot),
        )
        out = []
        for some in (good_in, good_out):
            edges = np.flatnonzero(np.diff(np.concatenate(([0], some.astype(int), [0]))))
            out += [(float(self.times[a]), float(self.times[b - 1])) for a, b in edges.reshape(-1, 2)]
        return out

    def snaps(self, handle: str) -> list[float]:
        """Return the moments a handle comes to rest at: the proposed one, and if nothing begins to show."""
        if handle == "start":
            if self.loops:
                return []
            ends = [b for a, b in self.spans() if b <= self.times[self.pivot]]
            return [self.proposed.start, *ends]
        if handle == "end":
            starts = [a for a, b in self.spans() if a >= self.times[self.pivot] and a > self.times[0] + 0.1]
            return [self.proposed.end, *starts]
        return []


def find_words_at(project: Project, action: Action, seen: SeenJumps, seconds: float) -> str:
    """Say what a moment would be like to begin or end at."""
    entering = seen.at(seconds) < seen.pivot
    cost = seen.cost("start" if entering else "end", seconds)
    blend = action.timing.blend_in if entering or seen.loops else action.timing.blend_out
    stance = project.stance(action.stance if entering or action.end_stance is None else action.end_stance)
    name = phrase("'{name}'", name=stance.name) if stance is not None else phrase("its stance")
    if cost <= 1:
        verdict = phrase("no jump, {cost:.1f} of the visible threshold", cost=cost)
    else:
        verdict = phrase("jumps, {cost:.1f} times the visible threshold", cost=cost)
    if blend > 0:
        verdict = phrase("{verdict}, blended over {blend:.2f} s", verdict=verdict, blend=blend)
    if seen.loops:
        return phrase("At {seconds:.2f} s it repeats from here: {verdict}", seconds=seconds, verdict=verdict)
    if entering:
        said = phrase(
            "At {seconds:.2f} s it enters from {name}: {verdict}", seconds=seconds, name=name, verdict=verdict
        )
    else:
        said = phrase(
            "At {seconds:.2f} s it leaves to {name}: {verdict}", seconds=seconds, name=name, verdict=verdict
        )
    return said


def describe_ends(costs: Mapping[str, float], far: Mapping[str, str] | None = None) -> str:
    """Say what beginning and ending cost: "Begins without a jump, ends with one, 2.7 times the
    visible threshold". far: of
    those that begin or end too far from their stance, what the problems say of it.
    """
    far = far or {}
    if len(costs) > 1 and max(costs.values()) <= 1 and not far:
        return phrase("Begins and ends without a jump")
    said: list[str] = []
    for what, cost in costs.items():
        said.append(far[what] if what in far else _cost_words(what, cost, any("jump" in x for x in said)))
    return join_phrases(said, ", ")


def _cost_words(what: str, cost: float, again: bool) -> str:
    """Say what one of both costs. again: whether a jump was spoken from before."""
    if what == "Repeats":
        if cost <= 1:
            return phrase("Loops smoothly")
        return phrase("Loop seam jumps, {cost:.1f} times the visible threshold", cost=cost)
    if what == "Begins":
        if cost <= 1:
            return phrase("Begins without a jump")
        return phrase("Begins with a jump, {cost:.1f} times the visible threshold", cost=cost)
    if cost <= 1:
        return phrase("ends without one") if again else phrase("ends without a jump")
    if again:
        return phrase("ends with one, {cost:.1f} times the visible threshold", cost=cost)
    return phrase("ends with a jump, {cost:.1f} times the visible threshold", cost=cost)


def find_far_ends(project: Project, action: Action) -> dict[str, str]:
    """Return which ends of an action are too far from their stance, by how `verdict` calls them, in words."""
    graph = project.graphs[action.layer]
    return {
        "Begins" if gap.edge == "begins" else "ends": _gap_words(gap, graph.stances[gap.stance].name)
        for gap in end_gaps.find_end_gaps(project, graph, action)
        if gap.far and gap.stance in graph.stances
    }


def _gap_words(gap: end_gaps.EndGap, stance: str) -> str:
    """Say a gap as the problems do; what begins a sentence with a capital."""
    if gap.edge == "begins":
        return phrase("Begins {far:.0f} cm from stance '{stance}'", far=gap.metres * 100, stance=stance)
    return end_gaps.describe_gap(gap, stance)


def describe_times(seen: SeenJumps) -> str:
    """Say proposed times."""
    p = seen.proposed
    if seen.loops:
        if p.blend_in > 0:
            return phrase("The whole clip, its loop seam blended over {blend:.2f} s", blend=p.blend_in)
        return phrase("The whole clip, without a blend")
    return phrase(
        "{start:.2f} to {end:.2f} s, blended in over {blend_in:.2f} s and out over {blend_out:.2f} s",
        start=p.start,
        end=p.end,
        blend_in=p.blend_in,
        blend_out=p.blend_out,
    )
