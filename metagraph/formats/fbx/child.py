"""Read FBX files with ufbx in a process of its own, one after another, and return them as binary glTF.

Paths come in as lines of JSON; each answer is a code, a length and either the glTF or the reason why there is
none. A broken file, or an error in the use of the library's handles, ends only this process. ufbx frees a
scene while its nodes are still in use unless every list is kept, so all lists are made at once and held until
the process ends. It reads a limited number of files.
"""

from __future__ import annotations

import json
import os
import struct
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from metagraph.common.budgets import CLIP_SECONDS, FBX_MEMORY, FBX_SAMPLES, NODES
from metagraph.formats.gltf.binary import BinaryChunk, make_glb_bytes

FPS = 30.0  # if the file's own rate is not one that motion is recorded at
_RATES = (10.0, 240.0)
MISSING, REFUSED = 4, 3  # exit code; code of an answer
_CAMERAS = (3, 4, 18, 19)  # ufbx element types: light, camera, camera switcher, stereo camera
_PATHS = (("translation", slice(0, 3)), ("rotation", slice(3, 7)), ("scale", slice(7, 10)))


_held: list[Any] = []  # every scene and its lists, until the process ends


def main() -> int:
    """Convert the requested files; return the exit code."""
    try:
        import ufbx
    except ImportError:
        return MISSING
    _bound()
    out = sys.stdout.buffer
    sys.stdout = sys.stderr  # what a library prints is not an answer
    for line in sys.stdin.buffer:
        code = 0
        try:
            scene = ufbx.load_file(
                json.loads(line),
                target_unit_meters=1.0,
                target_axes=ufbx.axes_right_handed_y_up,
                space_conversion=ufbx.SpaceConversion.MODIFY_GEOMETRY,
            )
            _held.append(scene)
            answer = _convert(scene)
        except (ufbx.UfbxError, ValueError, ArithmeticError, np.linalg.LinAlgError, MemoryError) as error:
            said = str(error) or "there is not enough memory for it"
            code, answer = REFUSED, said[:500].encode("utf-8", "replace")
        out.write(struct.pack("<Bq", code, len(answer)) + answer)
        out.flush()
    return 0


def _bound() -> None:
    """Limit this process's memory if the system supports it, because what the library unpacks is
    not counted.
    """
    with suppress(ImportError, OSError, ValueError):
        import resource

        most = resource.getrlimit(resource.RLIMIT_AS)[1]
        wanted = FBX_MEMORY if most == resource.RLIM_INFINITY else min(FBX_MEMORY, most)
        resource.setrlimit(resource.RLIMIT_AS, (wanted, most))


def _matrix(m: Any) -> Any:
    out = np.eye(4)
    for c, column in enumerate((m.c0, m.c1, m.c2, m.c3)):
        out[:3, c] = (column.x, column.y, column.z)
    return out


def _transform(t: Any) -> tuple[float, ...]:
    p, r, s = t.translation, t.rotation, t.scale
    return (p.x, p.y, p.z, r.x, r.y, r.z, r.w, s.x, s.y, s.z)


@dataclass(frozen=True, eq=False)
class _Scene:
    """The parts of a scene that are written.

    `nodes`, `stacks`, `clusters` and `blends` are the library's; `blends` are the channels of blend shapes.
    `parents` has each node's parent, -1 for none. `bones` lists the nodes that are bones. `still` `[N, 10]`
    is where nodes stand without motion: translation, rotation, scale. `fps` is the rate at which takes are
    sampled.
    """

    nodes: list[Any]
    stacks: list[Any]
    clusters: list[Any]
    blends: list[Any]
    fps: float
    parents: list[int]
    bones: list[int]
    still: Any


def _convert(scene: Any) -> bytes:
    """Return a scene as binary glTF. Raises ValueError if it is too large."""
    read = _read(scene)
    document: dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}]}
    document["nodes"] = _described(read)
    body = BinaryChunk()
    if read.bones:
        bind = _bind_pose(read)
        matrices = np.stack([np.linalg.pinv(bind[i]) for i in read.bones])
        inverse = body.array(matrices.transpose(0, 2, 1).reshape(-1, 16), 5126)
        document["skins"] = [{"joints": read.bones, "inverseBindMatrices": inverse}]
    animations = _animations(read, document, body)
    if animations:
        document["animations"] = animations
    return make_glb_bytes(document, body)


def _read(scene: Any) -> _Scene:
    nodes = list(scene.nodes)
    stacks = list(scene.anim_stacks)
    clusters = list(scene.skin_clusters)
    blends = list(scene.blend_channels)
    _held.append((nodes, stacks, clusters, blends))
    if len(nodes) > NODES:
        raise ValueError(f"it has more than {NODES:,} nodes")
    bones = [i for i, node in enumerate(nodes) if node.bone is not None]
    parents = [node.parent.typed_id if node.parent is not None else -1 for node in nodes]
    still = np.array([_transform(node.local_transform) for node in nodes])
    stated = float(scene.settings.frames_per_second)
    fps = stated if _RATES[0] <= stated <= _RATES[1] else FPS
    return _Scene(nodes, stacks, clusters, blends, fps, parents, bones, still)


