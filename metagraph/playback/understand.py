"""From asks at any level of abstraction to what the planner and the life layers work with (Borer et al.,
section 6 and figure 5).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

import msgspec

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.playback.life.line_timing import timed_seconds, told_text
from metagraph.playback.life.track import BlinkAt, Item, LookAt, ModeFrom, PlaceFrom, Speech, StayFrom
from metagraph.playback.line_lengths import spoken_seconds
from metagraph.playback.plan import MetaRequest, Report
from metagraph.playback.told_timing import told_timing

FOREVER = 1e9  # seconds; a look that lasts until the next


@dataclass(frozen=True)
class Understood:
    """requests: for the layers. items: for the track. withdrawn: ids taken back; every id where it holds "".
    refused: what could not be understood, and why."""

    requests: tuple[MetaRequest, ...] = ()
    items: tuple[Item, ...] = ()
    withdrawn: frozenset[str] = frozenset()
    refused: tuple[Report, ...] = ()


def understand(project: Project, asks: Iterable[a.AnyRequest], now: float) -> Understood:
    """Return what asks mean in a project. now: when those begin that do not say; seconds.

    An ask that makes several requests gives them ids of its own: `<id>`, then `<id>.1`, `<id>.2`, ...
    """
    requests: list[MetaRequest] = []
    items: list[Item] = []
    withdrawn: set[str] = set()
    refused: list[Report] = []
    for ask in asks:
        try:
            for meant in _meant(project, ask, now if ask.at is None else ask.at):
                if isinstance(meant, MetaRequest):
                    requests.append(meant)
                elif isinstance(meant, a.Withdraw):
                    withdrawn.add(meant.what)
                else:
                    items.append(meant)
        except (a.RequestError, ValueError) as error:
            layer: Layer = getattr(ask, "layer", None) or "arms"
            refused.append(
                Report(ask.id, "not-understood", str(error), layer, now if ask.at is None else ask.at)
            )
    return Understood(tuple(requests), tuple(items), frozenset(withdrawn), tuple(refused))


def _meant(project: Project, ask: a.AnyRequest, at: float) -> Sequence[MetaRequest | Item | a.Withdraw]:
    """Return what one ask means. Raises RequestError when there is nothing it could mean."""
    match ask:
        case a.Gesture():
            start, stroke = _timed(project, ask.layer, ask.tags, ask.stroke, at)
            return [
                MetaRequest(
                    ask.id,
                    ask.layer,
                    "gesture",
                    start,
                    ask.duration,
                    None,
                    ask.tags,
                    ask.limb,
                    None,
                    ask.priority,
                    ask.resume,
                    stroke,
                    ask.hold,
                    ask.prepare,
                    late=ask.late,
                )
            ]
        case a.Fidget():
            return [
                MetaRequest(
                    ask.id,
                    ask.layer,
                    "fidget",
                    at,
                    ask.duration,
                    None,
                    ask.tags,
                    ask.limb,
                    None,
                    ask.priority,
                    ask.resume,
                    late=ask.late,
                )
            ]
        case a.Play():
            action = find_action(project, ask.action, ask.layer)
            start = at if ask.stroke is None else max(0.0, ask.stroke - lead(project, action))
            return [
                MetaRequest(
                    ask.id, action.layer, action.kind, start, action=action.id, priority=ask.priority,
                    stroke=ask.stroke, hold=ask.hold, prepare=ask.prepare, late=ask.late,
                )
            ]  # fmt: skip
        case a.Go():
            layer, stance = find_stance(project, ask.stance, ask.layer)
            return [
                MetaRequest(
                    ask.id, layer, "transition", at, stance=stance, priority=ask.priority, late=ask.late
                ),
                StayFrom(ask.id, at, layer, ask.stay),
            ]
        case a.Change():
            # Whichever arm was seen to move: stances are joined by few transitions, and mostly of both.
            return [MetaRequest(ask.id, ask.layer, "transition", at, priority=ask.priority, late=ask.late)]
        case a.Nod() | a.Shake():
            return [_head(project, ask, "nod" if isinstance(ask, a.Nod) else "shake", at)]
        case a.Look():
            end = FOREVER if ask.duration is None else at + ask.duration
            return [LookAt(ask.id, at, end, ask.to, ask.amount, ask.strict, ask.priority)]
        case a.Blink():
            return [BlinkAt(ask.id, at)]
        case a.Behave():
            return [ModeFrom(ask.id, at, ask.mode)]
        case a.Place():
            return [PlaceFrom(ask.id, at, ask.name, ask.point)]
        case a.Withdraw():
            return [ask]
        case a.Say():
            return _said(project, ask, at)
        case a.Bml():
            from metagraph.playback.bml import read_bml  # only agents that speak it pay for its reader

            return [
                meant
                for n, inner in enumerate(read_bml(ask.bml, at, ask.priority, project))
                for meant in _meant(project, _named(inner, ask.id, n), at if inner.at is None else inner.at)
            ]
    raise a.RequestError(f"nothing is known of '{type(ask).__name__}'")


def _named(ask: Any, owner: str, number: int) -> Any:
    """Return an ask made by another one, under an id of its own."""
    return msgspec.structs.replace(ask, id=f"{owner}.{number + 1}")


def _said(project: Project, ask: a.Say, at: float) -> list[MetaRequest | Item | a.Withdraw]:
    line = None
    if ask.line is not None:
        ident = str(ask.line)
        line = project.lines.get(ident)
        if line is None:
            raise a.RequestError(f"there is no line '{ident}'{_hint(ident, project.lines)}")
    timing = told_timing(ask)
    told = "" if timing is None else told_text(timing)
    text = ask.text or (line.text if line is not None else told)
    if line is None and not text and timing is None:
        raise a.RequestError("say what: a line's id, text, or words with their times")
    name = str(ask.line) if line is not None else None
    if timing is None:
        length = spoken_seconds(project, name, text, ask.duration)
    else:
        length = timed_seconds(timing, ask.duration)
    out: list[MetaRequest | Item | a.Withdraw] = [
        Speech(ask.id, at, at + length, name, text, ask.priority, timing=timing)
    ]
    for n, inner in enumerate(line.asks if line is not None and ask.gestures else ()):
        if isinstance(inner, a.Say):
            raise a.RequestError(f"line '{ask.line}' would say another line; its asks may not")
        begins = at + (inner.at or 0.0)
        shifted = {"at": begins, "priority": max(inner.priority, ask.priority)}
        if getattr(inner, "stroke", None) is not None:
            shifted["stroke"] = at + getattr(inner, "stroke")  # noqa: B009 - not every ask has one
        out += _meant(project, _named(msgspec.structs.replace(inner, **shifted), ask.id, n), begins)
    return out


def _head(project: Project, ask: a.Nod | a.Shake, word: str, at: float) -> MetaRequest:
    """Nods are gestures tagged so; where none is, the likeliest of those called so, whatever stance it
    needs.
    """
    gestures = [
        x
        for x in project.graphs["head"].actions.values()
        if x.kind == "gesture" and set(ask.tags) <= set(x.tags)
    ]
    if any(word in x.tags for x in gestures):
        wanted = (word, *ask.tags)
        return MetaRequest(ask.id, "head", "gesture", at, tags=wanted, priority=ask.priority, late=ask.late)
    called = tuple(x.id for x in gestures if word in x.name.lower())
    if not called:
        tags = f" with the tags {', '.join(ask.tags)}" if ask.tags else ""
        raise a.RequestError(f"the head layer has no gesture tagged or called '{word}'{tags}")
    return MetaRequest(ask.id, "head", "gesture", at, priority=ask.priority, among=called, late=ask.late)


def _timed(
    project: Project, layer: Layer, tags: tuple[str, ...], stroke: float | None, at: float
) -> tuple[float, float | None]:
    """Return the earliest start of a gesture whose stroke should come at a time, and that time."""
    return (at, None) if stroke is None else (max(0.0, stroke - _longest_lead(project, layer, tags)), stroke)


def _longest_lead(project: Project, layer: Layer, tags: tuple[str, ...]) -> float:
    """Return how long before its stroke any gesture with these tags begins; remembered as long as graph and
    clips stay as they are.
    """
    graph = project.graphs[layer]
    known = graph.__dict__.get("_leads")
    leads: dict[tuple[str, ...], float] = known[1] if known is not None and known[0] is project.clips else {}
    graph.__dict__["_leads"] = (project.clips, leads)
    if tags not in leads:
        gestures = (x for x in graph.actions.values() if x.kind == "gesture" and set(tags) <= set(x.tags))
        leads[tags] = max((lead(project, x) for x in gestures), default=0.0)
    return leads[tags]


def lead(project: Project, action: Action) -> float:
    """Return the seconds from an action's start to its stroke; what is no gesture has it where it was set, or
    halfway.
    """
    if action.kind != "gesture":
        start, end = project.span(action)
        stroke = action.timing.stroke
        return min(max((start + end) / 2 if stroke is None else stroke, start), end) - start
    from metagraph.playback.phases import phases

    found = phases(project, action)
    return found.stroke - found.start


def find_action(project: Project, word: str, layer: Layer | None = None) -> Action:
    """Return the action of an id or, failing that, a name; of several of one name the likeliest. Raises
    RequestError.
    """
    found = project.action(word)
    if found is not None and layer in (None, found.layer):
        return found
    called = [x for x in project.actions() if x.name == word and layer in (None, x.layer)]
    if not called:
        names = {x.name: None for x in project.actions() if layer in (None, x.layer)}
        where = f" in the {layer} layer" if layer else ""
        raise a.RequestError(f"there is no action '{word}'{where}{_hint(word, names)}")
    return max(called, key=lambda x: x.likelihood)


def find_stance(project: Project, word: str, layer: Layer | None = None) -> tuple[Layer, str]:
    """Return layer and id of a stance from its id or name. Raises RequestError."""
    names: dict[str, None] = {}
    for each in LAYERS:
        if layer not in (None, each):
            continue
        stances = project.graphs[each].stances
        if word in stances:
            return each, word
        for stance in stances.values():
            if stance.name == word:
                return each, stance.id
            names[stance.name] = None
    raise a.RequestError(
        f"there is no stance '{word}'{f' in the {layer} layer' if layer else ''}{_hint(word, names)}"
    )


def _hint(word: str, known: Mapping[str, Any]) -> str:
    near = get_close_matches(word, [str(k) for k in known], 1)
    if near:
        return f"; did you mean '{near[0]}'?"
    some = ", ".join(list(known)[:6])
    return f"; there are {some}{' ...' if len(known) > 6 else ''}" if some else "; there are none"
