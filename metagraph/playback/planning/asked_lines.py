"""Which line asks for an action: what it would be said with, before anything is performed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from metagraph.graph import requests as a
from metagraph.graph.model import Action, Project
from metagraph.graph.repeating import seconds_played
from metagraph.playback.planning.line_lengths import find_spoken_seconds
from metagraph.playback.planning.understand import lead


@dataclass(frozen=True)
class AskedLine:
    """line: its id. at: seconds from the action's start at which it begins, negative where it begins
    before.
    """

    line: str
    at: float


def find_asked_line(project: Project, action: Action) -> AskedLine | None:
    """Return the line that an action is asked for with: beside it in a kept performance, else by the line's
    own asks; where several are, the one that names the action itself, then the first. None if none is.
    """
    found = [*_in_performances(project, action), *_by_lines(project, action)]
    return max(found, key=lambda f: f[0])[1] if found else None


def _in_performances(project: Project, action: Action) -> Iterator[tuple[bool, AskedLine]]:
    for kept in project.performances.values():
        says = [s for s in kept.asks if isinstance(s, a.Say) and s.line is not None and s.at is not None]
        for ask in kept.asks if says else ():
            begins = _begins(project, action, ask)
            if begins is None or (named := _names(ask, action)) is None:
                continue
            for say in says:
                at = float(say.at or 0.0)
                line = project.lines.get(str(say.line))
                length = find_spoken_seconds(project, str(say.line), line.text, say.duration) if line else 0.0
                start, end = project.span(action)
                lasts = seconds_played(action.kind, action.timing, start, end)
                if line is not None and at < begins + lasts and at + length > begins:
                    yield named, AskedLine(str(say.line), at - begins)


def _by_lines(project: Project, action: Action) -> Iterator[tuple[bool, AskedLine]]:
    for ident, line in project.lines.items():
        for ask in line.asks:
            named = _names(ask, action)
            begins = _begins(project, action, ask, 0.0) if named is not None else None
            if named is not None and begins is not None:
                yield named, AskedLine(ident, -begins)


def _names(ask: a.AnyRequest, action: Action) -> bool | None:
    """Return whether an ask names an action itself; None if it may not be that action at all."""
    match ask:
        case a.Play():
            fits = ask.action in (action.id, action.name) and ask.layer in (None, action.layer)
            return True if fits else None
        case a.Gesture() | a.Fidget():
            kind = "gesture" if isinstance(ask, a.Gesture) else "fidget"
            fits = (action.kind, action.layer) == (kind, ask.layer) and ask.limb in (None, action.limb)
            return False if fits and set(ask.tags) <= set(action.tags) else None
        case a.Nod() | a.Shake():
            word = "nod" if isinstance(ask, a.Nod) else "shake"
            fits = (action.kind, action.layer) == ("gesture", "head") and set(ask.tags) <= set(action.tags)
            return False if fits and (word in action.tags or word in action.name.lower()) else None
    return None


def _begins(
    project: Project, action: Action, ask: a.AnyRequest, default: float | None = None
) -> float | None:
    """Return when an action begins that an ask is answered with; None if it does not say when."""
    stroke = getattr(ask, "stroke", None)
    if stroke is not None:
        return float(stroke) - lead(project, action)
    return default if ask.at is None else float(ask.at)
