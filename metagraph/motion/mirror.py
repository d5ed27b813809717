"""The left/right twin of a clip: reflected on the character's sagittal plane, the sides of skeleton and face
swapped.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_names import HELPERS, split_joint_name
from metagraph.motion.roles import find_joint_sides, find_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

# Of the skeleton's height: how far rest poses may be from even on both sides, and when a position alone makes
# twins.
UNEVEN, ALIKE = 0.05, 0.01
SKEWED = np.radians(120)  # by how much twins may point elsewhere at rest
STILL = np.radians(0.1)  # below this turn a joint without a twin counts as unmoved
_SWAP = {"left": "right", "lf": "rt", "lft": "rgt", "l": "r"}
_SWAP = {**_SWAP, **{b: a for a, b in _SWAP.items()}, "lt": "rt"}
_PIECE = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+|[^A-Za-z\d]+")


def swap_sides(text: str) -> str:
    """Return `text` with its words for left and right exchanged: left/right, lf/rt, L/R and their like,
    keeping their case.
    """
    pieces = _PIECE.findall(text)
    out = []
    for i, piece in enumerate(pieces):
        word, rest = piece.lower(), ""
        glued = re.fullmatch(
            r"(left|right)(arm|forearm|hand|leg|upleg|foot|toe|shoulder|eye|brow|knee|elbow|wrist|ankle|thumb)s?",
            word,
        )
        if glued:
            word, rest = glued[1], piece[len(glued[1]) :]
        other = _SWAP.get(word)
        numbered = (
            len(word) == 1 and i + 1 < len(pieces) and pieces[i + 1].isdecimal()
        )  # "R2" is a number of something
        if other is None or numbered:
            out.append(piece)
            continue
        head = piece[: len(word)]
        upper = head.isupper() and (len(head) > 1 or not rest)
        out.append((other.upper() if upper else other.capitalize() if head[0].isupper() else other) + rest)
    return "".join(out)


def find_joint_twins(skeleton: Skeleton, roles: Mapping[str, int] | None = None) -> tuple[int, ...]:
    """Return each joint's twin on the other side, its own place for joints on the middle; -1 for a sided
    joint that has none.

    By the roles, then by the names, then by where the rest pose puts what names leave over.
    """
    pairing = _Pairing(skeleton, find_roles(skeleton) if roles is None else roles)
    pairing.by_roles()
    pairing.by_names()
    pairing.by_places()
    return tuple(pairing.twins)


class _Pairing:
    """The twins of a skeleton's joints found so far, -1 where none is known."""

    def __init__(self, skeleton: Skeleton, roles: Mapping[str, int]) -> None:
        self.skeleton = skeleton
        self.roles = roles
        self.words = [split_joint_name(name) for name in skeleton.names]
        self.twins = [-1] * len(skeleton)

    def _join(self, a: int, b: int) -> None:
        if self.twins[a] < 0 and self.twins[b] < 0 and a != b:
            self.twins[a], self.twins[b] = b, a

    def by_roles(self) -> None:
        """Pair what is on the left with what is on the right in the same role."""
        for role, joint in self.roles.items():
            if role.startswith("left_") and (other := self.roles.get("right_" + role[5:])) is not None:
                self._join(joint, other)

    def by_names(self) -> None:
        """Pair joints whose names say the same of the two sides, where no third one's does."""
        skeleton, words = self.skeleton, self.words
        apart: dict[tuple[tuple[str, ...], int, str], list[int]] = {}
        for i, w in enumerate(words):
            apart.setdefault((w.words, w.number, w.side), []).append(i)
        for i, name in enumerate(skeleton.names):
            if self.twins[i] >= 0:
                continue
            swapped = swap_sides(name)
            if swapped != name and swapped in skeleton:
                self._join(i, skeleton.index(swapped))
            elif words[i].side != "centre":
                beyond = "right" if words[i].side == "left" else "left"
                found = apart.get((words[i].words, words[i].number, beyond), [])
                if len(found) == 1 and len(apart[words[i].words, words[i].number, words[i].side]) == 1:
                    self._join(i, found[0])

    def by_places(self) -> None:
        """Pair joints that stand opposite each other at rest; those in the middle are their own twins."""
        skeleton, words, twins = self.skeleton, self.words, self.twins
        sides = find_joint_sides(skeleton, self.roles)
        _, positions = skeleton.globals(skeleton.rest)
        lateral, middle = _plane(skeleton, twins)
        mirrored = _reflect(positions, lateral, middle)
        for i in range(len(skeleton)):
            if twins[i] >= 0:
                continue
            above = int(skeleton.parents[i])
            unsided = words[i].side == "centre"
            level = abs(positions[i] @ lateral - middle) < ALIKE * skeleton.height
            if unsided and level and sides[i] == "centre":
                twins[i] = i
                continue
            near = self._opposite(i, mirrored[i], positions)
            if len(near) == 1:
                self._join(i, near[0])
            elif unsided and (above < 0 or twins[above] == above):
                twins[i] = i

    def _opposite(self, joint: int, place: Array, positions: Array) -> list[int]:
        """Return the joints without a twin that stand where a joint's mirror image does, and hang on the
        twin of what it hangs on.
        """
        skeleton, words = self.skeleton, self.words
        above, side = int(skeleton.parents[joint]), words[joint].side
        beside = self.twins[above] if above >= 0 else -1
        return [
            j
            for j in range(len(skeleton))
            if j != joint and self.twins[j] < 0 and int(skeleton.parents[j]) == beside
            and (words[j].side != side or side == "centre")
            and np.linalg.norm(positions[j] - place) < ALIKE * skeleton.height
        ]  # fmt: skip


