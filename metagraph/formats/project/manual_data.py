"""Manual state machines as plain data and back: one line a state, one line an alias, one line a link."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from metagraph.formats.project.fields import (
    Data,
    DataError,
    decode_joint_weights,
    encode_joint_weights,
    fill_fields,
    list_changed_fields,
    read_items,
    refuse_unknown_fields,
    require_one_of,
    round_number,
)
from metagraph.graph.manual.machine import ANY, WHENS, Alias, Condition, Link, Manual, State
from metagraph.graph.words import LIMBS, Layer

_STATE_FIELDS = {f.name for f in fields(State)} - {"layer"}
_ALIAS_FIELDS = {f.name for f in fields(Alias)} - {"layer"}
_LINK_FIELDS = ({f.name for f in fields(Link)} | {f.name for f in fields(Condition)}) - {"condition"}


def encode_state(state: State) -> Data:
    return {
        **list_changed_fields(state, ("layer", "joint_weights")),
        **encode_joint_weights(state.joint_weights),
    }


def encode_alias(alias: Alias) -> Data:
    return list_changed_fields(alias, ("layer",))


def encode_link(link: Link) -> Data:
    """Return a link; its condition's fields stand beside its own."""
    return {**list_changed_fields(link, ("condition",)), **list_changed_fields(link.condition)}


def make_manual_data(manual: Manual) -> Data:
    """Return a layer's manual state machine."""
    aliases = {"aliases": [encode_alias(a) for a in manual.aliases.values()]} if manual.aliases else {}
    return {
        "start": manual.start,
        "any_x": round_number(manual.any_x),
        "any_y": round_number(manual.any_y),
        "states": [encode_state(s) for s in manual.states.values()],
        **aliases,
        "links": [encode_link(x) for x in manual.links.values()],
    }


def decode_manual(layer: Layer, data: Any, ids: set[str]) -> Manual:
    """Return a layer's manual state machine from data. ids: those taken already, added to. Raises
    DataError.
    """
    where = f"manual.{layer}"
    refuse_unknown_fields(data, [f.name for f in fields(Manual) if f.name != "layer"], where)
    states: dict[str, State] = {}
    for place, item in read_items(data, "states", where, ids):
        refuse_unknown_fields(item, _STATE_FIELDS, place)
        values = _with(State, item, place, ("id", "clip", "name"), ("layer", "joint_weights"))
        require_one_of(values.get("limb", "both"), LIMBS, f"{place}.limb")
        weights = decode_joint_weights(item, place)
        states[item["id"]] = State(layer=layer, joint_weights=weights, **values)
    aliases: dict[str, Alias] = {}
    for place, item in read_items(data, "aliases", where, ids):
        refuse_unknown_fields(item, _ALIAS_FIELDS, place)
        values = _with(Alias, item, place, ("id", "name"), ("layer",))
        for n, state in enumerate(values.get("states", ())):
            if state not in states:
                raise DataError(f"{place}.states[{n}]", f"'{state}' is not a state of the {layer} layer")
        if values.get("entry") is not None and values["entry"] not in states:
            raise DataError(f"{place}.entry", f"'{values['entry']}' is not a state of the {layer} layer")
        aliases[item["id"]] = Alias(layer=layer, **values)
    links: dict[str, Link] = {}
    for place, item in read_items(data, "links", where, ids):
        refuse_unknown_fields(item, _LINK_FIELDS, place)
        values = _with(Link, item, place, ("id", "source", "target"), ("condition",))
        for end, allowed in (("source", values["source"] == ANY), ("target", False)):
            if values[end] not in states and values[end] not in aliases and not allowed:
                raise DataError(f"{place}.{end}", f"'{values[end]}' is not a state of the {layer} layer")
        if not 0 <= (values.get("exit_part") or 0.0) <= 1:
            raise DataError(f"{place}.exit_part", f"should be between 0 and 1, found {values['exit_part']:g}")
        condition = fill_fields(Condition, item, place)
        require_one_of(condition.get("when", "finished"), WHENS, f"{place}.when")
        links[item["id"]] = Link(condition=Condition(**condition), **values)
    more = fill_fields(Manual, data, where, ("layer", "states", "links", "aliases"))
    if more.get("start") is not None and more["start"] not in states:
        raise DataError(f"{where}.start", f"'{more['start']}' is not a state of the {layer} layer")
    return Manual(layer, states, links, aliases=aliases, **more)


def _with(cls: Any, data: Data, where: str, needed: tuple[str, ...], skip: tuple[str, ...]) -> dict[str, Any]:
    values = fill_fields(cls, data, where, skip)
    for key in needed:
        if key not in values:
            raise DataError(f"{where}.{key}", "is missing")
    return values
