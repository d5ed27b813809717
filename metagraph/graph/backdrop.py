"""What stands behind the character of a project: a studio, a room, one colour or a picture."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

_Color = Annotated[tuple[Annotated[int, Meta(ge=0, le=255)], ...], Meta(min_length=3, max_length=3)]
BackdropKind = Literal["", "studio", "room", "color", "picture"]


class Backdrop(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A backdrop. kind: "" for what the user of the window likes. color: of a plain one, red, green and blue,
    sRGB. path: of the picture, relative to the project file.
    """

    kind: BackdropKind = ""
    color: _Color = (138, 143, 152)
    path: str = ""
