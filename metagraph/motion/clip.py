"""Define the clip: one piece of motion, the same value for every file format."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metagraph.motion import rotation
from metagraph.motion.dense_keys import CLOSED, count_steps, fill_between_keys
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

MEASURES = 4096  # of a clip that are remembered


class ClipError(ValueError):
    """Raised if a clip's numbers do not fit together."""


@dataclass(frozen=True, slots=True)
class Repair:
    """A repair that was made when a file was read, and that can be left out.

    `name` says which repair, `words` what was done. `made` is False if somebody chose to leave the file as it
    is. `take` is the number of the take that it left out, None if it changed the clip itself.
    """

    name: str
    words: str
    made: bool = True
    take: int | None = None


@dataclass(frozen=True, eq=False)
class Clip:
    """Motion on a skeleton at a constant frame rate.

    `rotations` `[F, J, 4]` float32 are local, xyzw, with neighbouring frames on the same side. `translations`
    `[F, T, 3]` float32 are local, in metres, for the joints listed in `translated` (ascending, always with
    joint 0 first); all other joints keep their rest translation. `weights` `[F, K]` are morph target weights
    for `morphs`. `notes` tell the user what the reader changed or dropped. `repairs` are those of the changes
    that can be left out. `brought_from` is the fingerprint of the skeleton it was retargeted from, "" if it
    was not. `face_of` names the take of the same file that has this one as its face, "" if none has.
    `straight` says that straight lines join the keys as they are, as in an export; otherwise curves do.
    """

    name: str
    skeleton: Skeleton
    fps: float
    rotations: Array
    translations: Array
    translated: tuple[int, ...] = (0,)
    morphs: tuple[str, ...] = ()
    weights: Array | None = None
    notes: tuple[str, ...] = ()
    repairs: tuple[Repair, ...] = ()
    brought_from: str = ""
    face_of: str = ""
    straight: bool = False

    def __post_init__(self) -> None:
        r = np.ascontiguousarray(self.rotations, np.float32)
        t = np.ascontiguousarray(self.translations, np.float32)
        count, joints = len(r), len(self.skeleton)
        if count == 0:
            raise ClipError(f"clip '{self.name}' has no frames")
        if r.shape != (count, joints, 4):
            raise ClipError(f"clip '{self.name}': rotations are {r.shape}, expected ({count}, {joints}, 4)")
        if (
            not self.translated
            or self.translated[0] != 0
            or list(self.translated) != sorted(set(self.translated))
        ):
            raise ClipError(f"clip '{self.name}': translated joints must ascend and begin with joint 0")
        if t.shape != (count, len(self.translated), 3) or self.translated[-1] >= joints:
            raise ClipError(
                f"clip '{self.name}': translations are {t.shape}, expected ({count}, "
                f"{len(self.translated)}, 3)"
            )
        if not (self.fps > 0 and np.isfinite(self.fps)):
            raise ClipError(f"clip '{self.name}': {self.fps} frames per second")
        if not (np.isfinite(r).all() and np.isfinite(t).all()):
            raise ClipError(f"clip '{self.name}' holds a value that is not a number")
        w = (
            np.zeros((count, len(self.morphs)), np.float32)
            if self.weights is None
            else np.ascontiguousarray(self.weights, np.float32)
        )
        if w.shape != (count, len(self.morphs)) or not np.isfinite(w).all():
            raise ClipError(
                f"clip '{self.name}': morph weights are {w.shape}, expected ({count}, {len(self.morphs)}) "
                "finite numbers"
            )
        for field, array in (("rotations", r), ("translations", t), ("weights", w)):
            array.setflags(write=False)
            object.__setattr__(self, field, array)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is remembered of the clip: another thread may add to it while it is sent away."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def frames(self) -> int:
        return len(self.rotations)

    @property
    def duration(self) -> float:
        """Return the seconds from the first frame to the last."""
        return (self.frames - 1) / self.fps

    @property
    def root(self) -> Array:
        """Return the translation of joint 0, `[F, 3]`, in metres."""
        return np.asarray(self.translations[:, 0])

    def poses(self) -> Pose:
        """Return every frame as poses `[F, J, ...]`."""
        full = np.broadcast_to(
            self.skeleton.rest_translations.astype(np.float32), (self.frames, len(self.skeleton), 3)
        ).copy()
        full[:, list(self.translated)] = self.translations
        return Pose(self.rotations, full)

    @property
    def dense(self) -> Clip:
        """Return the clip with at least 60 keys a second, which is what plays and what exports hold: the keys
        between its own are on cubic curves. Itself if it has as many, or if its keys are `straight`.
        """
        plain = self.straight or self.frames < 2 or count_steps(self.fps) == 1
        return self if plain else self._dense  # a clip that held itself would outlive its project

    @cached_property
    def _dense(self) -> Clip:
        steps = count_steps(self.fps)
        apart = (self.rotations[-1] - self.rotations[0], self.translations[-1] - self.translations[0])
        loop = all(float(np.abs(ends).max()) < CLOSED for ends in apart)
        rotations = fill_between_keys(self.rotations, steps, loop)
        rotations /= np.sqrt(np.maximum(np.einsum("...i,...i->...", rotations, rotations), 1e-20))[..., None]
        weights = np.zeros((self.frames, 0), np.float32) if self.weights is None else self.weights
        return replace(
            self,
            fps=self.fps * steps,
            rotations=rotations,
            translations=fill_between_keys(self.translations, steps, loop),
            weights=fill_between_keys(weights[..., None], steps, loop)[..., 0],
        )

    def pose_at(self, seconds: ArrayLike) -> Pose:
        """Sample the clip at `seconds [...]`, clamped to its length: between dense keys linear for
        translations, nlerp for rotations.
        """
        dense = self.dense
        low, high, part = dense.locate(seconds)
        rotations = rotation.nlerp(
            dense.rotations[low],
            dense.rotations[high],
            np.broadcast_to(part[..., None], (*low.shape, len(self.skeleton))),
        )
        moved = (
            dense.translations[low] * (1 - part[..., None, None])
            + dense.translations[high] * part[..., None, None]
        )
        full = np.broadcast_to(
            self.skeleton.rest_translations.astype(np.float32), (*low.shape, len(self.skeleton), 3)
        ).copy()
        full[..., list(self.translated), :] = moved
        return Pose(rotations, full)

    def weights_at(self, seconds: ArrayLike) -> Array:
        """Return the weights of `morphs` at `seconds [...]`, `[..., K]`, as `pose_at` samples poses."""
        dense = self.dense
        low, high, part = dense.locate(seconds)
        assert dense.weights is not None  # `__post_init__` makes them
        return np.asarray(dense.weights[low] * (1 - part[..., None]) + dense.weights[high] * part[..., None])

    def morphs_at(self, seconds: float) -> dict[str, float]:
        """Return the morph target weights at one time, by name, clamped to the clip."""
        if not self.morphs:
            return {}
        return dict(zip(self.morphs, map(float, self.weights_at(seconds)), strict=True))

    def locate(self, seconds: ArrayLike) -> tuple[Array, Array, Array]:
        """Return the frames before and after `seconds [...]`, and how far between them it is
        (float32, 0..1).
        """
        at = np.clip(np.asarray(seconds, np.float64) * self.fps, 0, self.frames - 1)
        low = np.minimum(at.astype(np.int64), max(0, self.frames - 2))
        high = np.minimum(low + 1, self.frames - 1)
        return low, high, (at - low).astype(np.float32)

    def measured(self, what: Hashable, measure: Callable[[], float]) -> float:
        """Return a number that `measure` finds of this clip, and that is remembered under `what`."""
        known = self._measures
        if what not in known:
            if len(known) >= MEASURES:
                known.clear()
            known[what] = measure()
        return known[what]

    @cached_property
    def _measures(self) -> dict[Hashable, float]:
        return {}

    def trimmed(self, first: int, last: int | None = None) -> Clip:
        """Return the frames `first` to `last` (excluded). Raises ClipError if none are left."""
        return replace(
            self,
            rotations=self.rotations[first:last],
            translations=self.translations[first:last],
            weights=None if self.weights is None else self.weights[first:last],
        )

    def renamed(self, name: str) -> Clip:
        return replace(self, name=name)
