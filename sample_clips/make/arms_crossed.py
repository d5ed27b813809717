"""The arms layer with crossed arms: the right forearm lies in front, leaves first and comes back last."""

from __future__ import annotations

from sample_clips.make.key_poses import Hand
from sample_clips.make.phrases import arms_clip, finger_roll
from sample_clips.make.recipe import HOME, Recipe, go, home
from sample_clips.make.stage_places import OPEN_PALM, POINT_COCKED, POINT_YOU, READY, WIDE
from sample_clips.make.stance_clips import CROSS_OVER, CROSS_UNDER

S = "arms_crossed"
OUT = Hand(  # the right hand lifted off the left arm, its elbow still before the other hand
    at=(0.050, 1.245, 0.315), turn=8, bend=4, shape="relaxed", elbow=(0.75, -0.45, 0.35), reach=12
)
LEFT_OUT = Hand(at=(0.060, 1.135, 0.235), turn=2, bend=4, shape="relaxed", elbow=WIDE, reach=5)
ABOVE = CROSS_OVER.moved(0.040, 0.014, 0.046)  # about to come down on the left arm
BACK = go(0.40, rt=OUT, spine=(1, -1, 0.5), head=(-1, 1, 0), flow=0.18, overshoot=0.0)
LANDING = go(0.26, rt=ABOVE, flow=0.3, overshoot=0.0)

