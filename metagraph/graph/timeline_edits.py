"""Read and change the markers, cuts and other notes on a project's timelines."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import fields, replace
from typing import Any

import msgspec

from metagraph.graph import ids
from metagraph.graph import requests as a
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.graph.timeline import Lane, Marker, Timeline
from metagraph.graph.words import LAYERS


def get_timeline(project: Project, key: str) -> Timeline:
    """Return the timeline of a performance or conversation, by its id; an empty one if nothing is noted."""
    return project.timelines.get(key) or Timeline()


def change_timeline(project: Project, key: str, **changes: Any) -> Project:
    """Set fields of a timeline. One that has only defaults is removed. Raises EditError for values out of
    range.
    """
    before = get_timeline(project, key)
    if "markers" in changes:
        changes["markers"] = tuple(sorted(changes["markers"], key=lambda m: m.at))
    if "cuts" in changes:
        changes["cuts"] = tuple(sorted(changes["cuts"], key=lambda c: c.at))
    try:
        after = msgspec.convert(msgspec.to_builtins(msgspec.structs.replace(before, **changes)), Timeline)
    except (ValueError, TypeError) as error:  # msgspec raises ValueErrors
        raise EditError(str(error)) from None
    if after == before:
        return project
    kept = {k: t for k, t in project.timelines.items() if k != key}
    if after != Timeline():
        kept[key] = after
    return replace(project, timelines=kept)


def add_marker(project: Project, key: str, at: float, name: str = "") -> tuple[Project, str]:
    """Add a marker at a time, in seconds; return the project and the marker's id. A marker that is less than
    5 ms away is returned instead.
    """
    before = get_timeline(project, key).markers
    there = next((m for m in before if abs(m.at - at) < 0.005), None)
    if there is not None:
        return project, there.id
    at = round(max(0.0, at), 3)
    marker = Marker(id=ids.make_id(project, "m", key, at), at=at, name=name)
    return change_timeline(project, key, markers=(*before, marker)), marker.id


def change_marker(project: Project, key: str, ident: str, **changes: Any) -> Project:
    """Set a marker's name or time."""
    markers = tuple(
        msgspec.structs.replace(m, **changes) if m.id == ident else m
        for m in get_timeline(project, key).markers
    )
    return change_timeline(project, key, markers=markers)


def remove_markers(project: Project, key: str, idents: Collection[str]) -> Project:
    markers = tuple(m for m in get_timeline(project, key).markers if m.id not in idents)
    return change_timeline(project, key, markers=markers)


def remove_timeline(project: Project, key: str) -> Project:
    """Remove the timeline of something that is removed."""
    if key not in project.timelines:
        return project
    return replace(project, timelines={k: t for k, t in project.timelines.items() if k != key})


def differs_only_in_timeline(before: Project, after: Project) -> bool:
    """Return whether two states of a project differ, and only in their timelines."""
    same = (f.name for f in fields(before) if f.name != "timelines")
    return before.timelines is not after.timelines and all(
        getattr(before, n) is getattr(after, n) for n in same
    )


def find_lane(ask: a.AnyRequest, project: Project) -> Lane:
    """Return the lane that a request is in: its layer, or the stage."""
    match ask:
        case a.Gesture() | a.Fidget() | a.Change():
            return ask.layer
        case a.Nod() | a.Shake():
            return "head"
        case a.Play():
            found = project.action(ask.action) or next(
                (x for x in project.actions() if x.name == ask.action), None
            )
            return ask.layer or (found.layer if found is not None else "arms")
        case a.Go():
            if ask.layer is not None:
                return ask.layer
            stances = ((layer, s) for layer in LAYERS for s in project.graphs[layer].stances.values())
            return next((layer for layer, s in stances if ask.stance in (s.id, s.name)), "arms")
    return "stage"
