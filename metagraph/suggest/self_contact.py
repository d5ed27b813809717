"""Measure where hands touch their own body, which distinguishes a self-adaptor from a gesture in free space.

Body parts are capsules and a sphere about the joints, sized in heights of the character, so no mesh is
needed. A hand is the line from its wrist to its longest finger.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

# Heights: about half of what people measure there (a head is 0.09 wide and 0.11 deep, a chest 0.17 by 0.12).
HEAD, TRUNK, ARM, THIGH = 0.06, 0.075, 0.022, 0.045
SKULL = 0.06  # heights from the joint of the head to the middle of the skull
TOUCHES = 0.03  # heights between hand and surface at which they touch, because bones and takes are not exact
HANDLES = 0.05  # the same for a hand at the other arm, which may have sleeves or a watch
CLEAR = 0.02  # heights that a hand must come nearer than it is at first, so that the touch is new


@dataclass(frozen=True)
class SelfContact:
    """How much hands touch the own body, as shares of the time, 0..1.

    `head`, `trunk` and `arm`: a hand touches the own head, trunk, or other arm or hand, and did not at first.
    `kept`: the moving hand keeps touching what it touched at first. `rub` is in heights a second: how fast a
    hand moves on what it newly touches.
    """

    head: float = 0.0
    trunk: float = 0.0
    arm: float = 0.0
    kept: float = 0.0
    rub: float = 0.0


NOTHING = SelfContact()


def measure_self_contact(world: Mapping[str, Array], seconds: float) -> SelfContact:
    """Return how a clip's hands touch their own body. `world` is name -> `[F, 3]` in heights: hands, tips,
    lower and upper arms, head and skull, hips, thighs. `seconds` is the time from frame to frame.
    """
    share = {"head": 0.0, "trunk": 0.0, "arm": 0.0}
    kept, rub = 0.0, 0.0
    moving = {side: _goes(world, side) for side in ("left", "right")}
    for side, other in (("left", "right"), ("right", "left")):
        hand = world.get(f"{side}_hand")
        if hand is None or moving[side] < max(moving.values()) / 2:
            continue
        tip = world.get(f"{side}_tip", hand)
        points = np.stack([hand, (hand + tip) / 2, hand + 0.85 * (tip - hand)])
        for what, gap, place in _gaps(world, other, points):
            touching = gap < (HANDLES if what == "arm" else TOUCHES)
            if gap[0] < TOUCHES:
                kept = max(kept, float(touching.mean()) if what != "thigh" else 0.0)
            elif what in share and gap[0] - gap.min() > CLEAR:
                share[what] = max(share[what], float(touching.mean()))
                if touching.sum() > 2 and seconds > 0:
                    slide = np.linalg.norm(np.diff(place, axis=0), axis=-1)[touching[1:] & touching[:-1]]
                    rub = max(rub, float(slide.mean() / seconds) if len(slide) else 0.0)
    return SelfContact(share["head"], share["trunk"], share["arm"], kept, rub)


def _goes(world: Mapping[str, Array], side: str) -> float:
    """Return how far a hand moves relative to its shoulder, in heights."""
    hand, shoulder = world.get(f"{side}_hand"), world.get(f"{side}_upper_arm")
    if hand is None or shoulder is None:
        return 0.0
    return float(np.linalg.norm(np.ptp(hand - shoulder, axis=0)))


def _gaps(world: Mapping[str, Array], other: str, points: Array) -> list[tuple[str, Array, Array]]:
    """Return (part, `[F]` the distance of the hand from its surface, `[F, 3]` the hand's position relative to
    it).
    """
    out = []
    if (skull := world.get("skull")) is not None:
        out.append(("head", _nearest(points, skull, skull) - HEAD, points[2] - skull))
    left, right, hips = world.get("left_upper_arm"), world.get("right_upper_arm"), world.get("hips")
    if left is not None and right is not None and hips is not None:
        top = (left + right) / 2
        out.append(("trunk", _nearest(points, hips, top) - TRUNK, points[2] - top))
    for a, b in (("lower_arm", "hand"), ("upper_arm", "lower_arm"), ("hand", "tip")):
        start, end = world.get(f"{other}_{a}"), world.get(f"{other}_{b}")
        if start is not None and end is not None:
            out.append(("arm", _nearest(points, start, end) - ARM, points[2] - end))
    for side in ("left", "right"):
        start, end = world.get(f"{side}_upper_leg"), world.get(f"{side}_lower_leg")
        if start is not None and end is not None:
            out.append(("thigh", _nearest(points, start, end) - THIGH, points[2] - start))
    return out


def _nearest(points: Array, a: Array, b: Array) -> Array:
    """Return `[F]` the distance of the nearest of points `[P, F, 3]` from the line a-b, `[F, 3]` each."""
    line = b - a
    length = np.maximum(np.sum(line * line, -1), 1e-9)
    share = np.clip(np.sum((points - a) * line, -1) / length, 0, 1)
    return np.asarray(np.linalg.norm(points - a - share[..., None] * line, axis=-1).min(0))
