"""glTF with KHR_interactivity: a GLB that plays its stances of itself and its actions on custom events,
without a line of code.

Each layer's animations move the joints no later layer claims. Events: `<layer>.action.<state>`; what is asked
in another stance, or while an action plays, is passed over. `<layer>.stance.<stance>` goes there by the
shortest chain of transitions, once what plays is over. The layer's variables are `<layer>_stance` (number),
`<layer>_busy`, and `<layer>_goal`, 0 or the number of the stance to go to.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from metagraph.common.wording import phrase
from metagraph.engines.engine_machine import EngineState, Machine, list_machines, make_animations
from metagraph.engines.targets.losses import MACHINE, PROPS
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.formats.atomic import write_atomically
from metagraph.graph import anatomy
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import Layer, Part, Project

OWNERS: Mapping[Part, Layer] = {
    "legs": "body",
    "spine": "body",
    "arms": "arms",
    "head": "head",
    "face": "head",
}
TYPES = ("int", "float", "bool", "ref")


def find_joints_of_layers(project: Project, built: tuple[Machine, ...]) -> dict[Layer, list[int]]:
    """Return the joints each layer moves alone; those of a layer that has no machine go to the body, or the
    first there is.
    """
    there = [m.layer for m in built]
    out: dict[Layer, list[int]] = {layer: [] for layer in there}
    for joint, part in enumerate(anatomy.project_parts(project)):
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

    def variable(self, name: str, value: int = 0) -> int:
        self.variables.append({"name": name, "type": TYPES.index("int"), "value": [value]})
        return len(self.variables) - 1

    def event(self, name: str, called: str = "") -> int:
        self.events.append({"id": name, "extras": {"name": called}} if called else {"id": name})
        return len(self.events) - 1

    def set(self, variable: int, value: int) -> int:
        return self.node("variable/set", {"variables": [variable]}, **{f"_{variable}": ("int", value)})

    def equals(self, variable: int, value: int) -> int:
        return self.node(
            "math/eq", None, a=self.node("variable/get", {"variable": [variable]}), b=("int", value)
        )

    def start(self, state: EngineState, endless: int) -> int:
        end = endless if state.loop else ("float", self.seconds[state.name])
        return self.node(
            "animation/start",
            None,
            animation=("ref", f"/animations/{self.places[state.name]}"),
            startTime=("float", 0.0),
            endTime=end,
            speed=("float", 1.0),
        )

    def stop(self, state: EngineState) -> int:
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


def make_interactivity(
    built: tuple[Machine, ...], places: Mapping[str, int], seconds: Mapping[str, float]
) -> dict[str, Any]:
    """Return the KHR_interactivity object. places, seconds: of the animations, by state name."""
    graph = _Graph(places, seconds)
    endless = graph.node("math/Inf")
    begin = graph.node("event/onStart")
    last = (begin, "out")
    for machine in built:
        lane = _Lane(graph, machine, endless)
        first = graph.start(machine.start, endless)
        graph.flow(*last, first)
        last = (first, "out")
        for state in machine.states:
            if not state.loop:
                lane.action(state)
        lane.ways()
    return graph.document()


class _Lane:
    """What one layer hears and does. Flows lead to later nodes only, so each is made after what leads to it;
    to go on with a way it sends itself an event.
    """

    def __init__(self, graph: _Graph, machine: Machine, endless: int) -> None:
        self.graph, self.machine, self.endless = graph, machine, endless
        name = machine.layer
        self.stance = graph.variable(f"{name}_stance", machine.stances[machine.start.action.stance])
        self.busy, self.goal = (graph.variable(f"{name}_{x}") for x in ("busy", "goal"))
        self.go_on = graph.event(f"{name}.go_on")

    def action(self, state: EngineState) -> None:
        """Receive: if it is its stance and nothing plays, forget where to go, and play."""
        graph, here = self.graph, self.machine.stances[state.action.stance]
        name = f"{self.machine.layer}.action.{state.name}"
        heard = graph.node("event/receive", {"event": [graph.event(name, state.action.name)]})
        fits = graph.node("flow/branch", None, condition=graph.equals(self.stance, here))
        free = graph.node("flow/branch", None, condition=graph.equals(self.busy, 0))
        both = graph.node("flow/sequence")
        graph.flow(heard, "out", fits)
        graph.flow(fits, "true", free)
        graph.flow(free, "true", both)
        graph.flow(both, "0", graph.set(self.goal, 0))
        graph.flow(both, "1", self.play(state))

    def play(self, state: EngineState) -> int:
        """Return the node that stops the loop of the stance, plays, then the loop of the stance it ends in,
        and goes on with its way.
        """
        graph, machine = self.graph, self.machine
        here, there = state.action.stance, find_end_stance(state.action) or state.action.stance
        first = graph.node("flow/sequence")
        graph.flow(first, "0", graph.set(self.busy, 1))
        graph.flow(first, "1", graph.stop(machine.rest(here)))
        playing = graph.start(state, self.endless)
        graph.flow(first, "2", playing)
        then = graph.node("flow/sequence")
        graph.flow(playing, "done", then)
        graph.flow(then, "0", graph.set(self.stance, machine.stances[there]))
        graph.flow(then, "1", graph.set(self.busy, 0))
        graph.flow(then, "2", graph.start(machine.rest(there), self.endless))
        graph.flow(then, "3", graph.node("event/send", {"event": [self.go_on]}))
        return first

    def ways(self) -> None:
        """Receive where to go; whenever nothing plays, take the next transition that leads there."""
        graph, machine = self.graph, self.machine
        for ident, number in machine.stances.items():
            event = graph.event(
                f"{machine.layer}.stance.{machine.stance_words[ident]}", machine.graph.stances[ident].name
            )
            heard = graph.node("event/receive", {"event": [event]})
            both = graph.node("flow/sequence")
            graph.flow(heard, "out", both)
            graph.flow(both, "0", graph.set(self.goal, number))
            graph.flow(both, "1", graph.node("event/send", {"event": [self.go_on]}))
        heard = graph.node("event/receive", {"event": [self.go_on]})
        free = graph.node("flow/branch", None, condition=graph.equals(self.busy, 0))
        each = graph.node("flow/sequence")
        graph.flow(heard, "out", free)
        graph.flow(free, "true", each)
        for n, (here, number) in enumerate(machine.stances.items()):
            stands = graph.node("flow/branch", None, condition=graph.equals(self.stance, number))
            goals = graph.node("flow/sequence")
            graph.flow(each, f"{n:03}", stands)
            graph.flow(stands, "true", goals)
            hops: dict[str, list[int]] = {}  # the transition -> the branches that lead to it
            for goal, place in machine.stances.items():
                if (hop := machine.hop(here, goal)) is not None:
                    wanted = graph.node("flow/branch", None, condition=graph.equals(self.goal, place))
                    graph.flow(goals, f"{place:03}", wanted)
                    hops.setdefault(hop.name, []).append(wanted)
            for state in machine.states:
                if state.name in hops:
                    playing = self.play(state)
                    for wanted in hops[state.name]:
                        graph.flow(wanted, "true", playing)


def write(order: ExportOrder) -> ExportedFiles:
    """Write the GLB."""
    from metagraph.formats.gltf.writer import ForEngine, write_glb

    project, glb = order.project, order.folder / f"{order.stem}.glb"
    assert project.skeleton is not None
    built = list_machines(project)
    body, notes = find_ordered_mesh(order)
    order.tell(0, 2, "clips")
    clips = make_animations(project, built)
    joints = find_joints_of_layers(project, built)
    moved = {s.name: joints[m.layer] for m in built for s in m.states}
    chart = make_interactivity(
        built, {c.name: n for n, c in enumerate(clips)}, {c.name: c.duration for c in clips}
    )
    order.tell(1, 2, "graph")
    write_glb(
        glb,
        clips,
        body,
        engine=ForEngine(anatomy.get_base_pose(project), moved, {"KHR_interactivity": chart}),
    )
    events = order.folder / f"{order.stem}.events.json"
    names = {f"{m.layer}.action.{s.name}": s.action.name for m in built for s in m.states if not s.loop}
    for m in built:
        names |= {f"{m.layer}.stance.{word}": m.graph.stances[i].name for i, word in m.stance_words.items()}
    write_atomically(events, json.dumps(names, indent=1, ensure_ascii=False).encode())
    order.tell(2, 2, "done")
    return ExportedFiles((glb, events), notes)


TARGETS = (
    ExportTarget(
        "interactivity",
        "glTF + KHR_interactivity",
        phrase("one GLB that plays by itself, and a list of the events that it accepts"),
        write,
        (
            *MACHINE,
            PROPS,
            Loss(phrase("layers are not added: body, arms and head each move only their own joints")),
            Loss(phrase("no blends: each animation stops where the next one starts")),
        ),
    ),
)
