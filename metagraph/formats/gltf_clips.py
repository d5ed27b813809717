"""Animations of a glTF file as clips: every channel resampled to one constant frame rate."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from functools import cached_property
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from metagraph.budgets import CLIP_SECONDS
from metagraph.formats.gltf_file import Gltf, extras
from metagraph.formats.gltf_morphs import morph_weights
from metagraph.formats.gltf_sampling import Grid, KeyGroup, KeyTable, sample, sample_turns
from metagraph.formats.gltf_skeleton import GltfRig
from metagraph.formats.gltf_values import Animation
from metagraph.formats.takes import frame_rate, noted, take_name, take_repair, without_stray_poses
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.records import dataclass
from metagraph.wording import told

Array = NDArray[Any]

STILL = 1e-5  # metres: a translation channel that moves less than this from the rest pose is dropped
AT_ONCE = 1 << 18  # joints times frames of takes that are made together

_Group = tuple[int, str, str]  # key times' accessor, interpolation, path


def read_clips(gltf: Gltf, rig: GltfRig, as_is: Collection[str] = ()) -> list[Clip]:
    """Return all animations that move something of the skeleton. Raises FileError; for takes that are longer
    together than the file's size warrants before any of them is made.

    as_is: repairs (`takes.REPAIRS`) not to make.
    """
    keys: dict[int, Array] = {}
    numbers = range(len(gltf.json.animations))
    plans = [plan for n in numbers if (plan := _planned(gltf, rig, n, keys)) is not None]
    still = _Still(rig)
    return [
        clip
        for batch in _batches(plans, len(rig.nodes))
        for clip in _clips(gltf, rig, still, batch, keys, as_is)
    ]


@dataclass(frozen=True, eq=False)
class _Plan:
    """What an animation asks for. groups: of channels that share key times, with their joints and outputs.
    morphs: channels of weights: input, mode, node, output.
    """

    name: str
    where: str
    groups: dict[_Group, list[tuple[int, int]]]
    morphs: list[tuple[int, str, int, int]]
    notes: list[str]
    grid: Grid


class _Still:
    """What a skeleton does that no channel moves. places `[J, 3]`: translations. apart: the joints of which
    these are not those of the rest pose. turned: joints whose file values are turned. lengths `[J, 3]`: what
    translations are multiplied by, axis by axis, None where axes are turned or mixed.
    """

    def __init__(self, rig: GltfRig) -> None:
        self.rest = np.asarray(rig.skeleton.rest_translations)
        self.places = np.einsum("jab,jb->ja", rig.lift, rig.still_translations) + rig.shift
        diagonal = np.einsum("jaa->ja", rig.lift)
        straight = np.count_nonzero(diagonal) == np.count_nonzero(rig.lift)
        self.lengths = diagonal if straight else None
        self.values = rig.still_translations  # in the file's terms
        self.apart = np.flatnonzero(np.abs(self.places - self.rest).max(-1) > STILL).tolist()
        self.turned = np.flatnonzero(rotation.angle_between(rig.turn, rotation.IDENTITY) > 0)
        self.turns = rig.turn[self.turned].astype(np.float32)
        self._rig = rig

    @cached_property
    def pose(self) -> Pose:
        """The pose of the nodes as they are saved."""
        return Pose(rotation.multiply(self._rig.turn, self._rig.still_rotations), self.places)


def _planned(gltf: Gltf, rig: GltfRig, number: int, keys: dict[int, Array]) -> _Plan | None:
    """Return what animation `number` asks for, None when it moves nothing of the skeleton. keys: key times by
    accessor, as they were read.
    """
    animation = gltf.json.animations[number]
    where = f"animation {number} '{animation.name}'"
    groups, morph_channels, notes = _channels(gltf, rig, animation, where)
    if not groups and not morph_channels:
        return None
    inputs = {key[0] for key in groups} | {channel[0] for channel in morph_channels}
    for i in sorted(inputs - keys.keys()):
        keys[i] = _key_times(gltf, i, where)
    own = [keys[i] for i in sorted(inputs)]
    _spend_keys(gltf, 8 * sum(map(len, own)), where)
    start, end = min(float(k[0]) for k in own), max(float(k[-1]) for k in own)
    if not end - start <= CLIP_SECONDS:
        gltf.fail(told("it lasts {value:.3g} s", value=end - start), where)
    wanted = extras(animation.extras).get("fps")
    fps = frame_rate(own, float(wanted) if isinstance(wanted, int | float) and 1 <= wanted <= 1000 else None)
    frames = max(1, round((end - start) * fps) + 1)
    gltf.spend(frames * len(rig.nodes) * 32, where)
    if start * fps > 0.5:
        notes.append(f"it starts at {start:.3f} s in the file; that moment is now 0")
    grid = Grid(np.minimum(start + np.arange(frames) / fps, end), fps)
    return _Plan(animation.name, where, groups, morph_channels, notes, grid)


def _batches(plans: Sequence[_Plan], joints: int) -> Iterator[list[_Plan]]:
    """Yield takes that are made together: numbers of many short ones are reckoned as quickly as one's."""
    batch: list[_Plan] = []
    for plan in plans:
        if batch and joints * sum(len(p.grid.times) for p in (*batch, plan)) > AT_ONCE:
            yield batch
            batch = []
        batch.append(plan)
    if batch:
        yield batch


