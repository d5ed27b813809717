"""Edits of what a character performs: kept performances and their asks, lines, points, life. Pure functions
Project -> Project.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph import ids
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_free_name
from metagraph.graph.model import Project
from metagraph.graph.requests import LONGEST_NAME, AnyRequest, Line, Performance, Point, RequestError
from metagraph.graph.timeline_edits import remove_timeline


def add_performance(project: Project, performance: Performance) -> tuple[Project, str]:
    """Keep a performance under a name of its own; return the project and the performance's id."""
    named = msgspec.structs.replace(
        performance,
        name=_own_name(performance.name or "Performance", {p.name for p in project.performances.values()}),
        asks=_numbered(performance.asks),
    )
    ident = ids.make_id(project, "p", msgspec.json.encode(named))
    return replace(project, performances={**project.performances, ident: named}), ident


def _own_name(name: str, taken: Collection[str]) -> str:
    """Return a name nobody has, no longer than one may be with a number behind it."""
    found = find_free_name(name, taken)
    return found if len(found) <= LONGEST_NAME else find_free_name(name[: LONGEST_NAME - 12].rstrip(), taken)


def _numbered(asks: Collection[AnyRequest]) -> tuple[AnyRequest, ...]:
    """Return asks, each with an id no other has."""
    taken = {ask.id for ask in asks if ask.id}
    out: list[AnyRequest] = []
    seen: set[str] = set()
    number = 0
    for ask in asks:
        ident = ask.id
        if not ident or ident in seen:
            while not ident or ident in taken:
                number += 1
                ident = f"r{number}"
            taken.add(ident)
        seen.add(ident)
        out.append(ask if ident == ask.id else msgspec.structs.replace(ask, id=ident))
    return tuple(out)


def change_performance(project: Project, ident: str, **changes: Any) -> Project:
    """Set a performance's fields: name, seed, length, idle, stances, asks. Raises EditError, also for values
    out of range.
    """
    before = _performance(project, ident)
    if "name" in changes:
        changes["name"] = " ".join(str(changes["name"]).split())
        if not changes["name"]:
            raise EditError(phrase("a performance needs a name"))
    if "asks" in changes:
        changes["asks"] = _numbered(changes["asks"])
    try:
        after = msgspec.convert(msgspec.to_builtins(msgspec.structs.replace(before, **changes)), Performance)
    except msgspec.ValidationError as error:
        raise EditError(str(error)) from None
    return (
        project if after == before else replace(project, performances={**project.performances, ident: after})
    )


def remove_performance(project: Project, ident: str) -> Project:
    _performance(project, ident)
    project = remove_timeline(project, ident)
    return replace(project, performances={i: p for i, p in project.performances.items() if i != ident})


def _performance(project: Project, ident: str) -> Performance:
    found = project.performances.get(ident)
    if found is None:
        raise EditError(phrase("that performance is not in this project"))
    return found


def add_request(project: Project, performance: str, ask: AnyRequest) -> Project:
    """Ask for one thing more."""
    return change_performance(project, performance, asks=(*_performance(project, performance).asks, ask))


def change_request(project: Project, performance: str, ask: str, **changes: Any) -> Project:
    """Set fields of one ask. Raises EditError for fields it does not have and values it cannot take."""
    before = _performance(project, performance).asks
    try:
        after = tuple(_changed(x, changes) if x.id == ask else x for x in before)
    except (RequestError, AttributeError, TypeError) as error:
        raise EditError(str(error)) from None
    return change_performance(project, performance, asks=after)


def _changed(ask: AnyRequest, changes: Mapping[str, Any]) -> AnyRequest:
    from metagraph.graph.requests import make_request

    return make_request(msgspec.to_builtins(msgspec.structs.replace(ask, **changes)))


def move_requests(project: Project, performance: str, asks: Collection[str], by: float) -> Project:
    """Move asks in time by seconds, none to before the beginning; what waits for a stroke moves that."""
    of = _performance(project, performance)
    chosen = [x for x in of.asks if x.id in asks]
    times = [t for x in chosen for t in (x.at, getattr(x, "stroke", None)) if t is not None]
    by = max(by, -min(times, default=0.0))

    def moved(ask: AnyRequest) -> AnyRequest:
        if ask.id not in asks:
            return ask
        fields = {
            f: round(getattr(ask, f) + by, 3) for f in ("at", "stroke") if getattr(ask, f, None) is not None
        }
        if not fields:  # it began as soon as could be: at 0
            fields = {"at": round(max(0.0, by), 3)}
        return msgspec.structs.replace(ask, **fields)

    return change_performance(project, performance, asks=tuple(moved(x) for x in of.asks))


