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
    fingers=(-0.40, -0.50, 0.77),
    palm=(-0.75, -0.188, -0.635),
    shape="on_hip",
    elbow=(0.9, -0.05, -0.55),
)

# The forearms cross before the chest: the right one in front, its hand on the left upper arm; the left hand
# is tucked between the right upper arm and the ribs.
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
    at=(0.029, 1.395, 0.143),
    fingers=(-0.580, 0.815, 0.016),
    palm=(-0.321, -0.210, -0.924),
    shape="chin",
    elbow=(0.197, -0.980, 0.008),
)
SUPPORT = Hand(
    at=(-0.019, 1.099, 0.151),
    fingers=(-0.999, -0.023, -0.035),
    palm=(0.0, 0.837, -0.547),
    shape="cradle",
    elbow=(0.812, -0.576, 0.091),
)

CLASP_OVER = Hand(
    at=(0.082, 1.018, 0.235),
    fingers=(-0.657, -0.741, 0.138),
    palm=(-0.313, 0.101, -0.945),
    shape="clasp_over",
    elbow=(0.808, -0.303, -0.505),
)
CLASP_UNDER = Hand(
    at=(0.073, 1.009, 0.186),
    fingers=(-0.668, -0.660, 0.343),
    palm=(-0.498, 0.055, -0.866),
    shape="clasp_under",
    elbow=(0.808, -0.303, -0.505),
)

# Fingers over fingers, the thumbs free above them.
FOLD_UNDER = Hand(
    at=(0.102, 1.053, 0.233),
    fingers=(-0.862, -0.498, 0.097),
    palm=(-0.242, 0.236, -0.941),
    shape=((29, 7, 9, 10), (17, 19, 11, 0), (24, 26, 15, 0), (36, 38, 20, -1), (28, 28, 15, -2)),
    elbow=(0.856, -0.376, -0.355),
)
FOLD_OVER = Hand(
    at=(0.101, 1.062, 0.252),
    fingers=(-0.903, -0.430, 0.008),
    palm=(0.129, -0.290, -0.948),
    shape=((30, 6, 10, 10), (27, 29, 17, 0), (24, 26, 15, 0), (18, 20, 11, -1), (28, 28, 15, -2)),
    elbow=(0.910, -0.313, -0.272),
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

# On a stool: metres the hips are shifted (left, up, forwards), so that thighs lie on a seat 0.45 m high; the
# feet are where they stand.
SEAT = (0.0, -0.385, -0.390)
SEATED_BODY = {
    "sitting": replace(BASE, shift=SEAT, hips=(-5.0, 0.0, 0.0), spine=(5.0, 0.0, 0.0), head=(1.0, 0.0, 0.0)),
    "sitting_forward": replace(
        BASE,
        shift=(0.0, -0.383, -0.380),
        hips=(8.0, 0.0, 0.0),
        spine=(6.0, 0.0, 0.0),
        head=(-10.0, 0.0, 0.0),
    ),
}
LAP = Hand(  # on the thigh of one who sits
    at=(0.169, 0.9895, 0.127),
    fingers=(-0.399, 0.014, 0.917),
    palm=(0.047, -0.998, 0.036),
    shape="on_lap",
    elbow=(0.70, -0.40, -0.60),
)
SEATED_ARMS = {
    "on_lap": replace(BASE, left=LAP, right=LAP.moved(0.003, 0.002, 0.017)),
    "hands_folded": replace(  # clear of the thighs
        BASE, left=FOLD_UNDER.moved(up=0.025), right=FOLD_OVER.moved(up=0.025), spine=(1.0, 0.0, 0.0)
    ),
}

STANCES = {"body": BODY | SEATED_BODY, "arms": ARMS | SEATED_ARMS, "head": HEAD}

# Hands that stay where they are when the torso moves beneath them, while their arm does nothing else.
PINS: dict[str, tuple[tuple[str, str], ...]] = {
    "on_hips": (("Left", "Hips"), ("Right", "Hips")),
    "on_lap": (("Left", "Hips"), ("Right", "Hips")),
    "hand_to_chin": (("Right", "Head"),),
}
