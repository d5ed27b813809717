"""Where something is: a name or a point. Each runtime has its own, since languages differ in how a thing may
be one or the other.
"""

from __future__ import annotations

from collections.abc import Mapping

from metagraph.graph.requests import Point

Spot = str | Point


def named(name: str) -> Spot:
    """Return what has a name."""
    return name


def placed(places: Mapping[str, Point], to: Spot) -> Spot:
    """Return the point that a name stands for among places, else what was given."""
    return places.get(to, to) if isinstance(to, str) else to


def is_same_spot(one: Spot, other: Spot) -> bool:
    """Return whether two names or two points are the same."""
    return one == other
