"""Finding the face: which joints, morph targets or frames of clips move eyes, lids and mouth.

A face is worked by channels. Joints take part in a channel with the turn and the shift they have where it is
at 1: `upper_lid_left` ... `lower_lid_right` (1 is shut), `blink` (what else moves in a blink), `jaw_open`,
`viseme_PP` ... `viseme_U`. Morph targets have these and `blink_left`, `wide_left`, `look_up_left` ...
`look_right_right` (direction, then eye). The project's `Face` settings correct what was found.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.face.names import VISEMES, find_clip_shapes, find_morphs
from metagraph.graph.life import FacePose
from metagraph.graph.model import ClipEntry, Project
from metagraph.graph.remembered import Remembered
from metagraph.motion import rotation
from metagraph.motion.joint_names import split_joint_name
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

LIDS = ("upper_lid_left", "upper_lid_right", "lower_lid_left", "lower_lid_right")
MOUTH = ("jaw_open", *(f"viseme_{v}" for v in VISEMES[1:]))
CHANNELS = (*LIDS, "blink", *MOUTH)  # in the order of a rig's arrays
SIDES = ("left", "right")
# What `Face.channels` may bind to a joint and to a morph target, and `Face.poses` to a frame of a clip.
JOINT_BOUND = (*(f"eye_{s}" for s in SIDES), *LIDS, "jaw_open")
MORPH_BOUND = (
    "blink", *(f"{what}_{s}" for what in ("blink", "wide") for s in SIDES), *MOUTH,
    *(f"look_{way}_{s}" for way in ("up", "down", "left", "right") for s in SIDES),
)  # fmt: skip
POSE_BOUND = ("blink", *MOUTH)

# Where nothing in the project shows it, lids turn about the eye and the jaw about its joint; degrees about
# the axis to the left.
UPPER_LID_SHUT, LOWER_LID_SHUT = 40.0, -15.0
JAW_OPEN = 16.0
# The jaw's part of each shape, of the widest opening. An open "ah" is 10 degrees.
OPENING = {
    "PP": 0.0, "FF": 0.06, "TH": 0.20, "DD": 0.16, "kk": 0.24, "CH": 0.14, "SS": 0.08, "nn": 0.16, "RR": 0.20,
    "aa": 0.66, "E": 0.42, "I": 0.24, "O": 0.48, "U": 0.24,
}  # fmt: skip
# How far the lids go with the eye, degrees a degree of its pitch.
UPPER_FOLLOWS, LOWER_FOLLOWS = 0.6, 0.35
_TURNED, _MOVED = np.radians(0.25), 1e-4  # below this a joint has no part in a channel


@dataclass(frozen=True, eq=False)
class Eye:
    """joint; axes `[3, 3]`: to the left, up and where the eye looks, in the joint's own space at rest."""

    joint: int
    side: str
    axes: Array


@dataclass(frozen=True, eq=False)
class FaceRig:
    """What moves a face.

    joints: those that shapes move `[F]`. turns: rotation vectors `[C, F, 3]` in the joints' own space,
    radians, multiplied on the right; shifts `[C, F, 3]`: metres in the parents' space; both at 1, in the
    order of `CHANNELS`. follows: how much each of LIDS shuts for an eye that looks down by a radian `[4]`, 0
    for one that no joint moves. shut_by: `[4, 4]`, what a lid's own rotation `[4]` xyzw (relative to rest,
    real part positive) says about how far it is shut already. lid_joints: the joint that stands for each lid
    `[4]`, -1 for none. morphs: channel -> (morph target, weight at 1).
    """

    eyes: tuple[Eye, ...]
    joints: Array
    turns: Array
    shifts: Array
    follows: Array
    lid_joints: Array
    shut_by: Array
    morphs: Mapping[str, tuple[tuple[str, float], ...]]

    @property
    def empty(self) -> bool:
        """Whether there is no face at all."""
        return not (self.eyes or len(self.joints) or self.morphs)

    def joint_channels(self) -> tuple[str, ...]:
        """Return the channels that joints take part in."""
        return tuple(c for n, c in enumerate(CHANNELS) if self.turns[n].any() or self.shifts[n].any())

    @cached_property
    def shifted(self) -> Array:
        """Places among `joints` of those that any channel moves."""
        return np.flatnonzero(np.abs(self.shifts).max((0, 2), initial=0) > 0)


