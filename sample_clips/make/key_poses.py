"""A posture as an animator describes it, and its joints' rotations.

Hands are placed in the space of the chest, but in the numbers of the whole figure at rest: (out, up,
forwards) in metres, where out is the hand's own side, up is height above the floor (hip bone 1.0, belly 1.1,
chest 1.3, chin 1.48) and forwards is from the body's middle. The same `Hand` therefore serves either side,
and leans with the torso.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from metagraph.motion import rotation
from sample_clips.make import hands, ik
from sample_clips.make.mannequin_rig import (
    ARM_AXIS,
    JOINTS,
    NECK,
    PALM,
    REST,
    SIDES,
    SPINE,
    Angles,
    Array,
    about,
    at,
    mirrored,
    turned,
)

SPINE_SHARE = (0.28, 0.36, 0.36)  # how a bend of the whole spine falls on Spine, Chest, UpperChest
NECK_SHARE = (0.42, 0.58)  # and one of the head on Neck, Head
CHEST = REST[at("UpperChest")]


@dataclass(frozen=True)
class Hand:
    """One hand: where its wrist is, and how it is held.

    at: the wrist's (out, up, forwards), metres. turn: degrees the palm turns up from thumb-up (minus: down).
    bend: degrees the wrist bends to the palm (minus: back). side: degrees towards the thumb (minus: the
    little finger). fingers, palm: directions (out, up, forwards) that replace turn, bend and side. elbow:
    where the elbow points. shape: of the fingers. shrug, reach: degrees the shoulder is raised, and brought
    forwards.
    """

    at: tuple[float, float, float]
    turn: float = 0.0
    bend: float = 0.0
    side: float = 0.0
    shape: str | tuple[hands.Finger, ...] = "relaxed"
    elbow: tuple[float, float, float] = (0.45, -0.75, -0.5)
    shrug: float = 0.0
    reach: float = 0.0
    fingers: tuple[float, float, float] | None = None
    palm: tuple[float, float, float] | None = None

    def moved(self, out: float = 0.0, up: float = 0.0, forwards: float = 0.0, **changes: Any) -> Hand:
        """Return the hand moved by metres, with other fields changed; turn, bend, side, shrug and reach are
        added to.
        """
        added = {
            k: getattr(self, k) + v
            for k, v in changes.items()
            if k in ("turn", "bend", "side", "shrug", "reach")
        }
        x, y, z = self.at
        return replace(self, at=(x + out, y + up, z + forwards), **{**changes, **added})


@dataclass(frozen=True)
class Foot:
    """One foot: the ball's shift from rest (out, forwards; metres), lift (m), turn outwards and heel raise
    (degrees; less than 0 raises the toes with the ball).
    """

    out: float = 0.012
    forwards: float = 0.0
    turn: float = 8.0
    lift: float = 0.0
    heel: float = 0.0


@dataclass(frozen=True)
class Posture:
    """The whole figure. spine, head, hips: (pitch, turn, lean) degrees. shift: the hips' (left, up, forwards)
    from rest, metres. brows: degrees raised; lids: degrees closed.
    """

    left: Hand
    right: Hand
    spine: Angles = (0.0, 0.0, 0.0)
    head: Angles = (0.0, 0.0, 0.0)
    hips: Angles = (0.0, 0.0, 0.0)
    shift: tuple[float, float, float] = (0.0, -0.0035, 0.0)
    left_foot: Foot = field(default_factory=Foot)
    right_foot: Foot = field(default_factory=Foot)
    brows: float = 0.0
    lids: float = 0.0


def elbow_of(hand: Hand) -> tuple[Array, float]:
    """Return where a hand's elbow is, (out, up, forwards) in metres, and how far the wrist is from it."""
    collar, upper, _ = (arm_rotations(hand)[name] for name in ("Shoulder", "UpperArm", "LowerArm"))
    shoulder = REST[at("LeftShoulder")] + rotation.rotate_vectors(
        collar, REST[at("LeftUpperArm")] - REST[at("LeftShoulder")]
    )
    bone = REST[at("LeftLowerArm")] - REST[at("LeftUpperArm")]
    elbow = shoulder + rotation.rotate_vectors(rotation.multiply(collar, upper), bone)
    return elbow, float(np.linalg.norm(np.array(hand.at) - elbow))


