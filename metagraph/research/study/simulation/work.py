"""Work to simulate: a machine drawn by hand that does what a meta-graph does, and slips of the kinds people
make.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from metagraph.graph import edits, ids
from metagraph.graph.expand import list_connections
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import Condition, Link, Manual, State
from metagraph.graph.model import LAYERS, Action, Project

WIDE, HIGH, COLUMNS = 216.0, 88.0, 6  # how states lie in the editor


def draw_every_connection(project: Project) -> Project:
    """Return the project with a link drawn by hand for every connection its meta-graph stands for, and
    without the meta-graph's actions.
    """
    out = replace(edits.remove_actions(project, [a.id for a in project.actions()]), manual={})
    for layer in LAYERS:
        actions = project.graphs[layer].actions
        if not actions:
            continue
        states = {
            a.id: State(
                a.id,
                a.clip,
                a.name,
                layer,
                a.kind == "stance" or a.timing.loop,
                *project.span(a),
                a.limb,
                a.joints,
                n % COLUMNS * WIDE,
                n // COLUMNS * HIGH,
                joint_weights=a.joint_weights,
            )
            for n, a in enumerate(actions.values())
        }
        links: dict[str, Link] = {}
        for c in list_connections(project, project.graphs[layer]):
            ident = ids.make_id(out, "l", layer, c.source, c.target, more=links)
            leave = c.leave
            if leave is not None and leave >= project.span(actions[c.source])[1]:
                leave = max(
                    0.0, leave - c.blend
                )  # both run on while it blends, so it begins that much sooner
            links[ident] = Link(
                ident, c.source, c.target, _condition(actions[c.source], actions[c.target]), leave, c.blend
            )
        out = out.with_manual(Manual(layer, states, links, next(iter(states))))
    return out


def _condition(source: Action, target: Action) -> Condition:
    if target.kind == "fidget" or (target.kind == "stance" and source.kind != "stance"):
        return Condition()
    return Condition("request", target.name)


# --- slips


def make_slips(project: Project, manual: bool, slips: int, rng: np.random.Generator) -> Project:
    """Return the project with some slips: by hand links that were forgotten or lead elsewhere, in a
    meta-graph clips on the wrong node or stance, in both times that are off.
    """
    for _ in range(slips):
        project = _slip_by_hand(project, rng) if manual else _slip(project, rng)
    return project


def _slip_by_hand(project: Project, rng: np.random.Generator) -> Project:
    machine = next((m for m in project.manual.values() if m.links), None)
    if machine is None:
        return project
    link = _any(list(machine.links.values()), rng)
    sort = int(rng.integers(4))
    if sort < 2:
        return manual_edits.remove_states(project, links=[link.id])
    if sort == 2:
        target = _any(list(machine.states), rng)
        return project.with_manual(
            replace(machine, links={**machine.links, link.id: replace(link, target=target)})
        )
    state = _any(list(machine.states.values()), rng)
    return manual_edits.update_states(project, [state.id], start=round(state.start + 0.3, 3))


def _slip(project: Project, rng: np.random.Generator) -> Project:
    actions = [a for a in project.actions() if a.kind in ("gesture", "fidget")]
    if not actions:
        return project
    action = _any(actions, rng)
    sort = int(rng.integers(3))
    if sort == 0:
        return edits.move_actions(
            project, [action.id], "fidget" if action.kind == "gesture" else "gesture", action.stance
        )
    if sort == 1:
        return edits.move_actions(
            project, [action.id], action.kind, _any(list(project.graphs[action.layer].stances), rng)
        )
    return edits.update_actions(project, [action.id], timing={"start": round(action.timing.start + 0.3, 3)})


def _any(some: list[Any], rng: np.random.Generator) -> Any:
    return some[int(rng.integers(len(some)))]
