"""Where hands go when people talk: the arms' vocabulary. Each place serves either hand."""

from __future__ import annotations

from sample_clips.make import hands
from sample_clips.make.key_poses import Hand

LOW = (0.30, -0.9, -0.35)  # the elbow hangs
WIDE = (0.75, -0.6, -0.25)  # the elbow stands off

READY = Hand(at=(0.235, 1.135, 0.262), turn=6, bend=-8, shape="open", elbow=LOW)
BEAT = READY.moved(0.012, -0.085, 0.05, bend=20, turn=4)
BIG_READY = Hand(at=(0.265, 1.275, 0.235), turn=-4, bend=-16, shape="open", elbow=WIDE)
BIG_BEAT = Hand(at=(0.285, 1.085, 0.335), turn=18, bend=8, shape="flat", elbow=LOW)
OPEN_PALM = Hand(at=(0.315, 1.105, 0.275), turn=64, bend=-10, side=-6, shape="open", elbow=LOW)
SHRUGGED = Hand(
    at=(0.345, 1.185, 0.205), turn=84, bend=-26, side=-8, shape="spread", elbow=(0.35, -0.85, -0.45), shrug=18
)
POINT_YOU = Hand(at=(0.145, 1.225, 0.425), turn=-38, bend=-4, shape="point", elbow=(0.6, -0.75, 0.0))
POINT_COCKED = Hand(at=(0.205, 1.255, 0.235), turn=-20, bend=-18, shape="loose_point", elbow=LOW)
POINT_ME = Hand(
    at=(0.112, 1.215, 0.205),
    fingers=(-0.90, 0.18, -0.40),
    palm=(0.37, 0.05, -0.93),
    shape="loose_point",
    elbow=WIDE,
)
POINT_ASIDE = Hand(at=(0.475, 1.255, 0.185), turn=-22, bend=-5, shape="point", elbow=(0.3, -0.85, -0.4))
ON_HEART = Hand(
    at=(0.027, 1.282, 0.107),
    fingers=(-0.822, 0.544, -0.171),
    palm=(0.152, -0.079, -0.985),
    shape="flat",
    elbow=(0.930, -0.354, 0.102),
)
COUNTING = Hand(at=(0.225, 1.360, 0.195), turn=-58, bend=-6, shape="fist", elbow=(0.45, -0.85, -0.1))
WAVING = Hand(at=(0.325, 1.480, 0.150), turn=-74, bend=-10, shape="spread", elbow=(0.75, -0.65, -0.1))
STOPPING = Hand(at=(0.165, 1.265, 0.385), turn=-70, bend=-58, shape="flat", elbow=(0.7, -0.7, 0.0))
STOP_COCKED = Hand(at=(0.205, 1.235, 0.240), turn=-50, bend=-30, shape="open", elbow=LOW)
OFFERING = Hand(at=(0.205, 1.120, 0.365), turn=72, bend=-6, side=-4, shape="open", elbow=LOW)
SWEEP_IN = Hand(at=(0.035, 1.155, 0.300), turn=-72, bend=4, shape="flat", elbow=WIDE)
SWEEP_OUT = Hand(at=(0.365, 1.125, 0.265), turn=-66, bend=-14, side=-10, shape="flat", elbow=WIDE)
FLICK_READY = Hand(at=(0.130, 1.235, 0.245), turn=-46, bend=42, shape="relaxed", elbow=(0.6, -0.75, -0.2))
FLICKED = Hand(
    at=(0.415, 1.225, 0.285), turn=-52, bend=-34, side=-12, shape="spread", elbow=(0.7, -0.7, -0.2)
)
THUMB_UP = Hand(at=(0.155, 1.185, 0.335), turn=4, bend=2, side=6, shape="thumbs_up", elbow=LOW)
PRECISE = Hand(at=(0.190, 1.275, 0.290), turn=-46, bend=-24, side=6, shape="ring", elbow=(0.5, -0.85, -0.1))
WIDE_APART = Hand(at=(0.400, 1.165, 0.255), turn=4, bend=-14, shape="spread", elbow=WIDE)
CLOSE_TOGETHER = Hand(at=(0.105, 1.165, 0.290), turn=2, bend=4, shape="flat", elbow=WIDE)
WEIGHED = Hand(at=(0.330, 1.155, 0.250), turn=72, bend=-14, shape="cupped", elbow=LOW)
QUOTING = Hand(at=(0.265, 1.425, 0.150), turn=-70, bend=-8, shape="quotes", elbow=(0.7, -0.7, -0.1))
WATCHED = Hand(
    at=(0.030, 1.225, 0.285),
    turn=-64,
    bend=-20,
    side=3,
    shape="firm_fist",
    elbow=(0.85, -0.5, 0.05),
    shrug=2,
)


def lifted(shape: str, fingers: dict[int, float]) -> tuple[hands.Finger, ...]:
    """Return a hand shape with some fingers' knuckles raised by degrees (1 index ... 4 little)."""
    rows = list(hands.SHAPES[shape])
    for i, degrees in fingers.items():
        a, b, c, d = rows[i]
        rows[i] = (a - degrees, b - 0.25 * degrees, c, d)
    return tuple(rows)
