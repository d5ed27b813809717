"""Bring a clip onto the project's skeleton when both are the same character, and say why when they are
not.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.roles import find_missing_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

MOVED = 1e-4  # metres: below this a joint keeps its rest translation
_BETWEEN = 4  # joints that one skeleton may have between shared ones and the other not
_NOTABLE = 0.03  # of the figure's size: shorter bones are fingers and faces
_APART = 0.05  # of the figure's size that joints of one role may be apart at rest in the same character
_LONG_BONE = 0.1  # of the figure's size: limbs and their parts
_ELSEWHERE = np.radians(35)  # by which such a bone may point another way, seen from its joint
_SLIGHTLY = np.radians(15)  # that bones and joints may differ by when their axes are turned alike
_FEW = 6  # bones, below which nobody can say how axes are turned
_TURNED = np.radians(5)  # that such joints may be turned against each other at rest


_STAYS = phrase("it lacks {names} of the project's skeleton: at rest while it plays")  # notes' templates
_HANDED_DOWN = phrase(
    "its skeleton has {names} in between: their motion was handed down to the joints below them"
)


class SkeletonMismatchError(ValueError):
    """The clip belongs to another skeleton; the message says how they differ."""


def describe_difference(clip: Skeleton, project: Skeleton) -> str | None:
    """Return in words why a clip on skeleton `clip` cannot play on `project`, or None when it can.

    A clip may lack joints (a face-only file), bring ends of its own (a jaw, finger tips), and have up to
    `_BETWEEN` joints more or fewer between shared ones (a second chest, an armature above the hips). The
    bones between shared joints must be as long, and the longer ones lead the same way from their joints.
    Names may differ by what all joints of a file bear before or behind them (`mixamorig1:`), and altogether
    where each role's joint rests in the same place and turned the same way.
    """
    return _Match(clip, project).difference()


def measure_bone_difference(clip: Skeleton, project: Skeleton) -> float:
    """Return by which share, 0 or more, the longer bones of a clip's skeleton differ most from the project's,
    for skeletons between which `describe_difference` finds none.
    """
    return _Match(clip, project).bone_difference()


class _Match:
    """A clip's skeleton beside the project's.

    `clip` has the project's names where both name the same joint. `own` and `ours` have, for each shared
    joint by name, the joints from below the nearest shared one above it down to itself, in either skeleton.
    """

    def __init__(self, clip: Skeleton, project: Skeleton) -> None:
        self.clip, self.project = _called_alike(clip, project), project
        self.called = clip.names
        self.axes = _find_axes(self.clip, project)
        if self.axes is not None:
            self.clip = _with_axes(self.clip, self.axes)
        self.own, self.ours = _chains(self.clip, project), _chains(project, self.clip)

    def difference(self) -> str | None:
        """Return what `describe_difference` returns."""
        clip, project = self.clip, self.project
        if len(self.own) < max(1, len(clip) // 2):
            extra = next(name for name in clip.names if name not in project)
            return phrase(
                "its joints have other names (it has '{one}', the project has '{other}')",
                one=extra,
                other=project.names[0],
            )
        for name, chain in self.own.items():
            above, here = clip.parents[chain[0]], project.parents[self.ours[name][0]]
            one = clip.names[above] if above >= 0 else "nothing"
            other = project.names[here] if here >= 0 else "nothing"
            if one != other:
                return phrase(
                    "joint '{name}' is attached to '{one}' instead of '{other}'",
                    name=name,
                    one=one,
                    other=other,
                )
        between = sum(len(chain) - 1 for chains in (self.own, self.ours) for chain in chains.values())
        if between > _BETWEEN:
            return phrase(
                "{count} joints between the matched ones exist in only one of the skeletons",
                count=between,
            )
        theirs, mine = self._lengths()
        inner = self._inner() & (mine > 1e-3)
        ratio = float(np.median(theirs[inner] / mine[inner])) if inner.any() else 1.0
        if not 0.7 < ratio < 1.4:
            return phrase("its bones are {ratio:.3g} times as long", ratio=ratio)
        turned = self._turned_bones()
        if turned:
            return phrase("the bones of its joint '{name}' point another way at rest", name=turned[0])
        return None

    def bone_difference(self) -> float:
        """Return what `measure_bone_difference` returns."""
        theirs, mine = self._lengths()
        below = np.array([len(self.clip.descendants(chain[-1])) for chain in self.own.values()])
        bones = self._inner() & (mine > _NOTABLE * self.project.height) & (below <= len(self.clip) / 2)
        return float(np.abs(theirs[bones] / mine[bones] - 1).max(initial=0.0))

    def _turned_bones(self) -> list[str]:
        """Return the joints from which a longer bone leads another way, seen from the joint itself. Such a
        skeleton turns its joints about other axes, and would twist what is drawn on the project's.
        """
        theirs, mine = self._lengths()
        long = (np.minimum(theirs, mine) > _LONG_BONE * self.project.height) & self._inner()
        out = []
        for (name, chain), measured in zip(self.own.items(), long, strict=True):
            if not measured or len(chain) > 1 or len(self.ours[name]) > 1:
                continue
            one = self.clip.rest_translations[chain[0]]
            other = self.project.rest_translations[self.ours[name][0]]
            alike = float(one @ other / (np.linalg.norm(one) * np.linalg.norm(other)))
            if alike < np.cos(_ELSEWHERE):
                out.append(self.project.names[self.project.parents[self.ours[name][0]]])
        return out

    def note_lost(self) -> tuple[str, ...]:
        """Return a note on the joints of the clip whose motion the project's skeleton has no joints for."""
        kept = {joint for chain in self.own.values() for joint in chain}
        names = [name for joint, name in enumerate(self.clip.names) if joint not in kept]
        if not names:
            return ()
        if len(names) == 1:
            alone = phrase(
                "the motion of its joint '{name}' was left out: the project's skeleton has no such joint",
                name=names[0],
            )
            return (alone,)
        several = phrase(
            "the motion of its joint '{name}' and {count:,} more was left out: the project's skeleton "
            "has no such joints",
            name=names[0],
            count=len(names) - 1,
        )
        return (several,)

    def note_adopted(self) -> tuple[str, ...]:
        """Return notes on differences of the skeletons that were bridged: other names, and joints between
        shared ones that only one of them has.
        """
        out = []
        renamed = next(
            (pair for pair in zip(self.called, self.clip.names, strict=True) if pair[0] != pair[1]), None
        )
        if renamed is not None:
            out.append(
                phrase(
                    "its joints have other names ('{one}' for '{other}'): taken for the project's skeleton",
                    one=renamed[0],
                    other=renamed[1],
                )
            )
        if self.axes is not None:
            out.append(phrase("the axes of its joints were turned to those of the project's skeleton"))
        for chains, skeleton, words in (
            (self.ours, self.project, _STAYS),
            (self.own, self.clip, _HANDED_DOWN),
        ):
            names = [skeleton.names[joint] for chain in chains.values() for joint in chain[:-1]]
            if names:
                out.append(phrase(words, names=", ".join(f"'{name}'" for name in names)))
        return tuple(out)

    def _lengths(self) -> tuple[Array, Array]:
        return _lengths(self.clip, self.own), _lengths(self.project, self.ours)

    def _inner(self) -> Array:
        return np.array([self.clip.parents[chain[0]] >= 0 for chain in self.own.values()])


