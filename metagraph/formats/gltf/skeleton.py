"""Make a skeleton from glTF nodes: find which nodes are joints, the rest pose, and where scale is applied."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import JOINTS, JOINTS_DEEP, NODES
from metagraph.common.wording import phrase
from metagraph.formats.gltf.columns import PATHS, SCALE
from metagraph.formats.gltf.file import Gltf
from metagraph.formats.gltf.values import Node
from metagraph.formats.takes import UNIT
from metagraph.motion import rotation
from metagraph.motion.clip import Repair
from metagraph.motion.skeleton import Skeleton, make_names_unique

Array = NDArray[Any]

_TALL, _TINY = 20.0, 0.05  # metres: no talking character is taller or smaller, so the file has other units
_PATHS = tuple(PATHS)
_LARGEST = 1e7  # a larger translation or scale means damage


@dataclass(frozen=True, eq=False)
class GltfRig:
    """A skeleton and how the file's nodes map to it.

    `nodes` has the node of each joint, `places` the joint of each node, `parents` the parent of every node. A
    joint's translation is `lift [J, 3, 3] @ file value + shift [J, 3]`, its rotation `turn [J, 4] * file
    value`. `still_rotations`, `still_translations`, `still_scales` are the nodes' own values in the file's
    terms, which a joint without channels keeps. `rest_matrices` `[J, 4, 4]` are the full rest transforms with
    scale, in metres. `worlds` `[N, 4, 4]` are those of every node as saved.
    """

    skeleton: Skeleton
    nodes: tuple[int, ...]
    places: dict[int, int]
    parents: tuple[int, ...]
    lift: Array
    shift: Array
    turn: Array
    still_rotations: Array
    still_translations: Array
    still_scales: Array
    rest_matrices: Array
    worlds: Array
    unit: float
    notes: tuple[str, ...]
    repairs: tuple[Repair, ...] = ()


def compose(translations: Array, rotations: Array, scales: Array) -> Array:
    """Return matrices `[..., 4, 4]` of translation, rotation (xyzw) and scale."""
    out = np.zeros((*translations.shape[:-1], 4, 4))
    out[..., :3, :3] = rotation.to_matrix(rotations) * scales[..., None, :]
    out[..., :3, 3] = translations
    out[..., 3, 3] = 1
    return out


def decompose(matrices: Array) -> tuple[Array, Array, Array]:
    """Return translations, rotations (xyzw) and scales of matrices `[..., 4, 4]`. A mirroring becomes a
    negative x scale.
    """
    linear = matrices[..., :3, :3]
    scales = np.linalg.norm(linear, axis=-2)
    scales[..., 0] *= np.where(np.linalg.det(linear) < 0, -1, 1)
    safe = np.where(np.abs(scales) > 1e-12, scales, 1)
    return matrices[..., :3, 3], rotation.from_matrix(linear / safe[..., None, :]), scales


_CACHED = 16  # rigs that are kept: the files of a folder usually share one
_rigs: dict[bytes, GltfRig] = {}


def build_rig(gltf: Gltf, as_is: Collection[str] = ()) -> GltfRig:
    """Return the only skeleton of the file; the same object for files with equal nodes and skins. Raises
    FileError.

    `as_is` names repairs (`takes.REPAIRS`) not to make.
    """
    nodes = gltf.json.nodes
    if not nodes:
        gltf.fail(phrase("it holds no nodes"), phrase("its nodes"), phrase("Export it with its skeleton."))
    if len(nodes) > NODES:
        gltf.fail(
            phrase("it has more than {NODES:,} nodes", NODES=NODES),
            phrase("its nodes"),
            phrase("Export only the character."),
        )
    parents, order = _tree(gltf, nodes)
    members = _members(gltf, nodes, parents, order)
    key = hashlib.sha256(msgspec.json.encode((nodes, gltf.json.skins, sorted(members), UNIT in as_is)))
    for s, skin in enumerate(gltf.json.skins):
        if skin.inverse_bind_matrices is not None:
            key.update(np.asarray(gltf.array(skin.inverse_bind_matrices, f"skin {s}", "MAT4")).tobytes())
    found = _rigs.get(key.digest())
    if found is None:
        found = _build(gltf, nodes, parents, order, members, as_is)
        while len(_rigs) >= _CACHED:
            _rigs.pop(next(iter(_rigs)))
        _rigs[key.digest()] = found
    return found


def _build(
    gltf: Gltf,
    nodes: list[Node],
    parents: list[int],
    order: list[int],
    members: set[int],
    as_is: Collection[str],
) -> GltfRig:
    translations, rotations, scales = _transforms(gltf, nodes)
    joints, above = _joints(gltf, members, parents, order)
    places = {node: i for i, node in enumerate(joints)}
    locals_ = compose(translations, rotations, scales)
    worlds = _globals(locals_, np.array(parents), order)

    still = (rotations[joints], translations[joints], scales[joints])
    roots = np.flatnonzero(above < 0)
    base = np.tile(np.eye(4), (len(joints), 1, 1))  # folded into each root: its ancestors' transform
    for i in roots:
        if parents[joints[i]] >= 0:
            base[i] = worlds[parents[joints[i]]]
    rest_t, rest_r, rest_s = _rest_pose(gltf, places, above, base, locals_, worlds, still)
    _, base_r, base_s = decompose(base[roots])
    notes = _scale_notes(above, rest_s, base_s)
    lift, shift, turn = (
        _lift(above, rest_s, base_s),
        np.zeros((len(joints), 3)),
        rotation.make_identity_rotations((len(joints),)),
    )
    lift[roots], shift[roots], turn[roots] = base[roots, :3, :3], base[roots, :3, 3], base_r
    rest_translations = np.einsum("jab,jb->ja", lift, rest_t) + shift
    rest_rotations = rotation.normalize(rotation.multiply(turn, rest_r))
    names = make_names_unique([nodes[n].name or f"node_{n}" for n in joints])
    if len(set(names) - {nodes[n].name.strip() for n in joints if nodes[n].name}):
        notes.append("joints without a name or with a repeated one were given names of their own")

    rest_locals = compose(rest_t, rest_r, rest_s)
    rest_locals[roots] = base[roots] @ rest_locals[roots]
    rest_matrices = _globals(rest_locals, above, range(len(joints)))
    if not (
        np.isfinite(rest_matrices).all()
        and np.isfinite(rest_translations).all()
        and np.abs(rest_translations).max() < 1e9
    ):
        gltf.fail(phrase("its joints have an extreme scale"), phrase("its nodes"))
    unit, repairs = _unit(rest_matrices, as_is)
    if unit != 1.0:
        lift, shift, rest_translations = lift * unit, shift * unit, rest_translations * unit
        rest_matrices[:, :3] *= unit
    skeleton = Skeleton(names, above, rest_rotations, rest_translations)
    return GltfRig(
        skeleton,
        tuple(joints),
        places,
        tuple(parents),
        lift,
        shift,
        turn,
        *still,
        rest_matrices,
        worlds,
        unit,
        tuple(notes),
        repairs,
    )


def _joints(gltf: Gltf, members: set[int], parents: list[int], order: list[int]) -> tuple[list[int], Array]:
    """Return the joints' nodes, parents first, and each joint's parent among them, -1 for none. Refuses more
    joints than any character has.
    """
    joints = _in_order(gltf, members, parents, order)
    if len(joints) > JOINTS:
        gltf.fail(
            phrase(
                "it has {count} joints, more than the maximum of {JOINTS} for a character",
                count=len(joints),
                JOINTS=JOINTS,
            ),
            phrase("its nodes"),
            phrase("Export only the character."),
        )
    places = {node: i for i, node in enumerate(joints)}
    above = np.array([places.get(parents[n], -1) for n in joints])
    depths: list[int] = []
    for parent in above.tolist():  # parents come first
        depths.append(depths[parent] + 1 if parent >= 0 else 1)
    if max(depths) > JOINTS_DEEP:
        gltf.fail(
            phrase("its joint hierarchy is more than {most} levels deep", most=JOINTS_DEEP),
            phrase("its nodes"),
            phrase("Remove ropes, hair and cloth, or export only the character."),
        )
    return joints, above


def _scale_notes(above: Array, scales: Array, base_scales: Array) -> list[str]:
    """Return notes on the joints' scales at rest, and on those applied to the roots."""
    notes: list[str] = []
    spread = np.abs(scales).max(-1) > np.abs(scales).min(-1) * 1.01
    if spread.any():
        notes.append(
            f"{int(spread.sum())} joints are scaled unevenly; their rotation is kept, their scale is not"
        )
    carrying = [int(p) for p in above if p >= 0]  # a mirrored tip changes nothing
    if (base_scales[:, 0] < 0).any() or (scales[carrying] < 0).any():
        notes.append("the file mirrors a part of its scene with a negative scale; that part may look turned")
    return notes


def _lift(above: Array, scales: Array, base_scales: Array) -> Array:
    """Return matrices `[J, 3, 3]` that scale each joint's translation as the joints above it do, zero for
    roots. `scales` are those at rest, `base_scales` those applied to each root.
    """
    size = np.abs(np.cbrt(np.prod(scales, -1)))
    roots, inner = np.flatnonzero(above < 0), np.flatnonzero(above >= 0)
    total = size.tolist()  # the scale that a joint passes on; parents come first
    for root, scale in zip(roots.tolist(), np.abs(np.cbrt(np.prod(base_scales, -1))).tolist(), strict=True):
        total[root] *= scale
    for joint, parent in zip(inner.tolist(), above[inner].tolist(), strict=True):
        total[joint] *= total[parent]
    own = above[inner]
    lift = np.zeros((len(above), 3, 3))
    lift[inner[:, None], range(3), range(3)] = (
        scales[own] * (np.array(total)[own] / np.where(size[own] > 0, size[own], 1))[:, None]
    )
    return lift


def _unit(rest: Array, as_is: Collection[str]) -> tuple[float, tuple[Repair, ...]]:
    """Return the metres per unit of a figure, and the repair if it is not in metres. `rest` is `[J,
    4, 4]`.
    """
    height = float(np.ptp(rest[:, :3, 3], axis=0).max())
    unit = 0.01 if height > _TALL else 100.0 if 1e-3 < height < _TINY and len(rest) > 3 else 1.0
    if unit == 1.0:
        return unit, ()
    words = (
        phrase("its skeleton is {height:.3g} m long: read 100 times smaller (centimetres)", height=height)
        if unit < 1
        else phrase("its skeleton is {height:.3g} m long: read 100 times larger", height=height)
    )
    repair = Repair(UNIT, words, UNIT not in as_is)
    return (unit if repair.made else 1.0), (repair,)


def _tree(gltf: Gltf, nodes: list[Node]) -> tuple[list[int], list[int]]:
    """Return every node's parent, and the nodes depth first, with parents before children."""
    parents = [-1] * len(nodes)
    for i, node in enumerate(nodes):
        for child in node.children:
            if child >= len(nodes):
                gltf.fail(
                    phrase("child {child} does not exist", child=child),
                    phrase("node {i} '{name}'", i=i, name=node.name),
                )
            if parents[child] >= 0 or child == i:
                gltf.fail(
                    phrase("node {child} has more than one parent", child=child),
                    phrase("node {i} '{name}'", i=i, name=node.name),
                )
            parents[child] = i
    order: list[int] = []
    stack = [i for i in range(len(nodes) - 1, -1, -1) if parents[i] < 0]
    while stack:
        i = stack.pop()
        order.append(i)
        stack.extend(reversed(nodes[i].children))
    if len(order) < len(nodes):
        lost = min(set(range(len(nodes))) - set(order))
        gltf.fail(
            phrase("it is its own ancestor"), phrase("node {lost} '{name}'", lost=lost, name=nodes[lost].name)
        )
    return parents, order


def _transforms(gltf: Gltf, nodes: list[Node]) -> tuple[Array, Array, Array]:
    """Return every node's translation, rotation and scale."""
    translations = np.array([n.translation or (0.0, 0.0, 0.0) for n in nodes])
    rotations = np.array([n.rotation or (0.0, 0.0, 0.0, 1.0) for n in nodes])
    scales = np.array([n.scale or (1.0, 1.0, 1.0) for n in nodes])
    for i, node in enumerate(nodes):
        if node.matrix is not None:
            if (
                len(node.matrix) != 16
                or not np.isfinite(node.matrix).all()
                or np.abs(node.matrix).max() > _LARGEST
            ):
                gltf.fail(
                    phrase("its matrix does not have 16 plausible numbers"),
                    phrase("node {i} '{name}'", i=i, name=node.name),
                )
            translations[i], rotations[i], scales[i] = decompose(np.array(node.matrix).reshape(4, 4).T)
    wild = (
        (np.abs(translations).max(-1) > _LARGEST)
        | (np.abs(scales).max(-1) > _LARGEST)
        | (np.abs(rotations).max(-1) > _LARGEST)
    )
    if wild.any():
        i = int(np.flatnonzero(wild)[0])
        gltf.fail(
            phrase("its translation, rotation or scale is out of range"),
            phrase("node {i} '{name}'", i=i, name=nodes[i].name),
        )
    return translations, rotation.normalize(rotations), scales


def _members(gltf: Gltf, nodes: list[Node], parents: list[int], order: list[int]) -> set[int]:
    """Return the nodes that become joints."""
    doc = gltf.json
    skinned: set[int] = set()
    for s, skin in enumerate(doc.skins):
        for joint in dict.fromkeys(skin.joints):
            if joint >= len(nodes):
                gltf.fail(phrase("joint {joint} does not exist", joint=joint), phrase("skin {s}", s=s))
            skinned.add(joint)
    animated: dict[int, list[tuple[str, int]]] = {}
    table = gltf.channels
    free = np.flatnonzero((table.nodes >= 0) & (table.paths <= SCALE))
    free = free[~np.isin(table.nodes[free], list(skinned))]  # other nodes are joints in any case
    for n, node, path, output in zip(
        *(a[free].tolist() for a in (np.arange(len(table.nodes)), table.nodes, table.paths, table.outputs)),
        strict=True,
    ):
        if node >= len(nodes) or output < 0:
            a = int(np.searchsorted(table.begins, n, "right")) - 1
            where = phrase("animation {a} '{name}'", a=a, name=doc.animations[a].name)
            if node >= len(nodes):
                gltf.fail(phrase("its target node {node} does not exist", node=node), where)
            gltf.item(doc.animations[a].samplers, int(table.samplers[n]), "sampler", where)
        animated.setdefault(node, []).append((_PATHS[path], output))
    if skinned:
        moving = {n for n, outputs in animated.items() if _moves(gltf, nodes[n], outputs)}
        members = skinned | moving
    else:
        members = _without_skin(nodes, parents, order, set(animated))
    face = gltf.vrm_face.nodes - skinned
    if members - face:
        members -= face
    # A node between two joints is a joint, too.
    under, over = set(), set(members)
    for i in order:
        if parents[i] in under or parents[i] in members:
            under.add(i)
    for i in reversed(order):
        if i in over and parents[i] >= 0:
            over.add(parents[i])
    return members | (under & over)


def _moves(gltf: Gltf, node: Node, outputs: list[tuple[str, int]]) -> bool:
    """Return whether an animated node ever leaves the transform it has in the scene."""
    if node.matrix is not None:
        return True
    still = {
        "translation": node.translation or (0, 0, 0),
        "rotation": node.rotation or (0, 0, 0, 1),
        "scale": node.scale or (1, 1, 1),
    }
    for path, output in outputs:
        keys = gltf.array(output, f"node '{node.name}'")
        gltf.spend(keys.size * 24, f"node '{node.name}'")
        values = np.asarray(keys, float)
        rest = np.array(still[path], float)
        if values.ndim != 2 or values.shape[1] != len(rest):
            return True
        if path == "rotation":
            values = values * np.where(values @ rest < 0, -1, 1)[:, None]
        if len(values) and np.abs(values - rest).max() > 1e-4 * max(1.0, float(np.abs(rest).max())):
            return True
    return False


def _without_skin(nodes: list[Node], parents: list[int], order: list[int], animated: set[int]) -> set[int]:
    """Return the joints of a file without a skin: the trees that have animation, without scenery and without
    a wrapper on top.
    """
    kept: set[int] = set()
    for i in reversed(order):
        below = any(c in kept for c in nodes[i].children)
        scenery = nodes[i].mesh is not None or nodes[i].camera is not None
        if i in animated or below or not scenery:
            kept.add(i)
    live: set[int] = set()
    for i in reversed(order):
        if i in animated or i in live:
            live.add(i)
            if parents[i] >= 0:
                live.add(parents[i])
    tops = [i for i in order if parents[i] < 0 and (i in live or not animated)]
    inside: set[int] = set()
    for i in order:
        if i in kept and (i in tops or parents[i] in inside):
            inside.add(i)
    for top in tops:
        while top in inside and top not in animated:
            children = [c for c in nodes[top].children if c in inside]
            wrapper = (
                not any(nodes[top].translation or ()) or nodes[top].scale is not None
            )  # a bone has a place of its own
            if len(children) != 1 or not animated or not wrapper:
                break
            inside.discard(top)
            top = children[0]
    return inside or {order[0]}


def _in_order(gltf: Gltf, members: set[int], parents: list[int], order: list[int]) -> list[int]:
    """Return the joints, parents first, otherwise in the order of the skins, then as in the scene."""
    listed = (joint for skin in gltf.json.skins for joint in skin.joints)
    wanted = dict.fromkeys([*listed, *(i for i in order if i in members)])
    out: list[int] = []
    seen: set[int] = set()
    for joint in wanted:
        line = []
        while joint >= 0 and joint in members and joint not in seen:
            seen.add(joint)
            line.append(joint)
            joint = parents[joint]
        out.extend(reversed(line))
    return out


def _globals(locals_: Array, parents: Array, order: Sequence[int]) -> Array:
    """Return model-space matrices of local ones, level by level; in `order`, parents come first."""
    above = parents.tolist()
    levels: list[list[int]] = []
    depths = [0] * len(above)
    for i in order:
        depth = depths[above[i]] + 1 if above[i] >= 0 else 0
        depths[i] = depth
        if depth == len(levels):
            levels.append([])
        levels[depth].append(i)
    out = locals_.copy()
    for level in levels[1:]:
        out[level] = out[parents[level]] @ locals_[level]
    return out


def _is_sound(matrices: Array) -> bool:
    """Return whether matrices `[N, 4, 4]` are invertible translations, rotations and scales."""
    linear = matrices[:, :3, :3]
    return bool(
        np.isfinite(matrices).all()
        and np.abs(matrices).max() <= _LARGEST
        and np.abs(matrices[:, 3] - (0, 0, 0, 1)).max() < 1e-3
        and (np.abs(np.linalg.det(linear)) >= 1e-15).all()
        and (np.linalg.cond(linear) < 1e7).all()
    )


def _rest_pose(
    gltf: Gltf,
    places: dict[int, int],
    above: Array,
    base: Array,
    locals_: Array,
    worlds: Array,
    still: tuple[Array, Array, Array],
) -> tuple[Array, Array, Array]:
    """Return the rest translations, rotations and scales of the joints, in the file's own local terms.

    Exporters save nodes in whatever pose was on the screen, so the inverse bind matrices are more reliable.
    They are used if they describe rigid bones in the same frame as the nodes. Where both agree, the nodes'
    numbers are used, because they are exact.
    """
    rotations, translations, scales = (a.copy() for a in still)
    differs = False
    for s, skin in enumerate(gltf.json.skins):
        if skin.inverse_bind_matrices is None or not skin.joints:
            continue
        inverse = np.asarray(gltf.array(skin.inverse_bind_matrices, f"skin {s}", "MAT4"), float)
        if len(inverse) < len(skin.joints):
            gltf.fail(
                phrase(
                    "{count} inverse bind matrices for {count2} joints",
                    count=len(inverse),
                    count2=len(skin.joints),
                ),
                phrase("skin {s}", s=s),
            )
        inverse = inverse[: len(skin.joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
        if not _is_sound(inverse):
            continue
        bind = np.linalg.inv(inverse)
        own = np.array([places[j] for j in skin.joints])
        at = {joint: k for k, joint in enumerate(own.tolist())}
        parent = np.array([at.get(int(above[j]), -1) for j in own])
        inner, tops = np.flatnonzero(parent >= 0), np.flatnonzero(parent < 0)
        free = [k for k in tops if above[own[k]] < 0]
        local = np.tile(np.eye(4), (len(own), 1, 1))
        local[inner] = inverse[parent[inner]] @ bind[inner]
        seen = np.array(skin.joints)
        apart = [local[inner] - locals_[seen[inner]], bind[free] - worlds[seen[free]]]
        reach = max(1e-9, float(np.abs(translations[own]).max()))
        if all(
            not len(d) or (np.abs(d[:, :3, 3]).max() < 2e-6 * reach and np.abs(d[:, :3, :3]).max() < 1e-5)
            for d in apart
        ):
            continue  # as in most files, nodes and bind matrices agree
        believable = True
        for k in free:
            world, j = worlds[skin.joints[k]], own[k]
            _, world_r, world_s = decompose(world)
            where, bind_r, bind_s = decompose(bind[k])
            if rotation.measure_angle_between(world_r, bind_r) > np.radians(60) or not _is_sound(
                base[j][None]
            ):
                believable = False
                break
            ratio = np.cbrt(abs(np.prod(world_s))) / np.cbrt(abs(np.prod(bind_s)))
            placed = compose(where * ratio, bind_r, world_s)
            local[k] = np.linalg.inv(base[j]) @ placed
        t, r, size = decompose(local)
        use = np.concatenate([inner, np.array(free, int)])
        rigid = np.abs(rotation.to_matrix(r) * size[:, None, :] - local[:, :3, :3]).max(
            (-1, -2)
        ) < 0.02 * np.abs(size).max(-1)
        ratio_s = size[use] / np.where(np.abs(scales[own[use]]) > 1e-9, scales[own[use]], 1)
        if not believable or not rigid[use].all() or (ratio_s < 0.5).any() or (ratio_s > 2).any():
            continue
        differs |= bool(np.abs(t[use] - still[1][own[use]]).max() > 2e-6 * reach) if len(use) else False
        differs |= (
            bool(rotation.measure_angle_between(r[use], still[0][own[use]]).max() > 1e-4)
            if len(use)
            else False
        )
        translations[own[use]], rotations[own[use]], scales[own[use]] = t[use], r[use], size[use]
    if not differs:
        rotations, translations, scales = still
    return translations, rotations, scales