def find_body_axes(skeleton: Skeleton, roles: Mapping[str, int], positions: Array) -> Array:
    """Return the directions to the left, up and ahead `[3, 3]` of a character whose joints are at `positions
    [J, 3]`.

    From its eyes, hips or shoulders; a character without any looks along +Z.
    """
    for role in ("eye", "upper_leg", "upper_arm", "shoulder"):
        pair = [roles.get(f"{side}_{role}") for side in SIDES]
        if pair[0] is not None and pair[1] is not None:
            left = (positions[pair[0]] - positions[pair[1]]) * [1, 0, 1]
            if np.linalg.norm(left) > 1e-4:
                left = left / np.linalg.norm(left)
                return np.array([left, [0.0, 1, 0], np.cross(left, [0.0, 1, 0])])
    return np.eye(3)


def find_face(project: Project, morphs: Sequence[str] = ()) -> FaceRig:
    """Return the face of a project's character; one without a face has an empty rig.

    morphs: names of the character's morph targets beside those its clips move and the project remembers
    (`Face.morphs`). What was found is kept for as long as nothing it depends on changes.
    """
    return _found.of(project, tuple(morphs), lambda: _find(project, morphs))


def gather_face_parts(project: Project) -> tuple[object, ...]:
    """Return the parts of a project that faces and bodies are found in."""
    return project.skeleton, project.roles, project.parts, project.face, project.clips


_found: Remembered[FaceRig] = Remembered(gather_face_parts)