CLIPS = (
    Recipe("arms_crossed__stance", "arms", "stance", S, S, seconds=6.8),
    arms_clip(
        S,
        "gesture",
        "beat_small",
        "rt",
        go(
            0.40,
            rt=OUT.moved(0.04, 0.035, 0.0, turn=14, bend=-12, shape="open"),
            head=(-2, 1, 0),
            flow=0.08,
            overshoot=0.0,
        ),
        go(
            0.22,
            hold=0.30,
            rt=OUT.moved(0.055, -0.035, 0.05, turn=22, bend=10, shape="open"),
            head=(3, 0, 0),
            spine=(3, 0, 0),
            peak=0.55,
            overshoot=0.09,
        ),
        BACK,
        LANDING,
        home(0.42),
        tags="beat",
        likelihood=1.3,
    ),
    arms_clip(
        S,
        "gesture",
        "open_palm",
        "rt",
        go(0.36, rt=OUT.moved(0.02, -0.01, 0.0), flow=0.2, overshoot=0.0),
        go(
            0.36,
            hold=0.42,
            rt=OPEN_PALM.moved(-0.02, 0.055, 0.0),
            head=(1, 1, 6),
            spine=(1, -1, 0),
            overshoot=0.06,
        ),
        BACK,
        LANDING,
        home(0.42),
        tags="explain open",
    ),
    arms_clip(
        S,
        "gesture",
        "shrug",
        "bt",
        go(0.26, head=(2, 1, 0), spine=(2, -1, 0.5), overshoot=0.0, flow=0.06),
        go(
            0.34,
            hold=0.40,
            lf=CROSS_UNDER.moved(0, 0.016, 0.004, shrug=18),
            rt=CROSS_OVER.moved(0, 0.018, 0.004, shrug=18),
            head=(-3, 4, 11),
            spine=(-1, -1, 0.5),
            overshoot=0.05,
        ),
        home(0.7),
        tags="unsure",
        together=True,
    ),
    arms_clip(
        S,
        "gesture",
        "point_you",
        "rt",
        go(
            0.40,
            rt=POINT_COCKED.moved(-0.03, -0.01, 0.05, elbow=(0.75, -0.5, 0.25), reach=8),
            spine=(0, -2, 0.5),
            flow=0.14,
            overshoot=0.0,
        ),
        go(0.25, hold=0.40, rt=POINT_YOU, spine=(3, 1, 0), head=(3, 0, 1), peak=0.55, overshoot=0.06),
        BACK,
        LANDING,
        home(0.42),
        tags="you",
    ),
    arms_clip(
        S,
        "gesture",
        "open_palms",
        "bt",
        go(0.30, rt=OUT, flow=0.16, overshoot=0.0),
        go(0.36, rt=READY.moved(0.02, 0.02), lf=LEFT_OUT.moved(0.06, 0.0, 0.03), flow=0.22, overshoot=0.0),
        go(
            0.36,
            hold=0.40,
            lf=OPEN_PALM.moved(-0.02, 0.02),
            rt=OPEN_PALM.moved(-0.02, 0.035),
            head=(1, 2, 5),
            spine=(-1, 0, 0),
            overshoot=0.05,
        ),
        go(
            0.42,
            lf=LEFT_OUT,
            rt=OUT.moved(0.07, 0.02, 0.01),
            spine=(1, -1, 0.5),
            head=(-1, 1, 0),
            flow=0.2,
            overshoot=0.0,
        ),
        go(0.34, lf=HOME, rt=OUT.moved(0.01), flow=0.25, overshoot=0.0),
        go(0.30, rt=ABOVE, flow=0.3, overshoot=0.0),
        home(0.40),
        tags="explain open",
        later="Left",
    ),
    arms_clip(
        S,
        "gesture",
        "beat_torso",
        "bt",
        go(
            0.34,
            lf=CROSS_UNDER.moved(0, 0.008, 0),
            rt=CROSS_OVER.moved(0, 0.008, 0),
            spine=(-2, -1, 0.5),
            head=(-4, 1, 0),
            overshoot=0.0,
            flow=0.06,
        ),
        go(
            0.26,
            hold=0.36,
            lf=CROSS_UNDER.moved(0, -0.008, 0.003),
            rt=CROSS_OVER.moved(0, -0.008, 0.003),
            spine=(6, -1, 0.5),
            head=(4, 1, 0),
            peak=0.54,
            overshoot=0.08,
        ),
        home(0.66),
        tags="beat emphasis",
        together=True,
    ),
    arms_clip(
        S,
        "fidget",
        "tap_fingers",
        "rt",
        *finger_roll("rt", CROSS_OVER.moved(0.003, 0.0, 0.003), "hold_arm", size=0.4),
        home(0.4),
        tags="impatient",
        likelihood=0.6,
    ),
    arms_clip(
        S,
        "fidget",
        "rub_arm",
        "rt",
        go(
            0.34,
            rt=CROSS_OVER.moved(0.012, 0.055, 0.010, shrug=8),
            head=(6, 9, 4),
            spine=(3, -1, 0.5),
            overshoot=0.0,
            flow=0.04,
        ),
        go(0.36, rt=CROSS_OVER.moved(0.010, -0.030, 0.006, shrug=8), overshoot=0.0, flow=0.04),
        go(0.34, rt=CROSS_OVER.moved(0.012, 0.050, 0.010, shrug=8), head=(5, 8, 4), overshoot=0.0, flow=0.04),
        go(
            0.34, rt=CROSS_OVER.moved(0.010, -0.020, 0.006, shrug=4), head=(2, 4, 1), overshoot=0.0, flow=0.04
        ),
        home(0.5),
        tags="cold unsure",
        likelihood=0.5,
        drag=0.5,
    ),
    arms_clip(
        S,
        "fidget",
        "resettle",
        "bt",
        go(
            0.36,
            lf=CROSS_UNDER.moved(0.02, 0.018, 0.035, shrug=4),
            rt=CROSS_OVER.moved(0.025, 0.022, 0.05, shrug=5),
            spine=(-2, -1, 0.5),
            head=(0, 3, 0),
            flow=0.05,
        ),
        go(
            0.36,
            hold=0.16,
            lf=CROSS_UNDER.moved(0.002, -0.008, 0.004),
            rt=CROSS_OVER.moved(0.006, -0.008, 0.004),
            spine=(3, -1, 0.5),
            head=(1, 2, 0),
        ),
        home(0.6),
        likelihood=0.6,
        together=True,
    ),
)
