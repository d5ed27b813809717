"""Clips played faster, slower and held: an edit that keeps the clip as it was read, and lets everything that
names moments of it follow.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.clip_source import get_clip_course, get_source_clip, with_source
from metagraph.graph.edit_error import EditError
from metagraph.graph.manual.machine import Manual
from metagraph.graph.model import Action, BasePose, ClipEntry, Project, Timing
from metagraph.motion.clip import Clip
from metagraph.motion.contact_hold import Contact, find_nearest_joint
from metagraph.motion.contact_spans import ContactSpan
from metagraph.motion.retime import SHORTEST, Hold, Retime

MOMENTS = ("start", "end", "earliest_exit", "stroke", "ready", "stroke_end", "relax")
BODY = (
    "hips",
    "spine",
    "chest",
    "upper_chest",
    "neck",
    "head",
    "left_upper_leg",
    "right_upper_leg",
)  # roles a hand may stay with
LATE = ("end", "earliest_exit", "relax")  # go to the end of a hold that is put where they are


def set_retime(project: Project, clip: str, retime: Retime) -> Project:
    """Return the project with a clip retimed otherwise: its actions, the states and links that name moments
    of it and the base pose follow. Raises EditError if the clip is gone or its file is missing.
    """
    entry = project.clips.get(clip)
    if entry is None:
        raise EditError(phrase("that clip is no longer in the project"))
    source, before = get_source_clip(entry), get_clip_course(entry)
    if source is None or before is None:
        raise EditError(
            phrase("the file of '{name}' is missing: find the file, then change the speed", name=entry.name)
        )
    after = with_source(replace(entry, retime=retime.kept(source.duration)), source)
    if after.retime == entry.retime:
        return project
    if entry.timed_on:
        after = replace(after, timed_on=entry.timed_on * after.duration / entry.duration)
    course = get_clip_course(after)
    assert course is not None

    def moved(seconds: float | None, late: bool = False) -> float | None:
        return None if seconds is None else round(before.along(seconds, course, late), 3)

    return _move_times(project, after, moved)


def _move_times(project: Project, after: ClipEntry, moved: Callable[..., float | None]) -> Project:
    """Return the project with a clip as it is now, and all that names moments of it moved: its actions, the
    states and links of machines that were drawn, the base pose.
    """
    clip, before = after.id, project.clips[after.id]
    out = replace(project, clips={**project.clips, clip: after})
    for graph in project.graphs.values():
        changes: dict[str, Action | None] = {
            a.id: replace(a, timing=_timing(a.timing, moved), contacts=_contacts(a.contacts, moved))
            for a in graph.uses.get(clip, ())
        }
        if changes:
            out = out.with_graph(graph.with_actions(changes))
    manual = {layer: _manual(machine, clip, moved) for layer, machine in project.manual.items()}
    base = project.base
    if base.clip == clip:
        frame = round((moved(base.frame / before.fps) or 0.0) * after.fps)
        base = BasePose(clip, min(frame, after.frames - 1))
    return replace(out, manual=manual, base=base)


def keep_clips_in_place(project: Project, clips: Iterable[str], on: bool = True) -> Project:
    """Return the project with clips kept in place, or with their own way: see `motion.in_place`. Times stay.
    Raises EditError if a clip is gone or its file is missing.
    """
    changed = {}
    for clip in clips:
        entry = project.clips.get(clip)
        if entry is None:
            raise EditError(phrase("that clip is no longer in the project"))
        source = get_source_clip(entry)
        if source is None:
            raise EditError(
                phrase(
                    "the file of '{name}' is missing: find the file, then keep it in place", name=entry.name
                )
            )
        if entry.in_place != on:
            changed[clip] = with_source(replace(entry, in_place=on), source)
    return replace(project, clips={**project.clips, **changed}) if changed else project


def scale_times(project: Project, clip: str) -> Project:
    """Return the project with all moments of a clip whose file has another length since they were timed
    scaled to it, by as much as it is longer or shorter. Raises EditError if the clip is gone.
    """
    entry = project.clips.get(clip)
    if entry is None:
        raise EditError(phrase("that clip is no longer in the project"))
    if not entry.timed_on:
        return project
    part = entry.duration / entry.timed_on

    def moved(seconds: float | None, late: bool = False) -> float | None:
        return None if seconds is None else round(min(seconds * part, entry.duration), 3)

    return _move_times(project, replace(entry, timed_on=0.0), moved)


def keep_times(project: Project, clip: str) -> Project:
    """Return the project with the times of a clip's actions taken as right for the length it has."""
    entry = project.clips.get(clip)
    if entry is None:
        raise EditError(phrase("that clip is no longer in the project"))
    return replace(project, clips={**project.clips, clip: replace(entry, timed_on=0.0)})


def set_speed(project: Project, clip: str, speed: float) -> Project:
    """Return the project with a clip played at a speed, 1 as it was read. Raises EditError."""
    entry = project.clips.get(clip)
    return set_retime(project, clip, replace(entry.retime if entry else Retime(), speed=speed))


