"""The times by which the meta actions of a plan have to be over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.playback.plan import MetaAction

LOOKED_AT = 6  # how many of those that follow a meta action are listed


@dataclass(frozen=True, slots=True)
class Bound:
    """A meta action and its bounds. limit: when the next more important one begins; wish: when the next
    equally important request begins; infinity if there is none. after: equally important requests that say
    how late they may be, the next one first.
    """

    meta: MetaAction
    limit: float
    wish: float
    after: Sequence[MetaAction] = ()


@dataclass(slots=True)
class _First:
    """The first of some meta actions of a rank, written or requested, and when it starts."""

    rank: float
    written: bool
    start: float


def bounds(metas: Sequence[MetaAction]) -> list[Bound]:
    """Return each meta action with its bounds."""
    out: list[Bound] = []
    first: list[_First] = []
    pressing: list[MetaAction] = []  # what says how late it may be, the last first
    for meta in reversed(metas):
        limit = float("inf")
        wish = float("inf")
        own: _First | None = None
        start = begins(meta)
        rank = meta.rank
        for one in first:
            if one.rank > rank:
                limit = min(limit, one.start)
            if one.rank >= rank and not one.written:
                wish = min(wish, one.start)
            if one.rank == rank and one.written == meta.written:
                own = one
        after: list[MetaAction] = []
        if len(pressing) > 0:
            after = [one for one in reversed(pressing[-LOOKED_AT:]) if one.rank >= rank]
        out.append(Bound(meta, limit, wish, after))
        if meta.request.late is not None:
            pressing.append(meta)
        if own is None:
            first.append(_First(rank, meta.written, start))
        else:
            own.start = start
    return list(reversed(out))


def begins(meta: MetaAction) -> float:
    """Return the earliest time at which a meta action may begin. One whose stroke is judged is placed where
    its stroke comes.
    """
    if meta.request.late is not None and meta.request.stroke is not None:
        return min(meta.start, meta.request.start)
    return meta.start
