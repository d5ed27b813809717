"""Read animations of a glTF file as clips; every channel is resampled to one constant frame rate."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CLIP_SECONDS
from metagraph.common.wording import phrase
from metagraph.formats.gltf.channels import (
    JointChannels,
    check_channels,
    list_morph_channels,
    note_unused_channels,
    read_plain_key_times,
)
from metagraph.formats.gltf.columns import WEIGHTS, ChannelTable
from metagraph.formats.gltf.faces import join_faces
from metagraph.formats.gltf.file import DRACO, Gltf, get_extras
from metagraph.formats.gltf.morphs import read_morph_weights
from metagraph.formats.gltf.sampling import FrameGrid
from metagraph.formats.gltf.skeleton import GltfRig
from metagraph.formats.gltf.tracks import NotFiniteError, Still, TakeTracks, spend_keys
from metagraph.formats.takes import drop_stray_poses, guess_frame_rate, repair_note, take_name, take_repair
from metagraph.motion.clip import Clip

Array = NDArray[Any]

AT_ONCE = 1 << 18  # joints times frames of takes that are processed together


def read_animations(gltf: Gltf, rig: GltfRig, as_is: Collection[str] = ()) -> list[Clip]:
    """Return all animations that move something in the skeleton. Raises FileError; if the takes together are
    longer than the file's size justifies, before any of them is made.

    `as_is` names repairs (`takes.REPAIRS`) not to make.
    """
    table = gltf.channels
    channels = JointChannels.of(table, rig.places, len(gltf.json.nodes), len(gltf.json.accessors))
    weights = (table.paths == WEIGHTS) | np.isin(table.nodes, list(gltf.vrm_face.nodes))
    keys = read_plain_key_times(gltf, np.concatenate([channels.sources, table.inputs[weights]]))
    numbers = range(len(gltf.json.animations))
    planned = (_planned(gltf, rig, n, table, channels, keys) for n in numbers)
    plans = [plan for plan in planned if plan is not None]
    still = Still(rig)
    clips = [
        clip
        for batch in _batches(plans, len(rig.nodes))
        for clip in _clips(gltf, rig, still, batch, channels, keys, as_is)
    ]
    return join_faces(clips, [plan.first == plan.after for plan in plans])


@dataclass(frozen=True, eq=False)
class _Plan:
    """What has to be read for an animation.

    `number` is its index in the file. `first` and `after` bound its groups of joint channels. `morphs` has
    channels of weights: input, mode, node, output.
    """

    number: int
    name: str
    where: str
    first: int
    after: int
    morphs: list[tuple[int, str, int, int]]
    notes: list[str]
    grid: FrameGrid


def _planned(
    gltf: Gltf,
    rig: GltfRig,
    number: int,
    table: ChannelTable,
    channels: JointChannels,
    keys: dict[int, Array],
) -> _Plan | None:
    """Return what has to be read for animation `number`; None if it moves nothing in the skeleton. `keys` has
    the key times read so far, by accessor.
    """
    animation = gltf.json.animations[number]
    where = phrase("animation {a} '{name}'", a=number, name=animation.name)
    check_channels(gltf, table, number, where)
    first, after = channels.of_take(number)
    morphs = list_morph_channels(table, number, gltf.vrm_face.expressions)
    notes = note_unused_channels(gltf, table, number)
    if DRACO in gltf.json.extensions_required:
        notes.append(phrase("its mesh is packed with Draco and was left out; its motion was read"))
    own_nodes = table.nodes[table.begins[number] : table.begins[number + 1]]
    if gltf.vrm_face.gaze is not None and gltf.vrm_face.gaze in own_nodes:
        notes.append(phrase("the gaze of its eyes (lookAt) was left out: the project's own gaze moves them"))
    if first == after and not morphs:
        return None
    inputs = {*channels.sources[first:after].tolist(), *(channel[0] for channel in morphs)}
    for i in sorted(inputs - keys.keys()):
        keys[i] = _key_times(gltf, i, where)
    own = [keys[i] for i in sorted(inputs)]
    spend_keys(gltf, 8 * sum(map(len, own)), where)
    start, end = min(float(k[0]) for k in own), max(float(k[-1]) for k in own)
    if not end - start <= CLIP_SECONDS:
        gltf.fail(phrase("it lasts {value:.3g} s", value=end - start), where)
    wanted = get_extras(animation.extras).get("fps")
    fps = guess_frame_rate(
        own, float(wanted) if isinstance(wanted, int | float) and 1 <= wanted <= 1000 else None
    )
    frames = max(1, round((end - start) * fps) + 1)
    gltf.spend(frames * len(rig.nodes) * 32, where)
    if abs(start) * fps > 0.5:
        notes.append(f"it starts at {start:.3f} s in the file; that moment is now 0")
    grid = FrameGrid(np.minimum(start + np.arange(frames) / fps, end), fps)
    return _Plan(number, animation.name, where, first, after, morphs, notes, grid)


def _batches(plans: Sequence[_Plan], joints: int) -> Iterator[list[_Plan]]:
    """Yield takes that are processed together, because the arrays of many short takes take no longer than
    those of one.
    """
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
    still: Still,
    plans: Sequence[_Plan],
    channels: JointChannels,
    keys: dict[int, Array],
    as_is: Collection[str],
) -> list[Clip]:
    for plan in plans if channels.doubled else ():
        for group in range(plan.first, plan.after):
            joints, _ = channels.targets(group)
            again = len(joints) - len(set(joints.tolist()))
            if again:
                gltf.spend(
                    again * len(plan.grid.times) * 192, plan.where
                )  # the others were counted with the clip
    named = [plan.number for plan in plans], [plan.where for plan in plans], [plan.grid for plan in plans]
    takes = TakeTracks(gltf, rig, still, channels, plans[0].first, plans[-1].after, *named, keys)
    try:
        rotations = takes.turned()
    except NotFiniteError as error:
        _not_finite(gltf, rig, plans[error.take], error.joint)
    scaled, out = takes.scaled(), []
    for number, (plan, moved) in enumerate(zip(plans, takes.moved(), strict=True)):
        if scaled[number]:
            plan.notes.append(
                f"the scale of {scaled[number]} joints is animated; clips hold no scale, so it was left out"
            )
        own = rotations[takes.begins[number] : takes.ends[number]]
        out.append(_clip(gltf, rig, still, plan, keys, own, moved, as_is))
    return drop_stray_poses(out, as_is, [still.pose])


def _not_finite(gltf: Gltf, rig: GltfRig, plan: _Plan, joint: int) -> NoReturn:
    name = rig.skeleton.names[joint]
    gltf.fail(phrase("a key is not a number"), phrase("{where}, node '{name}'", where=plan.where, name=name))


def _clip(
    gltf: Gltf,
    rig: GltfRig,
    still: Still,
    plan: _Plan,
    keys: dict[int, Array],
    rotations: Array,
    moved: dict[int, Array],
    as_is: Collection[str],
) -> Clip:
    """Return the clip of a take. `rotations` are `[F, J, 4]`, `moved` is one item of what `moved` of the
    tracks returns.
    """
    translated = tuple(sorted({0, *moved}))
    translations = np.empty((len(rotations), len(translated), 3))
    for n, j in enumerate(translated):
        known = moved.get(j)
        translations[:, n] = still.rest[j] if known is None else known if len(known) else still.places[j]
    if not np.abs(translations).max() <= 1e7:
        bad = np.flatnonzero(~np.isfinite(translations).all((0, 2)))
        if len(bad):
            _not_finite(gltf, rig, plan, translated[int(bad[0])])
        gltf.fail(phrase("a translation is out of range"), plan.where)
    morphs, weights = read_morph_weights(gltf, plan.morphs, keys, plan.grid, plan.where)
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
        (*rig.notes, *plan.notes, *map(repair_note, repairs)),
        repairs,
    )


def _key_times(gltf: Gltf, accessor: int, where: str) -> Array:
    times = np.asarray(gltf.array(accessor, where, "SCALAR"), np.float64)
    if not len(times):
        gltf.fail(phrase("accessor {accessor} has no key times", accessor=accessor), where)
    if not np.isfinite(times).all() or (np.diff(times) < 0).any():
        gltf.fail(
            phrase("the key times of accessor {accessor} are not in ascending order", accessor=accessor),
            where,
        )
    return times