def adopt(clip: Clip, skeleton: Skeleton) -> Clip:
    """Return the clip expressed on `skeleton`: joints reordered by name, missing ones at rest, bones as the
    clip has them. A note names the joints whose motion is lost; that of joints between shared ones is handed
    down. Notes say which differences of the skeletons were bridged.

    Raises SkeletonMismatchError when the skeletons are not of the same character.
    """
    if clip.skeleton is skeleton:
        return clip
    if clip.skeleton == skeleton:
        return replace(clip, skeleton=skeleton)
    match = _Match(clip.skeleton, skeleton)
    why = match.difference()
    if why is not None:
        raise SkeletonMismatchError(why)
    own, chains, alike = match.own, match.ours, match.clip
    source = clip.poses()
    if match.axes is not None:
        source = _turn_axes(source, clip.skeleton.parents, match.axes)
    rotations = np.broadcast_to(skeleton.rest_rotations, (clip.frames, len(skeleton), 4)).astype(np.float32)
    translations = np.broadcast_to(skeleton.rest_translations, (clip.frames, len(skeleton), 3)).astype(
        np.float32
    )
    plain = [name for name in own if len(own[name]) == len(chains[name]) == 1]
    here, there = [skeleton.index(name) for name in plain], [alike.index(name) for name in plain]
    rotations[:, here], translations[:, here] = source.rotations[:, there], source.translations[:, there]
    for name in own.keys() - set(plain):
        turn, place = _along(source, own[name])
        above = Pose(skeleton.rest_rotations[None], skeleton.rest_translations[None])
        base_turn, base_place = _along(above, chains[name][:-1])
        back = rotation.conjugate(base_turn)
        rotations[:, chains[name][-1]] = rotation.multiply(back, turn)
        translations[:, chains[name][-1]] = rotation.rotate_vectors(back, place - base_place)
    rest = skeleton.rest_translations.astype(np.float32)
    moved = np.flatnonzero(np.abs(translations - rest).max(axis=(0, 2)) > MOVED)
    translated = tuple(sorted({0, *(int(j) for j in moved)}))
    return replace(
        clip,
        skeleton=skeleton,
        rotations=rotation.make_continuous(rotations),
        translations=translations[:, list(translated)],
        translated=translated,
        notes=(*clip.notes, *match.note_adopted(), *match.note_lost()),
    )


