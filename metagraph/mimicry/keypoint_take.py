"""Motion of a skeleton from a person's keypoints in three dimensions: what a pose estimator saw in a video
becomes a take.

Hips and chest turn as the lines between hips and between shoulders do, limbs point where theirs point and
bend in the plane of theirs, the head looks where nose and ears say. Fingers, feet and how far a hand is
turned are not in keypoints: feet stay flat, the others as in the rest pose.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.mimicry.keypoint_layouts import PLACE, KeypointTrack
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

FPS = 30.0
SURE = 0.3  # confidence below which a point was not seen
LONGEST_GAP = 0.5  # seconds that are bridged; somebody unseen for longer stays as he was last seen
SMOOTH = 0.05  # seconds, standard deviation of the filter on places
LEGS = ("left_knee", "right_knee", "left_ankle", "right_ankle")
RARE = 0.1  # share of the time below which a leg's points count as not seen
LEG_UNSEEN = "knees or feet were not seen, so the character stands on straight legs"
SHANK = 0.85  # of a thigh or a lower leg, in lengths of the torso from hips to shoulders
STRAIGHT = 0.15  # sine of the bend below which a limb has no plane of its own
NEEDED = ("hips", "head", "left_upper_arm", "right_upper_arm", "left_upper_leg", "right_upper_leg")
LIMBS = (  # role, the point it begins at and the one it points to; parents first
    ("upper_arm", "shoulder", "elbow"),
    ("lower_arm", "elbow", "wrist"),
    ("upper_leg", "hip", "knee"),
    ("lower_leg", "knee", "ankle"),
)


class KeypointTakeError(ValueError):
    """These keypoints cannot be made into motion; the message says why, and what to do."""


def make_clip_from_keypoints(
    keypoints: KeypointTrack, skeleton: Skeleton, name: str, fps: float = FPS, smooth: float = SMOOTH
) -> Clip:
    """Return a clip of the skeleton at `fps` frames a second that moves as a person's keypoints do. Places
    are smoothed over `smooth` seconds, a standard deviation. Somebody whose knees or feet are not in the
    picture stands on straight legs, which the clip's notes say. Raises KeypointTakeError if points are flat,
    too few, or the skeleton lacks arms, legs or a head.
    """
    if keypoints.dims < 3:
        raise KeypointTakeError(
            "these keypoints have no depth, which motion needs: write the estimator's world landmarks "
            "(MediaPipe) or triangulated points (OpenPose, pose_keypoints_3d)"
        )
    roles = find_roles(skeleton)
    missing = [role for role in NEEDED if role not in roles]
    if missing:
        raise KeypointTakeError(f"the skeleton has no {', '.join(missing)}: name them in its joints' roles")
    times, places, notes = _even(keypoints, fps, smooth)
    seen = {point: places[:, n] for point, n in PLACE.items()}
    turns = _turned(skeleton, roles, seen)
    rest = skeleton.rest
    local = np.empty((len(times), len(skeleton), 4))
    for joint, parent in enumerate(skeleton.parents.tolist()):
        local[:, joint] = (
            turns[:, joint]
            if parent < 0
            else rotation.multiply(rotation.conjugate(turns[:, parent]), turns[:, joint])
        )
    root = _placed(skeleton, roles, local, seen, smooth * fps)
    translations = np.repeat(rest.translations[None, :1], len(times), 0)
    translations[:, 0] = root
    return Clip(name, skeleton, fps, rotation.make_continuous(local), translations, notes=notes)


def _even(keypoints: KeypointTrack, fps: float, smooth: float) -> tuple[Array, Array, tuple[str, ...]]:
    """Return even times `[F]`, smoothed places `[F, 17, 3]` of the points, gaps bridged, and notes."""
    places, sure = keypoints.canonical
    if len(keypoints) < 2 or keypoints.seconds <= keypoints.times[0]:
        raise KeypointTakeError("one frame is no motion: give a recording")
    times = np.arange(keypoints.times[0], keypoints.seconds + 1e-9, 1 / fps)
    out = np.empty((len(times), len(PLACE), 3))
    legs = True
    for name, n in PLACE.items():
        there = (sure[:, n] >= SURE) & np.isfinite(places[:, n]).all(-1)
        if there.sum() < 2 or (name in LEGS and there.mean() < RARE):
            if name in ("nose", "left_eye", "right_eye", "left_ear", "right_ear"):
                out[:, n] = np.nan  # the head then follows the chest
                continue
            if name in LEGS:
                legs = False
                continue
            raise KeypointTakeError(f"the {name.replace('_', ' ')} was never seen: show the whole person")
        at, of = keypoints.times[there], places[there, n]
        known = np.stack([np.interp(times, at, of[:, axis]) for axis in range(3)], -1)
        after = np.clip(np.searchsorted(at, times), 0, len(at) - 1)
        before = np.maximum(after - 1, 0)
        long = (at[after] - at[before] > LONGEST_GAP) & (times < at[after])
        known[long] = of[before[long]]
        out[:, n] = _smoothed(known, smooth * fps)
    if not legs:
        _stand(out)
    return times - times[0], out, () if legs else (LEG_UNSEEN,)


def _stand(places: Array) -> None:
    """Put knees and ankles of places `[F, 17, 3]` straight below the hips."""
    hips = places[:, [PLACE["left_hip"], PLACE["right_hip"]]]
    shoulders = places[:, [PLACE["left_shoulder"], PLACE["right_shoulder"]]]
    torso = float(np.median(np.linalg.norm((shoulders - hips).mean(1), axis=-1)))
    for part, below in (("knee", SHANK), ("ankle", 2 * SHANK)):
        for n, side in enumerate(("left", "right")):
            places[:, PLACE[f"{side}_{part}"]] = hips[:, n] - np.array([0.0, below * torso, 0.0])


def _smoothed(places: Array, frames: float) -> Array:
    """Return places `[F, D]` under a bell whose standard deviation is so many frames."""
    reach = max(1, round(3 * frames))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / frames) ** 2)
    padded = np.pad(places, ((reach, reach), (0, 0)), mode="edge")
    return np.stack(
        [np.convolve(padded[:, axis], kernel / kernel.sum(), "valid") for axis in range(places.shape[1])], -1
    )


def _frame(left: Array, up: Array) -> Array:
    """Return the turn `[..., 4]` of a body whose left and up these are; up is kept."""
    y = _unit(up)
    x = _unit(left - (left * y).sum(-1, keepdims=True) * y)
    return rotation.from_matrix(np.stack([x, y, np.cross(x, y)], -1))


def _unit(v: Array) -> Array:
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9))


def _turned(skeleton: Skeleton, roles: Mapping[str, int], seen: Mapping[str, Array]) -> Array:
    """Return global rotations `[F, J, 4]`."""
    rest_turns, rest_places = skeleton.globals(skeleton.rest)

    def middle(part: str) -> Array:
        return (seen[f"left_{part}"] + seen[f"right_{part}"]) / 2

    def rest_line(role: str) -> Array:
        return np.asarray(rest_places[roles[f"left_{role}"]] - rest_places[roles[f"right_{role}"]])

    up = middle("shoulder") - middle("hip")
    rest_up = (
        rest_places[roles["left_upper_arm"]]
        + rest_places[roles["right_upper_arm"]]
        - rest_places[roles["left_upper_leg"]]
        - rest_places[roles["right_upper_leg"]]
    )
    hips = _from_rest(seen["left_hip"] - seen["right_hip"], up, rest_line("upper_leg"), rest_up)
    chest = _from_rest(seen["left_shoulder"] - seen["right_shoulder"], up, rest_line("upper_arm"), rest_up)
    head = _head(seen, chest, skeleton, roles)
    away: dict[int, Array] = {roles["hips"]: hips}  # joint -> its turn from the rest pose
    trunk = [r for r in ("spine", "chest", "upper_chest") if r in roles]
    for n, role in enumerate(trunk, 1):
        away[roles[role]] = rotation.slerp(hips, chest, np.full(len(hips), n / len(trunk)))
    if "neck" in roles:
        away[roles["neck"]] = rotation.slerp(chest, head, np.full(len(hips), 0.5))
    away[roles["head"]] = head
    ends = {"upper_arm": "lower_arm", "lower_arm": "hand", "upper_leg": "lower_leg", "lower_leg": "foot"}
    for side in ("left", "right"):
        for role, begin, end in LIMBS:
            joint, tip = roles.get(f"{side}_{role}"), roles.get(f"{side}_{ends[role]}")
            if joint is None or tip is None:
                continue
            base = chest if "arm" in role else hips
            if role.startswith("lower"):
                base = away.get(roles.get(f"{side}_upper_{role[6:]}", -1), base)
            bone = rest_places[tip] - rest_places[joint]
            wanted = seen[f"{side}_{end}"] - seen[f"{side}_{begin}"]
            away[joint] = _pointed(base, bone, wanted)
        _bent(away, roles, rest_places, seen, side)
        if f"{side}_foot" in roles:  # flat on the floor, pointing where the hips do
            ahead = rotation.rotate_vectors(hips, np.array([0.0, 0.0, 1.0]))
            turn = np.arctan2(ahead[:, 0], ahead[:, 2])
            away[roles[f"{side}_foot"]] = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), turn)
    out = np.empty((len(hips), len(skeleton), 4))
    whole = rotation.make_identity_rotations((len(hips),))
    turned: list[Array] = []
    for joint, parent in enumerate(skeleton.parents.tolist()):
        turned.append(away.get(joint, turned[parent] if parent >= 0 else whole))
        out[:, joint] = rotation.multiply(turned[joint], rest_turns[joint])
    return out


def _from_rest(left: Array, up: Array, rest_left: Array, rest_up: Array) -> Array:
    return rotation.multiply(_frame(left, up), rotation.conjugate(_frame(rest_left, rest_up)))


def _pointed(base: Array, bone: Array, wanted: Array) -> Array:
    """Return a joint's turn from rest `[F, 4]`: its parent's, and the least more that points its bone
    there.
    """
    return rotation.multiply(
        rotation.find_rotation_between(rotation.rotate_vectors(base, bone), wanted), base
    )


def _bent(
    away: dict[int, Array], roles: Mapping[str, int], rest: Array, seen: Mapping[str, Array], side: str
) -> None:
    """Turn upper limbs about themselves so that the lower ones bend as a hinge does: elbows and knees bend in
    one plane, which the measured one shows wherever the limb is bent.
    """
    for upper, lower, tip, points in (
        ("upper_arm", "lower_arm", "hand", ("shoulder", "elbow", "wrist")),
        ("upper_leg", "lower_leg", "foot", ("hip", "knee", "ankle")),
    ):
        names = [roles.get(f"{side}_{role}") for role in (upper, lower, tip)]
        if None in names:
            continue
        first, second, third = (int(n) for n in names if n is not None)
        a, b, c = (seen[f"{side}_{p}"] for p in points)
        one, two = _unit(b - a), _unit(c - b)
        axis = np.cross(one, two)
        bend = np.linalg.norm(axis, axis=-1)
        # The hinge of the rest pose: its own bend where it has one, else across the body's lateral axis.
        rest_one, rest_two = _unit(rest[second] - rest[first]), _unit(rest[third] - rest[second])
        hinge = np.cross(rest_one, rest_two)
        if np.linalg.norm(hinge) < 0.05:
            forward = np.array([0.0, 0.0, 1.0 if "arm" in upper else -1.0])
            hinge = np.cross(rest_one, forward)
        hinge = _unit(hinge - (hinge @ rest_one) * rest_one)
        shown = rotation.rotate_vectors(away[first], hinge)
        shown = _unit(shown - (shown * one).sum(-1, keepdims=True) * one)
        goal = _unit(axis)
        angle = np.arctan2((np.cross(shown, goal) * one).sum(-1), (shown * goal).sum(-1))
        weight = np.clip((bend - STRAIGHT) / STRAIGHT, 0, 1)
        angle = _held(np.unwrap(angle), weight)
        about = rotation.from_axis_angle(one, angle)
        away[first] = rotation.multiply(about, away[first])
        away[second] = _pointed(away[first], rest[third] - rest[second], c - b)


def _held(angle: Array, weight: Array) -> Array:
    """Return angles, where they are not told those of the nearest moments at which they are."""
    sure = np.flatnonzero(weight > 0.5)
    if not len(sure):
        return np.zeros_like(angle)
    return np.asarray(np.interp(np.arange(len(angle)), sure, angle[sure]))


def _head(seen: Mapping[str, Array], chest: Array, skeleton: Skeleton, roles: Mapping[str, int]) -> Array:
    """Return the head's turn from rest `[F, 4]`: by ears and nose, else the chest's."""
    ears = seen["left_ear"] - seen["right_ear"]
    middle = (seen["left_ear"] + seen["right_ear"]) / 2
    ahead = seen["nose"] - middle
    if not np.isfinite(ears).all() or not np.isfinite(ahead).all():
        return chest
    across = _unit(ears)
    ahead = _unit(ahead - (ahead * across).sum(-1, keepdims=True) * across)
    turn = rotation.from_matrix(np.stack([across, np.cross(ahead, across), ahead], -1))
    # A nose is below the ears' height by some 15 degrees when somebody looks straight ahead.
    level = rotation.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.array(-0.26))
    return rotation.multiply(turn, np.broadcast_to(level, turn.shape))


def _placed(
    skeleton: Skeleton, roles: Mapping[str, int], local: Array, seen: Mapping[str, Array], smooth: float
) -> Array:
    """Return where the root is `[F, 3]`: over the floor on the lower foot, aside as far as the hips went."""
    rest = skeleton.rest
    pose = Pose(local, np.repeat(rest.translations[None], len(local), 0))
    places = skeleton.globals(pose)[1]
    feet = [roles[r] for r in ("left_foot", "right_foot", "left_toes", "right_toes") if r in roles]
    floor = skeleton.globals(rest)[1][feet, 1].min() if feet else 0.0
    lowest = places[:, feet, 1].min(-1) if feet else np.zeros(len(local))
    hips = (seen["left_hip"] + seen["right_hip"]) / 2
    bone = np.linalg.norm(seen["left_hip"] - seen["left_knee"], axis=-1)
    upper, lower = roles["left_upper_leg"], roles.get("left_lower_leg", roles["left_upper_leg"])
    own = float(np.linalg.norm(np.subtract(*skeleton.globals(rest)[1][[upper, lower]])))
    scale = own / max(float(np.median(bone)), 1e-6) if own > 0 else 1.0
    root = np.repeat(rest.translations[:1], len(local), 0)
    root[:, [0, 2]] += (hips - hips[0])[:, [0, 2]] * scale
    root[:, 1] += _smoothed((floor - lowest)[:, None], smooth)[:, 0]
    return root
