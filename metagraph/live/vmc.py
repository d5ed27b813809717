"""VMC: the character for programs that show avatars and receive the Virtual Motion Capture protocol
(VSeeFace, VNyan, Warudo, receivers for Unity, Blender and others).

Each pose is a run of OSC messages, as the protocol's page says (protocol.vmc.info, performer to marionette):
`/VMC/Ext/OK`, `/VMC/Ext/T`, `/VMC/Ext/Root/Pos`, `/VMC/Ext/Bone/Pos` for each bone of Unity's humanoid and
`/VMC/Ext/Blend/Val` for each expression. Space is Unity's: metres, left-handed, y up, the character faces +z.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.engines.targets.vrm import find_vrm_bones
from metagraph.graph import anatomy
from metagraph.graph.face.expression_presets import make_presets, measure_presets
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import Project
from metagraph.graph.requests import RequestError
from metagraph.live.osc_bytes import pad_osc
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.t_pose import make_t_pose

Array = NDArray[Any]

LARGEST = 1400  # bytes of a datagram, so that no network takes it apart
# Expressions as VRM 0.x names them, which most receivers expect, by VRM 1.0's.
EXPRESSIONS = {
    "aa": "A", "ih": "I", "ou": "U", "ee": "E", "oh": "O", "blink": "Blink", "blinkLeft": "Blink_L",
    "blinkRight": "Blink_R", "happy": "Joy", "angry": "Angry", "sad": "Sorrow", "relaxed": "Fun",
    "surprised": "Surprised",
}  # fmt: skip
_THUMB = {"Metacarpal": "Proximal", "Proximal": "Intermediate"}  # VRM 1.0's bones of the thumb -> Unity's


def name_unity_bone(bone: str) -> str:
    """Return Unity's name of a humanoid bone of VRM 1.0's: leftThumbMetacarpal is `LeftThumbProximal`."""
    for part, name in _THUMB.items():
        if bone.endswith(f"Thumb{part}"):
            bone = bone.removesuffix(part) + name
            break
    return bone[0].upper() + bone[1:]


@dataclass
class VmcBody:
    """A project's character as VMC sends it.

    bones: names, joints and, for each, the place of the nearest bone above it, -1 for none. stand:
    rotations `[J, 4]` of the T-pose in the character's space, from which VMC counts. turn: quaternion that
    turns the character to face +z. mixes: expression -> morph target -> weight.
    """

    skeleton: Skeleton
    names: tuple[str, ...]
    joints: Array
    above: tuple[int, ...]
    stand: Array
    turn: Array
    mixes: Mapping[str, Mapping[str, float]]
    _prefixes: list[bytes] = field(default_factory=list)

    @classmethod
    def of(cls, project: Project, morphs: tuple[str, ...] = ()) -> VmcBody:
        """Return the body of a project. morphs: names of the character's morph targets. Raises RequestError
        for a character that is no humanoid.
        """
        skeleton = project.skeleton
        roles = anatomy.project_roles(project)
        bones = find_vrm_bones(skeleton, roles) if skeleton is not None else {}
        if skeleton is None or "hips" not in bones or "head" not in bones:
            raise RequestError("VMC needs a humanoid character: assign its joints in 'Skeleton'")
        _, at = skeleton.globals(skeleton.rest)
        axes = find_body_axes(skeleton, roles, at)
        stand, _ = skeleton.globals(make_t_pose(skeleton, roles, axes[0]))
        order = sorted(bones.items(), key=lambda item: item[1])  # parents come before what hangs on them
        places = {joint: n for n, (_, joint) in enumerate(order)}

        def nearest(joint: int) -> int:
            while (joint := int(skeleton.parents[joint])) >= 0:
                if joint in places:
                    return places[joint]
            return -1

        return cls(
            skeleton,
            tuple(name_unity_bone(bone) for bone, _ in order),
            np.array([joint for _, joint in order]),
            tuple(nearest(joint) for _, joint in order),
            stand,
            rotation.find_rotation_between(axes[2], np.array([0.0, 0.0, 1.0])),
            make_presets(morphs, project.face.channels),
        )

    def bones_of(self, pose: Pose) -> tuple[Array, Array]:
        """Return each bone's rotation `[B, 4]`, xyzw, and position `[B, 3]`, metres, below the bone above it:
        in Unity's space, and as if every bone stood unturned in the T-pose.
        """
        turned, at = self.skeleton.globals(pose)
        whole = rotation.multiply(turned[self.joints], rotation.conjugate(self.stand[self.joints]))
        back = rotation.conjugate(self.turn)
        whole = rotation.multiply(rotation.multiply(self.turn, whole), back)
        places = rotation.rotate_vectors(self.turn, at[self.joints])
        rotations, positions = np.array(whole), np.array(places)
        for n, parent in enumerate(self.above):
            if parent >= 0:
                undo = rotation.conjugate(whole[parent])
                rotations[n] = rotation.multiply(undo, whole[n])
                positions[n] = rotation.rotate_vectors(undo, places[n] - places[parent])
        return rotations * [1.0, -1.0, -1.0, 1.0], positions * [-1.0, 1.0, 1.0]

    def expressions_of(self, weights: Mapping[str, float]) -> dict[str, float]:
        """Return each expression's value, 0..1."""
        held = measure_presets(self.mixes, weights)
        return {name: float(held[preset]) for preset, name in EXPRESSIONS.items() if preset in held}

    def messages(self, now: float, pose: Pose, weights: Mapping[str, float]) -> bytes:
        """Return one pose as OSC messages, each after its size, as in a bundle. Morph targets are sent by
        their own names, too.
        """
        if not self._prefixes:
            self._prefixes = [
                pad_osc("/VMC/Ext/Bone/Pos") + pad_osc(",sfffffff") + pad_osc(name) for name in self.names
            ]
        rotations, positions = self.bones_of(pose)
        numbers = np.concatenate([positions, rotations], axis=1).astype(">f4")
        parts = [
            pad_osc("/VMC/Ext/OK") + pad_osc(",i") + struct.pack(">i", 1),
            pad_osc("/VMC/Ext/T") + pad_osc(",f") + struct.pack(">f", now),
            pad_osc("/VMC/Ext/Root/Pos") + pad_osc(",sfffffff") + pad_osc("root")
            + struct.pack(">7f", 0, 0, 0, 0, 0, 0, 1),
            *(prefix + row.tobytes() for prefix, row in zip(self._prefixes, numbers, strict=True)),
        ]  # fmt: skip
        shown = {**weights, **self.expressions_of(weights)}
        parts += [
            pad_osc("/VMC/Ext/Blend/Val") + pad_osc(",sf") + pad_osc(name) + struct.pack(">f", value)
            for name, value in shown.items()
        ]
        parts.append(pad_osc("/VMC/Ext/Blend/Apply") + pad_osc(","))
        return b"".join(struct.pack(">i", len(part)) + part for part in parts)


def split_bundles(messages: bytes) -> Iterator[bytes]:
    """Yield OSC bundles of at most `LARGEST` bytes from messages that each follow their size."""
    head = b"#bundle\0" + struct.pack(">Q", 1)
    at, bundle = 0, head
    while at < len(messages):
        end = at + 4 + int.from_bytes(messages[at : at + 4], "big")
        if len(bundle) > len(head) and len(bundle) + end - at > LARGEST:
            yield bundle
            bundle = head
        bundle += messages[at:end]
        at = end
    if len(bundle) > len(head):
        yield bundle
