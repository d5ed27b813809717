"""Extend the plan of one layer: the later part of the plan is turned back into its meta actions, merged with
new requests, placed and performed again (Borer et al., section 6).
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

from metagraph.graph.model import Kind, Layer, Markov, MetaGraph, Project
from metagraph.playback.life.track import Track
from metagraph.playback.plan import (
    TEMPORAL,
    Cue,
    Cursor,
    LayerPlan,
    MetaAction,
    MetaRequest,
    Past,
    Report,
    Rest,
)
from metagraph.playback.planning import markov
from metagraph.playback.planning.cue_shapes import FITS
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.leaving import make_way
from metagraph.playback.planning.mood import Moods, changed, mood_at, tempo
from metagraph.playback.planning.replan import delay, replan
from metagraph.playback.planning.sampling import begin_layer, perform_metas, resume_layer, vary_rests

WINDOW = 1.0  # seconds a request may use when it does not say how long


@dataclass(slots=True)
class LayerDraft:
    """A layer placed in time, not yet performed.

    able: whether the layer can perform at all. done: meta actions that were performed before. placed: those
    to perform, in order; those that a model wrote are performed as the mode says. reports: the reports so
    far.
    """

    layer: Layer
    state: LayerState
    able: bool
    done: list[MetaAction]
    placed: list[MetaAction]
    reports: list[Report]
    past: Past
    cursor: Cursor
    written: list[MetaAction]

    def performed(self, metas: Sequence[MetaAction], end: float) -> LayerPlan:
        """Return the layer's plan with the given meta actions performed; `reports` is then complete."""
        cues: list[Cue] = []
        rests: list[Rest] = []
        if self.able:
            perform_metas(self.state, metas, end)
            vary_rests(self.state, end)
            cues = self.state.cues
            rests = self.state.rests
            self.reports.extend(self.state.reports)
        every = (*self.done, *self.placed)
        return LayerPlan(
            self.layer, every, tuple(cues), tuple(rests), self.past, self.cursor, tuple(self.written)
        )


def draft(
    project: Project,
    graph: MetaGraph,
    chain: Markov | None,
    kinds: AbstractSet[Kind],
    old: LayerPlan,
    told: Sequence[Report],
    seed: Bits,
    now: float,
    fresh: Sequence[MetaRequest],
    replaced: AbstractSet[str],
    stopped: AbstractSet[str],
    end: float,
    stance: str | None,
    moods: Moods,
    track: Track,
) -> LayerDraft:
    """Return a layer's plan cut at `now`, with the requests placed again.

    chain: the model that writes when there are no requests, or None. kinds: the kinds of actions that the
    layer has. told: reports of the plan so far. fresh: new requests, of all layers. replaced: ids of requests
    that are replaced or withdrawn; stopped: those withdrawn, whose running action is left. stance: the stance
    in which the layer would begin. moods: the mood over time. track: what lasts, such as the mode.
    """
    layer = graph.layer
    asked = [meta_of(in_time(request, moods)) for request in fresh if request.layer == layer]
    kept = [cue for cue in old.cues if cue.start < now]
    played = {cue.meta for cue in kept}
    waiting = {cue.meta for cue in old.cues[len(kept) :]}  # also those whose chain of transitions has begun
    # Who lies ahead may be called as what was played long ago: a request that is asked for again and again.
    playing = {cue.meta for cue in kept if cue.end > now}
    written: list[MetaAction] = []
    cursor = old.cursor
    # What another's action has served since it began is played as that is.
    served = {report.request for report in told if report.outcome == "shared" and report.by in played}
    again = set(replaced)
    if chain is not None:
        more, cursor = markov.write(chain, seed, end, kinds, old.cursor)
        for meta in (*old.written, *more):
            if meta.start >= now:
                written.append(meta)
                again.add(meta.request.id)
    future: list[MetaAction] = []
    planned: dict[str, list[float]] = {}  # again: when those of a request start
    judged: set[str] = set()  # those whose lateness is known once they are performed
    for meta in old.metas:
        if meta.request.id in again or meta.request.id in served:
            continue
        if meta.key in waiting or (meta.start >= now and meta.key not in playing):
            future.append(meta)
            if meta.request.late is not None:
                judged.add(meta.request.id)
            planned[meta.request.id] = [*planned.get(meta.request.id, []), meta.start]
    # Reports about time still hold; those that are planned again report the rest.
    done = [
        meta
        for meta in old.metas
        if meta.request.id not in again
        and meta.start not in planned.get(meta.request.id, [])
        and (meta.key in playing or meta.start < now or meta.request.id in served)
    ]
    reports = [
        report
        for report in told
        if report.layer == layer
        and report.request not in again
        and (
            (report.outcome in TEMPORAL and report.request not in judged)
            or report.at not in planned.get(report.request, [])
        )
    ]
    begin = _begin(graph, old, stance)
    state = resume_layer(project, graph, seed, begin, old.past, kept, moods, track)
    state.model = chain
    if begin == "" or not begin_layer(state, begin):
        why = f"the {layer} layer has no stance with a loop to begin in"
        waits = [*future, *asked]
        for meta in waits:
            if not meta.written:
                reports.append(Report(meta.request.id, "no-stance", why, layer, meta.start))
        return LayerDraft(layer, state, False, done, waits, reports, old.past, cursor, written)
    state.begun = _begun(old, len(kept))
    if len(kept) > 0 and kept[-1].end > now:
        running = next((meta for meta in old.metas if meta.key == kept[-1].meta), None)
        leaves = _leaves(running, stopped, track, now)
        make_way(state, running, asked, now, leaves)
    if len(old.rests) > 0 and now > 0:
        begun = {cue.end - cue.blend_out for cue in state.cues}
        state.rests = [rest for rest in old.rests if rest.fade_start < now or rest.start in begun]
    state.free = max(now - (state.ready - state.free), state.free)
    asked, delayed = delay(asked, state.ready, project.settings)
    busy = float("-inf")  # what runs keeps the time it was wanted for, from the models
    for meta in done:
        if not meta.written:
            busy = max(busy, meta.end)
    placed, moved = replan([*future, *written, *asked], project.settings, busy)
    every = [*reports, *delayed, *moved]
    return LayerDraft(layer, state, True, done, placed, every, old.past, cursor, written)


