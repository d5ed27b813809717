"""Characters as studios have them, made here: other names, other rests, other units and axes, pieces missing.

Nothing of it was recorded: one figure of seventeen joints does the same calisthenics of sines on each
skeleton. The names are the conventions of tools, not anybody's files. `make(folder)` writes a file for each
of `ANIMALS`, some kilobytes each; the answers one would give by hand (which joint is the left hand, how tall
they are) stand with them.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.gltf.writer import Keys, write_glb
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]
SECONDS = 2.0
TAKES = {
    "calisthenics": 1.0,
    "half": 0.5,
    "the other way": -0.7,
}  # takes -> how far it is done; a BVH has the first alone

# The figure in a T-pose, metres, Y up, facing +Z: joint -> its parent and where it is. Its left side is at
# +X.
FIGURE: dict[str, tuple[str | None, tuple[float, float, float]]] = {
    "hips": (None, (0, 0.95, 0)),
    "spine": ("hips", (0, 1.05, 0)),
    "chest": ("spine", (0, 1.25, -0.01)),
    "neck": ("chest", (0, 1.48, -0.01)),
    "head": ("neck", (0, 1.56, 0.01)),
}
for _side, _x in (("left", 1.0), ("right", -1.0)):
    FIGURE |= {
        f"{_side}_shoulder": ("chest", (0.05 * _x, 1.42, 0)),
        f"{_side}_upper_arm": (f"{_side}_shoulder", (0.18 * _x, 1.43, 0)),
        f"{_side}_lower_arm": (f"{_side}_upper_arm", (0.46 * _x, 1.43, 0)),
        f"{_side}_hand": (f"{_side}_lower_arm", (0.71 * _x, 1.43, 0)),
        f"{_side}_index": (f"{_side}_hand", (0.80 * _x, 1.43, 0.02)),
        f"{_side}_upper_leg": ("hips", (0.1 * _x, 0.91, 0)),
        f"{_side}_lower_leg": (f"{_side}_upper_leg", (0.1 * _x, 0.5, 0.01)),
        f"{_side}_foot": (f"{_side}_lower_leg", (0.1 * _x, 0.08, 0)),
        f"{_side}_toes": (f"{_side}_foot", (0.1 * _x, 0.02, 0.13)),
    }


@dataclass(frozen=True)
class Animal:
    """One character.

    names: the figure's joint -> what it is called, a `@` standing for the side; joints without a name are
    missing. sides: what `@` is on the left and the right. arms: degrees that arms hang below the horizontal
    at rest. unit: metres of a unit of the file. up: the axis of the file that points up. bones: whether
    joints' Y axes lie along their bones in the T-pose, else they are parallel to the world's. above: a joint
    on the ground above the hips. bind: whether the first frame is the rest pose. size: of the body; legs: of
    the legs beside that.
    """

    kind: Literal[".glb", ".bvh"]
    names: Mapping[str, str]
    sides: tuple[str, str] = ("Left", "Right")
    arms: float = 0.0
    unit: float = 0.01
    up: Literal["Y", "Z"] = "Y"
    bones: bool = False
    fps: float = 30.0
    bind: bool = False
    size: float = 1.0
    legs: float = 1.0
    above: str | None = None

    def called(self, joint: str) -> str | None:
        """Return what a joint of the figure is called, None if it is missing."""
        side, _, part = joint.partition("_")
        if side not in ("left", "right"):
            return self.names.get(joint)
        name = self.names.get(part)
        return None if name is None else name.replace("@", self.sides[side == "right"])


def _names(prefix: str, trunk: str, arm: str, leg: str) -> dict[str, str]:
    parts = ("hips", "spine", "chest", "neck", "head", "shoulder", "upper_arm", "lower_arm", "hand", "index")
    parts += ("upper_leg", "lower_leg", "foot", "toes")
    words = [word.strip() for line in (trunk, arm, leg) for word in line.split(",")]
    return {part: prefix + word for part, word in zip(parts, words, strict=True) if word != "-"}


ANIMALS: dict[str, Animal] = {
    # Centimetres under a scaled node, T-pose, bones along Y, as the web service writes them.
    "mixamo": Animal(
        ".glb",
        _names(
            "mixamorig:",
            "Hips, Spine, Spine2, Neck, Head",
            "@Shoulder, @Arm, @ForeArm, @Hand, @HandIndex1",
            "@UpLeg, @Leg, @Foot, @ToeBase",
        ),
        bones=True,
    ),
    # Z up under a turned node, names with spaces, arms down, a rate of its own.
    "biped": Animal(
        ".glb",
        _names(
            "Bip01 ",
            "Pelvis, Spine, Spine1, Neck, Head",
            "@ Clavicle, @ UpperArm, @ Forearm, @ Hand, @ Finger0",
            "@ Thigh, @ Calf, @ Foot, @ Toe0",
        ),
        ("L", "R"),
        arms=75,
        up="Z",
        bones=True,
        fps=25,
    ),
    # Lower case, a fast camera, the bind pose on the first frame, no fingers.
    "cmu": Animal(
        ".bvh",
        _names(
            "",
            "hips, lowerback, thorax, lowerneck, head",
            "@clavicle, @humerus, @radius, @hand, -",
            "@femur, @tibia, @foot, @toes",
        ),
        ("l", "r"),
        fps=120,
        bind=True,
    ),
    # A-pose, Z up, a root on the ground above the pelvis, a game's rate.
    "unreal": Animal(
        ".glb",
        _names(
            "",
            "pelvis, spine_01, spine_03, neck_01, head",
            "clavicle_@, upperarm_@, lowerarm_@, hand_@, index_01_@",
            "thigh_@, calf_@, foot_@, ball_@",
        ),
        ("l", "r"),
        arms=45,
        up="Z",
        bones=True,
        fps=60,
        above="root",
    ),
    # Names in Japanese, metres, A-pose, no toes, short.
    "japanese": Animal(
        ".glb",
        _names(
            "", "センター, 上半身, 上半身2, 首, 頭", "@肩, @腕, @ひじ, @手首, @人指１", "@足, @ひざ, @足首, -"
        ),
        ("左", "右"),
        arms=35,
        unit=1.0,
        size=0.9,
    ),
    # Z up in a BVH, in metres, arms down, neither fingers nor toes.
    "bare": Animal(
        ".bvh",
        _names(
            "",
            "Hips, Spine, Chest, Neck, Head",
            "@Collar, @UpperArm, @LowerArm, @Hand, -",
            "@UpperLeg, @LowerLeg, @Foot, -",
        ),
        arms=80,
        unit=1.0,
        up="Z",
        fps=24,
    ),
    # A large head on short legs, no neck, no toes, a thousandth of a metre a unit.
    "toon": Animal(
        ".glb",
        _names(
            "",
            "hips, spine, chest, -, head",
            "shoulder.@, upperarm.@, lowerarm.@, hand.@, -",
            "upperleg.@, lowerleg.@, foot.@, -",
        ),
        ("l", "r"),
        arms=20,
        unit=0.001,
        fps=30,
        size=0.8,
        legs=0.7,
    ),
}


def joints_of(animal: Animal) -> list[str]:
    """Return the joints of the figure that a character has, parents first."""
    return [joint for joint in FIGURE if animal.called(joint) is not None]


def _parent(animal: Animal, joint: str) -> str | None:
    above = FIGURE[joint][0]
    while above is not None and animal.called(above) is None:
        above = FIGURE[above][0]
    return above


def _place(animal: Animal, joint: str) -> Array:
    """Return where a joint is in the T-pose, metres."""
    x, y, z = FIGURE[joint][1]
    ankle = 0.91
    y = y * animal.legs if y <= ankle else y - ankle * (1 - animal.legs)
    return np.array([x, y, z]) * animal.size


def _drop(joint: str, degrees: float) -> Array:
    """Return the turn about the way ahead that lowers an arm from the T-pose."""
    way = -1 if joint.startswith("left") else 1
    lowered = any(part in joint for part in ("upper_arm", "lower_arm", "hand", "index"))
    return rotation.from_axis_angle(np.array([0.0, 0, 1]), np.radians(degrees) * way * lowered)


def _moves(joint: str, t: Array, far: float) -> Array:
    """Return how joints are turned away from the T-pose at times, `[F, 4]`, in the world: what every
    character does alike.
    """

    def turn(axis: tuple[float, float, float], degrees: Array) -> Array:
        return rotation.from_axis_angle(np.array(axis), np.radians(degrees))

    wave = far * np.sin(2 * np.pi * t / SECONDS)
    way = -1.0 if joint.startswith("left") else 1.0
    trunk = turn((0, 1, 0), 6 * wave)
    if joint in ("hips",) or "leg" in joint or "foot" in joint or "toes" in joint:
        if not joint.startswith("left") or "foot" in joint or "toes" in joint:
            return np.tile([0.0, 0, 0, 1], (len(t), 1))
        lift = 20 * np.maximum(wave, 0)  # one knee comes up, and the foot with it
        return turn((-1.0, 0, 0), lift if "upper" in joint else -lift)
    if joint in ("neck", "head"):
        return rotation.multiply(trunk, turn((1, 0, 0), 10 * np.sin(4 * np.pi * t / SECONDS)))
    if any(part in joint for part in ("upper_arm", "lower_arm", "hand", "index")):
        down = turn((0, 0, 1), way * (60 - 35 * wave))
        bend = turn((0, 1, 0), way * (30 + 20 * wave))
        return rotation.multiply(trunk, rotation.multiply(down, bend) if "upper_arm" not in joint else down)
    return trunk


def _axes(animal: Animal, joint: str) -> Array:
    """Return how a joint's axes lie in the T-pose: its Y along the bone, or as the world's."""
    children = [c for c in joints_of(animal) if _parent(animal, c) == joint]
    if not animal.bones or not children:
        above = _parent(animal, joint)
        return (
            _axes(animal, above) if animal.bones and above is not None else rotation.make_identity_rotations()
        )
    along = _place(animal, children[0]) - _place(animal, joint)
    return rotation.find_rotation_between(np.array([0.0, 1, 0]), along / np.linalg.norm(along))


def _local(above: Array | None, own: Array) -> Array:
    return own if above is None else rotation.multiply(rotation.conjugate(above), own)


@cache
def clip_of(name: str, take: str = "calisthenics") -> Clip:
    """Return what a character does, in the units and axes of its file; `root`s above and the bind pose
    included.
    """
    animal = ANIMALS[name]
    t = np.arange(round(SECONDS * animal.fps) + 1) / animal.fps
    clip = clip_doing(animal, take, {joint: _moves(joint, t, TAKES[take]) for joint in joints_of(animal)})
    if not animal.bind:
        return clip
    turns = np.concatenate([clip.skeleton.rest_rotations[None], clip.rotations])
    return replace(
        clip, rotations=turns, translations=clip.translations[[0, *range(clip.frames)]], weights=None
    )


def clip_doing(animal: Animal, name: str, turns: Mapping[str, Array], way: Array | None = None) -> Clip:
    """Return a clip of a character in the units and axes of its file.

    turns: joint -> how it is turned away from the T-pose, `[F, 4]`, in the world. way: `[F, 3]` metres that
    the hips are from where they are in the T-pose.
    """
    joints = joints_of(animal)
    count = len(turns["hips"])
    resting, moving = {}, {}
    for joint in joints:
        axes = _axes(animal, joint)
        resting[joint] = rotation.multiply(_drop(joint, animal.arms), axes)
        moving[joint] = rotation.multiply(turns[joint], axes)
        if animal.kind == ".bvh":  # where joints have no turn at rest: all is given from there
            moving[joint] = rotation.multiply(moving[joint], rotation.conjugate(resting[joint]))
            resting[joint] = rotation.make_identity_rotations()
    rows: list[tuple[str, int, Array, Array, Array]] = []
    turned = (
        rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
        if animal.up == "Z"
        else rotation.make_identity_rotations()
    )
    if animal.above is not None:
        rows.append((animal.above, -1, turned, np.zeros(3), np.tile(turned, (count, 1))))
    for joint in joints:
        above = _parent(animal, joint)
        parent = (
            len(rows) - len(joints[: joints.index(joint)]) + joints.index(above)
            if above is not None
            else len(rows) - 1
        )
        called = animal.called(joint)
        assert called is not None
        if above is None:
            first = rotation.make_identity_rotations() if animal.above is not None else turned
            offset = rotation.rotate_vectors(first, _place(animal, joint))
            own, path = rotation.multiply(first, resting[joint]), rotation.multiply(first, moving[joint])
        else:
            # BVH's offsets are those of the rest pose; elsewhere they lie in the parent's axes.
            apart = _place(animal, joint) - _place(animal, above)
            hanging = rotation.rotate_vectors(_drop(above, animal.arms), apart)
            offset = (
                hanging
                if animal.kind == ".bvh"
                else rotation.rotate_vectors(rotation.conjugate(resting[above]), hanging)
            )
            own, path = _local(resting[above], resting[joint]), _local(moving[above], moving[joint])
        rows.append((called, parent if above is not None else len(rows) - 1, own, offset / animal.unit, path))
    names, parents, rest, offsets, paths = zip(*rows, strict=True)
    if animal.kind == ".bvh":  # the offsets turn, not the rest pose
        rest = tuple(rotation.make_identity_rotations() for _ in rest)
        offsets = tuple(
            rotation.rotate_vectors(turned, o) if n > (animal.above is not None) else o
            for n, o in enumerate(offsets)
        )
        back = rotation.conjugate(turned)
        paths = tuple(
            rotation.multiply(rotation.multiply(turned, p), back) if n else rotation.multiply(p, back)
            for n, p in enumerate(paths)
        )
    skeleton = Skeleton(names, np.array(parents), np.stack(rest), np.stack(offsets))
    whole = rotation.make_continuous(np.stack(paths, 1))
    moved = (0,) if animal.above is None or way is None else (0, 1)
    at = np.tile(skeleton.rest_translations[list(moved)], (count, 1, 1))
    if way is not None:
        at[:, -1] += (
            rotation.rotate_vectors(turned if animal.above is None else np.array([0.0, 0, 0, 1]), way)
            / animal.unit
        )
    return Clip(name, skeleton, animal.fps, whole, at, translated=moved)


def places(name: str, joint: str, take: str = "calisthenics") -> Array:
    """Return where a joint of the figure is in each frame, `[F, 3]` metres with Y up: from the T-pose alone,
    whatever the file says.
    """
    animal = ANIMALS[name]
    t = np.arange(round(SECONDS * animal.fps) + 1) / animal.fps
    line = [joint]
    while (above := _parent(animal, line[0])) is not None:
        line.insert(0, above)
    at = np.tile(_place(animal, line[0]), (len(t), 1))
    for above, below in pairwise(line):
        at = at + rotation.rotate_vectors(
            _moves(above, t, TAKES[take]), _place(animal, below) - _place(animal, above)
        )
    return at


def make(folder: Path) -> dict[str, Path]:
    """Write the file of every character into a folder; return them by name."""
    out = {}
    for name, animal in ANIMALS.items():
        out[name] = folder / f"{name}{animal.kind}"
        if animal.kind == ".bvh":
            write_bvh(out[name], clip_of(name), animal)
        else:
            write_glb_of(out[name], [clip_of(name, take) for take in TAKES], animal)
    return out


def write_glb_of(path: Path, clips: list[Clip], animal: Animal) -> None:
    """Write a GLB whose joints have the units and axes of the tool, under a node that makes metres with Y up
    of them.
    """
    write_glb(path, clips, keys=Keys(quantize=False))
    raw = path.read_bytes()
    (length,) = struct.unpack_from("<I", raw, 12)
    document, rest = json.loads(raw[20 : 20 + length]), raw[20 + length :]
    node: dict[str, Any] = {
        "name": "Armature",
        "scale": [animal.unit] * 3,
        "children": document["scenes"][0]["nodes"],
    }
    if animal.up == "Z":
        node["rotation"] = rotation.from_axis_angle(np.array([1.0, 0, 0]), -np.pi / 2).tolist()
    document["nodes"].append(node)
    document["scenes"][0]["nodes"] = [len(document["nodes"]) - 1]
    head = json.dumps(document).encode()
    head += b" " * (-len(head) % 4)
    path.write_bytes(
        struct.pack("<4sIIII", b"glTF", 2, 20 + len(head) + len(rest), len(head), 0x4E4F534A) + head + rest
    )


def write_bvh(path: Path, clip: Clip, animal: Animal) -> None:
    skeleton = clip.skeleton
    lines = ["HIERARCHY"]

    def joint(j: int, depth: int) -> None:
        pad, kind = "\t" * depth, "ROOT" if depth == 0 else "JOINT"
        x, y, z = skeleton.rest_translations[j] if depth else (0, 0, 0)
        turns = "Zrotation Xrotation Yrotation"
        channels = f"6 Xposition Yposition Zposition {turns}" if depth == 0 else f"3 {turns}"
        lines.extend(
            [
                f"{pad}{kind} {skeleton.names[j]}",
                f"{pad}{{",
                f"{pad}\tOFFSET {x:.5f} {y:.5f} {z:.5f}",
                f"{pad}\tCHANNELS {channels}",
            ]
        )
        children = np.flatnonzero(skeleton.parents == j).tolist()
        for child in children:
            joint(child, depth + 1)
        if not children:
            lines.extend(
                [
                    f"{pad}\tEnd Site",
                    f"{pad}\t{{",
                    f"{pad}\t\tOFFSET 0 {0.05 / animal.unit:.5f} 0",
                    f"{pad}\t}}",
                ]
            )
        lines.append(f"{pad}}}")

    joint(0, 0)
    order: list[int] = []

    def walk(j: int) -> None:
        order.append(j)
        for child in np.flatnonzero(skeleton.parents == j).tolist():
            walk(child)

    walk(0)
    angles = np.degrees(rotation.to_euler(clip.rotations.astype(np.float64)[:, order], "ZXY"))
    lines += ["MOTION", f"Frames: {clip.frames}", f"Frame Time: {1 / clip.fps:.8f}"]
    for place, row in zip(clip.root, angles, strict=True):
        lines.append(" ".join(f"{x:.5f}" for x in (*place, *row.reshape(-1))))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