def _find_axes(clip: Skeleton, project: Skeleton) -> Array | None:
    """Return the turn `[4]` that leads a clip's bones, seen from their joints, to those of the project, as
    between a file written with Z up and one with Y up; None if no single turn does that, or hardly any is
    needed.
    """
    shared = [
        (j, project.index(name))
        for j, name in enumerate(clip.names)
        if name in project
        and clip.parents[j] >= 0
        and project.parents[project.index(name)] >= 0
        and clip.names[clip.parents[j]] == project.names[project.parents[project.index(name)]]
    ]
    one, other = [j for j, _ in shared], [j for _, j in shared]
    theirs, mine = clip.rest_translations[one], project.rest_translations[other]
    sizes = np.minimum(np.linalg.norm(theirs, axis=-1), np.linalg.norm(mine, axis=-1))
    long = sizes > _NOTABLE * project.height
    if long.sum() < _FEW:
        return None
    theirs, mine = theirs[long], mine[long]
    u, _, vt = np.linalg.svd(theirs.T @ mine)
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(vt.T @ u.T))])
    axes = rotation.from_matrix(vt.T @ flip @ u.T)
    if 2 * np.arccos(min(1.0, abs(float(axes[3])))) < _ELSEWHERE:
        return None
    led = rotation.rotate_vectors(np.tile(axes, (len(theirs), 1)), theirs)
    alike = (led * mine).sum(-1) / np.linalg.norm(led, axis=-1) / np.linalg.norm(mine, axis=-1)
    turned = rotation.measure_angle_between(
        _with_axes(clip, axes).rest_rotations[one], project.rest_rotations[other]
    )
    return axes if alike.min() > np.cos(_SLIGHTLY) and turned.max() < _SLIGHTLY else None


def _with_axes(skeleton: Skeleton, axes: Array) -> Skeleton:
    rest = _turn_axes(
        Pose(skeleton.rest_rotations[None], skeleton.rest_translations[None]), skeleton.parents, axes
    )
    return Skeleton(skeleton.names, skeleton.parents, rest.rotations[0], rest.translations[0])


def _turn_axes(pose: Pose, parents: Array, axes: Array) -> Pose:
    """Return poses `[F, J]` with the axes of all joints turned; each joint stays in its place."""
    below = np.flatnonzero(parents >= 0)
    rotations = rotation.multiply(pose.rotations.astype(float), rotation.conjugate(axes))
    rotations[:, below] = rotation.multiply(
        np.broadcast_to(axes, rotations[:, below].shape), rotations[:, below]
    )
    translations = pose.translations.astype(float)
    shape = translations[:, below].shape
    translations[:, below] = rotation.rotate_vectors(
        np.broadcast_to(axes, (*shape[:-1], 4)), translations[:, below]
    )
    return Pose(rotations, translations)


