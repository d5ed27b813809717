"""The arms layer with a hand to the chin: the right hand thinks, the left arm carries its elbow."""

from __future__ import annotations

from typing import Any

import numpy as np

from sample_clips.make.key_poses import Hand, elbow_of
from sample_clips.make.mannequin_rig import REST, at
from sample_clips.make.phrases import arms_clip
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stage_places import lifted
from sample_clips.make.stance_clips import CHIN

S = "hand_to_chin"
SHOULDER = REST[at("LeftUpperArm")]
ELBOW, FOREARM = elbow_of(CHIN)


def over_elbow(out: float, up: float, forwards: float, **held: Any) -> Hand:
    """Return the hand in a direction from the elbow, which stays in the hand that carries it."""
    along = np.array([out, up, forwards])
    wrist = ELBOW + along / np.linalg.norm(along) * FOREARM
    pole = ELBOW - (wrist + SHOULDER) / 2
    return Hand(at=tuple(wrist.tolist()), elbow=tuple(pole.tolist()), **held)


OUT = over_elbow(-0.10, 0.85, 0.52, turn=-8, bend=2, shape="relaxed")  # the hand come away from the chin
STROKED = over_elbow(
    *(np.array(CHIN.at) - ELBOW + (0.012, 0.0, 0.030)).tolist(),
    fingers=CHIN.fingers,
    palm=CHIN.palm,
    shape="cupped",
)
BACK = go(0.38, rt=OUT, spine=(3, -2, 1.5), head=(3, 2, 2), flow=0.32, overshoot=0.0)

CLIPS = (
    Recipe("hand_to_chin__stance", "arms", "stance", S, S, seconds=7.0),
    arms_clip(
        S,
        "gesture",
        "point_up",
        "rt",
        go(
            0.30,
            rt=over_elbow(-0.05, 0.80, 0.60, turn=-12, bend=12, shape="loose_point"),
            head=(1, 1, 1),
            flow=0.1,
            overshoot=0.0,
        ),
        go(
            0.26,
            hold=0.42,
            rt=over_elbow(0.06, 0.95, 0.30, turn=-46, bend=-12, shape="count_one"),
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
        go(
            0.38,
            hold=0.40,
            rt=over_elbow(0.44, 0.66, 0.62, turn=60, bend=-24, side=-6, shape="open"),
            head=(3, 0, 6),
            spine=(1, -1, 0),
            overshoot=0.05,
        ),
        go(
            0.40,
            rt=over_elbow(0.05, 0.72, 0.66, turn=10, bend=2, shape="relaxed"),
            spine=(3, -2, 1.5),
            head=(3, 2, 2),
            flow=0.24,
            overshoot=0.0,
        ),
        home(0.52),
        tags="explain open",
    ),
    arms_clip(
        S,
        "gesture",
        "beat_small",
        "rt",
        go(
            0.36,
            rt=over_elbow(-0.02, 0.80, 0.60, turn=-16, bend=-8, shape="pinch"),
            head=(1, 1, 1),
            flow=0.08,
            overshoot=0.0,
        ),
        go(
            0.22,
            hold=0.12,
            rt=over_elbow(0.08, 0.70, 0.70, turn=-14, bend=12, shape="pinch"),
            head=(6, 1, 1),
            spine=(4, -2, 1),
            peak=0.55,
            overshoot=0.08,
        ),
        go(
            0.22,
            rt=over_elbow(0.06, 0.78, 0.62, turn=-14, bend=0, shape="pinch"),
            head=(2, 1, 1),
            overshoot=0.0,
            flow=0.07,
        ),
        go(
            0.20,
            hold=0.24,
            rt=over_elbow(0.11, 0.70, 0.69, turn=-12, bend=10, shape="pinch"),
            head=(6, 0, 1),
            peak=0.55,
            overshoot=0.08,
        ),
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
            0.40,
            rt=over_elbow(0.10, 0.62, 0.78, turn=-62, bend=16, shape="spread"),
            head=(2, -1, 2),
            spine=(2, -1, 1),
            flow=0.06,
        ),
        *(
            go(
                0.20,
                rt=over_elbow(out, 0.61, 0.79, turn=turn, bend=16, shape="spread"),
                head=(2, -1, lean),
                overshoot=0.0,
                flow=0.04,
            )
            for out, turn, lean in ((0.15, -16, 7), (0.07, -86, -4), (0.15, -18, 7))
        ),
        go(
            0.22,
            hold=0.20,
            rt=over_elbow(0.11, 0.61, 0.79, turn=-56, bend=16, shape="spread"),
            head=(2, -1, 4),
            overshoot=0.03,
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
        go(0.34, rt=STROKED, head=(2, 3, 3), overshoot=0.0, flow=0.05),
        go(0.34, rt=CHIN, overshoot=0.0, flow=0.05),
        go(0.34, rt=STROKED, head=(3, 1, 3), overshoot=0.0, flow=0.05),
        go(0.34, hold=0.2, rt=CHIN, overshoot=0.0),
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
                go(
                    0.16,
                    rt=CHIN.moved(shape=lifted("chin", {1: 26})),
                    head=(3, turn, 2),
                    overshoot=0.0,
                    flow=0.03,
                ),
                go(0.14, hold=0.12, rt=CHIN.moved(shape=lifted("chin", {1: 4})), overshoot=0.0),
            )
        ),
        home(0.44),
        tags="thinking",
        likelihood=0.7,
    ),
)
