"""Write clips, and a character if there is one, as a single binary glTF file."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.atomic import write_atomically
from metagraph.formats.gltf.binary import (
    ARRAY_BUFFER,
    BYTE,
    ELEMENT_BUFFER,
    FLOAT,
    SHORT,
    UBYTE,
    UINT,
    USHORT,
    BinaryChunk,
    Packing,
    make_glb_bytes,
)
from metagraph.formats.gltf.key_thinning import find_kept_frames
from metagraph.formats.gltf.materials import add_materials
from metagraph.formats.gltf.placed_props import PlacedProp, add_props
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, is_bound_to
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

# The errors of packed files: turns 0.007 degrees, keys of joints 8 micrometres, a mesh 15, texture
# coordinates a sixteenth of a pixel of 2,048.
TURNS = Packing(filter="QUATERNION", amount=15)
MOVES = Packing(filter="EXPONENTIAL", amount=-16)
PLACES = Packing(filter="EXPONENTIAL", amount=-15)
MORPHS = Packing(filter="EXPONENTIAL", amount=-17)
COORDINATES = Packing(filter="EXPONENTIAL", amount=-14)
NORMALS = Packing(filter="OCTAHEDRAL", amount=8)
AS_THEY_ARE, INDICES = Packing(), Packing("INDICES")


TOGETHER = 64  # clips whose keys are chosen together, so that a large set is not in memory twice
SCENE = "Character"  # the name of the scene of a GLB that stands in a pose


@dataclass(frozen=True)
class Keys:
    """How the keys of clips are stored.

    `quantize` stores rotations as normalised 16-bit integers (error below 0.003 degrees). `tolerance` says
    how far keys may be thinned: the largest change of a quaternion component or, in metres, of a translation;
    by default 5e-5 when quantizing, else 0. A rotation that stays the same keeps one key. With `pose_nodes`,
    joints that stand still with the same rotation in every clip are posed by their nodes and need no key; the
    rest pose is then only in the inverse bind matrices, as in the files of many exporters.
    """

    quantize: bool = True
    tolerance: float | None = None
    pose_nodes: bool = False

    @property
    def off(self) -> float:
        """Return the error that thinned keys may have."""
        return (5e-5 if self.quantize else 0.0) if self.tolerance is None else self.tolerance


@dataclass(frozen=True, eq=False)
class ForEngine:
    """What a file for an engine has besides clips and a character.

    `stand` is the pose of the joints' nodes, None for the rest pose; the skin stays bound to the rest pose,
    and the scene gets a name, with which paths begin in some engines. `moved` has the joints that each clip
    moves, by the clip's name; None for all. `extensions` are the document's, by name. `expressions` is name
    -> morph target -> weight, written beside the targets' names in the mesh's `extras`. `props` are nodes of
    their own.
    """

    stand: Pose | None = None
    moved: Mapping[str, Collection[int]] | None = None
    extensions: Mapping[str, Any] | None = None
    expressions: Mapping[str, Mapping[str, float]] | None = None
    props: tuple[PlacedProp, ...] = ()


SMALL_KEYS = Keys()
PLAIN = ForEngine()


def write_glb(
    path: str | Path,
    clips: Sequence[Clip],
    character: CharacterMesh | None = None,
    keys: Keys = SMALL_KEYS,
    engine: ForEngine = PLAIN,
    compress: bool = False,
) -> None:
    """Write one skeleton, its skin and every clip as an animation.

    All `clips` are on the same skeleton. The character's has the same joints; where it rests in another pose,
    the skin is bound in that. `compress` packs the file with
    EXT_meshopt_compression and KHR_mesh_quantization, which readers must then support, and leaves out
    channels that keep a joint as its node is posed. Raises FileError if the file cannot be written,
    ValueError for mixed skeletons.
    """
    path = Path(path)
    if not clips and character is None:
        raise ValueError("nothing to write: neither a clip nor a character")
    skeleton = clips[0].skeleton if clips or character is None else character.skeleton
    if character is not None and not is_bound_to(character, skeleton):
        raise ValueError(f"the character '{character.name}' is on another skeleton; fit it first")
    for clip in clips:
        if clip.skeleton is not skeleton and clip.skeleton != skeleton:
            raise ValueError(f"clip '{clip.name}' is on another skeleton; retarget it first")
    file = _File(skeleton, keys, engine, compress)
    shown = character if character is not None and len(character.triangles) else None
    file.add_body(shown)
    file.add_clips(clips)
    add_props(file.document, file.body, engine.props)
    file.add_extensions(packed_mesh=compress and shown is not None)
    write_atomically(path, make_glb_bytes(file.document, file.body))


class _File:
    """A file that is being built. `mesh_node` is the node with the mesh, None without one; `morphs` are its
    targets.
    """

    def __init__(self, skeleton: Skeleton, keys: Keys, engine: ForEngine, compress: bool) -> None:
        self.skeleton, self.keys, self.engine = skeleton, keys, engine
        self.body = BinaryChunk(compress)
        self.document: dict[str, Any] = {"asset": {"version": "2.0", "generator": "Metagraph"}, "scene": 0}
        self.nodes = _joint_nodes(skeleton, skeleton.rest if engine.stand is None else engine.stand)
        self.document["nodes"] = self.nodes
        self.morphs: tuple[str, ...] = ()
        self.mesh_node: int | None = None

    def add_body(self, character: CharacterMesh | None) -> None:
        """Add the skin, the mesh of a character, and the scene with both."""
        roots = [i for i, p in enumerate(self.skeleton.parents) if p < 0]
        # Two roots need a common node above them for the skin to be valid.
        if len(roots) > 1:
            self.nodes.append({"name": "Armature", "children": roots})
            roots = [len(self.nodes) - 1]
        bound = self.skeleton if character is None else character.skeleton
        self.document["skins"] = [_skin(self.body, bound, roots[0])]
        if character is not None:
            self.mesh_node = _add_character(self.document, self.body, character)
            self.morphs = character.morphs
            if self.engine.expressions and self.morphs:
                extras = self.document["meshes"][0].setdefault("extras", {})
                extras["expressions"] = self.engine.expressions
            roots = [*roots, self.mesh_node]
        named = {} if self.engine.stand is None else {"name": SCENE}
        self.document["scenes"] = [{**named, "nodes": roots}]

    def add_clips(self, clips: Sequence[Clip]) -> None:
        """Add clips as animations, choosing the keys of `TOGETHER` clips at once."""
        if not clips:
            return
        off = self.keys.off
        posed = _pose_still_nodes(self.nodes, clips, off) if self.keys.pose_nodes else frozenset()
        animations = []
        for first in range(0, len(clips), TOGETHER):
            some = clips[first : first + TOGETHER]
            turns = find_kept_frames([clip.rotations for clip in some], off, True)
            moves = find_kept_frames([clip.translations for clip in some], off, False)
            for clip, turned, placed in zip(some, turns, moves, strict=True):
                animation = _Animation(self, clip)
                animation.add_turns(turned, posed)
                animation.add_moves(placed)
                animation.add_weights()
                animations.append(animation.described())
        self.document["animations"] = animations

    def add_extensions(self, packed_mesh: bool) -> None:
        """List the file's extensions, and those that a packed mesh needs."""
        document, extensions = self.document, self.engine.extensions
        if extensions:
            document["extensionsUsed"] = sorted(extensions)
            document["extensions"] = dict(extensions)
        if packed_mesh:
            for name in ("extensionsUsed", "extensionsRequired"):
                document[name] = sorted({*document.get(name, ()), "KHR_mesh_quantization"})


