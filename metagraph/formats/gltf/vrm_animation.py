"""The face of a VRM animation (VRMC_vrm_animation 1.0): each expression has a node, and the x of the node's
translation is the expression's weight; another node's rotation is where the eyes look.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class VrmFace:
    """expressions: node -> the expression that it drives, "aa" or "Smirk". gaze: the node whose rotation is
    where the eyes look, None for none. Neither is a joint.
    """

    expressions: Mapping[int, str] = field(default_factory=dict)
    gaze: int | None = None

    @property
    def nodes(self) -> frozenset[int]:
        """Every node that is no joint."""
        return frozenset(self.expressions) | (frozenset() if self.gaze is None else {self.gaze})


def find_vrm_face(extensions: Mapping[str, Any]) -> VrmFace:
    """Return what a file's extensions say of the face; an empty value where it is no VRM animation. What is
    of another form than the format's is skipped.
    """
    stated = _part(extensions, "VRMC_vrm_animation")
    expressions = _part(stated, "expressions")
    named = [*_nodes(_part(expressions, "preset")), *_nodes(_part(expressions, "custom"))]
    gaze = dict(_nodes(stated)).get("lookAt")
    return VrmFace({node: name for name, node in named}, gaze)


def _part(value: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    part = value.get(name)
    return part if isinstance(part, dict) else {}


def _nodes(value: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
    for name, entry in value.items():
        node = entry.get("node") if isinstance(entry, dict) else None
        if isinstance(node, int) and not isinstance(node, bool) and node >= 0:
            yield name, node
