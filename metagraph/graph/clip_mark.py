"""What people put on a clip to find it again: a colour label, stars, a heart, a note."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from msgspec import Meta, Struct

Color = Literal["", "red", "orange", "yellow", "green", "blue", "purple"]
COLORS: tuple[Color, ...] = get_args(Color)[1:]
STARS = 5


class ClipMark(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """color: the label, "" for none. rating: stars, 0 to 5. favourite: a heart. note: to read."""

    color: Color = ""
    rating: Annotated[int, Meta(ge=0, le=STARS)] = 0
    favourite: bool = False
    note: str = ""


BARE = ClipMark()
