"""Requests as a text for the clipboard: copied out of one performance, pasted into another, of another
project, too. What a project does not have by id is looked for by name; what it does not have at all is left
out and told.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph import requests as a
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.performances import ask_time, change_performance, move_requests
from metagraph.graph.model import LAYERS, Project

KIND, VERSION = "requests", 1
MOST = 100_000  # requests of one text


@dataclass(frozen=True)
class Pasted:
    """idents: of what was pasted. left_out: what could not be kept, in words."""

    project: Project
    idents: tuple[str, ...]
    left_out: tuple[str, ...]


def write_request_text(project: Project, performance: str, idents: Collection[str]) -> str:
    """Return some requests of a performance as a text, with the names of what they speak of."""
    chosen = [x for x in project.performances[performance].asks if x.id in idents]
    names = {x.id: name for x in chosen if (name := _name(project, x)) is not None}
    data = {"metagraph": KIND, "version": VERSION, "requests": msgspec.to_builtins(chosen), "names": names}
    return json.dumps(data, ensure_ascii=False, indent=1)


def holds_requests(text: str) -> bool:
    """Return whether a text may be one of requests."""
    return f'"metagraph": "{KIND}"' in text[:80]


def _name(project: Project, ask: a.AnyRequest) -> str | None:
    """Return what is called by an id in a request: an action's or a stance's name, a line's words."""
    if isinstance(ask, a.Play):
        found = project.action(ask.action)
        return found.name if found is not None else None
    if isinstance(ask, a.Go):
        stance = project.stance(ask.stance)
        return stance.name if stance is not None else None
    if isinstance(ask, a.Say) and ask.line is not None:
        line = project.lines.get(str(ask.line))
        return line.text if line is not None else None
    return None


def paste_requests(project: Project, performance: str, text: str, at: float) -> Pasted:
    """Add a text's requests to a performance, the first of them at a time, their gaps kept. Raises EditError
    for a text that is none.
    """
    try:
        data = json.loads(text)
        if data["metagraph"] != KIND or data["version"] > VERSION or len(data["requests"]) > MOST:
            raise ValueError
        asks = [a.make_request(x) for x in data["requests"]]
        names: dict[str, Any] = dict(data.get("names", {}))
    except (a.RequestError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise EditError(phrase("the clipboard contains no requests")) from None
    kept: list[a.AnyRequest] = []
    left_out: list[str] = []
    for ask in asks:
        there = _there(project, ask, names.get(ask.id), left_out)
        if there is not None:
            kept.append(msgspec.structs.replace(there, id="", told=None))
    before = project.performances[performance].asks
    project = change_performance(project, performance, asks=(*before, *kept))
    made = tuple(x.id for x in project.performances[performance].asks[len(before) :])
    if made:
        project = move_requests(project, performance, made, at - min(map(ask_time, kept)))
    return Pasted(project, made, tuple(dict.fromkeys(left_out)))


def _there(project: Project, ask: a.AnyRequest, name: object, left_out: list[str]) -> a.AnyRequest | None:
    """Return a request as this project can have it, None if it cannot."""
    if isinstance(ask, a.Play):
        found = project.action(ask.action)
        if found is not None and name in (None, found.name):
            return ask
        wanted = str(name or ask.action)
        same = [x for x in project.actions() if x.name == wanted]
        same.sort(key=lambda x: x.layer != ask.layer)
        if same:
            return msgspec.structs.replace(
                ask, action=same[0].id, layer=None if ask.layer is None else same[0].layer
            )
        left_out.append(f"action '{wanted}'")
        return None
    if isinstance(ask, a.Go):
        stance = project.stance(ask.stance)
        if stance is not None and name in (None, stance.name):
            return ask
        wanted = str(name or ask.stance)
        stances = [s for layer in LAYERS for s in project.graphs[layer].stances.values() if s.name == wanted]
        stances.sort(key=lambda s: s.layer != ask.layer)
        if stances:
            return msgspec.structs.replace(ask, stance=stances[0].id)
        left_out.append(f"stance '{wanted}'")
        return None
    if isinstance(ask, a.Say) and ask.line is not None:
        line = project.lines.get(str(ask.line))
        if line is not None and name in (None, line.text):
            return ask
        if name:  # its words can be said all the same
            left_out.append(f"the sound of line '{ask.line}'")
            return msgspec.structs.replace(ask, line=None, text=str(name))
        left_out.append(f"line '{ask.line}'")
        return None
    return ask
