"""The planner: requests at any level in, a plan of specific actions out.

Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from
nothing and extending a running plan are the same function; `make_plan` extends an empty plan at time 0.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from metagraph.graph.model import LAYERS, Layer, MetaGraph, Project
from metagraph.playback import markov
from metagraph.playback.life.schedule import schedule
from metagraph.playback.plan import TEMPORAL, Cursor, LayerPlan, MetaAction, MetaRequest, Plan, Report
from metagraph.playback.replan import delay, replan
from metagraph.playback.sampling import FITS, performer_after

WINDOW = 1.0  # seconds a request may use when it does not say how long


def make_plan(
    project: Project,
    end: float,
    requests: Iterable[MetaRequest] = (),
    seed: int | None = None,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
) -> Plan:
    """Plan from 0 to `end` seconds.

    seed: 32-bit, the project's when None. stances: where layers begin, each layer's start stance when not
    given. idle: let the Markov model fill the time nobody asks for. A layer without a stance that has a loop
    stays still.
    """
    empty = Plan(project.settings.seed if seed is None else seed, 0.0)
    return extend(project, empty, 0.0, requests, end, stances, idle)


def extend(
    project: Project,
    plan: Plan,
    now: float,
    requests: Iterable[MetaRequest],
    end: float,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
    withdrawn: frozenset[str] = frozenset(),
    leave: Collection[Layer] = (),
) -> Plan:
    """Return the plan with new requests worked in, others withdrawn, and the horizon moved to `end`.

    What starts before `now` stays exactly as it was. What was planned for later is taken back to its meta
    actions, merged with the new ones and planned again. An extension in many steps gives what one in a single
    step does. leave: layers that are planned to `end` already and that nothing new concerns; planning them
    again would change nothing.
    """
    fresh = tuple({r.id: r for r in requests}.values())  # of two with one id the later counts
    again = {r.id for r in fresh} | withdrawn
    layers: dict[Layer, LayerPlan] = {}
    reports: list[Report] = []
    for layer in LAYERS:
        if layer in leave:
            layers[layer] = plan.layers[layer]
            reports += [r for r in plan.reports if r.layer == layer and r.request not in again]
            continue
        asked = [_meta(r) for r in fresh if r.layer == layer]
        begin = _begin(project.graphs[layer], plan.layers[layer], (stances or {}).get(layer))
        layers[layer], told = _extend_layer(project, plan, layer, now, asked, again, end, begin, idle)
        reports += told
    kept = tuple(r for r in plan.requests if r.id not in again)
    life = schedule(project.life, plan.track, project.voices, plan.seed, end, plan.life, now)
    return Plan(
        plan.seed, end, layers, tuple(sorted(reports, key=lambda r: r.at)), kept + fresh, plan.track, life
    )


def _meta(request: MetaRequest) -> MetaAction:
    length = WINDOW if request.duration is None else max(0.0, request.duration)
    if request.stroke is not None:
        length = max(length, request.stroke - request.start + FITS)
    return MetaAction(request, request.start, request.start + length)


def _extend_layer(
    project: Project,
    plan: Plan,
    layer: Layer,
    now: float,
    asked: list[MetaAction],
    again: set[str],
    end: float,
    begin: str | None,
    idle: bool,
) -> tuple[LayerPlan, list[Report]]:
    """Return a layer's plan and its reports, old and new. again: requests that replace what was asked
    before.
    """
    graph, old = project.graphs[layer], plan.layers[layer]
    kept = [cue for cue in old.cues if cue.start < now]
    played = {cue.meta for cue in kept}
    waiting = {cue.meta for cue in old.cues[len(kept) :]}  # also those whose chain of transitions has begun
    written, cursor = _written(project, plan, layer, now, end) if idle else ((), old.cursor)
    again = again | {m.request.id for m in written}
    future = [
        m
        for m in old.metas
        if m.request.id not in again and (m.key in waiting or (m.start >= now and m.key not in played))
    ]
    # What was told about time still holds; the rest will be told again by those that are planned again.
    planned_again = {(m.request.id, m.start) for m in future}
    done = tuple(
        m
        for m in old.metas
        if m.request.id not in again
        and (m.request.id, m.start) not in planned_again
        and (m.key in played or m.start < now)
    )
    reports = [
        r
        for r in plan.reports
        if r.layer == layer
        and r.request not in again
        and (r.outcome in TEMPORAL or (r.request, r.at) not in planned_again)
    ]
    performer = performer_after(project, graph, plan.seed, begin or "", old.past, kept)
    if not begin or not performer.begin(begin):
        why = f"the {layer} layer has no stance with a loop to begin in"
        reports += [
            Report(m.request.id, "no-stance", why, layer, m.start) for m in (*future, *asked) if not m.written
        ]
        return LayerPlan(
            layer, (*done, *future, *asked), past=old.past, cursor=cursor, written=written
        ), reports
    if old.rests and now > 0:
        begun = {cue.end - cue.blend_out for cue in kept}
        performer.rests = [r for r in old.rests if r.fade_start < now or r.start in begun]
    performer.begun = frozenset(played & waiting)
    performer.free = max(now - (performer.ready - performer.free), performer.free)
    asked, delayed = delay(asked, performer.ready, project.settings)
    busy = max(
        (m.end for m in done if not m.written), default=float("-inf")
    )  # what runs keeps the time it was wanted for, from the models
    placed, told = replan([*future, *written, *asked], project.settings, busy)
    performer.perform(
        [m for m in placed if not m.written or _performed(project, plan, layer, m)],
        end,
    )
    performer.vary_rests(end)
    whole = LayerPlan(
        layer, (*done, *placed), tuple(performer.cues), tuple(performer.rests), old.past, cursor, written
    )
    return whole, [*reports, *delayed, *told, *performer.reports]


def _performed(project: Project, plan: Plan, layer: Layer, meta: MetaAction) -> bool:
    """Whether what a model wrote is performed: not where it would leave a stance that was asked for, to stay
    in, and as often as its mode says.
    """
    if meta.request.kind == "transition" and plan.track.stays_at(layer, meta.start):
        return False
    return markov.performs(markov.model(project, layer), plan.seed, meta, plan.track.told_mode(meta.start))


def _written(
    project: Project, plan: Plan, layer: Layer, now: float, end: float
) -> tuple[tuple[MetaAction, ...], Cursor]:
    """Return what the layer's model writes from `now` to `end`, as it wrote it, and where it writes on."""
    old = plan.layers[layer]
    kinds = {kind for _, kind in project.graphs[layer].index}
    more, cursor = markov.write(markov.model(project, layer), plan.seed, end, kinds, old.cursor)
    return tuple(m for m in (*old.written, *more) if m.start >= now), cursor


def _begin(graph: MetaGraph, old: LayerPlan, stance: str | None) -> str | None:
    """Return the stance a layer begins in: as it did before, as asked, the graph's start, or the first that
    has a loop.
    """
    wishes = [
        old.past.stance,
        old.rests[0].stance if old.rests else None,
        stance,
        graph.start,
        *graph.stances,
    ]
    return next((s for s in wishes if s is not None and s in graph.stances and graph.of(s, "stance")), None)