def set_hold(project: Project, clip: str, at: float, seconds: float) -> Project:
    """Return the project with a clip held at a moment, seconds of the clip as it was read, for some seconds
    longer; 0 takes the hold away. Raises EditError.
    """
    entry = project.clips.get(clip)
    retime = entry.retime if entry else Retime()
    at = round(at, 3)
    others = tuple(h for h in retime.holds if h.at != at)
    return set_retime(project, clip, replace(retime, holds=(*others, Hold(at, seconds))))


def keep_hand(project: Project, clip: str, side: str, first: float, last: float) -> Project:
    """Return the project with a hand of a clip kept where it is on the body at the first of two moments,
    until the second; seconds of the clip as it was read. side: "left" or "right". Raises EditError.
    """
    entry = project.clips.get(clip)
    source = get_source_clip(entry) if entry is not None else None
    roles = anatomy.project_roles(project)
    limb = [roles.get(f"{side}_{part}") for part in ("upper_arm", "lower_arm", "hand")]
    if entry is None or source is None or source.skeleton != project.skeleton:
        raise EditError(phrase("that clip has no motion for this skeleton: find its file"))
    if None in limb:
        raise EditError(
            phrase(
                "the joints of the {side} arm are not known: assign them in 'Skeleton'",
                side=phrase(side),
            )
        )
    upper, lower, hand = (int(j) for j in limb if j is not None)
    to = find_nearest_joint(source, hand, _touched(project, side), first)
    if to is None or last <= first:
        raise EditError(phrase("there is nothing that the hand could stay at"))
    names = source.skeleton.names
    contact = Contact(names[upper], names[lower], names[hand], names[to], first, last)
    kept = tuple(c for c in entry.retime.contacts if c.hand != contact.hand or not _meet(c, contact))
    return set_retime(project, clip, replace(entry.retime, contacts=(*kept, contact)))


def set_kept(project: Project, clip: str, place: int, first: float, last: float) -> Project:
    """Return the project with a hand of a clip kept during other seconds of the clip as it was read, as far
    as the same hand is not kept elsewhere then; it stays with what it is nearest to at the first. Hardly any
    seconds let it go. place: of the contact among the clip's. Raises EditError.
    """
    entry = project.clips.get(clip)
    source = get_source_clip(entry) if entry is not None else None
    if entry is None or source is None or place >= len(entry.retime.contacts):
        raise EditError(phrase("that hand is no longer pinned there"))
    contacts, old = list(entry.retime.contacts), entry.retime.contacts[place]
    others = [c for n, c in enumerate(contacts) if n != place and c.hand == old.hand]
    first = max([0.0, first, *(c.last for c in others if c.last <= old.first)])
    last = min([source.duration, last, *(c.first for c in others if c.first >= old.last)])
    del contacts[place]
    if last - first >= SHORTEST:
        to = _nearest(project, source, old, first) if first != old.first else old.to
        contacts.insert(place, replace(old, to=to, first=first, last=last))
    return set_retime(project, clip, replace(entry.retime, contacts=tuple(contacts)))


def _nearest(project: Project, source: Clip, contact: Contact, seconds: float) -> str:
    """Return the joint that a kept hand is nearest to at a moment; the present one where its side is not
    known.
    """
    names, roles = source.skeleton.names, anatomy.project_roles(project)
    for side in ("left", "right") if source.skeleton == project.skeleton else ():
        if (hand := roles.get(f"{side}_hand")) is not None and names[hand] == contact.hand:
            to = find_nearest_joint(source, hand, _touched(project, side), seconds)
            return contact.to if to is None else names[to]
    return contact.to


def _touched(project: Project, side: str) -> list[int]:
    """Return the joints a hand of a side may stay with."""
    roles, other = anatomy.project_roles(project), "right" if side == "left" else "left"
    return [roles[r] for r in (*BODY, f"{other}_hand", f"{other}_lower_arm") if r in roles]


def _meet(one: Contact, other: Contact) -> bool:
    return one.first <= other.last and other.first <= one.last


def _timing(timing: Timing, moved: Callable[..., float | None]) -> Timing:
    changes: dict[str, Any] = {n: moved(getattr(timing, n), n in LATE) for n in MOMENTS}
    return replace(timing, **changes)


def _contacts(
    contacts: tuple[ContactSpan, ...], moved: Callable[..., float | None]
) -> tuple[ContactSpan, ...]:
    """Return contacts at the moments they have come to."""

    def at(seconds: float, late: bool = False) -> float:
        return moved(seconds, late) or 0.0

    return tuple(
        replace(
            span,
            start=at(span.start),
            end=at(span.end, True),
            keys=tuple(replace(key, time=at(key.time)) for key in span.keys),
        )
        for span in contacts
    )


def _manual(machine: Manual, clip: str, moved: Callable[..., float | None]) -> Manual:
    used = {i for i, s in machine.states.items() if s.clip == clip}
    if not used:
        return machine
    states = {
        i: replace(s, start=moved(s.start) or 0.0, end=moved(s.end, True)) if i in used else s
        for i, s in machine.states.items()
    }
    links = {
        i: replace(k, exit_time=moved(k.exit_time, True)) if k.source in used else k
        for i, k in machine.links.items()
    }
    return replace(machine, states=states, links=links)
