"""Where a target's hips, feet and hands go, by where the source's are and how the figures are built.

All but hands that are too short for their place goes back the way it came, so that a clip brought to a figure
and back is itself again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import ARM, SIDES
from metagraph.motion.limbs import ease_reach, fade_above_half
from metagraph.motion.standing import StandingFigure, align_standing

Array = NDArray[Any]

STRAIGHT = (
    0.96  # of the arm: from here on it stretches ever less for a place that only wider shoulders put so far
)
ASIDE = np.radians(50)  # how far at most a foot turned from the hips' heading is followed in setting it apart
UPTURNED, LIFTED = (
    0.5,
    0.3,
)  # 1 - cosine of the sole's tilt, and of the leg: from there a foot bears no weight
# Beside the trunk, of the left side: directions whose opposites no hand and no foot comes near.
OUTWARDS = {"upper_arm": np.array([0.6, -0.3, 0.75]), "upper_leg": np.array([0.0, -1, 0])}
FLOATING = 0.25  # of the leg: a rest pose this far off the ground is not standing on it


class LimbGoals:
    """A source's motion beside a target figure: `from_turns [F, J, 4]` and `from_places [F, J, 3]` in the
    character's axes.

    align: role -> the turn that brings the target's standing pose to the source's. scale: by the legs'
    length. chest: the role that carries the arms.
    """

    def __init__(
        self, clip: Clip, source: StandingFigure, target: StandingFigure, roles: Sequence[str]
    ) -> None:
        self.clip, self.source, self.target = clip, source, target
        turns, places = clip.skeleton.globals(clip.poses())
        self.from_turns = rotation.multiply(source.turn.astype(np.float32), turns)
        self.from_places = rotation.rotate_vectors(source.turn.astype(np.float32), places)
        self.align = align_standing(source, target, roles)
        self.level = rotation.IDENTITY if source.natural and target.natural else source.frame()
        self.chest = next(r for r in ("upper_chest", "chest", "spine", "hips") if r in roles)
        self.scale = target.leg / source.leg
        self.ground()

    def ground(self) -> None:
        """Find the ankles' heights that correspond: those of figures standing on the ground, whatever height
        a rest pose has.
        """
        ankles = self.from_places[:, [self.source.roles["left_foot"], self.source.roles["right_foot"]], 1]
        self.from_ankle = self.source.ankle
        if self.source.natural and abs(float(ankles.min()) - self.from_ankle) > FLOATING * self.source.leg:
            low = self.source.positions[:, 1].min()  # the rest pose floats or hangs: stand it on the ground
            self.from_ankle -= float(low)
        self.to_ankle = self.target.ankle
        low = float(self.target.positions[:, 1].min())
        if self.target.natural and abs(low) > FLOATING * self.target.leg:
            self.to_ankle -= low

    def turned(self, role: str) -> Array:
        """Return how a joint of the source is turned from its standing pose, `[F, 4]`."""
        joint = self.source.roles[role]
        return rotation.multiply(
            self.from_turns[:, joint].astype(np.float64), rotation.conjugate(self.source.rotations[joint])
        )

    def outwards(self, upper: str) -> Array:
        """Return the directions `[F, 3]` from which the bend of the limb of that role is computed."""
        side, kind = upper.split("_", 1)
        beside = OUTWARDS[kind] * [1 if side == "left" else -1, 1, 1]
        trunk = "hips" if kind == "upper_leg" else self.chest
        return rotation.rotate_vectors(self.turned(trunk), rotation.rotate_vectors(self.level, beside))

    def placed(self, points: Array) -> Array:
        """Return where places `[F, 3]` near the source's legs come to: scaled, the ankles of a standing
        figure on the ground.
        """
        origin = np.array([self.source.hip[0], self.from_ankle, self.source.hip[2]], np.float32)
        goal = np.array([self.target.hip[0], self.to_ankle, self.target.hip[2]], np.float32)
        return np.asarray(goal + np.float32(self.scale) * (points - origin))

    def foot_goal(self, side: str) -> Array:
        """Return where an ankle goes, `[F, 3]`. Wider hips set it further out: a foot flat on the ground as
        it points, so that it stays there while the hips turn; any other as the hips lie.
        """
        above, legs = self.source.roles[f"{side}_foot"], [self.source.roles[f"{s}_upper_leg"] for s in SIDES]
        wide = (1 if side == "left" else -1) * (self.target.half_hips - self.scale * self.source.half_hips)
        # Halfway between how either stands with toes out: the same way there and back.
        half = rotation.scale_rotation(self.align[f"{side}_foot"], 0.5)
        turned = rotation.multiply(
            self.from_turns[:, above],
            rotation.multiply(rotation.conjugate(self.source.rotations[above]), half).astype(np.float32),
        )
        hips = self.from_places[:, legs[0]] - self.from_places[:, legs[1]]
        hips = hips / np.maximum(np.linalg.norm(hips, axis=-1, keepdims=True), 1e-9)
        body, foot = np.arctan2(-hips[:, 2], hips[:, 0]), 2 * np.arctan2(turned[:, 1], turned[:, 3])
        aside = (foot - body + np.pi) % (2 * np.pi) - np.pi
        heading = body + np.sign(aside) * ASIDE * ease_reach(np.abs(aside) / ASIDE, np.full(len(aside), 0.6))
        flat = np.stack([np.cos(heading), 0 * heading, -np.sin(heading)], -1)
        tilt = 1 - 2 * (turned[:, 0] ** 2 + turned[:, 2] ** 2)  # of the sole: 1 flat, 0 upright
        high = np.abs(self.from_places[:, above, 1] - self.from_ankle) / self.source.leg
        planted = (fade_above_half((1 - tilt) / UPTURNED) * fade_above_half(high / LIFTED))[:, None]
        out = planted * flat + (1 - planted) * hips * [1, 0, 1]  # an ankle keeps its height
        place = self.placed(self.from_places[:, above])
        return np.asarray(place + np.float32(wide) * out.astype(np.float32))

    def hand_goal(self, side: str) -> Array:
        """Return where a wrist goes from its shoulder, `[F, 3]`: as it was, scaled by the arm's length, and
        towards the middle by the shoulders' width.
        """
        upper, hand = self.source.roles[f"{side}_upper_arm"], self.source.roles[f"{side}_hand"]
        arm = [f"{side}_{part}" for part in ARM]
        scale, sign = self.target.length(*arm) / self.source.length(*arm), 1 if side == "left" else -1
        away = self.from_places[:, hand] - self.from_places[:, upper]
        level = rotation.rotate_vectors(self.turned(self.chest), np.array([1.0, 0, 0])) * [1, 0, 1]
        length = np.linalg.norm(level, axis=-1, keepdims=True)
        level = level / np.maximum(length, 0.3)
        from_half, to_half = self.source.half_shoulders, self.target.half_shoulders
        out = sign * np.einsum("fi,fi->f", away, level) + from_half
        inside = np.clip(out, -from_half, from_half)
        extra = (to_half / from_half - scale) * (inside - from_half)
        away, inwards = scale * away, (sign * extra)[:, None] * level
        # As far inwards as the arm is long enough for: a hand that cannot come to the middle stays in front.
        length = self.target.length(*arm)
        free = np.maximum(np.linalg.norm(away, axis=-1) / length, STRAIGHT)
        reach = ease_reach(np.linalg.norm(away + inwards, axis=-1) / length, free) * length
        room = reach**2 - np.einsum("fi,fi->f", away, away)
        along, square = (
            np.einsum("fi,fi->f", away, inwards),
            np.maximum(np.einsum("fi,fi->f", inwards, inwards), 1e-12),
        )
        most = np.clip(
            (np.sqrt(np.maximum(0, along**2 + square * np.maximum(0, room))) - along) / square, 0, 1
        )
        return np.asarray(away + most[:, None] * inwards)
