"""What of a running plan lies so far back that planning on neither reads nor changes it: its head.

Planning on from the rest alone, with what the head leaves behind (`Past`), gives the same plan, in a time
that grows with what is new and with what is remembered (`RECENT`, the settings' memory), not with the plan.
What it leaves as it was is shared, not copied (`strand`).
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection
from dataclasses import dataclass, replace
from weakref import ref

from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.playback.plan import LayerPlan, Past, Plan
from metagraph.playback.planning.remembering import remember
from metagraph.playback.planning.strand import join_sequence

RECENT = 30.0  # seconds before now that planning on looks at, beside the settings' memory
KEPT = 8  # plans whose heads are known


@dataclass(slots=True)
class LayerHead:
    """How many cues, rests and meta actions of a layer are in the head, and what the cues leave behind."""

    cues: int
    rests: int
    metas: int
    past: Past


@dataclass(slots=True)
class PlanHead:
    """The head of a plan. end: before which all of it has ended, seconds. reports: how many. named: ids of
    what was asked for that they and the meta actions are about, and maybe more.
    """

    end: float
    layers: dict[Layer, LayerHead]
    reports: int
    named: set[str]

    def rest(self, of: LayerPlan) -> LayerPlan:
        """Return a layer without the head."""
        head = self.layers[of.layer]
        return replace(
            of,
            metas=of.metas[head.metas :],
            cues=of.cues[head.cues :],
            rests=of.rests[head.rests :],
            past=head.past,
            written=of.written[bisect_left(of.written, self.end, key=lambda m: m.start) :],
        )

    def whole(self, of: LayerPlan, rest: LayerPlan) -> LayerPlan:
        """Return what a layer became, from what the rest of it did."""
        head = self.layers[of.layer]
        return replace(
            rest,
            metas=join_sequence(of.metas, head.metas, rest.metas),
            cues=join_sequence(of.cues, head.cues, rest.cues),
            rests=join_sequence(of.rests, head.rests, rest.rests),
            past=of.past,
        )


def share_layer(of: LayerPlan) -> LayerPlan:
    """Return a layer as it is, laid down so that what is planned on from it can share what it leaves."""
    metas, cues, rests = (
        join_sequence((), 0, of.metas),
        join_sequence((), 0, of.cues),
        join_sequence((), 0, of.rests),
    )
    return replace(of, metas=metas, cues=cues, rests=rests)


def find_plan_head(project: Project, plan: Plan, now: float, again: Collection[str]) -> PlanHead | None:
    """Return the head of a plan at `now`; None if there is none, or where all has to be looked at. again: ids
    of what is requested again or withdrawn.
    """
    cut = now - max(RECENT, project.settings.memory)
    if cut <= 0:
        return None
    known = next((head for of, head in tuple(_known) if of() is plan), None)
    if known is None or known.end > cut:
        none = {layer: LayerHead(0, 0, 0, plan.layers[layer].past) for layer in LAYERS}
        known = PlanHead(0.0, none, 0, set())
    found = _moved(plan, known, cut)
    keep_head(plan, found)
    if not found.named.isdisjoint(again):
        return None
    for layer, head in found.layers.items():
        stances = project.graphs[layer].stances
        if head.cues and head.past.stance not in stances:
            return None
        if any(cue.then not in stances for cue in plan.layers[layer].cues[head.cues :]):
            return None
    return found


def keep_head(plan: Plan, head: PlanHead) -> None:
    """Remember the head of a plan."""
    # Whether it is this one is asked of each, not whether it is alike: that would be looked up cue by cue.
    others = [x for x in _known if (of := x[0]()) is not None and of is not plan]
    _known[:] = [(ref(plan), head), *others][:KEPT]


_known: list[tuple[ref[Plan], PlanHead]] = []


def _moved(plan: Plan, head: PlanHead, cut: float) -> PlanHead:
    """Return a plan's head with what has ended before `cut` since."""
    layers = {
        layer: _layer_moved(plan.layers[layer], head.layers[layer], cut, head.named) for layer in LAYERS
    }
    reports = head.reports
    while reports < len(plan.reports) and plan.reports[reports].at < cut:
        _name(head.named, plan.reports[reports].request, plan.reports[reports].written)
        reports += 1
    return PlanHead(cut, layers, reports, head.named)


def _layer_moved(of: LayerPlan, head: LayerHead, cut: float, named: set[str]) -> LayerHead:
    cues, rests, metas = head.cues, head.rests, head.metas
    while cues < len(of.cues) and of.cues[cues].end < cut:
        cues += 1
    while rests + 1 < len(of.rests) and of.rests[rests + 1].fade_start + of.rests[rests + 1].fade <= cut:
        rests += 1
    on = {cue.meta for cue in of.cues[cues:]}
    while metas < len(of.metas) and of.metas[metas].end < cut and of.metas[metas].key not in on:
        _name(named, of.metas[metas].request.id, of.metas[metas].written)
        metas += 1
    past = head.past
    if cues > head.cues:
        uses, recent, ended = dict(past.uses), dict(past.recent), dict(past.ended)
        for cue in of.cues[head.cues : cues]:
            remember(cue, uses, recent, ended)
        past = Past(of.cues[cues - 1].end, of.cues[cues - 1].then, uses, recent, ended)
    return LayerHead(cues, rests, metas, past)


def _name(named: set[str], ident: str, written: bool) -> None:
    if not written:
        named.add(ident)
