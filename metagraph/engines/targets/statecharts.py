"""State charts: XState's JSON and W3C SCXML. They decide; whoever runs them plays the animations they name.

Each layer is a region. Events ask: `<layer>.action.<state>` for an action, `<layer>.stance.<stance>` for a
stance. An action ends, and may be left, by the clock.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree as Xml

from metagraph.common.wording import phrase
from metagraph.common.xml_text import clean_xml_text
from metagraph.engines.engine_machine import Arrow, EngineState, Machine, list_machines, write_machine_glb
from metagraph.engines.engine_names import write_word
from metagraph.engines.targets.losses import MACHINE
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.formats.atomic import write_atomically

HOST = Loss(
    phrase(
        "the chart only decides: your program plays each state's animation, blends for the "
        "time that the arrow gives, and adds the layers"
    )
)
FORGETFUL = Loss(phrase("a request is forgotten if it comes while the playing action cannot exit yet"))
TOLD = Loss(
    phrase(
        "a request is reported as missed and forgotten if it comes while the playing action cannot exit yet"
    )
)


def _events(machine: Machine, arrow: Arrow) -> Iterator[str]:
    """Yield the events that take an arrow."""
    if arrow.on == "action":
        yield f"{machine.layer}.action.{arrow.target.name}"
    elif arrow.on == "stance":
        words = {number: machine.stance_words[ident] for ident, number in machine.stances.items()}
        yield from (f"{machine.layer}.stance.{words[value]}" for value in arrow.values)


def _ends(machine: Machine, state: EngineState) -> tuple[Arrow | None, float]:
    """Return the arrow that leaves an action of itself, and the seconds from which others may be taken."""
    done = next((a for a in machine.leaving[state.name] if a.on == "done"), None)
    others = [a.leave or 0.0 for a in machine.leaving[state.name] if a.on != "done"]
    return done, min(others, default=0.0) if done is not None else 0.0


def make_xstate(name: str, built: tuple[Machine, ...]) -> dict[str, Any]:
    """Return the machine as XState 5's `createMachine` takes it. The action `play` says what to play, from
    the loops it begins with on; `missed`, which layer was asked for what cannot be taken up now.
    """
    return {"id": name, "type": "parallel", "states": {machine.layer: _region(machine) for machine in built}}


def _play(state: EngineState, blend: float) -> dict[str, Any]:
    return {
        "type": "play",
        "params": {"animation": state.name, "blend": round(blend, 4), "loop": state.loop},
    }


def _region(machine: Machine) -> dict[str, Any]:
    start = machine.start
    return {
        "initial": {"target": start.name, "actions": [_play(start, 0.0)]},
        "on": {f"{machine.layer}.*": {"actions": [{"type": "missed", "params": {"layer": machine.layer}}]}},
        "states": {state.name: _node(machine, state) for state in machine.states},
    }


def _node(machine: Machine, state: EngineState) -> dict[str, Any]:
    done, leave = _ends(machine, state)
    events: dict[str, Any] = {}
    for arrow in machine.leaving[state.name]:
        for event in _events(machine, arrow):
            events.setdefault(
                event, {"target": f"#{arrow.target.name}", "actions": [_play(arrow.target, arrow.blend)]}
            )
    node: dict[str, Any] = {
        "id": state.name,
        "meta": {
            "animation": state.name,
            "loop": state.loop,
            "kind": state.action.kind,
            "name": state.action.name,
        },
    }
    if done is None:
        return {**node, "on": events}
    end = done.leave or 0.0
    over = {"target": f"#{done.target.name}", "actions": [_play(done.target, done.blend)]}
    if leave >= end:
        return {**node, "after": {_ms(end): over}}
    free = {"after": {_ms(end - leave): over}, "on": events}
    return {**node, "initial": "bound", "states": {"bound": {"after": {_ms(leave): "free"}}, "free": free}}


def _ms(seconds: float) -> str:
    return str(max(1, round(seconds * 1000)))


NAMESPACE, OURS = "http://www.w3.org/2005/07/scxml", "urn:metagraph:scxml"


def make_scxml(name: str, built: tuple[Machine, ...]) -> bytes:
    """Return the machine as SCXML 1.0 with the null data model; attributes of our own name animation, loop,
    blend and the action.
    """
    Xml.register_namespace("", NAMESPACE)
    Xml.register_namespace("metagraph", OURS)
    root = _tag(None, "scxml", version="1.0", name=write_word(name), datamodel="null", initial="layers")
    every = _tag(root, "parallel", id="layers")
    for machine in built:
        region = _tag(every, "state", id=machine.layer, initial=machine.start.name)
        for state in machine.states:
            _state(region, machine, state)
    Xml.indent(root, " ")
    text: str = Xml.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


def _tag(parent: Xml.Element | None, tag: str, **attributes: str) -> Xml.Element:
    named = {
        (f"{{{OURS}}}{key[3:]}" if key.startswith("my_") else key): value for key, value in attributes.items()
    }
    if parent is None:
        return Xml.Element(f"{{{NAMESPACE}}}{tag}", named)
    return Xml.SubElement(parent, f"{{{NAMESPACE}}}{tag}", named)


def _state(region: Xml.Element, machine: Machine, state: EngineState) -> None:
    done, leave = _ends(machine, state)
    end = (done.leave or 0.0) if done is not None else 0.0
    bound = done is not None and leave > 0
    own = {"my_animation": state.name, "my_loop": str(state.loop).lower(), "my_name": state.action.name}
    node = _tag(region, "state", id=state.name, **{key: clean_xml_text(text) for key, text in own.items()})
    taking = node
    if bound and leave < end:
        node.set("initial", f"{state.name}.bound")
        waiting = _tag(node, "state", id=f"{state.name}.bound")
        taking = _tag(node, "state", id=f"{state.name}.free")
        _timer(waiting, f"{state.name}.leave", leave)
        _tag(waiting, "transition", event=f"{state.name}.leave", target=f"{state.name}.free")
    if done is not None:
        _timer(node, f"{state.name}.done", end)
        _tag(
            node,
            "transition",
            event=f"{state.name}.done",
            target=done.target.name,
            my_blend=f"{done.blend:.4g}",
        )
    if bound and leave >= end:
        return
    for arrow in machine.leaving[state.name]:
        events = " ".join(_events(machine, arrow))
        if events:
            _tag(taking, "transition", event=events, target=arrow.target.name, my_blend=f"{arrow.blend:.4g}")


def _timer(node: Xml.Element, event: str, seconds: float) -> None:
    """Send an event after some seconds, unless the state is left before."""
    entry, leaving = Xml.Element(f"{{{NAMESPACE}}}onentry"), Xml.Element(f"{{{NAMESPACE}}}onexit")
    _tag(entry, "send", event=event, id=event, delay=f"{max(1, round(seconds * 1000))}ms")
    _tag(leaving, "cancel", sendid=event)
    node.insert(0, entry)
    node.insert(1, leaving)


def _write(order: ExportOrder, suffix: str, text: bytes, built: tuple[Machine, ...]) -> ExportedFiles:
    chart, glb = order.folder / f"{order.stem}.{suffix}", order.folder / f"{order.stem}.glb"
    body, notes = find_ordered_mesh(order)
    order.tell(0, 2, "clips")
    notes += write_machine_glb(order.project, built, glb, body, order.contents.base)
    order.tell(1, 2, "chart")
    write_atomically(chart, text)
    order.tell(2, 2, "done")
    return ExportedFiles((chart, glb), notes)


def write_xstate(order: ExportOrder) -> ExportedFiles:
    built = list_machines(order.project)
    text = json.dumps(make_xstate(order.stem, built), indent=1, ensure_ascii=False)
    return _write(order, "xstate.json", text.encode(), built)


def write_scxml(order: ExportOrder) -> ExportedFiles:
    built = list_machines(order.project)
    return _write(order, "scxml", make_scxml(order.stem, built), built)


TARGETS = (
    ExportTarget(
        "xstate",
        "XState (JSON)",
        phrase("one state chart for XState 5, and one GLB with an animation for each state"),
        write_xstate,
        (*MACHINE, HOST, TOLD),
    ),
    ExportTarget(
        "scxml",
        "SCXML",
        phrase("one W3C state chart, and one GLB with an animation for each state"),
        write_scxml,
        (*MACHINE, HOST, FORGETFUL),
    ),
)
