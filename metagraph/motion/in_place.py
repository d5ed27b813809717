"""Keep a clip in place: take the way and the turn out that its hips have made by its end, little by little,
so that it ends where it began. What they do in between stays.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose

Array = NDArray[Any]

TURNED = np.radians(8.0)  # from which on a turn is taken out; a smaller one is sway
ALIKE = float(np.cos(np.radians(0.5) / 2))  # of two rotations, from which on they are the same
STAYS = 0.001  # of the height, that a joint that stands still may be away from its rest


def keep_in_place(clip: Clip) -> Clip:
    """Return the clip with its hips over the same spot, facing the same way, in the last frame as in the
    first. Clips of one frame stay as they are.
    """
    if clip.frames < 2:
        return clip
    hips = find_roles(clip.skeleton).get("hips", 0)
    ends = clip.pose_at(np.array([0.0, clip.duration]))
    turns, places = clip.skeleton.globals(ends)
    way = places[1, hips] - places[0, hips]
    way[1] = 0.0
    turn = _heading(rotation.multiply(turns[1, hips], rotation.conjugate(turns[0, hips])))
    turn = turn if abs(turn) > TURNED else 0.0
    if not way.any() and not turn:
        return clip
    part = np.linspace(0.0, 1.0, clip.frames)
    _, at = clip.skeleton.globals(clip.poses())
    centre = at[:, hips].astype(float)
    centre[:, 1] = 0.0
    back = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), -turn * part)
    return _carried(clip, back, centre - rotation.rotate_vectors(back, centre) - part[:, None] * way)


def stand_elsewhere(clip: Clip, turn: float, x: float, z: float) -> Clip:
    """Return the clip turned about the vertical through the origin by radians, then moved by metres."""
    if turn == 0.0 and x == 0.0 and z == 0.0:
        return clip
    about = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.full(clip.frames, turn))
    return _carried(clip, about, np.broadcast_to(np.array([x, 0.0, z]), (clip.frames, 3)))


def _carried(clip: Clip, turns: Array, moves: Array) -> Clip:
    """Return the clip turned about the origin by `turns` [F, 4] and then moved by `moves` [F, 3], in the
    character's space. What stands still above the hips stays: otherwise the hips would swing about it where
    two clips blend that were carried elsewhere.
    """
    skeleton, poses = clip.skeleton, clip.poses()
    still = _find_still(clip)
    parents = skeleton.parents.tolist()
    joints = [j for j, p in enumerate(parents) if j not in still and (p < 0 or p in still)]
    translated = tuple(sorted({*clip.translated, *joints}))
    rotations, translations = poses.rotations.copy(), poses.translations.astype(float)
    above, over = skeleton.globals(Pose(poses.rotations[:1], poses.translations[:1]))
    for joint in joints:
        local, places = rotations[:, joint].astype(float), translations[:, joint]
        parent = int(parents[joint])
        if parent < 0:
            rotations[:, joint] = rotation.multiply(turns, local)
            translations[:, joint] = rotation.rotate_vectors(turns, places) + moves
            continue
        space, origin = above[0, parent].astype(float), over[0, parent].astype(float)
        back = np.broadcast_to(rotation.conjugate(space), turns.shape)
        space = np.broadcast_to(space, turns.shape)
        rotations[:, joint] = rotation.multiply(
            back, rotation.multiply(turns, rotation.multiply(space, local))
        )
        at = rotation.rotate_vectors(turns, rotation.rotate_vectors(space, places) + origin) + moves
        translations[:, joint] = rotation.rotate_vectors(back, at - origin)
    return replace(
        clip,
        rotations=rotation.make_continuous(rotations),
        translations=translations[:, list(translated)].astype(np.float32),
        translated=translated,
    )


def _find_still(clip: Clip) -> set[int]:
    """Return the joints above the hips, from the root on, that are as in the rest pose all along."""
    skeleton, poses = clip.skeleton, clip.poses()
    hips = find_roles(skeleton).get("hips", 0)
    out: set[int] = set()
    for joint in skeleton.chain(hips):
        if joint == hips:
            break
        along = np.abs((poses.rotations[:, joint] * skeleton.rest_rotations[joint]).sum(-1))
        away = np.abs(poses.translations[:, joint] - skeleton.rest_translations[joint]).max()
        if along.min() < ALIKE or away > STAYS * max(skeleton.height, 1e-6):
            break
        out.add(joint)
    return out


def find_spot(clip: Clip, hips: int, second: float) -> tuple[Array, Array]:
    """Return how the hips are turned in the character's space at a second, and where they are on the ground,
    metres: [4] and [2].
    """
    turns, places = clip.skeleton.globals(clip.pose_at(second))
    return turns[hips].astype(float), places[hips, (0, 2)].astype(float)


def measure_travel(clip: Clip, hips: int, start: float, end: float) -> float:
    """Return how far the hips are over the ground from where they were, metres, between two seconds."""

    def measure() -> float:
        _, places = clip.skeleton.globals(clip.pose_at(np.clip([start, end], 0.0, clip.duration)))
        way = places[1, hips] - places[0, hips]
        return float(np.hypot(way[0], way[2]))

    return clip.measured(("travel", hips, start, end), measure)


def measure_turn(before: Array, after: Array) -> float:
    """Return by how much two rotations [4] are turned about the vertical, -pi to pi."""
    return _heading(rotation.multiply(after, rotation.conjugate(before)))


def _heading(turn: Array) -> float:
    """Return the angle about the vertical axis of a rotation, -pi to pi."""
    angle = 2 * np.arctan2(turn[1], turn[3])
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
