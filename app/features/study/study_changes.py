"""What an edit was about, by what it changed: one word for its kind, the names of the clips, the layer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import LAYERS, Project

WHATS = (
    "place",
    "stance",
    "link",
    "timing",
    "delete",
    "rename",
    "arrange",
    "import",
    "settings",
)  # the first that fits is the edit's


def describe_change(before: Project, after: Project) -> dict[str, Any]:
    """Return `what`, `clips` (names, in the order of the project) and, where it is one layer's, `layer`."""
    whats: set[str] = set()
    clips: dict[str, None] = {}
    layers: list[str] = []
    for layer in LAYERS:
        count = len(whats)
        old, new = before.graphs[layer], after.graphs[layer]
        if old is not new:
            whats |= _items(old.actions, new.actions, "place", clips)
            whats |= _items(old.stances, new.stances, "stance", {})
            if old.start != new.start or old.weights != new.weights:
                whats.add("settings")
        one, other = before.manual.get(layer), after.manual.get(layer)
        if one is not other:
            states, links = (one.states if one else {}), (one.links if one else {})
            new_states, new_links = (other.states if other else {}), (other.links if other else {})
            whats |= _items(states, new_states, "place", clips)
            ends: dict[str, None] = {}
            whats |= _items(links, new_links, "link", ends)
            whats |= _items(one.aliases if one else {}, other.aliases if other else {}, "link", {})
            known = {**states, **new_states}
            clips.update(dict.fromkeys(known[s].clip for s in ends if s in known))
        if len(whats) > count:
            layers.append(layer)
    if set(after.clips) - set(before.clips):
        whats.add("import")
    found = {**before.clips, **after.clips}
    names = [found[c].name for c in clips if c in found]
    out: dict[str, Any] = {
        "what": next((w for w in WHATS if w in whats), "settings"),
        "clips": list(dict.fromkeys(names)),
    }
    if len(layers) == 1:
        out["layer"] = layers[0]
    return out


_TIMES = ("timing", "start", "end", "loop", "exit_time", "blend")
_PLACES = ("x", "y")


def _items(old: Mapping[str, Any], new: Mapping[str, Any], added: str, clips: dict[str, None]) -> set[str]:
    """Return what was done to the items, and note the clips they use; of a link the states it joins."""
    if old is new:
        return set()
    out: set[str] = set()
    for ident, item in new.items():
        was = old.get(ident)
        if was is item or was == item:
            continue
        _note(item, clips)
        out.add(added if was is None else _difference(was, item))
    gone = [was for ident, was in old.items() if ident not in new]
    for was in gone:
        _note(was, clips)
    return out | ({"delete"} if gone else set())


def _note(item: Any, clips: dict[str, None]) -> None:
    if hasattr(item, "source"):
        clips.update(dict.fromkeys(s for s in (item.source, item.target) if s != ANY))
    elif hasattr(item, "clip"):
        clips[item.clip] = None


def _difference(was: Any, item: Any) -> str:
    """Return what is different about an item: its times alone, its name alone, where it stands, or more."""
    for what, names in (("timing", _TIMES), ("rename", ("name",)), ("arrange", _PLACES)):
        there = {n: getattr(item, n) for n in names if hasattr(item, n)}
        if there and replace(was, **there) == item:
            return what
    return "settings"
