"""How alive a character is when nothing is asked of it: the amounts and rates of breathing, gaze, blinks and lip sync."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct


class Life(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """The life layers' settings. on: whether they play at all. stillness: 0 as set below .. 1 nothing moves of itself."""

    on: bool = True
    stillness: Annotated[float, Meta(ge=0, le=1)] = 0.0


class Face(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """Corrections of what was found in the face."""
