"""The planner: requests at any level in, a plan of specific actions out.

Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from nothing and
extending a running plan are the same function; `make_plan` extends an empty plan at time 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from metagraph.graph.model import LAYERS, Layer, MetaGraph, Project
from metagraph.playback import markov
from metagraph.playback.pick import Performer, count
from metagraph.playback.plan import LayerPlan, MetaAction, Plan, Report, Request
from metagraph.playback.replan import replan

WINDOW = 1.0  # seconds a request may use when it does not say how long


def make_plan(
    project: Project,
    end: float,
    requests: Iterable[Request] = (),
    seed: int | None = None,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
) -> Plan:
    """Plan from 0 to `end` seconds.

    seed: 32-bit, the project's when None. stances: where layers begin, each layer's start stance when not given.
    idle: let the Markov model fill the time nobody asks for. A layer without a stance that has a loop stays still.
    """
    empty = Plan(project.settings.seed if seed is None else seed, 0.0)
    return extend(project, empty, 0.0, requests, end, stances, idle)


def extend(
    project: Project,
    plan: Plan,
    now: float,
    requests: Iterable[Request],
    end: float,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
) -> Plan:
    """Return the plan with new requests worked in and the horizon moved to `end`.

    What starts before `now` stays exactly as it was. What was planned for later is taken back to its meta actions,
    merged with the new ones and planned again.
    """
    fresh = tuple(requests)
    reports: list[Report] = [r for r in plan.reports if r.at < now]
    layers: dict[Layer, LayerPlan] = {}
    for layer in LAYERS:
        asked = [_meta(r) for r in fresh if r.layer == layer]
        layers[layer] = _extend_layer(project, plan, layer, now, asked, end, (stances or {}).get(layer), idle, reports)
    known = {r.id for r in fresh}
    kept = tuple(r for r in plan.requests if r.id not in known)
    return Plan(plan.seed, end, layers, tuple(sorted(reports, key=lambda r: r.at)), kept + fresh)


def _meta(request: Request) -> MetaAction:
    length = WINDOW if request.duration is None else max(0.0, request.duration)
    return MetaAction(request, request.start, request.start + length)


def _extend_layer(
    project: Project,
    plan: Plan,
    layer: Layer,
    now: float,
    asked: list[MetaAction],
    end: float,
    stance: str | None,
    idle: bool,
    reports: list[Report],
) -> LayerPlan:
    graph = project.graphs[layer]
    old = plan.layers[layer]
    performer = Performer(project, graph, plan.seed, _begin(graph, old, stance) or "")
    if not performer.stance or not performer.begin():
        why = f"the {layer} layer has no stance with a loop to begin in"
        reports += [Report(m.request.id, "no-stance", why, layer, m.start) for m in asked]
        return LayerPlan(layer)
    kept = [cue for cue in old.cues if cue.start < now]
    if old.rests and now > 0:
        begun = {cue.end - cue.blend_out for cue in kept}
        performer.rests = [r for r in old.rests if r.fade_start < now or r.start in begun]
    for cue in kept:
        performer.cues.append(cue)
        performer.free, performer.stance = cue.end, cue.then
        count(performer.counts, performer.last, cue, project.settings.alpha)
    played = {cue.meta for cue in kept}
    future = [m for m in old.metas if m.start >= now and m.key not in played]
    if idle:
        future += [m for m in markov.write(markov.model(project, layer), plan.seed, end) if m.start >= max(plan.end, now)]
    replaced = {m.request.id for m in asked}
    metas = [m for m in future if m.request.id not in replaced] + asked
    floor = max(now, performer.free)
    placed, told = replan(metas, floor, project.settings)
    performer.free = floor
    performer.perform([m for m in placed if m.start < end])
    performer.vary_rests(end)
    reports += [*told, *performer.reports]
    done = tuple(m for m in old.metas if m.start < now or m.key in played)
    return LayerPlan(layer, done + tuple(placed), tuple(performer.cues), tuple(performer.rests))


def _begin(graph: MetaGraph, old: LayerPlan, stance: str | None) -> str | None:
    """Return the stance a layer begins in: as it did before, as asked, the graph's start, or the first that has a loop."""
    wishes = [old.rests[0].stance if old.rests else None, stance, graph.start, *graph.stances]
    return next((s for s in wishes if s is not None and s in graph.stances and graph.of(s, "stance")), None)
