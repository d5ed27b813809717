"""By when each meta action of a plan has to be over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.playback.plan import MetaAction


@dataclass(frozen=True, slots=True)
class Bound:
    """A meta action with when the next more important one begins (limit), and the next as important that was
    asked for (wish); infinity where there is none.
    """

    meta: MetaAction
    limit: float
    wish: float


@dataclass(slots=True)
class _First:
    """The first of some meta actions of a rank, written or asked for, and when it starts."""

    rank: float
    written: bool
    start: float


def bounds(metas: Sequence[MetaAction]) -> list[Bound]:
    """Return each meta action with what bounds it."""
    out: list[Bound] = []
    first: list[_First] = []
    for meta in reversed(metas):
        limit = float("inf")
        wish = float("inf")
        own: _First | None = None
        for one in first:
            if one.rank > meta.rank:
                limit = min(limit, one.start)
            if one.rank >= meta.rank and not one.written:
                wish = min(wish, one.start)
            if one.rank == meta.rank and one.written == meta.written:
                own = one
        out.append(Bound(meta, limit, wish))
        if own is None:
            first.append(_First(meta.rank, meta.written, meta.start))
        else:
            own.start = meta.start
    return list(reversed(out))
