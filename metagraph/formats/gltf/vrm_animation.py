"""Find the humanoid bones that a VRM file states, and the face of a VRM animation (VRMC_vrm_animation 1.0):
each expression has a node, and the x of the node's translation is the expression's weight; another node's
rotation is where the eyes look.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class VrmFace:
    """The nodes of a VRM animation's face.

    `expressions` has the expression, such as "aa" or "Smirk", that each node drives. `gaze` is the node whose
    rotation is where the eyes look, None for none. None of these is a joint.
    """

    expressions: Mapping[int, str] = field(default_factory=dict)
    gaze: int | None = None

    @property
    def nodes(self) -> frozenset[int]:
        """Return every node that is not a joint."""
        return frozenset(self.expressions) | (frozenset() if self.gaze is None else {self.gaze})


def find_vrm_face(extensions: Mapping[str, Any]) -> VrmFace:
    """Return the face that a file's extensions describe; an empty value if it is no VRM animation. Values
    with another form than the format's are skipped.
    """
    stated = _part(extensions, "VRMC_vrm_animation")
    expressions = _part(stated, "expressions")
    named = [*_nodes(_part(expressions, "preset")), *_nodes(_part(expressions, "custom"))]
    gaze = dict(_nodes(stated)).get("lookAt")
    return VrmFace({node: name for name, node in named}, gaze)


def find_humanoid_bones(extensions: Mapping[str, Any]) -> dict[str, int]:
    """Return humanoid bone, such as "leftUpperArm", -> node of a VRM 0.x, VRM 1.0 or VRM animation file;
    empty for other files. Values with another form than the format's are skipped.
    """
    bones: dict[str, int] = {}
    for name in ("VRMC_vrm", "VRMC_vrm_animation", "VRM"):
        stated = _part(_part(extensions, name), "humanoid").get("humanBones")
        if isinstance(stated, list):  # VRM 0.x
            stated = {b["bone"]: b for b in stated if isinstance(b, dict) and isinstance(b.get("bone"), str)}
        if isinstance(stated, dict):
            bones.update(_nodes(stated))
    return bones


def _part(value: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    part = value.get(name)
    return part if isinstance(part, dict) else {}


def _nodes(value: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
    for name, entry in value.items():
        node = entry.get("node") if isinstance(entry, dict) else None
        if isinstance(node, int) and not isinstance(node, bool) and node >= 0:
            yield name, node
