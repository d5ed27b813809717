"""The times of an action as handles that are moved: where each stands, and which fields a move changes. What
plots show and what numbers are typed go by the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from metagraph.graph import edits
from metagraph.graph.model import Action, Project
from metagraph.playback.phases import phases

HANDLES = ("start", "end", "in", "out", "exit", "stroke", "ready", "hold", "relax")
PHASES = ("ready", "hold", "relax")  # handles of a gesture's phases
MOMENTS = ("earliest_exit", "ready", "stroke", "stroke_end", "relax")  # of Timing, seconds of the clip
BANDS = ("prepare", "stroke", "hold", "retract")
FIELDS = {
    "start": "start",
    "end": "end",
    "blend_in": "in",
    "blend_out": "out",
    "earliest_exit": "exit",
    "stroke": "stroke",
}  # of Timing, by the handle that stands for each


def times_of(project: Project, action: Action) -> dict[str, float | None]:
    """Return where each handle stands, seconds of the clip; None for one that is not set."""
    start, end = project.span(action)
    t = action.timing
    return {
        "start": start,
        "end": end,
        "in": min(end, start + t.blend_in),
        "out": max(start, end - t.blend_out),
        "exit": t.earliest_exit,
        "stroke": t.stroke,
        **_phases(project, action),
    }


def _phases(project: Project, action: Action) -> dict[str, float | None]:
    if action.kind != "gesture":
        return dict.fromkeys(PHASES)
    found = phases(project, action)
    return {"ready": found.ready, "hold": found.stroke_end, "relax": found.relax}


def moved(project: Project, action: Action, handle: str, seconds: float) -> dict[str, Any]:
    """Return the Timing fields that dragging a handle to `seconds` changes; a pure function of where it is
    dropped.
    """
    entry = project.clips[action.clip]
    start, end = project.span(action)
    shortest = 1 / entry.fps
    at = round(min(max(0.0, seconds), entry.duration), 3)
    if handle == "start":
        at = min(at, round(end - shortest, 3))
        return {"start": at, **_within(action, at, end)}
    if handle == "end":
        at = max(at, round(start + shortest, 3))
        whole = at >= entry.duration - shortest / 2
        return {"end": None if whole else at, **_within(action, start, entry.duration if whole else at)}
    if handle == "in":
        return {"blend_in": round(min(max(0.0, at - start), end - start), 3)}
    if handle == "out":
        return {"blend_out": round(min(max(0.0, end - at), end - start), 3)}
    if handle == "exit":
        return {"earliest_exit": min(max(at, start), end)}
    if handle in PHASES:
        now = times_of(project, action)
        order = (start, *(float(now[p] or start) for p in PHASES), end)
        place = PHASES.index(handle) + 1
        fields = dict(zip(PHASES, ("ready", "stroke_end", "relax"), strict=True))
        return {fields[handle]: round(min(max(at, order[place - 1]), order[place + 1]), 3)}
    return {"stroke": min(max(at, start), end)}


def _within(action: Action, start: float, end: float) -> dict[str, Any]:
    """Return the moments that have to follow when an action is from start to end: those outside."""
    now = {name: getattr(action.timing, name) for name in MOMENTS}
    then = {name: min(max(at, start), end) for name, at in now.items() if at is not None}
    return {name: at for name, at in then.items() if at != now[name]}


def retimed(project: Project, actions: Iterable[str], name: str, value: float) -> Project:
    """Return the project with a Timing field of actions set, each kept within its own clip as a dragged
    handle is.
    """
    changes: dict[str, dict[str, Any]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is None or action.clip not in project.clips:
            continue
        start, end = project.span(action)
        at = {"blend_in": start + value, "blend_out": end - value}.get(name, value)
        changes[ident] = {"timing": moved(project, action, FIELDS[name], at)}
    return edits.update_each(project, changes)