def _chains(skeleton: Skeleton, other: Skeleton) -> dict[str, list[int]]:
    """Return, for each joint that another skeleton has, by name: the joints from below the nearest one above
    it that is shared, down to itself.
    """
    out = {}
    for joint, name in enumerate(skeleton.names):
        if name not in other:
            continue
        chain, above = [joint], int(skeleton.parents[joint])
        while above >= 0 and skeleton.names[above] not in other:
            chain.insert(0, above)
            above = int(skeleton.parents[above])
        out[name] = chain
    return dict(sorted(out.items()))


def _lengths(skeleton: Skeleton, chains: Mapping[str, Sequence[int]]) -> Array:
    """Return how far each chain leads at rest, metres."""
    _, places = skeleton.globals(skeleton.rest)
    ends = [(chain[-1], int(skeleton.parents[chain[0]])) for chain in chains.values()]
    return np.array([np.linalg.norm(places[end] - (places[top] if top >= 0 else 0)) for end, top in ends])


def _called_alike(clip: Skeleton, project: Skeleton) -> Skeleton:
    """Return the clip's skeleton with the project's names where these differ only by a namespace, or by what
    all of either's joints bear before or behind them, or where the joints of all roles rest alike; else as it
    is.
    """
    if all(name in project for name in clip.names):
        return clip
    for bare in (_without_namespace, _without_common):
        ours, theirs = bare(project.names), bare(clip.names)
        known = dict(zip(ours, project.names, strict=True))
        if len(known) == len(ours) and len(set(theirs)) == len(theirs) and all(n in known for n in theirs):
            return _renamed(clip, [known[name] for name in theirs])
    if sum(name in project for name in clip.names) >= len(clip) / 2:
        return clip
    return _called_by_roles(clip, project)


def _called_by_roles(clip: Skeleton, project: Skeleton) -> Skeleton:
    """Return the clip's skeleton with the project's names for the joints of its roles, if these rest in the
    same places and turned the same way, as those of a VRM animation and its character do; else as it is.
    """
    theirs, ours = find_known_roles(clip, None), find_known_roles(project, None)
    shared = [role for role in theirs if role in ours]
    if find_missing_roles(theirs) or find_missing_roles(ours):
        return clip
    one, other = [theirs[role] for role in shared], [ours[role] for role in shared]
    (turns, places), (our_turns, our_places) = clip.globals(clip.rest), project.globals(project.rest)
    apart = (places[one] - places[theirs["hips"]]) - (our_places[other] - our_places[ours["hips"]])
    turned = rotation.measure_angle_between(turns[one], our_turns[other])
    if np.linalg.norm(apart, axis=-1).max() > _APART * project.height or turned.max() > _TURNED:
        return clip
    known = dict(zip(one, (project.names[joint] for joint in other), strict=True))
    free = set(known.values())
    names = [
        known.get(joint, f"{name} (of the clip)" if name in free else name)
        for joint, name in enumerate(clip.names)
    ]
    return _renamed(clip, names)


def _renamed(skeleton: Skeleton, names: Sequence[str]) -> Skeleton:
    return Skeleton(tuple(names), skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations)


def _without_namespace(names: Sequence[str]) -> list[str]:
    return [re.split(r"[:|]", name)[-1] for name in names]


def _without_common(names: Sequence[str]) -> list[str]:
    """Return names without what all of them begin and end with."""
    bare = _without_namespace(names)
    if len(bare) < 3:
        return bare
    before = _shared(bare)
    behind = _shared([name[before:][::-1] for name in bare])
    return [name[before : len(name) - behind] for name in bare]


def _shared(names: Sequence[str]) -> int:
    """Return how many characters all names begin with alike."""
    first, last = min(names), max(names)
    return next(
        (n for n, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), min(map(len, names))
    )


def _along(pose: Pose, chain: Sequence[int]) -> tuple[Array, Array]:
    """Return the turn `[F, 4]` and place `[F, 3]` of a chain's end in the space above it; of no joints,
    none.
    """
    turn = np.tile([0.0, 0, 0, 1], (len(pose.rotations), 1))
    place = np.zeros((len(pose.rotations), 3))
    for joint in chain:
        place = place + rotation.rotate_vectors(turn, pose.translations[:, joint].astype(float))
        turn = rotation.multiply(turn, pose.rotations[:, joint].astype(float))
    return turn, place
