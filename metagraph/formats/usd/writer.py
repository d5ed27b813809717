"""Universal Scene Description: a character on its skeleton with each clip as an animation, by UsdSkel.

Metres, Y up. The skeleton's variant set `clip` says which animation plays. Everything stands in one text
file, textures in a folder beside it. Names that are no identifiers are written as ones; the real name is then
the prim's `displayName`, of joints in the skeleton's `jointNames`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.atomic import write_atomically
from metagraph.formats.usd.usda import (
    Names,
    Prim,
    format_usda_number,
    format_usda_numbers,
    format_usda_string,
    format_usda_strings,
    write_each_tuple,
    write_matrices,
    write_time_samples,
    write_tuples,
    write_usd_layer,
)
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, is_bound_to
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

FPS = 30.0  # time codes a second of a file without clips
CHARACTER = "/Character"
STILL = 1e-7  # metres: a blend shape's offset that is smaller is none


def write_usd(
    path: str | Path,
    skeleton: Skeleton,
    clips: Sequence[Clip],
    character: CharacterMesh | None = None,
    playing: str | None = None,
    more: Sequence[Prim] = (),
    metadata: Sequence[str] = (),
) -> tuple[Path, ...]:
    """Write one skeleton, its skin and every clip; return the files, the stage first.

    clips: all on the skeleton, which is also the character's; their names are unique. playing: the name of
    the clip that plays, the first where None. more: further prims of the character, which find a clip by
    `find_clip_paths`. metadata: of the root prim. Raises FileError when a file cannot be written, ValueError
    for mixed skeletons.
    """
    path = Path(path)
    if any(clip.skeleton is not skeleton and clip.skeleton != skeleton for clip in clips):
        raise ValueError("a clip is on another skeleton; retarget it first")
    if character is not None and not is_bound_to(character, skeleton):
        raise ValueError("the mesh is on another skeleton; fit it first")
    rate = Counter(clip.fps for clip in clips).most_common(1)[0][0] if clips else FPS
    joints = list_joint_paths(skeleton)
    places = find_clip_paths([clip.name for clip in clips])
    root = Prim("SkelRoot", CHARACTER[1:], ['kind = "component"', *metadata])
    if clips:
        _choose(root, places, places[clips[0].name if playing is None else playing])
    bound = skeleton if character is None else character.skeleton
    root.children.append(_skeleton(skeleton, bound, joints))
    files: list[tuple[Path, bytes]] = []
    if character is not None and len(character.triangles):
        looks, files = _materials(character, path)
        root.children += [_mesh(character, joints), looks]
    animations = [_animation(clip, places[clip.name], joints, rate) for clip in clips]
    root.children += [Prim("Scope", "Clips", children=animations), *more]
    end = max((clip.duration * rate for clip in clips), default=0.0)
    head = [
        f'defaultPrim = "{CHARACTER[1:]}"', 'upAxis = "Y"', "metersPerUnit = 1", "startTimeCode = 0",
        f"endTimeCode = {format_usda_number(end)}", f"timeCodesPerSecond = {format_usda_number(rate)}",
        f"framesPerSecond = {format_usda_number(rate)}",
    ]  # fmt: skip
    for place, content in files:
        place.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(place, content)
    write_atomically(path, write_usd_layer(head, [root]))
    return (path, *(place for place, _ in files))


def list_joint_paths(skeleton: Skeleton) -> list[str]:
    """Return the joints as UsdSkel names them: by their path from a root, of identifiers."""
    names, out = Names(), list[str]()
    for name, parent in zip(skeleton.names, skeleton.parents.tolist(), strict=True):
        own = names.of(name, "joint")
        out.append(f"{out[parent]}/{own}" if parent >= 0 else own)
    return out


def find_clip_paths(names: Sequence[str]) -> dict[str, str]:
    """Return where in the stage the clips of some names are, in the order they are written in."""
    found = Names()
    return {name: f"{CHARACTER}/Clips/{found.of(name, 'clip')}" for name in names}


def keep_name(name: str, identifier: str) -> list[str]:
    """Return the metadata that keeps a name that is no identifier."""
    return [] if name == identifier else [f"displayName = {format_usda_string(name)}"]


def _choose(root: Prim, places: dict[str, str], playing: str) -> None:
    """Let a variant say which clip the skeleton plays."""
    root.metadata += [
        'variants = {',
        f'    string clip = "{playing.rsplit("/", 1)[1]}"',
        "}",
        'prepend variantSets = "clip"',
    ]  # fmt: skip
    root.properties.append('variantSet "clip" = {')
    for place in places.values():
        root.properties += [
            f'    "{place.rsplit("/", 1)[1]}" {{',
            '        over "Skeleton" {',
            f"            rel skel:animationSource = <{place}>",
            "        }",
            "    }",
        ]
    root.properties.append("}")


def _skeleton(skeleton: Skeleton, bound: Skeleton, joints: list[str]) -> Prim:
    """bound: the same joints, at rest in the pose in which the mesh is bound."""
    turns, places = bound.globals(bound.rest)
    return Prim(
        "Skeleton",
        "Skeleton",
        ['prepend apiSchemas = ["SkelBindingAPI"]'],
        [
            f"uniform token[] joints = {format_usda_strings(joints)}",
            f"uniform token[] jointNames = {format_usda_strings(skeleton.names)}",
            f"uniform matrix4d[] bindTransforms = {write_matrices(_matrices(turns, places))}",
            "uniform matrix4d[] restTransforms = "
            + write_matrices(_matrices(skeleton.rest_rotations, skeleton.rest_translations)),
        ],
    )


def _matrices(rotations: Array, translations: Array) -> Array:
    out = np.tile(np.eye(4), (len(rotations), 1, 1))
    out[:, :3, :3] = rotation.to_matrix(rotations)
    out[:, :3, 3] = translations
    return out


def _animation(clip: Clip, place: str, joints: list[str], rate: float) -> Prim:
    own = place.rsplit("/", 1)[1]
    times = [n * rate / clip.fps for n in range(clip.frames)]
    turns = clip.rotations[..., [3, 0, 1, 2]]  # USD writes the real part first
    places = clip.skeleton.rest_translations
    properties = [
        f"custom double metagraph:fps = {format_usda_number(clip.fps)}",
        f"uniform token[] joints = {format_usda_strings(joints)}",
        f"quatf[] rotations.timeSamples = {write_time_samples(times, _changing(turns))}",
        f"half3[] scales = [{', '.join(['(1, 1, 1)'] * len(joints))}]",
    ]
    moving = clip.translations
    if (moving == moving[:1]).all():
        still = np.array(places, np.float64)
        still[list(clip.translated)] = moving[0]
        properties.append(f"float3[] translations = {write_tuples(still)}")
    else:
        fixed, rows = write_each_tuple(places), list[str]()
        for frame in moving:
            for joint, value in zip(clip.translated, write_each_tuple(frame), strict=True):
                fixed[joint] = value
            rows.append(f"[{', '.join(fixed)}]")
        properties.append(f"float3[] translations.timeSamples = {write_time_samples(times, rows)}")
    if clip.morphs and clip.weights is not None:
        properties += [
            f"uniform token[] blendShapes = {format_usda_strings(clip.morphs)}",
            "float[] blendShapeWeights.timeSamples = "
            f"{write_time_samples(times, map(format_usda_numbers, clip.weights))}",
        ]
    return Prim("SkelAnimation", own, keep_name(clip.name, own), properties)


def _changing(values: Array) -> Iterator[str]:
    """Yield each frame's tuples of `values [F, J, n]`; what stands still is made into text once."""
    moving = np.flatnonzero((values != values[:1]).any((0, 2))).tolist()
    row = write_each_tuple(values[0])
    for frame in values:
        for joint, value in zip(moving, write_each_tuple(frame[moving]), strict=True):
            row[joint] = value
        yield f"[{', '.join(row)}]"


