"""What stands behind the character of a project: a studio, a room, one colour or a picture."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

BackdropKind = Literal["", "studio", "room", "color", "picture"]


class Backdrop(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A backdrop. kind: "" for what the user of the window likes. color: "#rrggbb", for a plain one. path: of
    the picture, relative to the project file.
    """

    kind: BackdropKind = ""
    color: Annotated[str, Meta(pattern="^#[0-9a-fA-F]{6}$")] = "#8a8f98"
    path: str = ""
