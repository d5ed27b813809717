"""Contacts of an action: where on the body a hand stays, or moves along it, for a part of its clip.

A contact gives the position of the wrist and the rotation of the hand in the space of a joint. So it holds
whatever else moves that joint: a breathing spine, a layer below, a body of another shape.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from metagraph.motion.plain_vectors import Quaternion, Vector

HANDS: tuple[str, ...] = ("left", "right")
PLACES: tuple[str, ...] = ("palm", "fingertips", "back", "wrist")
EASE = 0.15  # seconds in which a hand comes to a contact, and leaves it, by default
SETTLES = 0.3  # seconds it takes at least where the contact lasts: what it touches may be far from its place


@dataclass(frozen=True, slots=True)
class ContactKey:
    """Where a hand is on a joint at a moment. time: clip seconds. at: the wrist in the joint's own space,
    metres. turn: how the hand is turned there, xyzw.
    """

    time: float
    at: Vector
    turn: Quaternion


@dataclass(frozen=True, slots=True)
class ContactSpan:
    """A hand that stays at a place on the body.

    hand: left or right. place: the part of the hand that touches: palm, fingertips, back, wrist. to: the name
    of the joint it stays with. start, end: clip seconds. keys: one for a hand that stays, more, in order, for
    one that moves over the body. ease_in, ease_out: seconds inside the span in which the contact sets in and
    fades out; they do not apply if the action begins, or ends, within the span.
    """

    hand: str
    place: str
    to: str
    start: float
    end: float
    keys: tuple[ContactKey, ...]
    ease_in: float = EASE
    ease_out: float = EASE


def contact_weight(span: ContactSpan, seconds: float, first: float, last: float) -> float:
    """Return how much a hand is held at a second of the clip, 0..1. first, last: the seconds of the clip that
    play.
    """
    if seconds < span.start or seconds > span.end:
        return 0.0
    shown = 1.0
    comes = span.start > first and span.ease_in > 0.0
    goes = span.end < last and span.ease_out > 0.0
    least = min(SETTLES, (span.end - span.start) / (2.0 if comes and goes else 1.0))
    if comes:
        shown = min(shown, (seconds - span.start) / max(span.ease_in, least))
    if goes:
        shown = min(shown, (span.end - seconds) / max(span.ease_out, least))
    return shown * shown * (3.0 - 2.0 * shown)


def contact_key(span: ContactSpan, seconds: float) -> ContactKey:
    """Return where a hand is at a second of the clip, interpolated linearly between two keys."""
    before = span.keys[0]
    for after in span.keys:
        if after.time >= seconds:
            if after.time <= before.time:
                return after
            part = (seconds - before.time) / (after.time - before.time)
            ax, ay, az = before.at
            bx, by, bz = after.at
            at = (ax + (bx - ax) * part, ay + (by - ay) * part, az + (bz - az) * part)
            px, py, pz, pw = before.turn
            qx, qy, qz, qw = after.turn
            other = -part if px * qx + py * qy + pz * qz + pw * qw < 0.0 else part
            own = 1.0 - part
            x, y, z, w = (
                px * own + qx * other,
                py * own + qy * other,
                pz * own + qz * other,
                pw * own + qw * other,
            )
            size = 1.0 / max(sqrt(x * x + y * y + z * z + w * w), 1e-12)
            return ContactKey(seconds, at, (x * size, y * size, z * size, w * size))
        before = after
    return before