def _skin(body: BinaryChunk, skeleton: Skeleton, root: int) -> dict[str, Any]:
    """Return the skin that is bound to the rest pose."""
    rest_r, rest_p = skeleton.globals(skeleton.rest)
    inverse = np.tile(np.eye(4), (len(skeleton), 1, 1))
    inverse[:, :3, :3] = rotation.to_matrix(rest_r).transpose(0, 2, 1)
    inverse[:, :3, 3] = -np.einsum("jab,jb->ja", inverse[:, :3, :3], rest_p)
    return {
        "name": "Skin",
        "joints": list(range(len(skeleton))),
        "inverseBindMatrices": body.array(inverse.transpose(0, 2, 1).reshape(-1, 16), FLOAT),
        "skeleton": root,
    }


def _joint_nodes(skeleton: Skeleton, pose: Pose) -> list[dict[str, Any]]:
    out: list[dict[str, Any]] = []
    for i, name in enumerate(skeleton.names):
        node: dict[str, Any] = {
            "name": name,
            "translation": pose.translations[i].tolist(),
            "rotation": pose.rotations[i].tolist(),
        }
        if skeleton.children[i]:
            node["children"] = list(skeleton.children[i])
        out.append(node)
    return out


def _add_character(document: dict[str, Any], body: BinaryChunk, character: CharacterMesh) -> int:
    """Add mesh, materials and images; return the node with the mesh."""
    weights = np.maximum(np.asarray(character.weights, np.float32), 0)
    total = weights.sum(1, keepdims=True)
    weights = np.where(
        total > 0, weights / np.where(total > 0, total, 1), np.array([1, 0, 0, 0], np.float32)
    ).astype(np.float32)
    joints = np.where(weights > 0, character.joints, 0)
    normals = np.asarray(character.normals, np.float64)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 1e-9, normals / np.maximum(length, 1e-9), [0.0, 1.0, 0.0])
    attributes = {
        "POSITION": body.array(character.positions, FLOAT, target=ARRAY_BUFFER, bounds=True, packing=PLACES),
        "NORMAL": _normals(body, normals),
        "TEXCOORD_0": body.array(character.uvs, FLOAT, target=ARRAY_BUFFER, packing=COORDINATES),
        **_second_coordinates(body, character),
        "JOINTS_0": body.array(
            joints,
            UBYTE if len(character.skeleton) <= 255 else USHORT,
            target=ARRAY_BUFFER,
            packing=AS_THEY_ARE,
        ),
        "WEIGHTS_0": _weights(body, weights),
    }
    targets = []
    if character.morph_positions is not None:
        targets = [
            {"POSITION": body.sparse(np.asarray(offsets, np.float32), MORPHS)}
            for offsets in character.morph_positions
        ]
    primitives = []
    for surface in character.surfaces:
        if not surface.count:
            continue
        order = np.asarray(character.triangles[surface.first : surface.first + surface.count]).reshape(-1)
        primitive: dict[str, Any] = {
            "attributes": attributes,
            "indices": body.array(
                order,
                USHORT if int(order.max()) < 65535 else UINT,
                target=ELEMENT_BUFFER,
                packing=INDICES,
            ),
            "material": surface.material,
        }
        if targets:
            primitive["targets"] = targets
        primitives.append(primitive)
    mesh: dict[str, Any] = {"name": character.name, "primitives": primitives}
    if targets:
        mesh["weights"] = [0.0] * len(targets)
        mesh["extras"] = {"targetNames": list(character.morphs)}
    add_materials(document, body, character.materials, character.grain_uvs is not None)
    document["meshes"] = [mesh]
    document["nodes"].append({"name": character.name, "mesh": 0, "skin": 0})
    return len(document["nodes"]) - 1


