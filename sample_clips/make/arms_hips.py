"""The arms layer with both hands on the hips: a hand leaves to say something while the other stays."""

from __future__ import annotations

from sample_clips.make.phrases import arms_clip, beat, finger_roll
from sample_clips.make.places import BEAT, FLICK_READY, FLICKED, LOW, OPEN_PALM, POINT_COCKED, POINT_YOU, READY
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stances import HIP

S = "on_hips"
OFF = HIP.moved(0.055, 0.005, 0.055, shape="relaxed", turn=0)  # just off the hip, on the way out and back
RIGHT_HIP = HIP.moved(up=-0.004, forwards=0.006)

CLIPS = (
    Recipe("on_hips__stance", "arms", "stance", S, S, seconds=6.4),
    arms_clip(
        S,
        "gesture",
        "beat_small",
        "rt",
        *beat("rt", READY.moved(0.02, 0.0, -0.01), BEAT.moved(0.02, 0.01)),
        go(0.42, rt=OFF, head=(1, 0, 0), spine=(-2, 0, 0), flow=0.2, overshoot=0.0),
        home(0.44),
        tags="beat",
        likelihood=1.3,
    ),
    arms_clip(
        S,
        "gesture",
        "open_palm",
        "lf",
        go(0.40, lf=READY.moved(0.0, -0.02, 0.0, turn=14), head=(1, 2, 0), flow=0.24, overshoot=0.0),
        go(0.34, hold=0.40, lf=OPEN_PALM.moved(0.01, 0.01), head=(3, 2, -5), spine=(-1.5, 1, 0), overshoot=0.06),
        go(0.46, lf=OFF, head=(1, 0, 0), spine=(-2, 0, 0), flow=0.2, overshoot=0.0),
        home(0.42),
        tags="explain open",
    ),
    arms_clip(
        S,
        "gesture",
        "shrug",
        "bt",
        go(0.24, head=(3, 0, 0), spine=(-1, 0, 0), overshoot=0.0, flow=0.05),
        go(
            0.36,
            hold=0.44,
            lf=HIP.moved(0.100, 0.060, 0.125, fingers=None, palm=None, turn=74, bend=-22, side=6, shape="spread", shrug=11),
            rt=HIP.moved(0.095, 0.070, 0.130, fingers=None, palm=None, turn=78, bend=-24, side=4, shape="spread", shrug=12),
            head=(-1, 2, 8),
            spine=(-3, 0, 1),
            overshoot=0.05,
        ),
        home(0.66),
        tags="unsure",
    ),
    arms_clip(
        S,
        "gesture",
        "point_you",
        "rt",
        go(0.40, rt=POINT_COCKED.moved(0.015, 0.0, -0.01), spine=(-3, -1, 0), flow=0.14, overshoot=0.0),
        go(0.25, hold=0.40, rt=POINT_YOU, spine=(1, 2, 0), head=(4, 0, 1), peak=0.55, overshoot=0.06),
        go(0.48, rt=OFF, head=(1, 0, 0), spine=(-2, 0, 0), flow=0.2, overshoot=0.0),
        home(0.42),
        tags="you",
    ),
    arms_clip(
        S,
        "gesture",
        "dismiss",
        "rt",
        go(0.40, rt=FLICK_READY.moved(0.02), head=(0, -4, 3), overshoot=0.0, flow=0.08),
        go(0.23, hold=0.24, rt=FLICKED.moved(0.01, -0.01), head=(3, 8, 5), spine=(-3, 2, 0), peak=0.5, overshoot=0.08),
        go(0.44, rt=OFF, head=(1, 0, 0), spine=(-2, 0, 0), flow=0.2, overshoot=0.0),
        home(0.42),
        tags="negative dismissive",
        drag=1.2,
    ),
    arms_clip(
        S,
        "gesture",
        "beat_torso",
        "bt",
        go(0.34, spine=(-4, 0, 0), head=(-1, 0, 0), overshoot=0.0, flow=0.06),
        go(0.26, hold=0.38, spine=(6, 0, 0), head=(4, 0, 0), peak=0.54, overshoot=0.08),
        home(0.66),
        tags="beat emphasis",
        likelihood=0.8,
    ),
    arms_clip(S, "fidget", "tap_fingers", "rt", *finger_roll("rt", RIGHT_HIP, "on_hip"), home(0.4), tags="impatient", likelihood=0.6),
    arms_clip(
        S,
        "fidget",
        "readjust",
        "bt",
        go(
            0.30,
            lf=HIP.moved(0.035, 0.03, 0.015, shape="relaxed"),
            rt=HIP.moved(0.03, 0.028, 0.02, shape="relaxed"),
            spine=(-3, 0, 0),
            flow=0.05,
        ),
        go(0.36, hold=0.22, lf=HIP.moved(0.022, 0.008, -0.004), rt=HIP.moved(0.022, 0.006, 0.0), spine=(-1, 0, 1), head=(2, -2, 0)),
        home(0.7),
        likelihood=0.6,
    ),
    arms_clip(
        S,
        "fidget",
        "drop_arm",
        "lf",
        go(0.34, lf=HIP.moved(0.07, -0.05, 0.04, shape="relaxed"), head=(2, 3, -2), flow=0.16, overshoot=0.0),
        go(
            0.44,
            hold=0.55,
            lf=HIP.moved(0.048, -0.135, 0.03, fingers=(-0.05, -0.99, 0.12), palm=(-0.95, 0.0, -0.3), shape="hanging", elbow=LOW),
            spine=(-1, 0, -1),
            overshoot=0.05,
        ),
        go(0.42, lf=HIP.moved(0.075, -0.03, 0.05, shape="relaxed"), spine=(-2, 0, 0), head=(1, 0, 0), flow=0.18, overshoot=0.0),
        home(0.44),
        likelihood=0.6,
    ),
)
