"""Run as a process of its own: read FBX files with ufbx, one after another, as binary glTF.

Paths come in as lines of JSON; out go a code, a length and either the glTF or why there is none. A broken
file, or a slip in the use of the library's handles, ends this process and nothing else. ufbx frees a scene
while its nodes are still in use unless every list is kept, so all of them are made at once and held to the
end: that of the process, which reads a limited number of files.
"""

from __future__ import annotations

import json
import os
import struct
import sys
from contextlib import suppress
from typing import Any

import numpy as np

from metagraph.common.budgets import CLIP_SECONDS, FBX_MEMORY, FBX_SAMPLES, NODES
from metagraph.formats.gltf.binary import BinaryChunk, glb_bytes

FPS = 30.0
MISSING, REFUSED = 4, 3  # exit code; code of an answer
_BONE, _CAMERAS = 5, (3, 4, 18, 19)  # ufbx element types: bone; light, camera, camera switcher, stereo camera


_held: list[Any] = []  # every scene and list of one, to the end of the process


def main() -> int:
    """Convert the files that are asked for; return the exit code."""
    try:
        import ufbx
    except ImportError:
        return MISSING
    _bound()
    out = sys.stdout.buffer
    sys.stdout = sys.stderr  # what a library prints is no answer
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
            answer = _convert(ufbx, scene)
        except (ufbx.UfbxError, ValueError, ArithmeticError, np.linalg.LinAlgError, MemoryError) as error:
            said = str(error) or "there is not enough memory for it"
            code, answer = REFUSED, said[:500].encode("utf-8", "replace")
        out.write(struct.pack("<Bq", code, len(answer)) + answer)
        out.flush()
    return 0


def _bound() -> None:
    """Take no more memory than a file is worth, where the system can see to that: what the library unpacks it
    does not count.
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


def _convert(ufbx: Any, scene: Any) -> bytes:
    nodes = list(scene.nodes)
    stacks = list(scene.anim_stacks)
    clusters = list(scene.skin_clusters)
    _held.append((nodes, stacks, clusters))
    if len(nodes) > NODES:
        raise ValueError(f"it has more than {NODES:,} nodes")
    bones = [i for i, node in enumerate(nodes) if node.bone is not None]
    parents = [node.parent.typed_id if node.parent is not None else -1 for node in nodes]
    still = np.array([_transform(node.local_transform) for node in nodes])
    usable = [int(node.attrib_type) not in _CAMERAS for node in nodes]

    document: dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}]}
    described: list[dict[str, Any]] = []
    below: dict[int, list[int]] = {}
    for i, parent in enumerate(parents):
        below.setdefault(parent, []).append(i)
    for i, node in enumerate(nodes):
        value: dict[str, Any] = {
            "name": node.name,
            "translation": still[i, :3].tolist(),
            "rotation": still[i, 3:7].tolist(),
            "scale": still[i, 7:].tolist(),
        }
        if i in below:
            value["children"] = below[i]
        described.append(value)
    document["nodes"] = described
    body = BinaryChunk()

    if bones:
        bind: dict[int, Any] = {}
        for cluster in clusters:
            if cluster.bone_node is not None:
                bind.setdefault(cluster.bone_node.typed_id, _matrix(cluster.bind_to_world))
        for i in bones:
            if (
                i not in bind
            ):  # a bone that moves no vertex stands as it does in the scene, on its parent's bind pose
                own = _matrix(nodes[i].node_to_parent)
                bind[i] = bind[parents[i]] @ own if parents[i] in bind else _matrix(nodes[i].node_to_world)
        if not clusters:
            # Nothing tells the bind pose; the root's own place is that of the first frame, so stand it over
            # the origin.
            away = bind[bones[0]][[0, 2], 3].copy()
            for i in bones:
                bind[i][[0, 2], 3] -= away
        matrices = np.stack([np.linalg.pinv(bind[i]) for i in bones])
        inverse = body.array(matrices.transpose(0, 2, 1).reshape(-1, 16), 5126)
        document["skins"] = [{"joints": bones, "inverseBindMatrices": inverse}]

    animations = []
    carrying = set(
        bones
    )  # bones and what carries them; lights, targets and footprints beside them do not matter
    for i in bones:
        while parents[i] >= 0 and parents[i] not in carrying:
            i = parents[i]
            carrying.add(i)
    moving = [i for i in range(len(nodes)) if usable[i] and parents[i] >= 0 and (not bones or i in carrying)]
    asked = 0
    for stack in stacks:
        anim = stack.anim
        length = float(stack.time_end - stack.time_begin)
        frames = round(length * FPS) + 1 if 0 <= length < CLIP_SECONDS else 1
        asked += frames * len(moving)
        if asked > FBX_SAMPLES:
            raise ValueError(f"its takes, up to '{stack.name}' of {length:.0f} s, are too long")
        times = stack.time_begin + np.arange(frames) / FPS
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        for i in moving:
            node = nodes[i]
            values = np.array([_transform(node.evaluate_transform(anim, t)) for t in times])
            for name, columns in (
                ("translation", slice(0, 3)),
                ("rotation", slice(3, 7)),
                ("scale", slice(7, 10)),
            ):
                own = values[:, columns]
                steady = np.abs(own - own[:1]).max() < 1e-7
                if steady and np.abs(own[0] - still[i, columns]).max() < 1e-7 and i not in bones[:1]:
                    continue
                kept = 1 if steady and i not in bones[:1] else frames
                source = body.array(times[:kept] - stack.time_begin, 5126)
                samplers.append({"input": source, "output": body.array(own[:kept], 5126)})
                channels.append({"sampler": len(samplers) - 1, "target": {"node": i, "path": name}})
        if channels:
            animations.append(
                {"name": stack.name, "samplers": samplers, "channels": channels, "extras": {"fps": FPS}}
            )
    if animations:
        document["animations"] = animations
    return glb_bytes(document, body)


if __name__ == "__main__":
    code = main()
    sys.stderr.flush()
    os._exit(code)  # the library's handles are not taken apart