def mirror(clip: Clip, pairs: Sequence[int]) -> Clip:
    """Return the clip with left and right exchanged. `pairs` are those of `find_joint_twins`; mirrored twice
    it is itself.

    Turns are reflected relative to the rest pose, so bones may have any axes. Raises ValueError, in words,
    where the skeleton is not the same on both sides.
    """
    skeleton = clip.skeleton
    twins = _checked(clip, pairs)
    lateral, _ = _plane(skeleton, twins)
    poses = clip.poses()
    local_r, local_t = poses.rotations.astype(np.float64), poses.translations.astype(np.float64)
    rest = skeleton.rest
    rest_r, rest_p = skeleton.globals(rest)
    model_r, _ = skeleton.globals(type(rest)(local_r, local_t))
    # `turned` is relative to the twin's bones as the reflected rest pose would hold them.
    turned = _reflect_turn(rotation.multiply(model_r, rotation.conjugate(rest_r)), lateral)[:, twins]
    turned = rotation.multiply(turned, rotation.multiply(_held(skeleton, rest_p, twins, lateral), rest_r))
    parents = skeleton.parents
    inner = np.flatnonzero(parents >= 0)
    rotations = turned.copy()
    rotations[:, inner] = rotation.multiply(rotation.conjugate(turned[:, parents[inner]]), turned[:, inner])
    alone = np.flatnonzero(np.array(pairs) < 0)
    rotations[:, alone] = rest.rotations[alone]
    # What a joint is shifted by goes through model space, so that both sides may have different axes and
    # lengths.
    shift = local_t - rest.translations
    shift[:, inner] = rotation.rotate_vectors(model_r[:, parents[inner]], shift[:, inner])
    shift = _reflect(shift, lateral, 0.0)[:, twins]
    shift[:, inner] = rotation.rotate_vectors(rotation.conjugate(turned[:, parents[inner]]), shift[:, inner])
    translated = sorted({0, *(int(twins[j]) for j in clip.translated)})
    order = _face_order(clip.morphs)
    return replace(
        clip,
        rotations=rotation.make_continuous(rotation.normalize(rotations).astype(np.float32)),
        translations=(rest.translations + shift)[:, translated],
        translated=tuple(translated),
        weights=None if clip.weights is None else clip.weights[:, order],
    )


def _checked(clip: Clip, pairs: Sequence[int]) -> Array:
    """Return the twins `[J]`, joints without one that do not move standing for themselves. Raises
    ValueError.
    """
    skeleton, names = clip.skeleton, clip.skeleton.names
    twins = np.array(pairs, int)
    if twins.shape != (len(skeleton),) or twins.min() < -1 or twins.max() >= len(skeleton):
        raise ValueError(f"'{clip.name}' cannot be mirrored: the pairs are those of another skeleton")
    still = (
        rotation.measure_angle_between(clip.rotations, skeleton.rest_rotations.astype(np.float32)).max(0)
        < STILL
    )
    still[list(clip.translated)] &= (
        np.abs(clip.translations - skeleton.rest_translations[list(clip.translated)]).max((0, 2)) < 1e-4
    )
    alone = twins < 0
    if (alone & ~still).any():
        raise ValueError(
            f"'{clip.name}' cannot be mirrored: joint '{names[int(np.argmax(alone & ~still))]}' has no twin "
            "on the other side"
        )
    twins = np.where(alone, np.arange(len(twins)), twins)
    if (twins[twins] != np.arange(len(twins))).any():
        raise ValueError(f"'{clip.name}' cannot be mirrored: a joint is the twin of two others")
    for j in range(len(twins)):
        above, beside = int(skeleton.parents[j]), int(skeleton.parents[twins[j]])
        if not alone[j] and (beside != twins[above] if above >= 0 else beside >= 0):
            raise ValueError(
                f"'{clip.name}' cannot be mirrored: '{names[j]}' and '{names[twins[j]]}' do not hang on twins"
            )
    _, positions = skeleton.globals(skeleton.rest)
    lateral, middle = _plane(skeleton, twins)
    middling = twins == np.arange(len(twins))
    off = np.where(middling & ~alone, np.abs(positions @ lateral - middle), 0.0)
    length = np.linalg.norm(skeleton.rest_translations, axis=-1) * (skeleton.parents >= 0)
    uneven = np.abs(length - length[twins])
    skewed = rotation.measure_angle_between(_held(skeleton, positions, twins, lateral), rotation.IDENTITY)
    for j, name in enumerate(names):
        if alone[j] or HELPERS & set(
            split_joint_name(name).words
        ):  # where an animator keeps a handle says nothing of the body
            continue
        if off[j] > UNEVEN * skeleton.height:
            raise ValueError(
                f"'{clip.name}' cannot be mirrored: at rest '{name}' is {100 * off[j]:.0f} cm beside the "
                "middle"
            )
        if uneven[j] > UNEVEN * skeleton.height:
            raise ValueError(
                f"'{clip.name}' cannot be mirrored: '{name}' and '{names[twins[j]]}' differ in length by "
                f"{100 * uneven[j]:.0f} cm"
            )
        if skewed[j] > SKEWED:
            raise ValueError(
                f"'{clip.name}' cannot be mirrored: at rest '{name}' points {np.degrees(skewed[j]):.0f} "
                "degrees away"
                f" from where '{names[twins[j]]}' is mirrored"
            )
    return twins


