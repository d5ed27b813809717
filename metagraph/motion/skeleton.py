"""Define the skeleton: joints with names, parents and a rest pose, and forward kinematics over any number of
poses at once.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.forward import Forward

Array = NDArray[Any]

FARTHEST = 1e9  # metres between a joint and its parent: more is a broken file


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints in an order in which every parent comes before its children.

    `names` are unique. `parents` is `[J]` int, -1 for a root; joint 0 is a root. `rest_rotations` is `[J, 4]`
    local, xyzw. `rest_translations` is `[J, 3]` local, in metres, Y up. Scale found in a file is applied to
    the translations. Two skeletons are equal if their fingerprints (`joint_map.make_fingerprint`) are.
    """

    names: tuple[str, ...]
    parents: Array
    rest_rotations: Array
    rest_translations: Array

    def __post_init__(self) -> None:
        parents = np.asarray(self.parents, np.int32)
        rotations = np.array(self.rest_rotations, np.float64)
        count = len(self.names)
        if rotations.shape == (count, 4):
            unit = (
                np.abs(np.einsum("ji,ji->j", rotations, rotations) - 1) <= 1e-12
            )  # unit quaternions stay the same to the bit
            rotations[~unit] = rotation.normalize(rotations[~unit])
        translations = np.asarray(self.rest_translations, np.float64)
        if count == 0:
            raise ValueError("a skeleton needs at least one joint")
        if parents.shape != (count,) or rotations.shape != (count, 4) or translations.shape != (count, 3):
            raise ValueError(
                f"a skeleton of {count} joints needs parents [{count}], rotations [{count}, 4] and "
                f"translations [{count}, 3]"
            )
        if len(set(self.names)) != count:
            raise ValueError("joint names must be unique")
        if parents[0] != -1 or np.any(parents >= np.arange(count)) or np.any(parents < -1):
            raise ValueError("every joint's parent must come before it, and joint 0 must be a root")
        if not (np.isfinite(rotations).all() and (np.abs(translations) < FARTHEST).all()):
            raise ValueError("the rest pose holds a value that is not a number, or far too large")
        for array in (parents, rotations, translations):
            array.setflags(write=False)
        object.__setattr__(self, "parents", parents)
        object.__setattr__(self, "rest_rotations", rotations)
        object.__setattr__(self, "rest_translations", translations)

    def __len__(self) -> int:
        return len(self.names)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Skeleton) and self.fingerprint == other.fingerprint

    def __hash__(self) -> int:
        return hash(self.fingerprint)

    def index(self, name: str) -> int:
        """Return the joint's index. Raises KeyError if no joint has this name."""
        return self._places[name]

    def __contains__(self, name: object) -> bool:
        return name in self._places

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.names)}

    @cached_property
    def fingerprint(self) -> str:
        """Return the hex digest of names, parents, rest translations rounded to 0.1 mm and rest rotations
        rounded to 0.001. Skeletons with equal fingerprints are the same.
        """
        digest = hashlib.sha256("\n".join(self.names).encode())
        digest.update(self.parents.astype("<i4").tobytes())
        digest.update((np.round(self.rest_translations, 4) + 0.0).astype("<f4").tobytes())
        digest.update((np.round(self._signed_rest, 3) + 0.0).astype("<f4").tobytes())
        return digest.hexdigest()[:16]

    @property
    def _signed_rest(self) -> Array:
        q = self.rest_rotations
        return np.where(q[:, 3:] < 0, -q, q)

    @cached_property
    def levels(self) -> tuple[Array, ...]:
        """Return the joints grouped by depth, roots first, for forward kinematics."""
        depth = np.zeros(len(self), int)
        for i in range(1, len(self)):
            depth[i] = depth[self.parents[i]] + 1 if self.parents[i] >= 0 else 0
        return tuple(np.flatnonzero(depth == d) for d in range(depth.max() + 1))

    @cached_property
    def _forward(self) -> Forward:
        return Forward(self.parents, self.levels)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Return the indices of each joint's children."""
        out: list[list[int]] = [[] for _ in self.names]
        for i, parent in enumerate(self.parents):
            if parent >= 0:
                out[parent].append(i)
        return tuple(tuple(c) for c in out)

    @cached_property
    def below(self) -> Array:
        """Return `[J]` the number of joints in the subtree of each joint, itself included."""
        out = np.ones(len(self))
        for joint in reversed(np.flatnonzero(self.parents >= 0).tolist()):
            out[self.parents[joint]] += out[joint]
        return out

    def descendants(self, joint: int) -> tuple[int, ...]:
        """Return `joint` and all joints below it."""
        out = [joint]
        for one in out:
            out.extend(self.children[one])
        return tuple(sorted(out))

    def chain(self, joint: int) -> tuple[int, ...]:
        """Return the joints from the root to `joint`, both included."""
        out = [joint]
        while self.parents[out[-1]] >= 0:
            out.append(int(self.parents[out[-1]]))
        return tuple(reversed(out))

    @cached_property
    def rest(self) -> Pose:
        """Return the rest pose."""
        return Pose(self.rest_rotations, self.rest_translations)

    @cached_property
    def height(self) -> float:
        """Return the extent of the rest pose's joints along its longest axis, in metres; at least 1 mm."""
        _, positions = self.globals(self.rest)
        return max(1e-3, float(np.ptp(positions, axis=0).max()))

    def globals(self, pose: Pose) -> tuple[Array, Array]:
        """Return model-space rotations `[..., J, 4]` and positions `[..., J, 3]` of poses."""
        r, p = pose.rotations, pose.translations
        turns, places = self._forward(r.reshape(-1, *r.shape[-2:]), p.reshape(-1, *p.shape[-2:]))
        return turns.reshape(r.shape), places.reshape(p.shape)


@dataclass(frozen=True, eq=False)
class Pose:
    """Local joint transforms: `rotations [..., J, 4]` xyzw, `translations [..., J, 3]` metres."""

    rotations: Array
    translations: Array

    def __getitem__(self, key: Any) -> Pose:
        """Index the leading dimensions."""
        return Pose(self.rotations[key], self.translations[key])

    @property
    def root(self) -> Array:
        """Return the translation of joint 0, `[..., 3]`."""
        return np.asarray(self.translations[..., 0, :])


def make_names_unique(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names with `_2`, `_3` ... appended to repeated ones. Empty names become `joint`."""
    seen: set[str] = set()
    last: dict[str, int] = {}
    out = []
    for raw in names:
        name = raw.strip() or "joint"
        candidate, n = name, last.get(name, 1)
        while candidate in seen:
            n += 1
            candidate = f"{name}_{n}"
        last[name] = n
        seen.add(candidate)
        out.append(candidate)
    return tuple(out)
