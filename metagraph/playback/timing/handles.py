"""The times of an action as handles that are moved: where each stands, and which fields a move changes. What
plots show and what numbers are typed go by the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from metagraph.graph import edits
from metagraph.graph.model import Action, Project
from metagraph.graph.repeating import seconds_played
from metagraph.playback.timing.phases import find_phases

HANDLES = ("start", "end", "in", "out", "exit", "stroke", "ready", "hold", "relax")
PHASES = ("ready", "hold", "relax")  # handles of a gesture's phases
MOMENTS = ("earliest_exit", "ready", "stroke", "stroke_end", "relax")  # of Timing, seconds of the clip
BLOCKS = ("preparation", "stroke", "hold", "retraction")
EDGES = ("start", "ready", "hold", "relax", "end")  # handles between which a gesture's phases are
WORDS = {
    "start": "start",
    "end": "end",
    "in": "blend in",
    "out": "blend out",
    "exit": "exit",
    "stroke": "stroke",
    "ready": "ready",
    "hold": "hold",
    "relax": "relax",
}  # by which people know the handles
FIELDS = {
    "start": "start",
    "end": "end",
    "blend_in": "in",
    "blend_out": "out",
    "earliest_exit": "exit",
    "stroke": "stroke",
}  # of Timing, by the handle that stands for each


def handle_times(project: Project, action: Action) -> dict[str, float | None]:
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
    found = find_phases(project, action)
    return {"ready": found.ready, "hold": found.stroke_end, "relax": found.relax}


def move_handle(project: Project, action: Action, handle: str, seconds: float) -> dict[str, Any]:
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
    longest = seconds_played(action.kind, action.timing, start, end)  # a blend may span cycles
    if handle == "in":
        return {"blend_in": round(min(max(0.0, seconds - start), longest), 3)}
    if handle == "out":
        return {"blend_out": round(min(max(0.0, end - seconds), longest), 3)}
    if handle == "exit":
        return {"earliest_exit": min(max(at, start), end)}
    if handle in PHASES:
        now = handle_times(project, action)
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


def set_timing_field(project: Project, actions: Iterable[str], name: str, value: float) -> Project:
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
        changes[ident] = {"timing": move_handle(project, action, FIELDS[name], at)}
    return edits.update_each(project, changes)


@dataclass(frozen=True, slots=True)
class Handle:
    """name: of `HANDLES`. at: seconds of the clip. own: the timing says so; else the motion was asked.
    number: what is written at it, seconds: of a blend how long it is, else where it stands.
    """

    name: str
    at: float
    own: bool
    number: float

    @property
    def words(self) -> str:
        """Its name and number: "blend in 0.20"."""
        return f"{WORDS[self.name]} {self.number:.2f}"


@dataclass(frozen=True, slots=True)
class PhaseBlock:
    """A phase of a gesture. name: of `BLOCKS`. first, last: seconds of the clip. own: an edge of it is the
    timing's.
    """

    name: str
    first: float
    last: float
    own: bool


def list_handles(project: Project, action: Action) -> tuple[Handle, ...]:
    """Return an action's handles that can be seen and taken; a gesture's stroke also where it was found."""
    t, at = action.timing, handle_times(project, action)
    own = {"ready": t.ready, "hold": t.stroke_end, "relax": t.relax, "stroke": t.stroke}
    if action.kind == "gesture" and at["stroke"] is None:
        at["stroke"] = find_phases(project, action).stroke
    loop = action.kind == "stance"
    numbers = {"in": t.blend_in, "out": t.blend_out}
    return tuple(
        Handle(name, seconds, own.get(name, 0.0) is not None, numbers.get(name, seconds))
        for name, seconds in at.items()
        if seconds is not None and not (loop and name in ("out", "exit", "stroke"))
    )


def find_blocks(project: Project, action: Action) -> tuple[PhaseBlock, ...]:
    """Return a gesture's phases in time; none of other kinds."""
    if action.kind != "gesture":
        return ()
    t, at = action.timing, handle_times(project, action)
    own = (False, t.ready is not None, t.stroke_end is not None, t.relax is not None, False)
    edges = [float(at[name] or 0.0) for name in EDGES]
    return tuple(
        PhaseBlock(name, edges[n], edges[n + 1], own[n] or own[n + 1]) for n, name in enumerate(BLOCKS)
    )


def move_block(project: Project, action: Action, block: str, by: float) -> dict[str, Any]:
    """Return the Timing fields that dragging one of `BLOCKS` by seconds changes: it keeps its length as far
    as its neighbours let it, and what is beside it gives way. Nothing of what is no gesture.
    """
    found = find_blocks(project, action)
    if not found:
        return {}
    place = BLOCKS.index(block)
    edges = [found[0].first, *(b.last for b in found)]
    least = 0.0 if place == 0 else edges[place - 1]
    most = project.clips[action.clip].duration if place == len(BLOCKS) - 1 else edges[place + 2]
    by = min(max(by, least - edges[place]), most - edges[place + 1])
    moving = (EDGES[place], EDGES[place + 1])
    return _moved_by(project, action, moving if by <= 0 else moving[::-1], by, edges)


def _moved_by(
    project: Project, action: Action, names: Iterable[str], by: float, edges: list[float]
) -> dict[str, Any]:
    """Return the fields of edges moved one after the other, the one ahead first: none is in the way."""
    out: dict[str, Any] = {}
    for name in names:
        fields = move_handle(project, action, name, edges[EDGES.index(name)] + by)
        project = edits.update_actions(project, [action.id], timing=fields)
        action = project.action(action.id) or action
        out |= fields
    return out


def slip_action(project: Project, action: Action, by: float) -> dict[str, Any]:
    """Return the Timing fields that playing another part of the clip changes, as long and as late as the
    present one: start, end and all moments set go by the same seconds, as far as the clip reaches.
    """
    start, end = project.span(action)
    entry = project.clips[action.clip]
    by = min(max(by, -start), entry.duration - end)
    last = round(end + by, 3)
    out: dict[str, Any] = {
        "start": round(start + by, 3),
        "end": None if last >= entry.duration - 0.5 / entry.fps else last,
    }
    for name in MOMENTS:
        at = getattr(action.timing, name)
        if at is not None:
            out[name] = round(at + by, 3)
    return {name: value for name, value in out.items() if value != getattr(action.timing, name)}


def move_handle_by(
    project: Project, actions: Iterable[str], handle: str, by: float
) -> dict[str, dict[str, Any]]:
    """Return what `edits.update_each` is given for a handle dragged by seconds in each of some actions,
    within its own clip; those that have no such handle stay as they are.
    """
    out: dict[str, dict[str, Any]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is None or action.clip not in project.clips:
            continue
        at = next((h.at for h in list_handles(project, action) if h.name == handle), None)
        if at is not None:
            out[ident] = {"timing": move_handle(project, action, handle, at + by)}
    return out