def _mesh(character: CharacterMesh, joints: list[str]) -> Prim:
    weights = np.maximum(np.asarray(character.weights, np.float64), 0)
    total = weights.sum(1, keepdims=True)
    weights = np.where(total > 0, weights / np.where(total > 0, total, 1), [1.0, 0.0, 0.0, 0.0])
    held = np.where(weights > 0, character.joints, 0).astype(int)
    points = np.asarray(character.positions, np.float64)
    uvs = np.asarray(character.uvs, np.float64) * [1, -1] + [0, 1]  # glTF counts from the top
    both = any(character.materials[s.material].double_sided for s in character.surfaces if s.count)
    mesh = Prim(
        "Mesh",
        "Mesh",
        ['prepend apiSchemas = ["SkelBindingAPI", "MaterialBindingAPI"]', *keep_name(character.name, "Mesh")],
        [
            'uniform token subdivisionScheme = "none"',
            f"uniform bool doubleSided = {int(both)}",
            f"float3[] extent = {write_tuples(np.stack([points.min(0), points.max(0)]))}",
            f"int[] faceVertexCounts = {format_usda_numbers(np.full(len(character.triangles), 3))}",
            f"int[] faceVertexIndices = {format_usda_numbers(np.asarray(character.triangles, int))}",
            f"point3f[] points = {write_tuples(points)}",
            f"normal3f[] primvars:normals = {write_tuples(np.asarray(character.normals, np.float64))} (",
            '    interpolation = "vertex"',
            ")",
            f"texCoord2f[] primvars:st = {write_tuples(uvs)} (",
            '    interpolation = "vertex"',
            ")",
            f"uniform token[] skel:joints = {format_usda_strings(joints)}",
            f"rel skel:skeleton = <{CHARACTER}/Skeleton>",
            "matrix4d primvars:skel:geomBindTransform = "
            "( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) )",
            f"int[] primvars:skel:jointIndices = {format_usda_numbers(held)} (",
            "    elementSize = 4",
            '    interpolation = "vertex"',
            ")",
            f"float[] primvars:skel:jointWeights = {format_usda_numbers(weights)} (",
            "    elementSize = 4",
            '    interpolation = "vertex"',
            ")",
        ],
    )
    _blend_shapes(mesh, character)
    names, looks = Names(), _look_names(character)
    mesh.properties.append('uniform token subsetFamily:materialBind:familyType = "partition"')
    for surface in character.surfaces:
        if not surface.count:
            continue
        called = surface.mesh or character.materials[surface.material].name
        own = names.of(called, "surface")
        mesh.children.append(
            Prim(
                "GeomSubset",
                own,
                ['prepend apiSchemas = ["MaterialBindingAPI"]', *keep_name(called, own)],
                [
                    'uniform token elementType = "face"',
                    'uniform token familyName = "materialBind"',
                    f"int[] indices = {format_usda_numbers(surface.first + np.arange(surface.count))}",
                    f"rel material:binding = <{CHARACTER}/Materials/{looks[surface.material]}>",
                ],
            )
        )
    return mesh


