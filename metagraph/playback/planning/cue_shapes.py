"""How an action would play for a request: when it begins, how long it lasts and how late it is.

A gesture waits for its stroke or cuts its preparation to catch up with it; its hold is stretched, and its
retraction may be cut (Borer et al., section 6.2).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from metagraph.graph.model import Action, Project
from metagraph.graph.repeating import LONGEST_REPEAT, cycle_of, times_played
from metagraph.playback.plan import MetaAction, MetaRequest
from metagraph.playback.planning.mood import drag
from metagraph.playback.timing.phases import find_phases

FITS = 1e-6  # seconds by which sums of times may be off
HURRY = 2.0  # a hold is played at most this many times as fast as it was made
STOPPED = 0.3  # seconds in which an action that is taken back goes back to its stance, from where it is
RETRACTION = 0.4  # seconds in which an action whose retraction is cut goes back to its stance, at the least
SHARED = 0.25  # seconds within which two strokes may be one


@dataclass(frozen=True, slots=True)
class CueShape:
    """How an action would play: from `start` on, for `length` seconds, at least `shortest`; the other fields
    are those of a cue.
    """

    start: float
    entry: float
    length: float
    shortest: float
    hold_from: float = 0.0
    hold_to: float = 0.0
    hold: float = 0.0
    tempo: float = 1.0


def shape_of(
    project: Project, action: Action, request: MetaRequest | None, now: float, speed: float
) -> CueShape:
    """Return how an action would play for a request from `now` on, or as a step on the way to it. speed: a
    factor of the action's own speed.
    """
    start, end = project.span(action)
    begin, entry, hold_from, hold_to, hold = now, start, 0.0, 0.0, 0.0
    cycle = cycle_of(action.kind, action.timing, start, end)
    if (
        request is not None
        and action.kind == "gesture"
        and (request.hold is not None or request.stroke is not None or not request.prepare)
    ):
        found = find_phases(project, action)
        latest = found.skip(action.timing.blend_in)
        entry = start if request.prepare else latest
        # Wait for the stroke, or catch up with it by cutting the preparation.
        if request.stroke is not None:
            begin = max(now, request.stroke - (found.stroke - entry) / speed)
            missed = found.stroke - max(0.0, request.stroke - begin) * speed
            entry = min(max(entry, missed), max(entry, latest))
        if request.hold is not None and cycle <= 0:
            hold_from, hold_to = found.stroke_end, found.relax
            hold = max(request.hold, (hold_to - hold_from) / HURRY)
            if hold <= 0:
                hold_from, hold_to = 0.0, 0.0
    natural = hold_to - hold_from
    length = end - entry + hold - natural + drag(end - entry - natural, speed)
    shortest, exit_at = length, action.timing.earliest_exit
    if cycle > 0:
        wanted = min(action.timing.repeat, LONGEST_REPEAT)
        if request is not None and request.hold is not None:
            wanted = request.hold  # what repeats goes on for as long as another gesture would be held
        if request is not None and request.duration is not None:
            wanted = request.duration
        length += (times_played(cycle, wanted * speed) - 1.0) * cycle / speed
        exit_at = end if exit_at is None else exit_at
    if exit_at is not None:
        left = exit_at - entry + (hold - natural if exit_at >= hold_to else 0.0)
        left += drag(exit_at - entry - (natural if exit_at >= hold_to else 0.0), speed)
        shortest = min(length, max(0.0, left) + action.timing.blend_out)
    return CueShape(begin, entry, length, shortest, hold_from, hold_to, hold, speed)


def fits_before(shape: CueShape, limit: float) -> bool:
    """Return whether something with this shape is over by a limit."""
    return shape.start + shape.shortest <= limit + FITS


def lateness(project: Project, action: Action, request: MetaRequest, shape: CueShape) -> float:
    """Return by how many seconds an action with this shape comes late, measured at its stroke if the request
    has one; below 0 if it comes early.
    """
    if request.stroke is not None and action.kind == "gesture":
        found = find_phases(project, action)
        until = found.stroke - shape.entry
        return shape.start + found.stroke - shape.entry + drag(until, shape.tempo) - request.stroke
    return shape.start - request.start


def slack_of(request: MetaRequest) -> float:
    """Return by how many seconds a request may come late, 0 if it does not say."""
    return 0.0 if request.late is None else request.late


def hurried(project: Project, action: Action, shape: CueShape) -> float:
    """Return how many seconds a gesture takes if its retraction is cut and its hold is left out, unless the
    request has a hold.
    """
    start, end = project.span(action)
    repeats = cycle_of(action.kind, action.timing, start, end) > 0
    if action.kind != "gesture" or action.timing.earliest_exit is not None or repeats:
        return shape.shortest
    found = find_phases(project, action)
    left = found.relax - shape.entry + shape.hold - (shape.hold_to - shape.hold_from)
    moving = found.relax - shape.entry - (shape.hold_to - shape.hold_from)
    if shape.hold <= 0:
        left = found.stroke_end - shape.entry
        moving = left
    left += drag(moving, shape.tempo)
    return min(shape.length, left + max(action.timing.blend_out, RETRACTION))


def may_share(request: MetaRequest, other: MetaRequest) -> bool:
    """Return whether one stroke may meet two requests."""
    if request.stroke is None or other.stroke is None:
        return False
    return (
        request.action is None
        and other.action is None
        and request.kind == other.kind
        and (other.hold is None or other.hold == request.hold)
        and abs(request.stroke - other.stroke) <= SHARED
    )


def meets(action: Action, request: MetaRequest) -> bool:
    """Return whether an action fits a request that does not name one."""
    return (
        all(tag in action.tags for tag in request.tags)
        and (request.limb is None or action.limb == request.limb)
        and (len(request.among) == 0 or action.id in request.among)
    )


def remaining(meta: MetaAction, now: float) -> MetaRequest:
    """Return the request of a meta action; for a remainder, with the duration that is left. What a model
    wrote has no duration.
    """
    request = meta.request
    if request.duration is None or (meta.part == 0 and not meta.written):
        return request
    return replace(request, duration=None if meta.written else max(0.0, meta.end - now))
