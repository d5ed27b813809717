"""A hand kept where it is on the body for a while: on a hip that sways, at a chin that turns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.limbs import normalize_directions

Array = NDArray[Any]

EASE = (0.16, 0.7)  # seconds in which a hand comes to where it stays, and leaves it: least and most
PACE = 0.7  # metres a second, on average, that it leaves with
MOST = 16  # contacts of a clip
REACHED = 0.999  # of a limb: it never quite snaps straight


@dataclass(frozen=True, slots=True)
class Contact:
    """upper, lower, hand: names of the joints of a limb, each above the next. to: the joint the hand stays
    with. first, last: seconds of the clip as it was read; the hand stays as it is at the first.
    """

    upper: str
    lower: str
    hand: str
    to: str
    first: float
    last: float


def hold_hands(clip: Clip, contacts: Iterable[Contact]) -> Clip:
    """Return a clip in which hands stay where contacts say; those whose joints it has not, or that are no
    limb, are left out.
    """
    for contact in contacts:
        if _fits(clip, contact):
            clip = _held(clip, contact)
    return clip


def find_nearest_joint(clip: Clip, hand: int, among: Iterable[int], seconds: float) -> int | None:
    """Return which of some joints a hand is nearest to at a moment, None of none."""
    _, places = clip.skeleton.globals(clip.pose_at(seconds))
    found = [(float(np.linalg.norm(places[hand] - places[j])), j) for j in among if j != hand]
    return min(found)[1] if found else None


def _fits(clip: Clip, contact: Contact) -> bool:
    skeleton = clip.skeleton
    if any(n not in skeleton for n in (contact.upper, contact.lower, contact.hand, contact.to)):
        return False
    upper, lower, hand, to = (
        skeleton.index(n) for n in (contact.upper, contact.lower, contact.hand, contact.to)
    )
    above = _above(clip, hand)
    return lower in above and upper in _above(clip, lower) and upper not in _above(clip, to) and to != upper


def _above(clip: Clip, joint: int) -> list[int]:
    out, parent = [], int(clip.skeleton.parents[joint])
    while parent >= 0:
        out.append(parent)
        parent = int(clip.skeleton.parents[parent])
    return out


def _held(clip: Clip, contact: Contact) -> Clip:
    skeleton = clip.skeleton
    upper, lower, hand, to = (
        skeleton.index(n) for n in (contact.upper, contact.lower, contact.hand, contact.to)
    )
    turns, places = (np.asarray(a, np.float64) for a in skeleton.globals(clip.poses()))
    at = min(max(round(contact.first * clip.fps), 0), clip.frames - 1)
    back = rotation.conjugate(turns[at, to])
    offset = rotation.rotate_vectors(back, places[at, hand] - places[at, to])
    turn = rotation.multiply(back, turns[at, hand])
    stays = places[:, to] + rotation.rotate_vectors(
        turns[:, to], np.broadcast_to(offset, places[:, to].shape)
    )
    weight = _weight(clip, contact, np.linalg.norm(stays - places[:, hand], axis=-1))
    goal = places[:, hand] + weight[:, None] * (stays - places[:, hand])
    wanted = rotation.multiply(turns[:, to], np.broadcast_to(turn, turns[:, to].shape))
    turned = rotation.nlerp(turns[:, hand], wanted, weight)
    rotations = bring_limb(clip, turns, places, (upper, lower, hand), goal, turned)
    out, moved = clip.rotations.copy(), weight > 0
    for joint in (upper, lower, hand):
        out[moved, joint] = _continuous(rotations[moved, joint], clip.rotations[moved, joint])
    return replace(clip, rotations=out)


def bring_limb(
    clip: Clip, turns: Array, places: Array, limb: tuple[int, int, int], goal: Array, turned: Array
) -> Array:
    """Return a clip's local rotations `[F, J, 4]` with the end of a limb of two bones where it should be, or
    as near as it reaches; it bends to the side it is bent to.

    turns `[F, J, 4]`, places `[F, J, 3]`: of all joints, globally. limb: its upper and lower joint, its end.
    goal `[F, 3]`: where the end comes to. turned `[F, 4]`: how the end is turned then, globally.
    """
    parents = clip.skeleton.parents
    upper, lower, end = limb
    swing, fold = _bent(places[:, upper], places[:, lower], places[:, end], goal, turns[:, upper])
    rotations = np.array(clip.rotations, np.float64)
    above_upper = turns[:, parents[upper]] if parents[upper] >= 0 else rotation.IDENTITY
    rotations[:, upper] = rotation.multiply(
        rotation.conjugate(above_upper), rotation.multiply(swing, turns[:, upper])
    )
    above_lower = rotation.multiply(swing, turns[:, parents[lower]])
    both = rotation.multiply(fold, swing)
    rotations[:, lower] = rotation.multiply(
        rotation.conjugate(above_lower), rotation.multiply(both, turns[:, lower])
    )
    above_end = rotation.multiply(both, turns[:, parents[end]])
    rotations[:, end] = rotation.multiply(rotation.conjugate(above_end), turned)
    return rotations


def _continuous(rotations: Array, like: Array) -> Array:
    """Return rotations on the side their neighbours are on."""
    out = np.where(np.einsum("...i,...i->...", rotations, like)[..., None] < 0, -rotations, rotations)
    return np.asarray(out / np.linalg.norm(out, axis=-1, keepdims=True), np.float32)


def _weight(clip: Clip, contact: Contact, gaps: Array) -> Array:
    """Return `[F]` how much the hand is held, 0..1, coming and going smoothly. gaps `[F]`: metres from where
    it would be.
    """
    times = np.arange(clip.frames) / clip.fps
    way = float(np.interp(contact.last, times, gaps))
    leaving = min(max(EASE[0], way / PACE), EASE[1])
    outside = np.maximum((contact.first - times) / EASE[0], (times - contact.last) / leaving)
    x = np.clip(1 - outside, 0, 1)
    return np.asarray(x * x * (3 - 2 * x))


def _bent(root: Array, middle: Array, end: Array, goal: Array, turn: Array) -> tuple[Array, Array]:
    """Return how the two bones of a limb turn, `[F, 4]` each, the second after the first, so that its end
    comes to the goal, or as near as it reaches; it bends to the side it is bent to.
    """
    one, two = (np.linalg.norm(v, axis=-1) for v in (middle - root, end - middle))
    way = goal - root
    far = np.clip(np.linalg.norm(way, axis=-1), np.abs(one - two) + 1e-4, REACHED * (one + two))
    ahead, now = normalize_directions(way), normalize_directions(end - root)
    aside = middle - root - now * np.einsum("fi,fi->f", middle - root, now)[:, None]
    # A straight limb has no side: then one that goes with the bone.
    spare = rotation.rotate_vectors(turn, np.broadcast_to(np.array([0.31, 0.52, 0.8]), now.shape))
    straight = np.linalg.norm(aside, axis=-1) < 1e-3 * (one + two)
    aside = np.where(straight[:, None], spare - now * np.einsum("fi,fi->f", spare, now)[:, None], aside)
    aside = rotation.rotate_vectors(rotation.find_rotation_between(now, ahead), aside)
    along = (one**2 + far**2 - two**2) / (2 * far)
    high = np.sqrt(np.maximum(0, one**2 - along**2))
    knee = ahead * along[:, None] + normalize_directions(aside) * high[:, None]
    swing = rotation.find_rotation_between(normalize_directions(middle - root), normalize_directions(knee))
    carried = rotation.rotate_vectors(swing, end - middle)
    fold = rotation.find_rotation_between(
        normalize_directions(carried), normalize_directions(ahead * far[:, None] - knee)
    )
    return swing, fold
