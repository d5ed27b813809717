"""What people put on a clip: a colour label, stars, a heart and a note to find it again, and the part of its
label that is known so far.
"""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from msgspec import Meta, Struct

from metagraph.graph.words import Kind, Layer, Limb

Color = Literal["", "red", "orange", "yellow", "green", "blue", "purple"]
COLORS: tuple[Color, ...] = get_args(Color)[1:]
STARS = 5


class HalfLabel(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """The known part of the label of a clip that has no action yet. "" is unknown.

    Stances are named, not identified, because they may be made later. limb and tags wait for the action.
    """

    kind: Kind | Literal[""] = ""
    layer: Layer | Literal[""] = ""
    stance: str = ""
    end_stance: str = ""
    limb: Limb | Literal[""] = ""
    tags: tuple[str, ...] = ()


class ClipMark(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """color: the label, "" for none. rating: stars, 0 to 5. favourite: a heart. note: to read. label: what is
    known of a clip without an action, None for nothing.
    """

    color: Color = ""
    rating: Annotated[int, Meta(ge=0, le=STARS)] = 0
    favourite: bool = False
    note: str = ""
    label: HalfLabel | None = None


BARE = ClipMark()
