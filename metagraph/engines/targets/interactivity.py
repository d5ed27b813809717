"""glTF with KHR_interactivity: a GLB that plays its stances of itself and its actions on custom events,
without a line of code.

Each layer's animations move the joints no later layer claims. Events: `<layer>.action.<state>`; what is asked
in another stance, or while an action plays, is passed over. The layer's variables are `<layer>_stance`
(number) and `<layer>_busy`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from metagraph.engines.engine_machine import Machine, State, animations, machines
from metagraph.engines.targets.losses import MACHINE
from metagraph.engines.targets.meshes import mesh_of
from metagraph.engines.targets.target import ExportOrder, ExportTarget, Loss, Made
from metagraph.formats.atomic import write_atomically
from metagraph.graph import anatomy
from metagraph.graph.expand import ends_in
from metagraph.graph.model import Layer, Part, Project

OWNERS: Mapping[Part, Layer] = {
    "legs": "body",
    "spine": "body",
    "arms": "arms",
    "head": "head",
    "face": "head",
}
TYPES = ("int", "float", "bool", "ref")


def owned(project: Project, built: tuple[Machine, ...]) -> dict[Layer, list[int]]:
    """Return the joints each layer moves alone; those of a layer that has no machine go to the body, or the
    first there is.
    """
    there = [m.layer for m in built]
    out: dict[Layer, list[int]] = {layer: [] for layer in there}
    for joint, part in enumerate(anatomy.parts(project)):
        owner = OWNERS[part] if OWNERS[part] in there else there[0]
        out[owner].append(joint)
    return out


class _Graph:
    """A behaviour graph being written."""

    def __init__(self, places: Mapping[str, int], seconds: Mapping[str, float]) -> None:
        self.places, self.seconds = places, seconds  # of animations, by name
        self.nodes: list[dict[str, Any]] = []
        self.declarations: list[str] = []
        self.variables: list[dict[str, Any]] = []
        self.events: list[dict[str, Any]] = []

    def node(self, op: str, configuration: Mapping[str, Any] | None = None, **values: Any) -> int:
        """Add a node; values: (type, constant), or the number of the node whose value it is."""
        if op not in self.declarations:
            self.declarations.append(op)
        node: dict[str, Any] = {"declaration": self.declarations.index(op)}
        if configuration:
            node["configuration"] = {key: {"value": value} for key, value in configuration.items()}
        if values:
            node["values"] = {key.strip("_"): _value(value) for key, value in values.items()}
        self.nodes.append(node)
        return len(self.nodes) - 1

    def flow(self, source: int, socket: str, target: int) -> None:
        self.nodes[source].setdefault("flows", {})[socket] = {"node": target, "socket": "in"}

    def variable(self, name: str) -> int:
        self.variables.append({"name": name, "type": TYPES.index("int"), "value": [0]})
        return len(self.variables) - 1

    def event(self, name: str) -> int:
        self.events.append({"id": name})
        return len(self.events) - 1

    def set(self, variable: int, value: int) -> int:
        return self.node("variable/set", {"variables": [variable]}, **{f"_{variable}": ("int", value)})

    def equals(self, variable: int, value: int) -> int:
        return self.node(
            "math/eq", None, a=self.node("variable/get", {"variable": [variable]}), b=("int", value)
        )

    def start(self, state: State, endless: int) -> int:
        end = endless if state.loop else ("float", self.seconds[state.name])
        return self.node(
            "animation/start",
            None,
            animation=("ref", f"/animations/{self.places[state.name]}"),
            startTime=("float", 0.0),
            endTime=end,
            speed=("float", 1.0),
        )

    def stop(self, state: State) -> int:
        return self.node("animation/stop", None, animation=("ref", f"/animations/{self.places[state.name]}"))

    def document(self) -> dict[str, Any]:
        graph = {
            "types": [{"signature": name} for name in TYPES],
            "variables": self.variables,
            "events": self.events,
            "declarations": [{"op": op} for op in self.declarations],
            "nodes": self.nodes,
        }
        return {"graphs": [graph], "graph": 0}


def _value(value: Any) -> dict[str, Any]:
    if isinstance(value, tuple):
        kind, constant = value
        return {"type": TYPES.index(kind), "value": [constant]}
    return {"node": value, "socket": "value"}


def behaviour(
    built: tuple[Machine, ...], places: Mapping[str, int], seconds: Mapping[str, float]
) -> dict[str, Any]:
    """Return the KHR_interactivity object. places, seconds: of the animations, by state name."""
    graph = _Graph(places, seconds)
    endless = graph.node("math/Inf")
    begin = graph.node("event/onStart")
    last = (begin, "out")
    for machine in built:
        stance, busy = graph.variable(f"{machine.layer}_stance"), graph.variable(f"{machine.layer}_busy")
        first = graph.start(machine.start, endless)
        graph.flow(*last, first)
        last = (first, "out")
        for state in machine.states:
            if not state.loop:
                _action(graph, machine, state, stance, busy, endless)
    return graph.document()


def _action(graph: _Graph, machine: Machine, state: State, stance: int, busy: int, endless: int) -> None:
    """Receive, if it is its stance and nothing plays: stop the loop, play, then the loop of the stance it
    ends in.
    """
    here, there = state.action.stance, ends_in(state.action) or state.action.stance
    heard = graph.node("event/receive", {"event": [graph.event(f"{machine.layer}.action.{state.name}")]})
    fits = graph.node("flow/branch", None, condition=graph.equals(stance, machine.stances[here]))
    free = graph.node("flow/branch", None, condition=graph.equals(busy, 0))
    graph.flow(heard, "out", fits)
    graph.flow(fits, "true", free)
    # Flows lead to later nodes only, so each is made after what leads to it.
    first = graph.node("flow/sequence")
    graph.flow(free, "true", first)
    graph.flow(first, "0", graph.set(busy, 1))
    graph.flow(first, "1", graph.stop(machine.rest(here)))
    playing = graph.start(state, endless)
    graph.flow(first, "2", playing)
    then = graph.node("flow/sequence")
    graph.flow(playing, "done", then)
    graph.flow(then, "0", graph.set(stance, machine.stances[there]))
    graph.flow(then, "1", graph.set(busy, 0))
    graph.flow(then, "2", graph.start(machine.rest(there), endless))


def write(order: ExportOrder) -> Made:
    """Write the GLB."""
    from metagraph.formats.gltf_writer import write_glb

    project, glb = order.project, order.folder / f"{order.stem}.glb"
    assert project.skeleton is not None
    built = machines(project)
    body, notes = mesh_of(order)
    order.tell(0, 2, "clips")
    clips = animations(project, built)
    joints = owned(project, built)
    moved = {s.name: joints[m.layer] for m in built for s in m.states}
    chart = behaviour(built, {c.name: n for n, c in enumerate(clips)}, {c.name: c.duration for c in clips})
    order.tell(1, 2, "graph")
    write_glb(
        glb,
        clips,
        body,
        stand=anatomy.base_pose(project),
        moved=moved,
        extensions={"KHR_interactivity": chart},
    )
    events = order.folder / f"{order.stem}.events.json"
    names = [f"{m.layer}.action.{s.name}" for m in built for s in m.states if not s.loop]
    write_atomically(events, json.dumps(names, indent=1).encode())
    order.tell(2, 2, "done")
    return Made((glb, events), notes)


TARGETS = (
    ExportTarget(
        "interactivity",
        "glTF + KHR_interactivity",
        "one GLB that plays by itself, and a list of the events it hears",
        write,
        (
            *MACHINE,
            Loss("layers do not add: body, arms and head each move their own joints alone"),
            Loss("no blends: one animation stops where the next begins"),
            Loss("a stance that needs several transitions is reached by asking for each of them in turn"),
        ),
    ),
)
