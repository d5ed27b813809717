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

# Right forearm above and in front, its hand on the left upper arm; left forearm beneath, its hand under the
# right arm.
CROSS_OVER = Hand(
    at=(-0.071, 1.227, 0.167),
    fingers=(-0.893, 0.163, -0.421),
    palm=(-0.365, -0.135, -0.921),
    shape="hold_arm",
    elbow=(0.230, -0.928, 0.294),
    reach=14,
)
CROSS_UNDER = Hand(
    at=(0.006, 1.103, 0.125),
    fingers=(-0.896, 0.163, -0.413),
    palm=(-0.131, 0.066, -0.989),
    shape="tucked",
    elbow=(-0.028, -0.935, 0.355),
    reach=12,
)

CHIN = Hand(
    at=(0.034, 1.398, 0.134),
    fingers=(-0.595, 0.801, -0.072),
    palm=(-0.326, -0.281, -0.903),
    shape="chin",
    elbow=(0.3, -0.95, 0.1),
)
SUPPORT = Hand(
    at=(-0.026, 1.124, 0.165),
    fingers=(-0.951, 0.111, 0.288),
    palm=(-0.168, 0.377, -0.911),
    shape="cradle",
    elbow=(0.75, -0.65, -0.1),
)

CLASP_OVER = Hand(
    at=(0.080, 1.017, 0.223),
    fingers=(-0.663, -0.739, 0.124),
    palm=(-0.371, 0.034, -0.928),
    shape="clasp_over",
    elbow=(0.8, -0.3, -0.5),
)
CLASP_UNDER = Hand(
    at=(0.071, 1.010, 0.178),
    fingers=(-0.671, -0.644, 0.368),
    palm=(-0.415, 0.146, -0.898),
    shape="clasp_under",
    elbow=(0.8, -0.3, -0.5),
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
