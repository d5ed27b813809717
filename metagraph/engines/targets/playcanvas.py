"""PlayCanvas: an AnimStateGraph, loaded by the engine as it is. Animations are bound by the states' names.

Parameters, for each layer: the integers `<layer>_stance` and `<layer>_action`, and the trigger
`<layer>_play`, see `metagraph.engines.engine_machine`. The body overwrites; arms and head add to the pose of
the GLB's nodes, which is the base pose.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from metagraph.common.wording import phrase
from metagraph.engines.engine_machine import Arrow, Machine, list_machines, write_machine_glb
from metagraph.engines.targets.losses import CROSSFADE, MACHINE, WEIGHTS
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget
from metagraph.formats.atomic import write_atomically
from metagraph.formats.gltf.writer import SCENE
from metagraph.graph.model import Project


def make_anim_state_graph(project: Project, built: tuple[Machine, ...]) -> dict[str, Any]:
    """Return the AnimStateGraph."""
    parameters: dict[str, Any] = {}
    for machine in built:
        begin = machine.stances[machine.start.action.stance]
        for word, kind, value in (
            ("stance", "INTEGER", begin),
            ("action", "INTEGER", 0),
            ("play", "TRIGGER", False),
        ):
            name = f"{machine.layer}_{word}"
            parameters[name] = {"name": name, "type": kind, "value": value}
    return {"layers": [_layer(project, machine) for machine in built], "parameters": parameters}


def _layer(project: Project, machine: Machine) -> dict[str, Any]:
    assert project.skeleton is not None
    states: list[dict[str, Any]] = [{"name": "START"}]
    states += [{"name": s.name, "speed": 1, "loop": s.loop} for s in machine.states]
    transitions: list[dict[str, Any]] = [
        {"from": "START", "to": machine.start.name, "time": 0, "priority": 0}
    ]
    for arrow in machine.arrows:
        transitions += _transitions(machine, arrow)
    return {
        "name": machine.layer,
        "blendType": "OVERWRITE" if machine.layer == "body" else "ADDITIVE",
        "weight": 1,
        "states": states,
        "transitions": transitions,
        "mask": {path: {"children": False} for joint in machine.joints for path in _paths(project, joint)},
    }


def _paths(project: Project, joint: str) -> Iterator[str]:
    """Yield a joint's path from the root joint down, as PlayCanvas names entities, and the same from the
    scene, where there is a mesh.
    """
    skeleton = project.skeleton
    assert skeleton is not None
    place, names = skeleton.index(joint), [joint]
    while (place := int(skeleton.parents[place])) >= 0:
        names.append(skeleton.names[place])
    path = "/".join(reversed(names))
    yield from (path, f"{SCENE}/{path}")


def _transitions(machine: Machine, arrow: Arrow) -> Iterator[dict[str, Any]]:
    """Yield an arrow's transitions: one for each value, since all of a transition's conditions must hold."""
    whole: dict[str, Any] = {
        "from": arrow.source.name,
        "to": arrow.target.name,
        "time": round(arrow.blend, 4),
    }
    if arrow.leave is not None and arrow.source.seconds > 0:
        whole["exitTime"] = round(min(0.999, arrow.leave / arrow.source.seconds), 4)
    layer = machine.layer
    if arrow.on == "done":
        yield {**whole, "priority": 2}
    for value in arrow.values:
        conditions = [{"parameterName": f"{layer}_{arrow.on}", "predicate": "EQUAL_TO", "value": value}]
        if arrow.on == "action":
            conditions.append({"parameterName": f"{layer}_play", "predicate": "EQUAL_TO", "value": True})
        yield {**whole, "priority": 0 if arrow.on == "action" else 1, "conditions": conditions}


def write(order: ExportOrder) -> ExportedFiles:
    """Write the state graph, a guide to its numbers, and the GLB."""
    built = list_machines(order.project)
    graph, glb = order.folder / f"{order.stem}.animstategraph.json", order.folder / f"{order.stem}.glb"
    body, notes = find_ordered_mesh(order)
    order.tell(0, 2, "clips")
    notes += write_machine_glb(order.project, built, glb, body, order.contents.base)
    order.tell(1, 2, "graph")
    write_atomically(
        graph, json.dumps(make_anim_state_graph(order.project, built), indent=1, ensure_ascii=False).encode()
    )
    numbers = order.folder / f"{order.stem}.numbers.json"
    write_atomically(
        numbers, json.dumps(write_playcanvas_guide(built), indent=1, ensure_ascii=False).encode()
    )
    order.tell(2, 2, "done")
    return ExportedFiles((graph, numbers, glb), notes)


def write_playcanvas_guide(built: tuple[Machine, ...]) -> dict[str, Any]:
    """Return which number stands for which action and stance, and what each state's action is called."""
    return {
        machine.layer: {
            "stance": {
                machine.graph.stances[ident].name: number for ident, number in machine.stances.items()
            },
            "action": {state.name: state.number for state in machine.states},
            "names": {state.name: state.action.name for state in machine.states},
        }
        for machine in built
    }


TARGETS = (
    ExportTarget(
        "playcanvas", "PlayCanvas (AnimStateGraph)",
        phrase("a state graph, the numbers of its actions and stances, and one GLB with an "
        "animation for each state"),
        write, (*MACHINE, WEIGHTS, CROSSFADE),
    ),
)  # fmt: skip