def _clips(
    gltf: Gltf,
    rig: GltfRig,
    still: _Still,
    plans: Sequence[_Plan],
    keys: dict[int, Array],
    as_is: Collection[str],
) -> list[Clip]:
    frames = [len(plan.grid.times) for plan in plans]
    begins = np.cumsum(frames) - frames
    for plan, count in zip(plans, frames, strict=True):
        for targets in plan.groups.values():
            again = len(targets) - len({joint for joint, _ in targets})
            if again:
                gltf.spend(again * count * 192, plan.where)  # others were counted with the clip
    rotations = _turned(gltf, rig, plans, keys, begins, sum(frames))
    if len(still.turned):
        rotations[:, still.turned] = rotation.multiply(still.turns, rotations[:, still.turned])
    if not np.isfinite(rotations).all():
        frame, joint = (int(place[0]) for place in np.nonzero(~np.isfinite(rotations).all(-1)))
        _not_finite(gltf, rig, plans[int(np.searchsorted(begins, frame, "right")) - 1], joint)
    rotations = rotation.normalize(rotations)
    scaled = _scaled(gltf, rig, plans, keys)
    out = []
    for number, (plan, moved) in enumerate(zip(plans, _moved(gltf, rig, still, plans, keys), strict=True)):
        if scaled[number]:
            plan.notes.append(
                f"the scale of {scaled[number]} joints is animated; clips hold no scale, so it was left out"
            )
        own = rotation.continuous(rotations[begins[number] : begins[number] + frames[number]])
        out.append(_clip(gltf, rig, still, plan, keys, own, moved, as_is))
    return without_stray_poses(out, as_is, [still.pose])


def _not_finite(gltf: Gltf, rig: GltfRig, plan: _Plan, joint: int) -> NoReturn:
    name = rig.skeleton.names[joint]
    gltf.fail(told("a key is not a number"), told("{where}, node '{name}'", where=plan.where, name=name))


def _clip(
    gltf: Gltf,
    rig: GltfRig,
    still: _Still,
    plan: _Plan,
    keys: dict[int, Array],
    rotations: Array,
    moved: dict[int, Array],
    as_is: Collection[str],
) -> Clip:
    """rotations `[F, J, 4]`; moved: as `_moved` has it."""
    translated = tuple(sorted({0, *moved}))
    translations = np.empty((len(rotations), len(translated), 3))
    for n, j in enumerate(translated):
        known = moved.get(j)
        translations[:, n] = still.rest[j] if known is None else known if len(known) else still.places[j]
    if not np.isfinite(translations).all():
        bad = np.flatnonzero(~np.isfinite(translations).all((0, 2)))
        _not_finite(gltf, rig, plan, translated[int(bad[0])])
    if np.abs(translations).max() > 1e7:
        gltf.fail(told("a translation is out of range"), plan.where)
    morphs, weights = morph_weights(gltf, plan.morphs, keys, plan.grid, plan.where)
    stem = gltf.path.stem
    name, renaming = take_repair(plan.name, take_name(plan.name, stem), stem, as_is)
    repairs = tuple(repair for repair in (*rig.repairs, renaming) if repair is not None)
    return Clip(
        name,
        rig.skeleton,
        plan.grid.fps,
        rotations,
        translations,
        translated,
        morphs,
        weights,
        (*rig.notes, *plan.notes, *map(noted, repairs)),
        repairs,
    )