def _second_coordinates(body: BinaryChunk, character: CharacterMesh) -> dict[str, int]:
    """Add the second texture coordinates, if the character has any."""
    if character.grain_uvs is None:
        return {}
    return {"TEXCOORD_1": body.array(character.grain_uvs, FLOAT, target=ARRAY_BUFFER, packing=COORDINATES)}


def _normals(body: BinaryChunk, normals: Array) -> int:
    """Add normals: floats, or bytes if the file is packed, which have room for the packed values."""
    if not body.compress:
        return body.array(normals, FLOAT, target=ARRAY_BUFFER)
    small = np.rint(normals * 127)
    return body.array(small, BYTE, target=ARRAY_BUFFER, normalized=True, packing=NORMALS)


def _weights(body: BinaryChunk, weights: Array) -> int:
    """Add skin weights: floats, or integers with the right sum if the file is packed."""
    if not body.compress:
        return body.array(weights, FLOAT, target=ARRAY_BUFFER)
    whole = np.rint(weights.astype(np.float64) * 65535)
    rows = np.arange(len(whole))
    whole[rows, whole.argmax(1)] += 65535 - whole.sum(1)
    return body.array(whole, USHORT, target=ARRAY_BUFFER, normalized=True, packing=AS_THEY_ARE)


def _pose_still_nodes(nodes: list[dict[str, Any]], clips: Sequence[Clip], tolerance: float) -> frozenset[int]:
    """Turn the nodes of joints whose rotation no clip changes, and return those joints."""
    first = clips[0].rotations[0].astype(np.float64)
    away = np.max([np.abs(clip.rotations - first).max((0, 2)) for clip in clips], axis=0)
    still = np.flatnonzero(away <= max(tolerance, 1e-7))
    for joint in still.tolist():
        nodes[joint]["rotation"] = np.round(rotation.normalize(first[joint]), 7).tolist()
    return frozenset(still.tolist())