def _blend_shapes(mesh: Prim, character: CharacterMesh) -> None:
    if character.morph_positions is None or not character.morphs:
        return
    names = Names()
    own = [names.of(f"shape_{name}") for name in character.morphs]
    mesh.properties += [
        f"uniform token[] skel:blendShapes = {format_usda_strings(character.morphs)}",
        f"rel skel:blendShapeTargets = [{', '.join(f'<{CHARACTER}/Mesh/{name}>' for name in own)}]",
    ]
    for name, shape, offsets in zip(own, character.morphs, character.morph_positions, strict=True):
        there = np.flatnonzero((np.abs(offsets) > STILL).any(1))
        there = there if len(there) else np.array([0])  # UsdSkel takes an empty list for every point
        mesh.children.append(
            Prim(
                "BlendShape",
                name,
                keep_name(shape, name),
                [
                    f"uniform vector3f[] offsets = {write_tuples(np.asarray(offsets, np.float64)[there])}",
                    f"uniform int[] pointIndices = {format_usda_numbers(there)}",
                ],
            )
        )


def _look_names(character: CharacterMesh) -> list[str]:
    names = Names()
    return [names.of(material.name, "material") for material in character.materials]


def _materials(character: CharacterMesh, path: Path) -> tuple[Prim, list[tuple[Path, bytes]]]:
    """Return the materials, and the pictures that they need, in a folder beside the stage."""
    folder = path.with_name(f"{path.stem}_textures")
    known: dict[bytes, Path] = {}
    looks = Prim("Scope", "Materials")
    for name, material in zip(_look_names(character), character.materials, strict=True):
        place = None
        if material.image is not None:
            ending = "png" if material.image[:4] == b"\x89PNG" else "jpg"
            place = known.setdefault(material.image, folder / f"{name}.{ending}")
        looks.children.append(_look(name, material, place))
    return looks, [(place, image) for image, place in known.items()]


def _look(name: str, material: MeshMaterial, picture: Path | None) -> Prim:
    where = f"{CHARACTER}/Materials/{name}"
    red, green, blue, alpha = (format_usda_number(x) for x in material.color)
    surface = [
        'uniform token info:id = "UsdPreviewSurface"',
        f"float inputs:roughness = {format_usda_number(material.roughness)}",
        "float inputs:metallic = 0",
        f"float inputs:opacity = {alpha}",
        f"color3f inputs:diffuseColor = ({red}, {green}, {blue})"
        if picture is None
        else f"color3f inputs:diffuseColor.connect = <{where}/Texture.outputs:rgb>",
        "token outputs:surface",
    ]
    out = Prim(
        "Material",
        name,
        keep_name(material.name, name),
        [f"token outputs:surface.connect = <{where}/Surface.outputs:surface>"],
        [Prim("Shader", "Surface", [], surface)],
    )
    if picture is not None:
        texture = [
            'uniform token info:id = "UsdUVTexture"',
            f"asset inputs:file = @./{picture.parent.name}/{picture.name}@",
            'token inputs:sourceColorSpace = "sRGB"',
            'token inputs:wrapS = "repeat"',
            'token inputs:wrapT = "repeat"',
            f"float4 inputs:scale = ({red}, {green}, {blue}, {alpha})",
            f"float2 inputs:st.connect = <{where}/Place.outputs:result>",
            "float3 outputs:rgb",
        ]
        place = [
            'uniform token info:id = "UsdPrimvarReader_float2"',
            'string inputs:varname = "st"',
            "float2 outputs:result",
        ]
        out.children += [Prim("Shader", "Texture", [], texture), Prim("Shader", "Place", [], place)]
    return out
