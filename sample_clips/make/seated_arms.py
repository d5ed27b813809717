"""The arms layer of one who sits: hands on the lap, or folded above it. Twenty clips; their legs are those
of one who sits, so that where the hands touch them can be found.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from sample_clips.make import arms_transitions
from sample_clips.make.arms_clasped import twiddled
from sample_clips.make.key_poses import Hand
from sample_clips.make.motion_tracks import Step
from sample_clips.make.phrases import arms_clip, beat, finger_roll
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stage_places import BEAT, OPEN_PALM, POINT_COCKED, POINT_YOU, READY, SHRUGGED
from sample_clips.make.stance_clips import LAP, SEATED_ARMS

S, F, OVER = "on_lap", "hands_folded", "sitting"
RIGHT = SEATED_ARMS[S].right
OFF = LAP.moved(0.010, 0.055, 0.020, shape="relaxed")  # just off the thigh
BACK = {"flow": 0.2, "overshoot": 0.0}


def lap(kind: str, action: str, limb: str, *steps: Step, tags: str = "", **more: Any) -> Recipe:
    return replace(arms_clip(S, kind, action, limb, *steps, tags=tags, **more), over=OVER)


def folded(kind: str, action: str, limb: str, *steps: Step, tags: str = "", **more: Any) -> Recipe:
    return replace(arms_clip(F, kind, action, limb, *steps, tags=tags, **more), over=OVER)


def both(up: float, forwards: float, out: float = 0.0, shape: str = "") -> dict[str, Hand]:
    """Return both folded hands moved; with a `shape`, they have let go."""
    posture, more = SEATED_ARMS[F], {"shape": shape} if shape else {}
    return {
        "lf": posture.left.moved(out, up, forwards, **more),
        "rt": posture.right.moved(out, up, forwards, **more),
    }


def stroked(hand: Hand, metres: float) -> Hand:
    """Return the hand slid along its thigh towards the knee."""
    return hand.moved(0.14 * metres, -0.085 * metres, metres)


CLIPS = (
    Recipe("on_lap__stance", "arms", "stance", S, S, seconds=6.6, over=OVER),
    lap(
        "gesture",
        "beat_small",
        "rt",
        *beat("rt", READY.moved(-0.02, 0.0, 0.02), BEAT.moved(-0.02, 0.02, 0.01)),
        go(0.40, rt=OFF, head=(0, 0, 0), spine=(0, 0, 0), **BACK),
        home(0.44),
        tags="beat",
        likelihood=1.4,
    ),
    lap(
        "gesture",
        "open_palm",
        "rt",
        go(0.38, rt=READY.moved(-0.01, -0.02, 0.02, turn=14), head=(1, -1, 0), flow=0.24, overshoot=0.0),
        go(
            0.34,
            hold=0.42,
            rt=OPEN_PALM.moved(-0.03, 0.0, 0.02),
            head=(3, -2, 5),
            spine=(1, -1, 0),
            overshoot=0.06,
        ),
        go(0.46, rt=OFF, head=(0, 0, 0), spine=(0, 0, 0), **BACK),
        home(0.44),
        tags="explain open",
        likelihood=1.2,
    ),
    lap(
        "gesture",
        "open_palms",
        "bt",
        go(
            0.38,
            lf=READY.moved(-0.05, -0.03, 0.02, turn=16),
            rt=READY.moved(-0.05, -0.02, 0.03, turn=18),
            head=(1, 0, 0),
            flow=0.22,
            overshoot=0.0,
        ),
        go(
            0.36,
            hold=0.42,
            lf=OPEN_PALM.moved(-0.03, 0.0, 0.01),
            rt=OPEN_PALM.moved(-0.02, 0.01, 0.01),
            head=(2, 1, 4),
            spine=(-1, 0, 0),
            overshoot=0.05,
        ),
        go(0.46, lf=OFF.moved(0.0, -0.006), rt=OFF, head=(0, 0, 0), spine=(0, 0, 0), **BACK),
        home(0.46),
        tags="explain open",
        likelihood=1.2,
    ),
    lap(
        "gesture",
        "point_you",
        "rt",
        go(0.40, rt=POINT_COCKED.moved(-0.02, -0.03, 0.02), spine=(-1, -1, 0), flow=0.14, overshoot=0.0),
        go(
            0.25,
            hold=0.40,
            rt=POINT_YOU.moved(0.0, -0.02),
            spine=(2, 1, 0),
            head=(3, 0, 1),
            peak=0.55,
            overshoot=0.06,
        ),
        go(0.48, rt=OFF, head=(0, 0, 0), spine=(0, 0, 0), **BACK),
        home(0.44),
        tags="you",
    ),
    lap(
        "gesture",
        "shrug",
        "bt",
        go(0.26, lf=OFF.moved(0.02), rt=OFF.moved(0.02), head=(2, 0, 0), flow=0.24, overshoot=0.0),
        go(
            0.36,
            hold=0.40,
            lf=SHRUGGED.moved(-0.08, -0.05, 0.05),
            rt=SHRUGGED.moved(-0.07, -0.04, 0.05),
            head=(-2, 2, -7),
            spine=(-2, 0, 0),
            overshoot=0.05,
        ),
        go(0.44, lf=OFF, rt=OFF, head=(0, 0, 0), spine=(0, 0, 0), **BACK),
        home(0.46),
        tags="unsure",
    ),
    lap(
        "fidget",
        "rub_thighs",
        "bt",
        go(
            0.40,
            lf=stroked(LAP, 0.050),
            rt=stroked(RIGHT, 0.050),
            spine=(2, 0, 0),
            head=(4, 0, 0),
            overshoot=0.0,
            flow=0.04,
        ),
        go(
            0.40,
            lf=stroked(LAP, -0.030),
            rt=stroked(RIGHT, -0.030),
            spine=(0, 0, 0),
            overshoot=0.0,
            flow=0.04,
        ),
        go(
            0.40,
            lf=stroked(LAP, 0.042),
            rt=stroked(RIGHT, 0.042),
            spine=(2, 0, 0),
            head=(3, 2, 0),
            overshoot=0.0,
            flow=0.04,
        ),
        home(0.60, overshoot=0.0),
        tags="nervous",
        together=True,
        drag=0.2,
        likelihood=0.7,
    ),
    lap(
        "fidget",
        "tap_fingers",
        "rt",
        *finger_roll("rt", RIGHT, "on_lap"),
        home(0.4),
        tags="impatient",
        likelihood=0.6,
    ),
    Recipe("hands_folded__stance", "arms", "stance", F, F, seconds=6.2, over=OVER),
    folded(
        "gesture",
        "beat_small",
        "bt",
        go(0.34, **both(0.050, 0.02), head=(-2, 0, 0), spine=(0, 0, 0), overshoot=0.0, flow=0.06),
        go(0.24, hold=0.30, **both(-0.008, 0.025), head=(3, 0, 0), spine=(2, 0, 0), peak=0.55, overshoot=0.1),
        home(0.6),
        tags="beat",
        together=True,
        pins=(("Right", "LeftHand"),),
        likelihood=1.4,
    ),
    folded(
        "gesture",
        "open_palms",
        "bt",
        go(0.22, **both(0.012, 0.006, 0.040, "open"), flow=0.3, overshoot=0.0),
        go(
            0.38,
            hold=0.44,
            lf=OPEN_PALM.moved(-0.06, -0.01, 0.01),
            rt=OPEN_PALM.moved(-0.05, 0.0, 0.01),
            head=(2, 1, 4),
            spine=(0, 0, 0),
            overshoot=0.05,
        ),
        go(
            0.46,
            **both(0.012, 0.012, 0.045, "relaxed"),
            spine=(1, 0, 0),
            head=(0, 0, 0),
            flow=0.2,
            overshoot=0.0,
        ),
        home(0.42),
        tags="explain open",
        likelihood=1.2,
    ),
    folded(
        "fidget",
        "twiddle_thumbs",
        "bt",
        *(go(0.16, **twiddled(n / 4, 0.025), head=(6, 0.5, 0), overshoot=0.0, flow=0.05) for n in range(9)),
        home(0.45),
        tags="bored",
        together=True,
        likelihood=0.6,
        drag=0.2,
    ),
    *(
        arms_transitions.way(leaves, arrives, timing, OVER)
        for leaves, arrives, timing in (
            ("hands_at_sides", S, (0.34, 0.36, 0.42, (3, 0, 0))),
            (S, "hands_at_sides", (0.28, 0.34, 0.50, (1, 0, 0))),
            (S, F, (0.26, 0.34, 0.40, (3, 0, 0))),
            (F, S, (0.24, 0.34, 0.42, (2, 0, 0))),
            (S, "arms_crossed", (0.28, 0.40, 0.36, (2, -1, 0))),
            ("arms_crossed", S, (0.30, 0.42, 0.42, (1, 0, 0))),
            (S, "hand_to_chin", (0.28, 0.36, 0.42, (3, 2, 1))),
            ("hand_to_chin", S, (0.26, 0.38, 0.44, (1, 0, 0))),
        )
    ),
)
