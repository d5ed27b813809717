"""Compute where the relevant joints of clips are, for comparing transitions: from the root, as the character
faces, at one frame rate.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.motion.rig_controls import find_rig_controls
from metagraph.motion.roles import assign_body_parts, find_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.suggest.body_points import measure_facing, turn_to_viewer

Array = NDArray[Any]

RATE = 30.0  # frames a second


@dataclass(frozen=True, eq=False)
class TrackRig:
    """The relevant part of a skeleton. `small` has its joints `keep`."""

    small: Skeleton
    keep: Array
    joints: Array  # indices in `keep` of the relevant joints
    parts: tuple[str, ...]  # the body part of each of `joints`
    places: Mapping[str, int]  # indices in `keep` of legs and arms, which show where it faces
    root: int  # index in `keep`


@lru_cache(maxsize=32)
def _rig(skeleton: Skeleton, named: tuple[tuple[str, int], ...]) -> TrackRig:
    roles = dict(named)
    parts = assign_body_parts(skeleton, roles)
    hands = [roles[r] for r in ("left_hand", "right_hand") if r in roles]
    fingers = {j for hand in hands for j in skeleton.descendants(hand)} - set(hands)
    unseen = fingers | find_rig_controls(skeleton)
    used = [j for j in range(len(skeleton)) if j not in unseen and parts[j] != "face"] or [0]
    keep = np.array(sorted({k for j in used for k in skeleton.chain(j)}))
    place = {int(j): i for i, j in enumerate(keep)}
    parents = np.array([place.get(int(skeleton.parents[j]), -1) for j in keep])
    small = Skeleton(
        tuple(skeleton.names[j] for j in keep),
        parents,
        skeleton.rest_rotations[keep],
        skeleton.rest_translations[keep],
    )
    limbs = {r: place[j] for r, j in roles.items() if r.endswith(("upper_leg", "upper_arm")) and j in place}
    root = place.get(roles.get("hips", 0), 0)
    return TrackRig(
        small, keep, np.array([place[j] for j in used]), tuple(parts[j] for j in used), limbs, root
    )


_TRACKS: WeakKeyDictionary[Clip, tuple[TrackRig, Array, Array]] = WeakKeyDictionary()


def make_joint_track(rig: TrackRig, clip: Clip) -> Array:
    """Return where the relevant joints are, `[F, J, 3]` float32, in metres, from the root as the character
    faces, at RATE frames a second.
    """
    return _tracks(rig, clip)[1]


def track_floor(rig: TrackRig, clip: Clip) -> Array:
    """Return where the hips are over the floor, `[F, 2]` metres, at RATE frames a second."""
    return _tracks(rig, clip)[2]


def _tracks(rig: TrackRig, clip: Clip) -> tuple[TrackRig, Array, Array]:
    known = _TRACKS.get(clip)
    if known is None or known[0] is not rig:
        facing, at = measure_facing_and_standing(rig, sample_clip_poses(clip))
        track = turn_to_viewer(facing[:, None], at[:, rig.joints] - at[:, rig.root, None]).astype(np.float32)
        known = _TRACKS[clip] = rig, track, at[:, rig.root][:, [0, 2]]
    return known


def sample_clip_poses(clip: Clip) -> Pose:
    """Return a clip's poses at RATE frames a second."""
    return clip.pose_at(track_seconds(clip)) if abs(clip.fps - RATE) > 1e-6 else clip.poses()


def measure_facing_and_standing(rig: TrackRig, poses: Pose) -> tuple[Array, Array]:
    """Return where a character faces `[F, 2]`, as in `body_points.measure_facing`, and where the joints
    `TrackRig.keep` are `[F, K, 3]`, in the world.
    """
    turns, at = rig.small.globals(Pose(poses.rotations[:, rig.keep], poses.translations[:, rig.keep]))
    return measure_facing(
        {role: at[:, j] for role, j in rig.places.items()}, turns[:, rig.root], np.array([0.0, 0, 0, 1])
    ), at


def track_seconds(clip: Clip) -> Array:
    """Return the seconds `[F]` of a clip's track."""
    if abs(clip.fps - RATE) <= 1e-6:
        return np.arange(clip.frames) / clip.fps
    return np.linspace(0, clip.duration, max(1, round(clip.duration * RATE)) + 1)


def measure_velocity(track: Array) -> Array:
    """Return the velocities `[F, J, 3]` of a track, in metres a second."""
    return np.gradient(track, 1 / RATE, axis=0) if len(track) > 1 else np.zeros_like(track)


def track_rig(clip: Clip, roles: Mapping[str, int] | None) -> TrackRig:
    """Return the relevant part of a clip's skeleton. `roles` are found if None."""
    named = find_roles(clip.skeleton) if roles is None else roles
    return _rig(clip.skeleton, tuple(sorted(named.items())))