def _turned(
    gltf: Gltf, rig: GltfRig, plans: Sequence[_Plan], keys: dict[int, Array], begins: Array, frames: int
) -> Array:
    """Return rotations `[F, J, 4]` of several takes, one after another, in the file's terms. begins: the
    first frame of each.
    """
    rotations = np.empty((frames, len(rig.nodes), 4), np.float32)
    rotations[:] = rig.still_rotations
    table, others = _sorted(gltf, plans, keys, "rotation")
    if table is not None:
        sample_turns(table, [plan.grid for plan in plans], begins, rotations)
    for number, (source, mode, _), targets in others:
        plan = plans[number]
        values = _stack(gltf, [t[1] for t in targets], len(keys[source]), mode, 4, plan.where)
        sampled = sample(keys[source], values, plan.grid, mode, True)
        own = rotations[begins[number] : begins[number] + len(plan.grid.times)]
        own[:, [t[0] for t in targets]] = sampled.transpose(1, 0, 2)
    return rotations


def _moved(
    gltf: Gltf, rig: GltfRig, still: _Still, plans: Sequence[_Plan], keys: dict[int, Array]
) -> list[dict[int, Array]]:
    """Return of each take where the joints are that are not where the rest pose has them: `[F, 3]`, empty for
    those that stay where their nodes are saved.
    """
    moved = [dict.fromkeys(still.apart, np.empty(0)) for _ in plans]
    table, others = _sorted(gltf, plans, keys, "translation")
    if table is not None and not still.apart:
        away = (table.values != table.along(still.values[table.joints])).any(1)
        table = table.only(np.logical_or.reduceat(away, table.begins))
    if table is not None:
        if still.lengths is None:
            lifted = np.einsum("kab,kb->ka", table.along(rig.lift[table.joints]), table.values)
        else:
            lifted = table.along(still.lengths[table.joints]) * table.values
        lifted += table.along(rig.shift[table.joints])
        loose = table.most(np.abs(lifted - table.along(still.rest[table.joints]))) > STILL
        for take, j in zip(
            table.takes[table.groups[~loose]].tolist(), table.joints[~loose].tolist(), strict=True
        ):
            moved[take].pop(j, None)
        for group in np.unique(table.groups[loose]).tolist():
            channels, places = table.some(group)
            times, take, some = table.times[group], int(table.takes[group]), loose[channels]
            own = lifted[places].reshape(-1, len(times), 3)[some]
            sampled = sample(times, own, plans[take].grid, "LINEAR", False)
            moved[take].update(zip(table.joints[channels][some].tolist(), sampled, strict=True))
    for take, (source, mode, _), targets in others:
        joints = np.array([t[0] for t in targets])
        values = _stack(gltf, [t[1] for t in targets], len(keys[source]), mode, 3, plans[take].where)
        values = values.astype(np.float64) if values.dtype.kind != "f" else values
        lifted = np.einsum("cab,ckb->cka", rig.lift[joints], values)
        own = lifted[:, 1::3] if mode == "CUBICSPLINE" else lifted
        own += rig.shift[joints, None]
        loose = np.abs(own - still.rest[joints, None]).max((-1, -2)) > STILL
        for j in joints[~loose].tolist():
            moved[take].pop(j, None)
        if loose.any():
            sampled = sample(keys[source], lifted[loose], plans[take].grid, mode, False)
            moved[take].update(zip(joints[loose].tolist(), sampled, strict=True))
    return moved


def _scaled(gltf: Gltf, rig: GltfRig, plans: Sequence[_Plan], keys: dict[int, Array]) -> list[int]:
    """Return of each take how many joints' scales are animated."""
    table, others = _sorted(gltf, plans, keys, "scale")
    scales, scaled = rig.still_scales, np.zeros(len(plans), int)
    most = 0.01 * np.abs(scales).max(-1)
    if table is not None:
        away = table.most(np.abs(table.values - table.along(scales[table.joints]))) > most[table.joints]
        scaled += np.bincount(table.takes[table.groups[away]], minlength=len(plans))
    for take, (source, mode, _), targets in others:
        joints = [t[0] for t in targets]
        values = _stack(gltf, [t[1] for t in targets], len(keys[source]), mode, 3, plans[take].where)
        own = values[:, 1::3] if mode == "CUBICSPLINE" else values
        scaled[take] += int((np.abs(own - scales[joints, None]).max((-1, -2)) > most[joints]).sum())
    return [int(count) for count in scaled]