def remove_requests(project: Project, performance: str, asks: Collection[str] | None = None) -> Project:
    """Take asks back, all where None is given."""
    of = _performance(project, performance)
    return change_performance(
        project, performance, asks=() if asks is None else tuple(x for x in of.asks if x.id not in asks)
    )


def ask_time(ask: AnyRequest) -> float:
    """Return when an ask is wanted, seconds: its stroke, else its start; 0 for as soon as can be."""
    stroke = getattr(ask, "stroke", None)
    return float(stroke if stroke is not None else ask.at if ask.at is not None else 0.0)


def close_up_after(
    project: Project,
    performance: str,
    asks: Collection[str],
    spans: Collection[tuple[float, float]],
    still: Collection[str] = (),
) -> Project:
    """Take asks back and let all that follow move up, by the time that is gone before them.

    spans: first and last second that is gone, of each; they may overlap. still: ids of asks that stay where
    they are.
    """
    gone: list[list[float]] = []
    for start, end in sorted(spans):
        if gone and start <= gone[-1][1]:
            gone[-1][1] = max(gone[-1][1], end)
        else:
            gone.append([start, end])
    project = remove_requests(project, performance, asks)
    shifts: dict[float, list[str]] = {}
    for ask in _performance(project, performance).asks:
        at = ask_time(ask)
        by = sum(max(0.0, min(end, at) - start) for start, end in gone)
        if by > 0 and ask.id not in still:
            shifts.setdefault(round(by, 3), []).append(ask.id)
    for by, idents in shifts.items():
        project = move_requests(project, performance, idents, -by)
    return project


def find_following_asks(
    performance: Performance, asks: Collection[str], still: Collection[str] = ()
) -> tuple[str, ...]:
    """Return some asks and all that are wanted from the first of them on, except for those that stay
    `still`.
    """
    first = min((ask_time(x) for x in performance.asks if x.id in asks), default=0.0)
    return tuple(
        x.id for x in performance.asks if x.id in asks or (ask_time(x) >= first and x.id not in still)
    )


def set_line(project: Project, ident: str, line: Line | None) -> Project:
    """Set or, with None, remove a line of dialogue. Raises EditError for an id of nothing."""
    ident = ident.strip()
    if not ident:
        raise EditError(phrase("a line needs an id"))
    lines = (
        {i: x for i, x in project.lines.items() if i != ident}
        if line is None
        else {**project.lines, ident: line}
    )
    voices = project.voices
    if line is None or project.lines.get(ident) is None or line.audio != project.lines[ident].audio:
        voices = {i: v for i, v in voices.items() if i != ident}
    return replace(project, lines=lines, voices=voices)


def rename_line(project: Project, ident: str, new: str) -> Project:
    """Give a line another id, in the performances that call it, too. Raises EditError if the new one is
    taken.
    """
    new = new.strip()
    if new == ident:
        return project
    if not new or new in project.lines:
        raise EditError(
            phrase("there is already a line '{new}'", new=new) if new else phrase("a line needs an id")
        )
    lines = {new if i == ident else i: x for i, x in project.lines.items()}
    voices = {new if i == ident else i: v for i, v in project.voices.items()}

    def called(ask: AnyRequest) -> AnyRequest:
        said = getattr(ask, "line", None)
        return msgspec.structs.replace(ask, line=new) if said is not None and str(said) == ident else ask

    performances = {
        i: msgspec.structs.replace(p, asks=tuple(map(called, p.asks)))
        for i, p in project.performances.items()
    }
    return replace(project, lines=lines, voices=voices, performances=performances)


def set_point(project: Project, name: str, point: Point | None) -> Project:
    """Put a named point somewhere, or with None take it away."""
    points = {n: p for n, p in project.points.items() if n != name}
    return replace(project, points=points if point is None else {**points, name: point})


def set_life(project: Project, **changes: Any) -> Project:
    """Set fields of the life layers. Raises EditError for a value out of range."""
    before = project.life
    try:
        after = msgspec.convert(msgspec.to_builtins(msgspec.structs.replace(before, **changes)), type(before))
    except (msgspec.ValidationError, TypeError) as error:
        raise EditError(str(error)) from None
    return project if after == before else replace(project, life=after)
