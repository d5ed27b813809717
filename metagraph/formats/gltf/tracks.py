"""Evaluate what glTF channels do to the joints of several takes together: rotation, translation, scale."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.formats.gltf.channels import JointChannels
from metagraph.formats.gltf.columns import LINEAR, MODES, ROTATION, SCALE, TRANSLATION
from metagraph.formats.gltf.file import Gltf
from metagraph.formats.gltf.sampling import FrameGrid, KeyTable, sample_channels, sample_turns
from metagraph.formats.gltf.skeleton import GltfRig
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose

Array = NDArray[Any]

STILL = 1e-5  # metres: a translation channel that moves less than this from the rest pose is dropped
_NAMES = tuple(MODES)


class Still:
    """The values of a skeleton's joints that no channel moves.

    `places` `[J, 3]` are translations. `apart` has the joints for which these differ from the rest pose.
    `turned` has joints whose file values are turned. `lengths` `[J, 3]` are the factors of translations, axis
    by axis, None if axes are turned or mixed.
    """

    def __init__(self, rig: GltfRig) -> None:
        self.rest = np.asarray(rig.skeleton.rest_translations)
        self.places = np.einsum("jab,jb->ja", rig.lift, rig.still_translations) + rig.shift
        diagonal = np.einsum("jaa->ja", rig.lift)
        straight = np.count_nonzero(diagonal) == np.count_nonzero(rig.lift)
        self.lengths = diagonal if straight else None
        self.values = rig.still_translations  # in the file's terms
        self.apart = np.flatnonzero(np.abs(self.places - self.rest).max(-1) > STILL).tolist()
        self.turned = np.flatnonzero(rotation.measure_angle_between(rig.turn, rotation.IDENTITY) > 0)
        self.turns = rig.turn[self.turned].astype(np.float32)
        self._rig = rig

    @cached_property
    def pose(self) -> Pose:
        """Return the pose of the nodes as they are saved."""
        return Pose(rotation.multiply(self._rig.turn, self._rig.still_rotations), self.places)


class NotFiniteError(ValueError):
    """Raised if a key is not a number."""

    def __init__(self, take: int, joint: int) -> None:
        super().__init__(take, joint)
        self.take, self.joint = take, joint


@dataclass(frozen=True, eq=False)
class TakeTracks:
    """Takes that are processed together.

    `first` and `after` bound their groups of `channels`. `numbers` are their indices among the file's
    animations; `wheres` are their names in errors. `keys` has key times by accessor.
    """

    gltf: Gltf
    rig: GltfRig
    still: Still
    channels: JointChannels
    first: int
    after: int
    numbers: Sequence[int]
    wheres: Sequence[str]
    grids: Sequence[FrameGrid]
    keys: dict[int, Array]

    @cached_property
    def ends(self) -> Array:
        """Return the frames up to each take's end, `[T]`."""
        return np.cumsum([len(grid.times) for grid in self.grids])

    @cached_property
    def begins(self) -> Array:
        return np.asarray(self.ends - [len(grid.times) for grid in self.grids])

    def turned(self) -> Array:
        """Return rotations `[F, J, 4]` of the takes, one after another, with neighbouring frames on the same
        side. Raises NotFiniteError.
        """
        out = np.empty((int(self.ends[-1]), len(self.rig.nodes), 4), np.float32)
        out[:] = self.rig.still_rotations
        table, others = self._sorted(ROTATION)
        if table is not None:
            sample_turns(table, self.grids, self.begins, out)
        for group in others:
            take, source, mode = self._take(group)
            joints, outputs = self.channels.targets(group)
            values = stack(self.gltf, outputs, len(self.keys[source]), mode, 4, self.wheres[take])
            sampled = sample_channels(self.keys[source], values, self.grids[take], mode, True)
            own = out[self.begins[take] : self.ends[take]]
            own[:, joints.tolist()] = sampled.transpose(1, 0, 2)
        return self._finished(out)

    def _finished(self, rotations: Array) -> Array:
        """Return rotations normalised, with neighbouring frames of a take on the same side."""
        still = self.still
        if len(still.turned):
            rotations[:, still.turned] = rotation.multiply(still.turns, rotations[:, still.turned])
        if not np.isfinite(rotations).all():
            frame, joint = (int(place[0]) for place in np.nonzero(~np.isfinite(rotations).all(-1)))
            raise NotFiniteError(int(np.searchsorted(self.ends, frame, "right")), joint)
        rotations = rotation.normalize(rotations)
        for begin, end in zip(self.begins, self.ends, strict=True):
            rotations[begin:end] = rotation.make_continuous(rotations[begin:end])
        return rotations

    def moved(self) -> list[dict[int, Array]]:
        """Return for each take the translations `[F, 3]` of the joints that are not as in the rest pose;
        empty for those that stay as their nodes are saved.
        """
        still, keys = self.still, self.keys
        moved = [dict.fromkeys(still.apart, np.empty(0)) for _ in self.grids]
        table, others = self._sorted(TRANSLATION)
        if table is not None:
            self._move(table, moved)
        for group in others:
            take, source, mode = self._take(group)
            joints, outputs = self.channels.targets(group)
            values = stack(self.gltf, outputs, len(keys[source]), mode, 3, self.wheres[take])
            values = values.astype(np.float64) if values.dtype.kind != "f" else values
            lifted = np.einsum("cab,ckb->cka", self.rig.lift[joints], values)
            own = lifted[:, 1::3] if mode == "CUBICSPLINE" else lifted
            own += self.rig.shift[joints, None]
            loose = np.abs(own - still.rest[joints, None]).max((-1, -2)) > STILL
            for j in joints[~loose].tolist():
                moved[take].pop(j, None)
            if loose.any():
                sampled = sample_channels(keys[source], lifted[loose], self.grids[take], mode, False)
                moved[take].update(zip(joints[loose].tolist(), sampled, strict=True))
        return moved

    def _move(self, table: KeyTable, moved: list[dict[int, Array]]) -> None:
        rig, still = self.rig, self.still
        if not still.apart:
            away = (table.values != table.along(still.values[table.joints])).any(1)
            some = table.only(np.logical_or.reduceat(away, table.begins))
            if some is None:
                return
            table = some
        if still.lengths is None:
            lifted = np.einsum("kab,kb->ka", table.along(rig.lift[table.joints]), table.values)
        else:
            lifted = table.along(still.lengths[table.joints]) * table.values
        lifted += table.along(rig.shift[table.joints])
        loose = table.most(np.abs(lifted - table.along(still.rest[table.joints]))) > STILL
        for take, j in zip(*table.where(~loose), strict=True):
            moved[take].pop(j, None)
        for group in np.unique(table.groups[loose]).tolist():
            channels, keys = table.some(group)
            times, take, chosen = table.times[group], int(table.takes[group]), loose[channels]
            own = lifted[keys].reshape(-1, len(times), 3)[chosen]
            sampled = sample_channels(times, own, self.grids[take], "LINEAR", False)
            moved[take].update(zip(table.joints[channels][chosen].tolist(), sampled, strict=True))

    def scaled(self) -> list[int]:
        """Return for each take how many joints' scales are animated."""
        table, others = self._sorted(SCALE)
        scales, scaled = self.rig.still_scales, np.zeros(len(self.grids), int)
        most = 0.01 * np.abs(scales).max(-1)
        if table is not None:
            far = table.most(np.abs(table.values - table.along(scales[table.joints])))
            away = far > most[table.joints]
            scaled += np.bincount(table.takes[table.groups[away]], minlength=len(scaled))
        for group in others:
            take, source, mode = self._take(group)
            joints, outputs = self.channels.targets(group)
            values = stack(self.gltf, outputs, len(self.keys[source]), mode, 3, self.wheres[take])
            own = values[:, 1::3] if mode == "CUBICSPLINE" else values
            scaled[take] += int((np.abs(own - scales[joints, None]).max((-1, -2)) > most[joints]).sum())
        return [int(count) for count in scaled]

    def _take(self, group: int) -> tuple[int, int, str]:
        """Return which of the takes a group belongs to, the accessor of its key times, and its mode."""
        c = self.channels
        return self.numbers.index(int(c.takes[group])), int(c.sources[group]), _NAMES[c.modes[group]]

    def _sorted(self, path: int) -> tuple[KeyTable | None, list[int]]:
        """Return the keys of a path's channels that can be read together, and the groups of the others:
        splines and steps, keys with another layout in the file, and all channels of a take in which two move
        the same joint; of these the last one counts.
        """
        width, c = 4 if path == ROTATION else 3, self.channels
        mine = np.flatnonzero(c.paths[self.first : self.after] == path) + self.first
        alike = c.modes[mine] == LINEAR
        if c.doubled:
            alike &= np.array([(take, path) not in c.doubled for take in c.takes[mine].tolist()], bool)
        some = mine[alike]
        if not len(some):
            return None, mine.tolist()
        takes = np.searchsorted(self.numbers, c.takes[some])
        sizes = c.begins[some + 1] - c.begins[some]
        groups = np.repeat(np.arange(len(some)), sizes)
        channels = np.repeat(c.begins[some] - (np.cumsum(sizes) - sizes), sizes) + np.arange(len(groups))
        times = [self.keys[source] for source in c.sources[some].tolist()]
        counts = np.array([len(own) for own in times])
        where = self.wheres[takes[0]]
        starts = self.gltf.starts(c.outputs[channels], counts[groups], width, where)
        fine = np.logical_and.reduceat(starts >= 0, np.cumsum(sizes) - sizes)
        if fine.any():
            for group in np.flatnonzero(fine & (sizes * counts * width * 4 > 1 << 20)).tolist():
                self.gltf.spend(int(sizes[group] * counts[group]) * width * 4, self.wheres[takes[group]])
        table = KeyTable(
            self.gltf.numbers(where), width, times, takes, groups, c.joints[channels], starts
        ).only(fine[groups])
        alike[alike] = fine
        return table, mine[~alike].tolist()


def spend_keys(gltf: Gltf, size: int, where: str) -> None:
    if size > 1 << 20:
        gltf.spend(size, where)


def stack(gltf: Gltf, outputs: Array, count: int, mode: str, width: int, where: str) -> Array:
    """Return key values `[C, count, width]` of several accessors; a spline has three for each of `count`
    keys.
    """
    count *= 3 if mode == "CUBICSPLINE" else 1
    spend_keys(gltf, len(outputs) * count * width * 4, where)
    starts = gltf.starts(outputs, count, width, where)
    if (starts >= 0).all():
        together = gltf.numbers(where)[starts[:, None] + np.arange(count * width)]
        return np.asarray(together.reshape(-1, count, width))
    arrays = []
    for output in outputs.tolist():
        values = gltf.array(output, where)
        if values.ndim != 2 or values.shape[1] != width or len(values) < count:
            gltf.fail(
                phrase(
                    "accessor {output} holds {names} values, expected {count}x{width}",
                    output=output,
                    names="x".join(map(str, values.shape)),
                    count=count,
                    width=width,
                ),
                where,
            )
        arrays.append(values if len(values) == count else values[:count])
    return np.stack(arrays)
