"""What the animator does not key: the wrist that drags behind, the hand that stays on the hip, the life in a
hold.
"""

from __future__ import annotations

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from sample_clips.make import ik
from sample_clips.make.mannequin_rig import (
    ARM_AXIS,
    FPS,
    PALM,
    SIDES,
    SKELETON,
    THUMB_SIDE,
    Array,
    about,
    at,
    flipped,
    mirrored,
)
from sample_clips.make.mannequin_skeleton import FINGERS
from sample_clips.make.motion_tracks import ease, wander

DRAG = 9.0  # degrees the hand lags per metre a second of its wrist
DRAG_MOST = 22.0  # degrees
SPRING, DAMPING = 15.0, 0.6  # how fast (rad/s) and how springily the hand comes after
FINGER_DRAG = 0.45  # of the hand's lag is seen in each knuckle


def globals_of(rotations: Array) -> tuple[Array, Array]:
    """Return model-space rotations `[F, J, 4]` and places `[F, J, 3]` with the root at rest."""
    translations = np.broadcast_to(SKELETON.rest_translations, (*rotations.shape[:-1], 3))
    return SKELETON.globals(Pose(rotations, translations))


def hanging(rotations: Array, base: Array, share: float) -> Array:
    """Return `rotations [F, J, 4]` whose upper arms are turned back by a share of how far the trunk bends
    forwards, so that arms hang, or lie on what they lie on. base `[J, 4]`: how the arms are upright.
    """
    out = rotations.copy()
    turned, _ = globals_of(rotations)
    upright, _ = globals_of(base[None])
    for side in SIDES:
        collar, upper = at(side + "Shoulder"), at(side + "UpperArm")
        leans = []
        for turn in (turned[:, at("UpperChest")], upright[:, at("UpperChest")]):
            up = rotation.rotate_vectors(turn, np.broadcast_to(np.array([0.0, 1.0, 0.0]), (len(turn), 3)))
            leans.append(np.degrees(np.arctan2(up[:, 2], up[:, 1])))
        back = about((1, 0, 0), -share * (leans[0] - leans[1]))
        inside = rotation.multiply(rotation.conjugate(turned[:, collar]), back)
        out[:, upper] = rotation.multiply(rotation.multiply(inside, turned[:, collar]), base[upper])
    return out


def _springy(target: Array) -> Array:
    """Return `target [F, N]` followed by a damped spring, from rest."""
    out, value, speed = np.empty_like(target), target[0] * 0, target[0] * 0
    small = 4
    dt = 1 / FPS / small
    for i, wanted in enumerate(target):
        for _ in range(small):
            speed = speed + dt * (SPRING**2 * (wanted - value) - 2 * DAMPING * SPRING * speed)
            value = value + dt * speed
        out[i] = value
    return out


def _window(frames: int, seconds: float = 0.3) -> Array:
    """Return `[F]`: 0 at both ends, 1 between."""
    t = np.arange(frames) / FPS
    long = min(seconds, t[-1] / 3)
    return ease(t / long, 0.5) * ease((t[-1] - t) / long, 0.5)


def drag(rotations: Array, amount: float = 1.0) -> Array:
    """Let hands and fingers lag behind their wrists and settle after them; `rotations [F, J, 4]`."""
    out = rotations.copy()
    turns, places = globals_of(rotations)
    window = _window(len(rotations))[:, None]
    for side in SIDES:
        hand = at(side + "Hand")
        velocity = np.gradient(places[:, hand], 1 / FPS, axis=0)
        # In the hand's own axes: backwards and forwards of the palm it flaps, towards the thumb it hardly
        # gives.
        local = rotation.rotate_vectors(rotation.conjugate(turns[:, hand]), velocity)
        local = local if side == "Left" else flipped(local)
        curl_way, side_way = local @ PALM, local @ THUMB_SIDE
        lag = (
            np.clip(_springy(-DRAG * amount * np.stack([curl_way, side_way], -1)), -DRAG_MOST, DRAG_MOST)
            * window
        )
        if np.abs(lag).max() < 0.05:
            continue
        q = rotation.multiply(about(np.cross(ARM_AXIS, PALM), lag[:, 0]), about(PALM, lag[:, 1] * 0.7))
        out[:, hand] = rotation.multiply(out[:, hand], q if side == "Left" else mirrored(q))
        curl = about(np.cross(ARM_AXIS, PALM), lag[:, 0] * FINGER_DRAG)
        for finger in FINGERS[1:]:
            for bone in ("1", "2"):
                joint = at(side + finger + bone)
                out[:, joint] = rotation.multiply(out[:, joint], curl if side == "Left" else mirrored(curl))
    return out


def pin(rotations: Array, side: str, joint: str, weight: Array | float = 1.0) -> Array:
    """Keep a hand where it is on the first frame relative to a joint, by `weight [F]`; `rotations [F, J,
    4]`.
    """
    out = rotations.copy()
    turns, places = globals_of(rotations)
    chest, hand, base = at("UpperChest"), at(side + "Hand"), at(joint)
    inverse = rotation.conjugate
    grip = rotation.rotate_vectors(inverse(turns[0, base]), places[0, hand] - places[0, base])
    grip_turn = rotation.multiply(inverse(turns[0, base]), turns[0, hand])
    held = places[:, base] + rotation.rotate_vectors(turns[:, base], grip)
    held_turn = rotation.multiply(turns[:, base], grip_turn)
    w = np.broadcast_to(np.asarray(weight, float), (len(out),))
    wrist = places[:, hand] + w[:, None] * (held - places[:, hand])
    hand_turn = rotation.slerp(turns[:, hand], held_turn, w)
    return reach(out, side, wrist, hand_turn, turns, places, chest)


def reach(
    out: Array, side: str, wrist: Array, hand_turn: Array, turns: Array, places: Array, chest: int
) -> Array:
    """Move one arm so that its wrist is at `wrist [F, 3]` turned as `hand_turn [F, 4]`; the elbow stays on
    its side.
    """
    inverse = rotation.conjugate
    to_chest = inverse(turns[:, chest])
    wrist_c = rotation.rotate_vectors(to_chest, wrist - places[:, chest])
    shoulder, elbow = places[:, at(side + "UpperArm")], places[:, at(side + "LowerArm")]
    middle = (shoulder + places[:, at(side + "Hand")]) / 2
    pole = rotation.rotate_vectors(to_chest, elbow - middle)
    collar = out[:, at(side + "Shoulder")]
    turn_c = rotation.multiply(to_chest, hand_turn)
    if side == "Right":
        wrist_c, pole, collar, turn_c = flipped(wrist_c), flipped(pole), mirrored(collar), mirrored(turn_c)
    upper, lower, forearm = ik.arm(wrist_c, pole, collar)
    lower, local = ik.share_twist(lower, rotation.multiply(inverse(forearm), turn_c))
    for name, q in (("UpperArm", upper), ("LowerArm", lower), ("Hand", local)):
        out[:, at(side + name)] = q if side == "Left" else mirrored(q)
    return out


def life(rotations: Array, seed: int, sizes: dict[str, float], loop: bool, every: float = 0.55) -> Array:
    """Add slow unsteady drifts to the joints named, each of about `sizes` degrees; still at both ends."""
    out = rotations.copy()
    generator = np.random.default_rng(seed)
    drifts = wander(generator, len(rotations), every, 3 * len(sizes), loop).reshape(
        len(rotations), len(sizes), 3
    )
    for i, (name, size) in enumerate(sizes.items()):
        joint = at(name)
        out[:, joint] = rotation.multiply(out[:, joint], rotation.exp(np.radians(size) * drifts[:, i]))
    return out