class _Animation:
    """A clip that is being turned into an animation. `chosen` has the joints it moves."""

    def __init__(self, file: _File, clip: Clip) -> None:
        moved = file.engine.moved
        self.file, self.clip, self.partly = file, clip, moved is not None
        self.chosen: Collection[int] = range(len(clip.skeleton)) if moved is None else moved[clip.name]
        self.times = np.arange(clip.frames) / clip.fps
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []
        self.places: dict[tuple[int, int], int] = {}

    def described(self) -> dict[str, Any]:
        """Return the animation in glTF's form."""
        clip = self.clip
        extras = {"fps": clip.fps}
        return {"name": clip.name, "samplers": self.samplers, "channels": self.channels, "extras": extras}

    def _add(self, node: int, path: str, kept: Array, values: Array, component: int) -> None:
        """Add a channel with the values at the kept frames."""
        body = self.file.body
        packing = TURNS if component == SHORT else AS_THEY_ARE if path == "rotation" else MOVES
        source = body.array(self.times[kept], FLOAT, bounds=True, shared="times")
        output = body.array(values, component, normalized=component == SHORT, packing=packing, shared=path)
        place = self.places.setdefault((source, output), len(self.samplers))
        if place == len(self.samplers):
            self.samplers.append({"input": source, "output": output})
        self.channels.append({"sampler": place, "target": {"node": node, "path": path}})

    def add_turns(self, frames: Sequence[Array], posed: frozenset[int]) -> None:
        """Add the joints' rotations. `frames` are those to keep of each joint; joints in `posed`
        need none.
        """
        clip, compress = self.clip, self.file.body.compress
        rotations = clip.rotations.astype(np.float64)
        quantize = self.file.keys.quantize
        written = np.round(rotation.normalize(rotations) * 32767) if quantize else rotations
        for joint, kept in enumerate(frames):
            if joint in posed or joint not in self.chosen:
                continue
            if self.partly and joint == min(self.chosen) and joint != 0 and len(kept) == 1:
                kept = self._whole_length(kept)
            single = compress and len(kept) == 1 and joint > 0
            if single and _as_posed(rotations[kept[0], joint], self.file.nodes[joint]["rotation"]):
                continue
            self._add(joint, "rotation", kept, written[kept, joint], SHORT if quantize else FLOAT)

    def add_moves(self, frames: Sequence[Array]) -> None:
        """Add the joints' translations. `frames` are those to keep of each joint that has any."""
        translations = self.clip.translations.astype(np.float64)
        for column, (joint, kept) in enumerate(zip(self.clip.translated, frames, strict=True)):
            if joint not in self.chosen:
                continue
            if joint == 0 and len(kept) == 1:
                kept = self._whole_length(kept)
            self._add(joint, "translation", kept, translations[kept, column], FLOAT)

    def _whole_length(self, kept: Array) -> Array:
        """Return frames of a joint with which the clip keeps its length even if everything stands still."""
        return np.array([0, self.clip.frames - 1]) if self.clip.frames > 1 else kept

    def add_weights(self) -> None:
        """Add the weights of the mesh's morph targets, if the clip has any of them."""
        clip, node = self.clip, self.file.mesh_node
        shared = [clip.morphs.index(name) if name in clip.morphs else -1 for name in self.file.morphs]
        if node is None or clip.weights is None or not any(i >= 0 for i in shared):
            return
        weights = np.stack([clip.weights[:, i] if i >= 0 else np.zeros(clip.frames) for i in shared], 1)
        still = bool((np.abs(weights - weights[:1]) <= self.file.keys.off).all())
        kept = np.array([0]) if still else np.arange(clip.frames)
        self._add(node, "weights", kept, weights[kept].reshape(-1), FLOAT)


def _as_posed(turn: Array, node: list[float]) -> bool:
    """Return whether a rotation equals the node's own, which readers use if there is no channel."""
    return bool(np.minimum(np.abs(turn - node).max(), np.abs(turn + node).max()) < 1e-6)
