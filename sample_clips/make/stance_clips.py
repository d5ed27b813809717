"""The stances of the three layers: the postures every other clip begins and ends in.

The base pose, against which the layers are composed, is the arms' `hands_at_sides`; it is `weight_both` and
`head_straight` too.
"""

from __future__ import annotations

from dataclasses import replace

from sample_clips.make.key_poses import Foot, Hand, Posture

SIDE = Hand(at=(0.236, 0.893, 0.012), turn=-16, bend=6, shape="hanging", elbow=(0.35, -0.2, -0.9))
BASE = Posture(left=SIDE, right=SIDE)

HIP = Hand(
    at=(0.2040, 1.0220, -0.0220),
    fingers=(-0.365, -0.68, 0.627),
    palm=(-0.75, -0.188, -0.635),
    shape="on_hip",
    elbow=(0.9, -0.05, -0.55),
)

# The forearms cross before the chest: the right one in front, its hand on the left upper arm; the left hand is
# tucked between the right upper arm and the ribs.
CROSS_OVER = Hand(
    at=(-0.088, 1.222, 0.228),
    fingers=(-0.764, 0.173, -0.622),
    palm=(0.626, 0.437, -0.646),
    shape="hold_arm",
    elbow=(0.363, -0.762, 0.536),
    reach=20,
)
CROSS_UNDER = Hand(
    at=(-0.053, 1.195, 0.137),
    fingers=(-0.820, 0.382, -0.426),
    palm=(0.307, -0.334, -0.891),
    shape="tucked",
    elbow=(0.370, -0.838, 0.400),
    reach=18,
)

CHIN = Hand(
    at=(0.030, 1.409, 0.143),
    fingers=(-0.581, 0.814, 0.025),
    palm=(-0.324, -0.202, -0.924),
    shape="chin",
    elbow=(0.186, -0.982, -0.002),
)
SUPPORT = Hand(
    at=(-0.017, 1.113, 0.140),
    fingers=(-1.0, -0.028, -0.005),
    palm=(-0.021, 0.849, -0.528),
    shape="cradle",
    elbow=(0.789, -0.614, 0.007),
)

CLASP_OVER = Hand(
    at=(0.082, 1.018, 0.225),
    fingers=(-0.657, -0.741, 0.138),
    palm=(-0.313, 0.101, -0.945),
    shape="clasp_over",
    elbow=(0.808, -0.303, -0.505),
)
CLASP_UNDER = Hand(
    at=(0.073, 1.009, 0.176),
    fingers=(-0.668, -0.660, 0.343),
    palm=(-0.498, 0.055, -0.866),
    shape="clasp_under",
    elbow=(0.808, -0.303, -0.505),
)

ARMS = {
    "hands_at_sides": BASE,
    "on_hips": replace(
        BASE,
        left=HIP,
        right=HIP.moved(up=-0.004, forwards=0.006),
        spine=(-2.0, 0.0, 0.0),
        head=(1.0, 0.0, 0.0),
    ),
    "arms_crossed": replace(
        BASE, left=CROSS_UNDER, right=CROSS_OVER, spine=(1.0, -1.0, 0.5), head=(-1.0, 1.0, 0.0)
    ),
    "hand_to_chin": replace(BASE, left=SUPPORT, right=CHIN, spine=(3.0, -2.0, 1.5), head=(3.0, 2.0, 2.0)),
    "hands_clasped": replace(
        BASE, left=CLASP_UNDER, right=CLASP_OVER, spine=(1.0, 0.0, 0.0), head=(-0.5, 0.0, 0.0)
    ),
}

BODY = {
    "weight_both": BASE,
    "weight_left": replace(
        BASE,
        shift=(0.060, -0.009, 0.004),
        hips=(0.0, 4.0, 4.5),
        spine=(0.5, -2.5, -6.5),
        head=(0.0, -1.0, 2.5),
        right_foot=Foot(out=0.02, forwards=0.012, turn=17),
        left_foot=Foot(),
    ),
    "weight_right": replace(
        BASE,
        shift=(-0.058, -0.010, 0.002),
        hips=(0.5, -5.0, -4.2),
        spine=(0.0, 3.0, 6.0),
        head=(0.0, 1.5, -2.0),
        left_foot=Foot(out=0.022, forwards=0.016, turn=19),
        right_foot=Foot(),
    ),
    "lean_forward": replace(
        BASE, shift=(0.0, -0.011, -0.042), hips=(7.0, 0.0, 0.0), spine=(9.0, 0.0, 0.0), head=(-11.0, 0.0, 0.0)
    ),
}

HEAD = {
    "head_straight": BASE,
    "head_tilt_left": replace(BASE, head=(1.0, 2.0, -10.0), spine=(0.0, 0.5, -1.5)),
    "head_tilt_right": replace(BASE, head=(1.5, -2.5, 9.5), spine=(0.0, -0.5, 1.5)),
}

STANCES = {"body": BODY, "arms": ARMS, "head": HEAD}

# Hands that stay where they are when the torso moves beneath them, while their arm does nothing else.
PINS: dict[str, tuple[tuple[str, str], ...]] = {
    "on_hips": (("Left", "Hips"), ("Right", "Hips")),
    "hand_to_chin": (("Right", "Head"),),
}
