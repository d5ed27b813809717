"""What a prop is: a thing of a file that stands beside the character, or that a joint carries."""

from __future__ import annotations

from math import cos, radians, sin
from typing import Annotated

from msgspec import Meta, Struct

LARGEST = 1000.0  # metres that a prop may be away, and times that it may be larger than in its file
_Three = Annotated[
    tuple[Annotated[float, Meta(ge=-LARGEST, le=LARGEST)], ...], Meta(min_length=3, max_length=3)
]


class Prop(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A prop. path: of an OBJ, STL, PLY, OFF, 3MF or GLB file, relative to the project file. at: metres,
    where its origin is: from the ground between the character's feet, or from the joint that carries it,
    along that joint's axes. turn: degrees about x, then y, then z. scale: 1 for as large as its file has it,
    in metres. joint: the name of the joint that carries it, "" if it stands. sha256: of the file's content
    when it was added, in hex, "" if unknown.
    """

    name: Annotated[str, Meta(max_length=200)]
    path: str
    at: _Three = (0.0, 0.0, 0.0)
    turn: _Three = (0.0, 0.0, 0.0)
    scale: Annotated[float, Meta(gt=0, le=LARGEST)] = 1.0
    joint: Annotated[str, Meta(max_length=200)] = ""
    sha256: Annotated[str, Meta(pattern="^([0-9a-f]{64})?$")] = ""

    @property
    def digest(self) -> str:
        """The digest of its file, as clips have it."""
        return self.sha256


def make_turn(prop: Prop) -> tuple[float, float, float, float]:
    """Return a prop's turn about x, then y, then z, as a quaternion xyzw."""
    (sx, cx), (sy, cy), (sz, cz) = ((sin(radians(a) / 2), cos(radians(a) / 2)) for a in prop.turn)
    return (
        sx * cy * cz - cx * sy * sz,
        cx * sy * cz + sx * cy * sz,
        cx * cy * sz - sx * sy * cz,
        cx * cy * cz + sx * sy * sz,
    )
