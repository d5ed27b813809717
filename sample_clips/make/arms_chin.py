"""The arms layer with a hand to the chin: the right hand thinks, the left arm carries its elbow."""

from __future__ import annotations

from sample_clips.make.phrases import arms_clip
from sample_clips.make.places import LOW, OPEN_PALM, lifted
from sample_clips.make.poses import Hand
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stances import CHIN

S = "hand_to_chin"
OUT = Hand(at=(0.085, 1.335, 0.245), turn=-8, bend=2, shape="relaxed", elbow=(0.35, -0.9, 0.0))  # the hand come away from the chin
BACK = go(0.38, rt=OUT, spine=(3, -2, 1.5), head=(3, 2, 2), flow=0.17, overshoot=0.0)

CLIPS = (
    Recipe("hand_to_chin__stance", "arms", "stance", S, S, seconds=7.0),
    arms_clip(
        S,
        "gesture",
        "point_up",
        "rt",
        go(0.30, rt=OUT.moved(0.0, -0.01, 0.0, shape="loose_point", bend=10), head=(1, 1, 1), flow=0.1, overshoot=0.0),
        go(
            0.26,
            hold=0.42,
            rt=OUT.moved(0.035, 0.055, 0.015, shape="count_one", turn=-40, bend=-14),
            head=(-4, 0, -1),
            spine=(0, -2, 1),
            peak=0.5,
            overshoot=0.07,
        ),
        BACK,
        home(0.46),
        tags="idea positive",
    ),
    arms_clip(
        S,
        "gesture",
        "open_palm",
        "rt",
        go(0.34, rt=OUT, flow=0.18, overshoot=0.0),
        go(0.38, hold=0.40, rt=OPEN_PALM.moved(-0.03, 0.06, 0.01), head=(3, 0, 6), spine=(1, -1, 0), overshoot=0.05),
        go(0.40, rt=OUT.moved(0.03, -0.05, 0.02), spine=(3, -2, 1.5), head=(3, 2, 2), flow=0.24, overshoot=0.0),
        home(0.52),
        tags="explain open",
    ),
    arms_clip(
        S,
        "gesture",
        "beat_small",
        "rt",
        go(0.36, rt=OUT.moved(0.02, 0.02, 0.0, shape="pinch", turn=-8, bend=-8), head=(1, 1, 1), flow=0.08, overshoot=0.0),
        go(
            0.22,
            hold=0.12,
            rt=OUT.moved(0.035, -0.055, 0.035, shape="pinch", turn=-6, bend=12),
            head=(6, 1, 1),
            spine=(4, -2, 1),
            peak=0.55,
            overshoot=0.08,
        ),
        go(0.22, rt=OUT.moved(0.035, -0.005, 0.02, shape="pinch", turn=-6), head=(2, 1, 1), overshoot=0.0, flow=0.07),
        go(0.20, hold=0.24, rt=OUT.moved(0.045, -0.05, 0.04, shape="pinch", turn=-4, bend=10), head=(6, 0, 1), peak=0.55, overshoot=0.08),
        BACK,
        home(0.46),
        tags="beat detail",
        likelihood=1.3,
    ),
    arms_clip(
        S,
        "gesture",
        "so_so",
        "rt",
        go(
            0.42,
            rt=Hand(at=(0.115, 1.235, 0.330), turn=-72, bend=-4, shape="spread", elbow=LOW),
            head=(2, 0, 3),
            spine=(2, -1, 1),
            flow=0.06,
        ),
        go(0.20, rt=Hand(at=(0.120, 1.232, 0.332), turn=-38, bend=-2, shape="spread", elbow=LOW), head=(2, 0, 5), overshoot=0.0, flow=0.05),
        go(0.20, rt=Hand(at=(0.112, 1.232, 0.332), turn=-84, bend=-6, shape="spread", elbow=LOW), head=(2, 0, 0), overshoot=0.0, flow=0.05),
        go(
            0.22, hold=0.14, rt=Hand(at=(0.117, 1.230, 0.334), turn=-52, bend=-2, shape="spread", elbow=LOW), head=(2, 0, 4), overshoot=0.08
        ),
        BACK,
        home(0.46),
        tags="unsure",
        likelihood=0.8,
    ),
    arms_clip(
        S,
        "fidget",
        "stroke_chin",
        "rt",
        go(0.34, rt=CHIN.moved(0.006, -0.020, 0.010, shape="cupped"), head=(2, 3, 3), overshoot=0.0, flow=0.05),
        go(0.34, rt=CHIN.moved(0.002, 0.004, 0.004), overshoot=0.0, flow=0.05),
        go(0.34, rt=CHIN.moved(0.006, -0.022, 0.010, shape="cupped"), head=(3, 1, 3), overshoot=0.0, flow=0.05),
        go(0.34, hold=0.2, rt=CHIN.moved(0.002, 0.002, 0.002), overshoot=0.0),
        home(0.5),
        tags="thinking",
        drag=0.4,
    ),
    arms_clip(
        S,
        "fidget",
        "tap_cheek",
        "rt",
        *(
            step
            for turn in (2.5, 3.5, 3.0)
            for step in (
                go(0.16, rt=CHIN.moved(shape=lifted("chin", {1: 26})), head=(3, turn, 2), overshoot=0.0, flow=0.03),
                go(0.14, hold=0.12, rt=CHIN.moved(shape=lifted("chin", {1: 4})), overshoot=0.0),
            )
        ),
        home(0.44),
        tags="thinking",
        likelihood=0.7,
    ),
)