_Targets = list[tuple[int, int]]  # joints and outputs


def _sorted(
    gltf: Gltf, plans: Sequence[_Plan], keys: dict[int, Array], path: str
) -> tuple[KeyTable | None, list[tuple[int, _Group, _Targets]]]:
    """Return the keys of a path's channels that can be read and looked at together, and the groups of the
    others with the number of their take: splines and steps, what lies otherwise in the file, and all of a
    take where two move the same joint, of which the last one counts.
    """
    width = 4 if path == "rotation" else 3
    others: list[tuple[int, _Group, _Targets]] = []
    together: list[KeyGroup] = []
    for number, plan in enumerate(plans):
        groups = {group: targets for group, targets in plan.groups.items() if group[2] == path}
        joints = [joint for targets in groups.values() for joint, _ in targets]
        alone = len(joints) == len(set(joints))
        for group, targets in groups.items():
            times, outputs = keys[group[0]], [t[1] for t in targets]
            starts = None
            if alone and group[1] == "LINEAR":
                starts = gltf.starts(outputs, len(times), width, plan.where)
            if starts is None:
                others.append((number, group, targets))
                continue
            _spend_keys(gltf, len(outputs) * len(times) * width * 4, plan.where)
            together.append(KeyGroup(number, times, [t[0] for t in targets], starts))
    return KeyTable.read(gltf.numbers(plans[0].where), together, width) if together else None, others


def _channels(
    gltf: Gltf, rig: GltfRig, animation: Animation, where: str
) -> tuple[dict[_Group, list[tuple[int, int]]], list[tuple[int, str, int, int]], list[str]]:
    """Sort channels into groups that share key times: (input, mode, path) -> [(joint, output)], and the morph
    channels.
    """
    groups: dict[_Group, list[tuple[int, int]]] = defaultdict(list)
    morphs: list[tuple[int, str, int, int]] = []
    unknown: set[str] = set()
    samplers = animation.samplers
    places, count = rig.places, len(samplers)
    for channel in animation.channels:
        target = channel.target
        node, path = target.node, target.path
        if channel.sampler >= count:
            gltf.fail(told("sampler {sampler} does not exist", sampler=channel.sampler), where)
        sampler = samplers[channel.sampler]
        mode = sampler.interpolation
        if mode != "LINEAR" and mode not in ("STEP", "CUBICSPLINE"):
            gltf.fail(told("interpolation '{mode}' is unknown", mode=mode), where)
        if node is None:
            unknown.add(path)
        elif path == "weights":
            morphs.append((sampler.input, mode, node, sampler.output))
        elif path in ("translation", "rotation", "scale"):
            joint = places.get(node)
            if joint is not None:  # else it animates something that never moves and was folded away
                groups[sampler.input, mode, path].append((joint, sampler.output))
        else:
            unknown.add(path)
    notes = [f"channels for '{path[:40]}' were left out" for path in sorted(unknown)]
    return groups, morphs, notes


def _key_times(gltf: Gltf, accessor: int, where: str) -> Array:
    times = np.asarray(gltf.array(accessor, where, "SCALAR"), np.float64)
    if not len(times):
        gltf.fail(told("accessor {accessor} holds no key times", accessor=accessor), where)
    if not np.isfinite(times).all() or (np.diff(times) < 0).any():
        gltf.fail(told("the key times of accessor {accessor} do not ascend", accessor=accessor), where)
    return times


def _spend_keys(gltf: Gltf, size: int, where: str) -> None:
    if size > 1 << 20:
        gltf.spend(size, where)


def _stack(gltf: Gltf, outputs: list[int], count: int, mode: str, width: int, where: str) -> Array:
    """Return key values `[C, count, width]` of several accessors, three for each of `count` keys of a
    spline.
    """
    count *= 3 if mode == "CUBICSPLINE" else 1
    _spend_keys(gltf, len(outputs) * count * width * 4, where)
    starts = gltf.starts(outputs, count, width, where)
    if starts is not None:
        together = gltf.numbers(where)[np.array(starts)[:, None] + np.arange(count * width)]
        return np.asarray(together.reshape(-1, count, width))
    arrays = []
    for output in outputs:
        values = gltf.array(output, where)
        if values.ndim != 2 or values.shape[1] != width or len(values) < count:
            gltf.fail(
                told(
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