def _held(skeleton: Skeleton, positions: Array, twins: Array, lateral: Array) -> Array:
    """Return turns `[J, 4]` from each joint's rest pose to the mirror image of its twin's: by where the bone
    points, parents first.
    """
    children = np.zeros((len(skeleton), 3))
    count = np.bincount(skeleton.parents[skeleton.parents >= 0], minlength=len(skeleton))
    np.add.at(children, skeleton.parents[skeleton.parents >= 0], positions[skeleton.parents >= 0])
    bone = children / np.maximum(count, 1)[:, None] - positions
    wanted = _reflect(bone, lateral, 0.0)[twins]
    out = rotation.make_identity_rotations((len(skeleton),))
    for j in range(len(skeleton)):
        if twins[j] == j:
            continue
        out[j] = out[skeleton.parents[j]] if skeleton.parents[j] >= 0 else rotation.IDENTITY
        if count[j] and count[twins[j]] and min(np.linalg.norm(bone[j]), np.linalg.norm(wanted[j])) > 1e-3:
            out[j] = rotation.multiply(
                rotation.find_rotation_between(rotation.rotate_vectors(out[j], bone[j]), wanted[j]), out[j]
            )
    return out


def _plane(skeleton: Skeleton, twins: Sequence[int] | Array) -> tuple[Array, float]:
    """Return the direction across the body `[3]` and where along it the middle is, in the rest pose."""
    _, positions = skeleton.globals(skeleton.rest)
    twin = np.array([t if t >= 0 else i for i, t in enumerate(twins)])
    sided = twin != np.arange(len(twin))
    if not sided.any():
        return np.array([1.0, 0, 0]), 0.0
    apart, between = (positions - positions[twin])[sided], (positions + positions[twin])[sided] / 2

    def misfit(lateral: Array) -> float:
        """Sine of the angle by which the better placed twins are apart aslant; arms posed differently at rest
        must not count.
        """
        aside = np.linalg.norm(apart - np.outer(apart @ lateral, lateral), axis=-1)
        return float(np.quantile(aside / np.maximum(np.linalg.norm(apart, axis=-1), 1e-9), 0.25))

    lateral = min(np.eye(3), key=misfit)
    aslant = np.linalg.eigh(apart.T @ apart)[1][:, -1]
    if misfit(lateral) > 0.1 and misfit(aslant) < misfit(lateral) / 2:
        lateral = aslant  # the figure stands aslant in its file
    return lateral, float(np.median(between @ lateral))


def _reflect(points: Array, lateral: Array, middle: float) -> Array:
    """Reflect points `[..., 3]` on the plane across `lateral`."""
    return np.asarray(points - 2 * ((points @ lateral) - middle)[..., None] * lateral)


def _reflect_turn(q: Array, lateral: Array) -> Array:
    """Reflect rotations `[..., 4]`: their axis is reflected, their sense turns round."""
    return np.concatenate([-_reflect(q[..., :3], lateral, 0.0), q[..., 3:]], -1)


def _face_order(morphs: Sequence[str]) -> list[int]:
    """Return from which column each morph target's weights come."""
    place = {name: i for i, name in enumerate(morphs)}
    return [place.get(swap_sides(name), i) for i, name in enumerate(morphs)]