def list_morph_names(project: Project, morphs: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the names of all morph targets that are known of: the character's, else those that clips move
    where no character is drawn.
    """
    names = dict.fromkeys((*project.face.morphs, *morphs))
    if project.character is not None:
        return tuple(names)
    for entry in project.clips.values():
        if entry.motion is not None and entry.motion.morphs:
            names.update(dict.fromkeys(entry.motion.morphs))
    return tuple(names)


def with_morphs(project: Project, names: Iterable[str]) -> Project:
    """Return the project remembering the morph targets of its character; the same one where it knows them
    already.
    """
    found = tuple(names)
    if found == project.face.morphs:
        return project
    return replace(project, face=msgspec.structs.replace(project.face, morphs=found))


def _find(project: Project, morphs: Sequence[str]) -> FaceRig:
    bound = project.face.channels
    targets = find_morphs(list_morph_names(project, morphs), bound)
    skeleton = project.skeleton
    if skeleton is None:
        return _rig((), {}, [-1] * 4, targets, None)
    reader = _Reader(project, skeleton)
    eyes = reader.eyes()
    twice = ["look_"] if eyes else []  # eyes that are joints are not turned twice
    looks = sum(c.startswith("look_") for c in targets)
    if len(eyes) == 2 and looks == 8 and len(reader.lid_groups()) == len(LIDS):
        twice += ["blink", "wide_"]  # all that the joints of eyes and lids do is there again as targets
    targets = {c: t for c, t in targets.items() if not c.startswith(tuple(twice)) or c in bound}
    shapes: dict[str, Shape] = {}
    if not {"blink", "blink_left", "blink_right"} & targets.keys():
        shapes |= reader.lids()
    if not any(c in targets for c in MOUTH):
        shapes |= reader.mouth()
    shapes |= reader.shown({c: p for c, p in project.face.poses.items() if c in POSE_BOUND})
    off = {c for c, name in bound.items() if not name}
    return _rig(
        eyes, {c: s for c, s in shapes.items() if c not in off}, reader.lid_joints(off), targets, skeleton
    )


Shape = dict[int, tuple[Array, Array]]  # joint -> turn [3], shift [3]


class _Reader:
    """One skeleton's face."""

    def __init__(self, project: Project, skeleton: Skeleton) -> None:
        self.project, self.skeleton = project, skeleton
        self.roles = dict(anatomy.project_roles(project))
        self.turned, self.at = skeleton.globals(skeleton.rest)
        self.axes = find_body_axes(skeleton, self.roles, self.at)
        self.face = np.array([p == "face" for p in anatomy.project_parts(project)])
        self.bound = project.face.channels

    def joint(self, channel: str, role: str) -> int | None:
        """Return the joint the user bound to a channel, else the one found in a role; None for a channel that
        is off.
        """
        name = self.bound.get(channel)
        if name is None:
            return self.roles.get(role)
        return self.skeleton.index(name) if name and name in self.skeleton else None

    def local(self, joint: int, axis: Array) -> Array:
        return rotation.rotate_vectors(rotation.conjugate(self.turned[joint]), axis)

    def eyes(self) -> tuple[Eye, ...]:
        found = [(side, self.joint(f"eye_{side}", f"{side}_eye")) for side in SIDES]
        return tuple(
            Eye(joint, side, self.local(joint, self.axes)) for side, joint in found if joint is not None
        )

    def lid_groups(self, helpers: bool = False) -> dict[str, list[int]]:
        """Return the joints along each of LIDS, the one that stands for it first; helpers: also those that
        only serve the skin.
        """
        out: dict[str, list[int]] = {}
        below = set(self.skeleton.descendants(self.roles["head"])) if "head" in self.roles else set()
        for channel in LIDS:
            level, _, side = channel.split("_")
            main = self.joint(channel, f"{side}_{level}_lid")
            if main is None:
                continue
            group = [main]
            for j in sorted(below) if channel not in self.bound else ():
                words = split_joint_name(self.skeleton.names[j])
                low = bool({"low", "lower", "bottom", "dwn", "down"} & set(words.words))
                helper = bool({"adj", "adjust", "ctrl", "end"} & set(words.words))
                if (
                    "lid" in words.joined
                    and words.side == side
                    and low == (level == "lower")
                    and j != main
                    and (helpers or not helper)
                ):
                    group.append(j)
            out[channel] = group
        return out

    def lid_joints(self, off: Collection[str]) -> list[int]:
        groups = self.lid_groups()
        return [groups[c][0] if c in groups and c not in off else -1 for c in LIDS]

    def lids(self) -> dict[str, Shape]:
        """Return how the lids shut: as a clip of a blink shows it, else turned about the eye."""
        groups = self.lid_groups()
        if not groups:
            return {}
        blink = find_clip_shapes(self.project).get("blink")
        if "blink" not in self.project.face.poses and blink is not None:
            shown = self.shown({"blink": FacePose(clip=blink)})
            if any(c in shown for c in LIDS):
                return shown
        out: dict[str, Shape] = {}
        for channel, joints in groups.items():
            side = channel.rsplit("_", 1)[1]
            angle = np.radians(UPPER_LID_SHUT if channel.startswith("upper") else LOWER_LID_SHUT)
            eye = self.roles.get(f"{side}_eye", joints[0])
            out[channel] = {j: self._about(j, self.at[eye], angle) for j in joints}
        return out

    def _about(self, joint: int, centre: Array, angle: float) -> tuple[Array, Array]:
        """Return turn and shift of a joint that goes round a centre, about the axis to the left."""
        arm = self.at[joint] - centre
        moved = rotation.rotate_vectors(rotation.from_axis_angle(self.axes[0], angle), arm) - arm
        parent = int(self.skeleton.parents[joint])
        shift = (
            moved if parent < 0 else rotation.rotate_vectors(rotation.conjugate(self.turned[parent]), moved)
        )
        return angle * self.local(joint, self.axes[0]), shift

    def mouth(self) -> dict[str, Shape]:
        """Return the mouth's shapes: as clips show them, else made by the jaw alone."""
        out: dict[str, Shape] = {}
        jaw = self.joint("jaw_open", "jaw")
        if jaw is not None:
            axis = self.local(jaw, self.axes[0])
            for channel, part in {"jaw_open": 1.0, **{f"viseme_{v}": p for v, p in OPENING.items()}}.items():
                if part > 0:
                    out[channel] = {jaw: (np.radians(JAW_OPEN) * part * axis, np.zeros(3))}
        found = find_clip_shapes(self.project)
        clips = {c: FacePose(clip=found[c]) for c in MOUTH if c in found and c not in self.project.face.poses}
        shown = self.shown(clips)
        return {**({} if any(c.startswith("viseme") for c in shown) else out), **shown}

    def shown(self, poses: Mapping[str, FacePose]) -> dict[str, Shape]:
        """Return the shapes that frames of clips show. A blink is distinguished by lids; what else moves in
        it is its own channel.
        """
        out: dict[str, Shape] = {}
        groups = self.lid_groups(helpers=True)
        for channel, pose in poses.items():
            entry = self.project.clips.get(pose.clip)
            shape = self._difference(entry, pose) if entry is not None else {}
            if channel != "blink":
                if shape:
                    out[channel] = shape
                continue
            for lid, joints in groups.items():
                own = {j: shape.pop(j) for j in joints if j in shape}
                if own:
                    out[lid] = own
            if shape:
                out["blink"] = shape
        return out

    def _difference(self, entry: ClipEntry, pose: FacePose) -> Shape:
        """Return what a frame of a clip adds to the face in its neutral frame."""
        motion = entry.motion
        if motion is None or motion.skeleton != self.skeleton or motion.frames < 2:
            return {}
        joints = np.flatnonzero(self.face)
        neutral = min(pose.neutral, motion.frames - 1)
        turns = rotation.log(
            rotation.multiply(
                rotation.conjugate(motion.rotations[neutral, joints]), motion.rotations[:, joints]
            )
        )
        shifts = np.zeros_like(turns)
        for n, joint in enumerate(motion.translated):
            place = np.flatnonzero(joints == joint)
            if len(place):
                shifts[:, place[0]] = motion.translations[:, n] - motion.translations[neutral, n]
        size = np.square(turns).sum((1, 2)) + np.square(shifts / 0.02).sum(
            (1, 2)
        )  # 2 cm tell as much as a radian
        frame = int(size.argmax()) if pose.frame is None else min(pose.frame, motion.frames - 1)
        turn, shift = turns[frame].astype(float), shifts[frame].astype(float)
        moved = (np.linalg.norm(turn, axis=1) > _TURNED) | (np.linalg.norm(shift, axis=1) > _MOVED)
        return {int(joints[i]): (turn[i], shift[i]) for i in np.flatnonzero(moved)}


def _rig(
    eyes: tuple[Eye, ...],
    shapes: Mapping[str, Shape],
    lid_joints: Iterable[int],
    morphs: Mapping[str, tuple[tuple[str, float], ...]],
    skeleton: Skeleton | None,
) -> FaceRig:
    joints = sorted({j for shape in shapes.values() for j in shape})
    place = {j: n for n, j in enumerate(joints)}
    turns, shifts = np.zeros((len(CHANNELS), len(joints), 3)), np.zeros((len(CHANNELS), len(joints), 3))
    for n, channel in enumerate(CHANNELS):
        for joint, (turn, shift) in shapes.get(channel, {}).items():
            turns[n, place[joint]], shifts[n, place[joint]] = turn, shift
    main = np.array(
        [j if c in shapes and j in shapes[c] else -1 for c, j in zip(LIDS, lid_joints, strict=True)]
    )
    follows, shut_by = np.zeros(4), np.zeros((4, 4))
    for n, joint in enumerate(main.tolist()):
        if joint < 0 or skeleton is None:
            continue
        turn = turns[n, place[joint]]
        angle = float(np.linalg.norm(turn))
        upper = LIDS[n].startswith("upper")
        follows[n] = UPPER_FOLLOWS if upper else -LOWER_FOLLOWS
        follows[n] /= max(angle, np.radians(10.0)) if angle > np.radians(1.0) else np.radians(UPPER_LID_SHUT)
        if angle > np.radians(1.0):
            # rest^-1 q is nearly 1 + half the turn, so its vector part along the shutting turn, doubled, is
            # how far.
            inverse = rotation.conjugate(skeleton.rest_rotations[joint])
            basis = rotation.multiply(inverse, np.eye(4))[:, :3]
            shut_by[n] = 2 * basis @ turn / angle**2
    for array in (turns, shifts, follows, shut_by, main):
        array.setflags(write=False)
    return FaceRig(eyes, np.array(joints, int), turns, shifts, follows, main, shut_by, dict(morphs))