def _described(scene: _Scene) -> list[dict[str, Any]]:
    """Return the nodes in glTF's form."""
    described: list[dict[str, Any]] = []
    below: dict[int, list[int]] = {}
    for i, parent in enumerate(scene.parents):
        below.setdefault(parent, []).append(i)
    for i, node in enumerate(scene.nodes):
        value: dict[str, Any] = {
            "name": node.name,
            "translation": scene.still[i, :3].tolist(),
            "rotation": scene.still[i, 3:7].tolist(),
            "scale": scene.still[i, 7:].tolist(),
        }
        if i in below:
            value["children"] = below[i]
        described.append(value)
    return described


def _bind_pose(scene: _Scene) -> dict[int, Any]:
    """Return where the bones stand in the pose that the skin is bound to, as matrices `[4, 4]` by node."""
    nodes, parents, bones = scene.nodes, scene.parents, scene.bones
    bind: dict[int, Any] = {}
    for cluster in scene.clusters:
        if cluster.bone_node is not None:
            bind.setdefault(cluster.bone_node.typed_id, _matrix(cluster.bind_to_world))
    for i in bones:
        if i not in bind:  # a bone that moves no vertex stands as in the scene, on its parent's bind pose
            own = _matrix(nodes[i].node_to_parent)
            bind[i] = bind[parents[i]] @ own if parents[i] in bind else _matrix(nodes[i].node_to_world)
    if not scene.clusters:
        # The bind pose is unknown, and the root is where it is in the first frame, so move it over the
        # origin.
        away = bind[bones[0]][[0, 2], 3].copy()
        for i in bones:
            bind[i][[0, 2], 3] -= away
    return bind


def _moving(scene: _Scene) -> list[int]:
    """Return the nodes whose motion is read: bones and their ancestors; all nodes if there are no bones.
    Lights, targets and footprints beside them do not matter.
    """
    nodes, parents = scene.nodes, scene.parents
    carrying = set(scene.bones)
    for i in scene.bones:
        while parents[i] >= 0 and parents[i] not in carrying:
            i = parents[i]
            carrying.add(i)
    return [
        i
        for i, node in enumerate(nodes)
        if int(node.attrib_type) not in _CAMERAS and parents[i] >= 0 and (not scene.bones or i in carrying)
    ]


def _animations(scene: _Scene, document: dict[str, Any], body: BinaryChunk) -> list[dict[str, Any]]:
    """Return the takes that move anything. `document` gets a node for the face of each take that has one.
    Raises ValueError if they are too long together.
    """
    moving = _moving(scene)
    animations = []
    asked = 0
    for stack in scene.stacks:
        length = float(stack.time_end - stack.time_begin)
        frames = round(length * scene.fps) + 1 if 0 <= length < CLIP_SECONDS else 1
        asked += frames * (len(moving) + len(scene.blends))
        if asked > FBX_SAMPLES:
            raise ValueError(f"its takes, up to '{stack.name}' of {length:.0f} s, are too long")
        animation = _animation(scene, stack, frames, moving, body)
        _add_face(animation, scene, stack, frames, document, body)
        if animation["channels"]:
            animations.append(animation)
    return animations


def _animation(
    scene: _Scene, stack: Any, frames: int, moving: list[int], body: BinaryChunk
) -> dict[str, Any]:
    """Return a take with a channel for everything that differs from its node. The first bone has all
    channels, because they keep the length of the take.
    """
    anim = stack.anim
    times = stack.time_begin + np.arange(frames) / scene.fps
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for i in moving:
        node = scene.nodes[i]
        root = i in scene.bones[:1]
        values = np.array([_transform(node.evaluate_transform(anim, t)) for t in times])
        for name, columns in _PATHS:
            own = values[:, columns]
            steady = np.abs(own - own[:1]).max() < 1e-7
            if steady and np.abs(own[0] - scene.still[i, columns]).max() < 1e-7 and not root:
                continue
            kept = 1 if steady and not root else frames
            source = body.array(times[:kept] - stack.time_begin, 5126)
            samplers.append({"input": source, "output": body.array(own[:kept], 5126)})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": i, "path": name}})
    return {"name": stack.name, "samplers": samplers, "channels": channels, "extras": {"fps": scene.fps}}


def _add_face(
    animation: dict[str, Any],
    scene: _Scene,
    stack: Any,
    frames: int,
    document: dict[str, Any],
    body: BinaryChunk,
) -> None:
    """Add the weights of blend shapes that are not zero throughout a take. Meshes that share a shape's name
    share its weight. The deformer's name before a shape's is removed ("blendShape1.jawOpen").
    """
    times = stack.time_begin + np.arange(frames) / scene.fps
    columns: dict[str, Any] = {}
    for blend in scene.blends:
        name = blend.name.rpartition(".")[2].strip()
        weights = np.array([blend.evaluate_blend_weight(stack.anim, t) for t in times])
        if name and np.isfinite(weights).all() and np.abs(weights).max() > 1e-5:
            columns.setdefault(name, weights)
    if not columns:
        return
    mesh = {
        "name": "face",
        "primitives": [{"attributes": {}, "targets": [{} for _ in columns]}],
        "extras": {"targetNames": [*columns]},
    }
    document.setdefault("meshes", []).append(mesh)
    document["nodes"].append({"name": "face", "mesh": len(document["meshes"]) - 1})
    source = body.array(times - stack.time_begin, 5126)
    output = body.array(np.stack([*columns.values()], 1).reshape(-1), 5126)
    animation["samplers"].append({"input": source, "output": output})
    target = {"node": len(document["nodes"]) - 1, "path": "weights"}
    animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": target})


if __name__ == "__main__":
    code = main()
    sys.stderr.flush()
    os._exit(code)  # the library's handles are not released
