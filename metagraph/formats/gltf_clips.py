"""Animations of a glTF file as clips: every channel resampled to one constant frame rate."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.budgets import CLIP_SECONDS
from metagraph.formats.gltf_file import Gltf, extras
from metagraph.formats.gltf_skeleton import GltfRig
from metagraph.formats.gltf_values import Animation
from metagraph.formats.takes import frame_rate, repaired, take_name, take_repair, without_stray_poses
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.records import dataclass
from metagraph.wording import told

Array = NDArray[Any]

STILL = 1e-5  # metres: a translation channel that moves less than this from the rest pose is dropped


@dataclass(frozen=True, eq=False)
class _Grid:
    """Frame times in seconds, and how each array of key times maps onto them."""

    times: Array
    fps: float


def read_clip(gltf: Gltf, rig: GltfRig, number: int, as_is: Collection[str] = ()) -> Clip | None:
    """Return animation `number` as a clip, or None when it moves nothing of the skeleton. Raises FileError.

    as_is: repairs (`takes.REPAIRS`) not to make.
    """
    animation = gltf.json.animations[number]
    where = f"animation {number} '{animation.name}'"
    groups, morph_channels, notes = _channels(gltf, rig, animation, where)
    if not groups and not morph_channels:
        return None
    inputs = {key[0] for key in groups} | {channel[0] for channel in morph_channels}
    keys = {i: _key_times(gltf, i, where) for i in sorted(inputs)}
    start, end = min(float(k[0]) for k in keys.values()), max(float(k[-1]) for k in keys.values())
    if not end - start <= CLIP_SECONDS:
        gltf.fail(told("it lasts {value:.3g} s", value=end - start), where)
    wanted = extras(animation.extras).get("fps")
    fps = frame_rate(
        list(keys.values()),
        float(wanted) if isinstance(wanted, int | float) and 1 <= wanted <= 1000 else None,
    )
    frames = max(1, round((end - start) * fps) + 1)
    joints = len(rig.nodes)
    gltf.spend(frames * joints * 32, where)
    if start * fps > 0.5:
        notes.append(f"it starts at {start:.3f} s in the file; that moment is now 0")
    grid = _Grid(np.minimum(start + np.arange(frames) / fps, end), fps)

    rotations = np.empty((frames, joints, 4), np.float32)
    rotations[:] = rig.still_rotations
    rest = np.asarray(rig.skeleton.rest_translations)
    still = np.einsum("jab,jb->ja", rig.lift, rig.still_translations) + rig.shift
    moved = {
        j: np.broadcast_to(still[j], (frames, 3))
        for j in np.flatnonzero(np.abs(still - rest).max(-1) > STILL).tolist()
    }
    scaled = 0
    for (source, mode, path), targets in groups.items():
        again = len(targets) - len({joint for joint, _ in targets})
        gltf.spend(again * frames * 192, where)  # others were counted with the clip
        places = np.array([t[0] for t in targets])
        width = 4 if path == "rotation" else 3
        values = _stack(
            gltf,
            [t[1] for t in targets],
            len(keys[source]) * (3 if mode == "CUBICSPLINE" else 1),
            width,
            where,
        )
        if path == "rotation":
            rotations[:, places] = _sample(keys[source], values, grid, mode, True).transpose(1, 0, 2)
        elif path == "translation":
            values = values.astype(np.float64) if values.dtype.kind != "f" else values
            lifted = np.einsum("cab,ckb->cka", rig.lift[places], values)
            own = slice(1, None, 3) if mode == "CUBICSPLINE" else slice(None)
            lifted[:, own] += rig.shift[places, None]
            loose = np.abs(lifted[:, own] - rest[places, None]).max((-1, -2)) > STILL
            for j in places[~loose].tolist():
                moved.pop(j, None)
            if loose.any():
                sampled = _sample(keys[source], lifted[loose], grid, mode, False)
                moved.update(zip(places[loose].tolist(), sampled, strict=True))
        else:
            own = slice(1, None, 3) if mode == "CUBICSPLINE" else slice(None)
            away = np.abs(values[:, own] - rig.still_scales[places, None]).max((-1, -2))
            scaled += int((away > 0.01 * np.abs(rig.still_scales[places]).max(-1)).sum())
    if scaled:
        notes.append(f"the scale of {scaled} joints is animated; clips hold no scale, so it was left out")
    turned = np.flatnonzero(rotation.angle_between(rig.turn, rotation.IDENTITY) > 0)
    if len(turned):
        rotations[:, turned] = rotation.multiply(rig.turn[turned].astype(np.float32), rotations[:, turned])
    translated = tuple(sorted({0, *moved}))
    translations = np.stack([moved.get(j, np.broadcast_to(rest[j], (frames, 3))) for j in translated], 1)
    if not (np.isfinite(rotations).all() and np.isfinite(translations).all()):
        bad = np.flatnonzero(~np.isfinite(rotations).all((0, 2)))
        name = (
            rig.skeleton.names[int(bad[0])]
            if len(bad)
            else rig.skeleton.names[next(j for j in moved if not np.isfinite(moved[j]).all())]
        )
        gltf.fail(told("a key is not a number"), told("{where}, node '{name}'", where=where, name=name))
    if np.abs(translations).max() > 1e7:
        gltf.fail(told("a translation is out of range"), where)
    morphs, weights = _morphs(gltf, morph_channels, keys, grid, where)
    stem = gltf.path.stem
    name, renaming = take_repair(animation.name, take_name(animation.name, stem), stem, as_is)
    clip = Clip(
        name,
        rig.skeleton,
        fps,
        rotation.continuous(rotation.normalize(rotations)),
        translations,
        translated,
        morphs,
        weights,
        (*rig.notes, *notes),
    )
    for repair in (*rig.repairs, renaming):
        clip = repaired(clip, repair)
    nodes = Pose(rotation.multiply(rig.turn, rig.still_rotations), still)
    return without_stray_poses(clip, as_is, [nodes])


_Group = tuple[int, str, str]


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


def _stack(gltf: Gltf, outputs: list[int], count: int, width: int, where: str) -> Array:
    """Return key values `[C, count, width]` of several accessors."""
    size = len(outputs) * count * width * 4
    if size > 1 << 20:
        gltf.spend(size, where)
    together = gltf.floats(outputs, count, width, where)
    if together is not None:
        return together
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


def _sample(times: Array, values: Array, grid: _Grid, mode: str, turning: bool) -> Array:
    """Evaluate channels with common key times at the grid: `[C, K, n]` (3 K for splines) -> `[C, F, n]`."""
    at, count = grid.times, len(times)
    spline = mode == "CUBICSPLINE"
    keys = values[:, 1::3] if spline else values
    if count == 1 or (not spline and (keys == keys[:, :1]).all()):
        return np.broadcast_to(keys[:, :1], (len(keys), len(at), keys.shape[-1]))
    near = 1e-3 / grid.fps
    if not spline and count == len(at) and np.abs(times - at).max() < near:
        return keys
    low = np.clip(np.searchsorted(times, at + near, "right") - 1, 0, count - 1)
    if mode == "STEP":
        return keys[:, low]
    low = np.minimum(low, count - 2)
    gap = times[low + 1] - times[low]
    part = np.clip((at - times[low]) / np.where(gap > 1e-9, gap, 1), 0, 1)
    a, b = keys[:, low], keys[:, low + 1]
    u = part[None, :, None]
    if spline:
        gap, u2, u3 = gap[None, :, None], u * u, u * u * u
        leave, arrive = values[:, 2::3][:, low], values[:, 0::3][:, low + 1]
        out = (
            (2 * u3 - 3 * u2 + 1) * a
            + gap * (u3 - 2 * u2 + u) * leave
            + (3 * u2 - 2 * u3) * b
            + gap * (u3 - u2) * arrive
        )
        return np.asarray(rotation.normalize(out) if turning else out)
    if not turning:
        return np.asarray(a + (b - a) * u)
    # Slerp: keys may be far apart after a tool has thinned them out.
    dot = np.einsum("cfi,cfi->cf", a, b, dtype=np.float64)[..., None]
    b = np.where(dot < 0, -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0, 1))
    sine = np.sin(angle)
    close = sine < 1e-3
    sine = np.where(close, 1, sine)
    return np.asarray(
        a * np.where(close, 1 - u, np.sin((1 - u) * angle) / sine)
        + b * np.where(close, u, np.sin(u * angle) / sine)
    )


def morph_names(gltf: Gltf, node: int) -> tuple[str, ...]:
    """Return the names of the morph targets of a node's mesh: from `targetNames`, else made from the mesh's
    name.
    """
    mesh_index = gltf.json.nodes[node].mesh
    if mesh_index is None:
        return ()
    mesh = gltf.item(gltf.json.meshes, mesh_index, "mesh", f"node {node}")
    count = max((len(p.targets) for p in mesh.primitives), default=0)
    if not count:
        return ()
    first = mesh.primitives[0]
    for raw in (mesh.extras, gltf.json.nodes[node].extras, first.extras):
        names = extras(raw).get("targetNames")
        if (
            isinstance(names, list)
            and len(names) >= count
            and all(isinstance(n, str) and n for n in names[:count])
        ):
            return tuple(names[:count])
    return tuple(f"{mesh.name or 'mesh'}_morph_{k}" for k in range(count))


def _morphs(
    gltf: Gltf, channels: list[tuple[int, str, int, int]], keys: dict[int, Array], grid: _Grid, where: str
) -> tuple[tuple[str, ...], Array | None]:
    """Return morph names and weights `[F, K]`; meshes that share a target's name share its weight."""
    columns: dict[str, Array] = {}
    for source, mode, node, output in channels:
        if node >= len(gltf.json.nodes):
            gltf.fail(told("its target node {node} does not exist", node=node), where)
        names = morph_names(gltf, node)
        values = gltf.array(output, where, "SCALAR")
        count = len(keys[source]) * (3 if mode == "CUBICSPLINE" else 1)
        if not names:
            continue
        if len(values) != count * len(names):
            gltf.fail(
                told(
                    "accessor {output} holds {count} weights, expected {count2} x {count3}",
                    output=output,
                    count=len(values),
                    count2=count,
                    count3=len(names),
                ),
                where,
            )
        gltf.spend(len(grid.times) * len(names) * 8, where)
        tracks = np.asarray(values, np.float64).reshape(count, len(names)).T[..., None]
        for name, track in zip(names, _sample(keys[source], tracks, grid, mode, False)[..., 0], strict=True):
            columns.setdefault(name, track)
    if not columns:
        return (), None
    weights = np.stack(list(columns.values()), 1)
    if not np.isfinite(weights).all() or np.abs(weights).max() > 1e6:
        gltf.fail(told("a morph weight is not a sensible number"), where)
    return tuple(columns), weights