def arm_rotations(hand: Hand) -> dict[str, Array]:
    """Return the left arm's local rotations by joint name without its side."""
    wrist = np.array(hand.at) - CHEST
    collar = ik.raised(hand.shrug, hand.reach)
    for _ in range(3):  # the collarbone follows the arm, which moves the shoulder the arm hangs from
        upper, lower, forearm = ik.arm(wrist, hand.elbow, collar)
        collar = ik.collarbone(upper, collar, hand.shrug, hand.reach)
    upper, lower, forearm = ik.arm(wrist, hand.elbow, collar)
    if hand.fingers is not None and hand.palm is not None:
        aim = rotation.multiply(
            ik.frame(np.array(hand.fingers), np.array(hand.palm)),
            rotation.conjugate(ik.frame(ARM_AXIS, PALM)),
        )
        turn = rotation.multiply(rotation.conjugate(forearm), aim)
    else:
        bent = rotation.multiply(about(np.cross(ARM_AXIS, PALM), hand.bend), about(PALM, hand.side))
        turn = rotation.multiply(about(ARM_AXIS, -hand.turn), bent)
    lower, turn = ik.share_twist(lower, turn)
    return {
        "Shoulder": collar,
        "UpperArm": upper,
        "LowerArm": lower,
        "Hand": turn,
        **hands.finger_rotations(hand.shape),
    }


def solve(posture: Posture) -> Array:
    """Return local rotations `[J, 4]` of everything but the legs, which `channels` and `legs` place frame by
    frame.
    """
    out = rotation.make_identity_rotations((JOINTS,))
    out[at("Hips")] = turned(posture.hips)
    for names, shares, angles in ((SPINE, SPINE_SHARE, posture.spine), (NECK, NECK_SHARE, posture.head)):
        for name, share in zip(names, shares, strict=True):
            out[at(name)] = turned(np.array(angles) * share)
    for side, hand in zip(SIDES, (posture.left, posture.right), strict=True):
        for name, q in arm_rotations(hand).items():
            out[at(side + name)] = q if side == "Left" else mirrored(q)
        out[at(side + "Brow")] = about((1, 0, 0), -posture.brows)
        out[at(side + "UpperLid")] = about((1, 0, 0), posture.lids)
    return out


def channels(posture: Posture) -> Array:
    """Return what is interpolated as plain numbers `[13]`: the hips' shift and both feet."""
    feet = (posture.left_foot, posture.right_foot)
    return np.array(
        [*posture.shift, *(v for f in feet for v in (f.out, f.forwards, f.turn, f.lift, f.heel))], float
    )


def legs(rotations: Array, numbers: Array) -> tuple[Array, Array]:
    """Place the legs: return `rotations [F, J, 4]` with feet where `numbers [F, 13]` say, and the root's
    places `[F, 3]`.
    """
    out = rotations.copy()
    root = REST[0] + numbers[:, :3]
    hips = out[:, 0]
    targets = []
    for side, sign, first in (("Left", 1.0, 3), ("Right", -1.0, 8)):
        sideways, forwards, turn, lift, heel = numbers[:, first : first + 5].T
        yaw = about((0, 1, 0), sign * turn)
        foot = rotation.multiply(yaw, about((1, 0, 0), heel))
        ball = ik.BALL[side] + np.stack([sign * sideways, lift, forwards], -1)
        ankle = ball + rotation.rotate_vectors(foot, ik.ANKLE[side] - ik.BALL[side])
        knee = rotation.rotate_vectors(about((0, 1, 0), sign * (turn * 0.8 + 2)), np.array([0.0, 0, 1.0]))
        targets.append((side, ankle, knee, foot, heel))
    sinks = [ik.out_of_reach(side, hips, root, ankle) for side, ankle, *_ in targets]
    root[:, 1] -= np.max(sinks, axis=0)  # feet stay, hips give
    for side, ankle, knee, foot, heel in targets:
        thigh, shin, foot_local = ik.leg(side, hips, root, ankle, knee, foot)
        for joint, q in (("UpperLeg", thigh), ("LowerLeg", shin), ("Foot", foot_local)):
            out[:, at(side + joint)] = q
        out[:, at(side + "Toes")] = about((1, 0, 0), -np.maximum(heel, 0.0))
    return out, root
