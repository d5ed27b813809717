"""What is noted on the timeline of a performance or a conversation: a range that is played again and again,
markers, layers that are locked, the cameras and whether words are shown. It changes no plan and no pose.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta, Struct

from metagraph.graph import ids
from metagraph.graph import requests as a
from metagraph.graph.edit_error import EditError
from metagraph.graph.requests import Seconds
from metagraph.graph.words import LAYERS

if TYPE_CHECKING:
    from metagraph.graph.model import Project

Lane = Literal["stage", "body", "arms", "head"]
Shot = Literal["over", "two", "close"]
SHOTS: tuple[Shot, ...] = get_args(Shot)
IMPROVISED = ""  # the key of what is noted where neither a performance nor a conversation is on stage
SAME_CUT = 0.05  # seconds: a cut so near another is the same, changed
SHORTEST_RANGE = 0.1  # seconds; shorter, a range is a slip of the hand
_Name = Annotated[str, Meta(max_length=200)]


class Marker(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A moment with a name. at: seconds."""

    id: str
    at: Seconds
    name: _Name = ""


class Cut(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """From `at` seconds on the camera of a conversation shows it so. shot: over another's shoulder at a
    side's face, close at it, or all who talk from three quarters ("two"). side: who is seen, from 0.
    """

    at: Seconds
    shot: Shot
    side: Annotated[int, Meta(ge=0, le=7)] = 0


class Timeline(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """range: first and last second of what is played again and again and can be written alone; None for all.
    markers: by time. locked: lanes whose requests are not to be moved or taken back. cuts: by time; none, and
    the camera is the hand's. captions: whether the words of who speaks are shown.
    """

    range: tuple[Seconds, Seconds] | None = None
    markers: tuple[Marker, ...] = ()
    locked: tuple[Lane, ...] = ()
    cuts: tuple[Cut, ...] = ()
    captions: bool = False

    def __post_init__(self) -> None:
        if self.range is not None and self.range[1] - self.range[0] < SHORTEST_RANGE / 2:
            raise ValueError(f"range: it ends after it begins, found {self.range[0]:g} to {self.range[1]:g}")


def timeline_of(project: Project, key: str) -> Timeline:
    """Return what is noted of a performance or conversation, by its id."""
    return project.timelines.get(key) or Timeline()


def change_timeline(project: Project, key: str, **changes: Any) -> Project:
    """Set what is noted; nothing but defaults is not kept. Raises EditError for values out of range."""
    before = timeline_of(project, key)
    if "markers" in changes:
        changes["markers"] = tuple(sorted(changes["markers"], key=lambda m: m.at))
    if "cuts" in changes:
        changes["cuts"] = tuple(sorted(changes["cuts"], key=lambda c: c.at))
    try:
        after = msgspec.convert(msgspec.to_builtins(msgspec.structs.replace(before, **changes)), Timeline)
    except (ValueError, TypeError) as error:  # msgspec's are ValueErrors
        raise EditError(str(error)) from None
    if after == before:
        return project
    kept = {k: t for k, t in project.timelines.items() if k != key}
    if after != Timeline():
        kept[key] = after
    return replace(project, timelines=kept)


def add_marker(project: Project, key: str, at: float, name: str = "") -> tuple[Project, str]:
    """Put a marker at a time; return the project and the marker's id. One that is there already is it."""
    before = timeline_of(project, key).markers
    there = next((m for m in before if abs(m.at - at) < 0.005), None)
    if there is not None:
        return project, there.id
    at = round(max(0.0, at), 3)
    marker = Marker(id=ids.new_id(project, "m", key, at), at=at, name=name)
    return change_timeline(project, key, markers=(*before, marker)), marker.id


def change_marker(project: Project, key: str, ident: str, **changes: Any) -> Project:
    """Set a marker's name or time."""
    markers = tuple(
        msgspec.structs.replace(m, **changes) if m.id == ident else m
        for m in timeline_of(project, key).markers
    )
    return change_timeline(project, key, markers=markers)


def remove_markers(project: Project, key: str, idents: Collection[str]) -> Project:
    markers = tuple(m for m in timeline_of(project, key).markers if m.id not in idents)
    return change_timeline(project, key, markers=markers)


def with_cut(cuts: tuple[Cut, ...], cut: Cut) -> tuple[Cut, ...]:
    """Return cuts with one more, which replaces one at its time; one to the picture that is seen anyway is
    none.
    """
    others = sorted((c for c in cuts if abs(c.at - cut.at) > SAME_CUT), key=lambda c: c.at)
    out: list[Cut] = []
    for one in sorted([*others, cut], key=lambda c: c.at):
        if not out or (out[-1].shot, out[-1].side) != (one.shot, one.side):
            out.append(one)
    return tuple(out)


def without_timeline(project: Project, key: str) -> Project:
    """Forget what is noted of something that goes."""
    if key not in project.timelines:
        return project
    return replace(project, timelines={k: t for k, t in project.timelines.items() if k != key})


def only_noted(before: Project, after: Project) -> bool:
    """Return whether two states of a project are apart in nothing but what is noted on timelines."""
    same = (f.name for f in fields(before) if f.name != "timelines")
    return before.timelines is not after.timelines and all(
        getattr(before, n) is getattr(after, n) for n in same
    )


def lane_of(ask: a.AnyRequest, project: Project) -> Lane:
    """Return the lane an ask stands in: its layer, or the stage."""
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