def _leaves(running: MetaAction | None, stopped: AbstractSet[str], track: Track, now: float) -> bool:
    """Return whether the running action is left: it was stopped, or it is a gesture of the character's own
    and what it said was broken off.
    """
    if running is None:
        return False
    own = running.written and running.request.kind == "gesture"
    return running.request.id in stopped or (own and track.hushed_at(now))


def _begun(old: LayerPlan, kept: int) -> set[str]:
    """Return the key of the meta action whose chain of transitions plays where the first cues are kept; none
    if none does. An earlier action may have had the same key, so that only the last cue can be of a chain.
    """
    out: set[str] = set()
    if 0 < kept < len(old.cues):
        last, following = old.cues[kept - 1], old.cues[kept]
        if last.meta == following.meta and following.start <= last.end:
            out.add(last.meta)
    return out


def in_time(request: MetaRequest, moods: Moods) -> MetaRequest:
    """Return a request that may begin earlier, by the extra time that its preparation takes in its mood."""
    if request.stroke is None:
        return request
    mood = mood_at(moods, request.stroke)
    speed = tempo(changed(mood, request.valence, request.arousal, request.intensity))
    if speed >= 1:
        return request
    return replace(request, start=max(0.0, request.stroke - (request.stroke - request.start) / speed))


def meta_of(request: MetaRequest) -> MetaAction:
    """Return a request as a meta action with the window it may use; if its stroke is judged, with the moment
    of the stroke.
    """
    if request.late is not None and request.stroke is not None:
        return MetaAction(request, request.stroke, request.stroke + FITS)
    length = WINDOW if request.duration is None else max(0.0, request.duration)
    if request.stroke is not None:
        length = max(length, request.stroke - request.start + FITS)
    return MetaAction(request, request.start, request.start + length)


def _begin(graph: MetaGraph, old: LayerPlan, stance: str | None) -> str:
    """Return the stance in which a layer begins: that of the plan before, the given one, the graph's start,
    or the first that has a loop; "" for none.
    """
    wishes = [old.past.stance]
    if len(old.rests) > 0:
        wishes.append(old.rests[0].stance)
    if stance is not None:
        wishes.append(stance)
    if graph.start is not None:
        wishes.append(graph.start)
    wishes.extend(list(graph.stances))
    for wish in wishes:
        if wish in graph.stances and len(graph.of(wish, "stance")) > 0:
            return wish
    return ""
