"""Make a plan of specific actions from requests at any level.

Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from
nothing and extending a running plan are the same function; `make_plan` extends an empty plan at time 0.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.playback.life.near_life import with_past
from metagraph.playback.life.schedule import schedule
from metagraph.playback.life.wanted import moods_of
from metagraph.playback.plan import LayerPlan, MetaRequest, Plan, Report
from metagraph.playback.planning import markov
from metagraph.playback.planning.layer_planning import draft
from metagraph.playback.planning.plan_head import find_plan_head, keep_head, share_layer
from metagraph.playback.planning.strand import join_sequence


@dataclass(frozen=True)
class Revision:
    """Other changes to a plan that is extended.

    `withdrawn` has the ids of requests that are withdrawn, `stopped` those of them whose running action is
    left, too. `leave` has the layers that are planned to the end
    already and that no new request concerns; planning them again would change nothing.
    """

    withdrawn: frozenset[str] = frozenset()
    stopped: frozenset[str] = frozenset()
    leave: Collection[Layer] = ()


NOTHING_ELSE = Revision()


def make_plan(
    project: Project,
    end: float,
    requests: Iterable[MetaRequest] = (),
    seed: int | None = None,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
) -> Plan:
    """Plan from 0 to `end` seconds.

    `seed` has 32 bits; None takes the project's. `stances` says where layers begin; others begin in their
    start stance. With `idle`, the Markov model fills the time without requests. A layer whose stances have no
    loop stays still.
    """
    empty = Plan(project.settings.seed if seed is None else seed, 0.0)
    return extend_plan(project, empty, 0.0, requests, end, stances, idle)


def extend_plan(
    project: Project,
    plan: Plan,
    now: float,
    requests: Iterable[MetaRequest],
    end: float,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
    revision: Revision = NOTHING_ELSE,
) -> Plan:
    """Return the plan with new requests added, others withdrawn, and the horizon moved to `end`.

    What starts before `now` stays exactly as it was. What was planned for later is taken back to its meta
    actions, merged with the new ones and planned again. Many small extensions give the same plan as a single
    one.
    """
    fresh = tuple({r.id: r for r in requests}.values())  # of two requests with one id, the later one counts
    again = {r.id for r in fresh} | revision.withdrawn
    layers: dict[Layer, LayerPlan] = {}
    reports: list[Report] = []
    moods = moods_of(project.life, plan.track)
    head = find_plan_head(project, plan, now, again)
    told = plan.reports if head is None else plan.reports[head.reports :]
    for layer in LAYERS:
        old = plan.layers[layer]
        if layer in revision.leave:
            layers[layer] = old
            reports += [r for r in told if r.layer == layer and r.request not in again]
            continue
        graph, chain = project.graphs[layer], markov.model(project, layer)
        stance = (stances or {}).get(layer)
        drafted = draft(
            project, graph, chain if idle else None, {kind for _, kind in graph.index},
            old if head is None else head.rest(old), told, plan.seed, now, fresh, again,
            revision.stopped, end, stance, moods, plan.track,
        )  # fmt: skip
        made = drafted.performed(drafted.placed, end)
        layers[layer] = share_layer(made) if head is None else head.whole(old, made)
        reports += drafted.reports
    kept = tuple(r for r in plan.requests if r.id not in again) if again else plan.requests
    near = plan.life if head is None else plan.life.since(head.end)
    grown = schedule(project.life, plan.track, project.voices, plan.seed, end, near, now)
    every = join_sequence(
        plan.reports, 0 if head is None else head.reports, sorted(reports, key=lambda r: r.at)
    )
    life = with_past(plan.life, near, grown)
    out = Plan(plan.seed, end, layers, every, kept + fresh, plan.track, life)
    if head is not None:
        keep_head(out, head)
    return out
