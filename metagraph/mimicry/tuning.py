"""The numbers keypoints are judged by. They are ours, chosen on the sample's stances under jitter, lost
points and turning.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from metagraph.graph.words import Layer


@dataclass(frozen=True, slots=True)
class Judging:
    """How one layer is judged. smooth: time constant, seconds, of the running mean that is judged. still:
    speed, torso lengths a second, above which somebody moves: gesturing is no stance. near: distance below
    which somebody may come into a stance. way: share of the way there from the one before that they must have
    gone. dwell: for how many seconds. used: how much is got used to of how a person differs from the
    character in the stance they are in, usual differences. mistaken: by how many tens of degrees the heading
    in a picture may be, for stances to be distinguished all the same. Distances are those of `measures`: 1 is
    as far off as is usual.
    """

    smooth: float
    still: float
    near: float
    way: float
    dwell: float
    used: float
    mistaken: int


JUDGING: Mapping[Layer, Judging] = {
    "body": Judging(smooth=0.3, still=0.3, near=1.3, way=0.65, dwell=0.3, used=1.0, mistaken=3),
    "arms": Judging(smooth=0.2, still=0.6, near=0.9, way=0.65, dwell=0.5, used=0.6, mistaken=1),
    "head": Judging(smooth=0.45, still=0.35, near=1.3, way=0.65, dwell=0.3, used=0.5, mistaken=1),
}


@dataclass(frozen=True)
class Tuning:
    """How keypoints are judged; times are seconds. layers: each of them.

    quick: time constant of the running mean that, beside the smooth one, tells the speed. seen: confidence
    below which a point counts for nothing; sure: from which on for all. turning: time constant of the heading
    of somebody in a picture, looked at every `turned` seconds. using: time constant with which is got used to
    how a person differs from the character; using_first: the same at first, it grows with the time that
    somebody has been seen. way_first: share of the way from the start stance to another that somebody must
    have gone who is seen for the first time. left: distance beyond which somebody has left a stance, whatever
    they are in now. again: after which a stance the character is not in is asked for again; each time twice
    as long. gap: after which all begins again. lost: after which somebody who is not seen is gone.
    """

    layers: Mapping[Layer, Judging] = field(default_factory=lambda: JUDGING)
    quick: float = 0.08
    seen: float = 0.2
    sure: float = 0.6
    turning: float = 1.0
    turned: float = 0.1
    using: float = 6.0
    using_first: float = 1.0
    way_first: float = 0.85
    left: float = 2.0
    again: float = 2.0
    gap: float = 1.0
    lost: float = 5.0
