"""What is noted on the timeline of a performance or a conversation: a range that is played again and again,
markers, layers that are locked, the cameras and whether words are shown. It changes no plan and no pose.
"""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from msgspec import Meta, Struct

from metagraph.graph.requests import Seconds

Lane = Literal["stage", "body", "arms", "head"]
Shot = Literal["over", "two", "close"]
SHOTS: tuple[Shot, ...] = get_args(Shot)
IMPROVISED = ""  # the key of what is noted where neither a performance nor a conversation is on stage
SAME_CUT = 0.05  # seconds: a cut so near another is the same, changed
SHORTEST_RANGE = 0.1  # seconds; shorter, a range is a slip of the hand
_Name = Annotated[str, Meta(max_length=200)]


class Marker(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A moment with a name. at: seconds."""

    id: str
    at: Seconds
    name: _Name = ""


class Cut(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """From `at` seconds on the camera of a conversation shows it so. shot: over another's shoulder at a
    side's face, close at it, or all who talk from three quarters ("two"). side: who is seen, from 0.
    """

    at: Seconds
    shot: Shot
    side: Annotated[int, Meta(ge=0, le=7)] = 0


class Timeline(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """range: first and last second of what is played again and again and can be written alone; None for all.
    markers: by time. locked: lanes whose requests are not to be moved or taken back. cuts: by time; none, and
    the camera is the hand's. captions: whether the words of who speaks are shown.
    """

    range: tuple[Seconds, Seconds] | None = None
    markers: tuple[Marker, ...] = ()
    locked: tuple[Lane, ...] = ()
    cuts: tuple[Cut, ...] = ()
    captions: bool = False

    def __post_init__(self) -> None:
        if self.range is not None and self.range[1] - self.range[0] < SHORTEST_RANGE / 2:
            raise ValueError(f"range: it ends after it begins, found {self.range[0]:g} to {self.range[1]:g}")


def with_cut(cuts: tuple[Cut, ...], cut: Cut) -> tuple[Cut, ...]:
    """Return cuts with one more, which replaces one at its time; one to the picture that is seen anyway is
    none.
    """
    others = sorted((c for c in cuts if abs(c.at - cut.at) > SAME_CUT), key=lambda c: c.at)
    out: list[Cut] = []
    for one in sorted([*others, cut], key=lambda c: c.at):
        if not out or (out[-1].shot, out[-1].side) != (one.shot, one.side):
            out.append(one)
    return tuple(out)
