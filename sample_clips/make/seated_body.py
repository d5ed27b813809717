"""The body layer of one who sits on a stool as high as most chairs, and the ways down and up. Fifteen clips;
the feet stay where they stand, the hips on the seat.
"""

from __future__ import annotations

from typing import Any

from sample_clips.make.body_clips import body_clip, off
from sample_clips.make.key_poses import Foot
from sample_clips.make.motion_tracks import Step
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stance_clips import SEAT

UPRIGHT, FORWARD = "sitting", "sitting_forward"
STILL = {"sway": 0.08}  # hips that are sat on do not wander


def on_seat(left: float = 0.0, up: float = 0.0, ahead: float = 0.0) -> tuple[float, float, float]:
    """Return a shift of the hips, metres from how they sit: to the character's left, up and forwards."""
    return (SEAT[0] + left, SEAT[1] + up, SEAT[2] + ahead)


def seated(stance: str, kind: str, action: str, *steps: Step, tags: str = "", **more: Any) -> Recipe:
    return body_clip(stance, kind, action, *steps, tags=tags, **STILL, **more)


def way(leaves: str, arrives: str, *steps: Step, **more: Any) -> Recipe:
    return Recipe(
        f"body_{leaves}__to__{arrives}", "body", "transition", leaves, arrives, steps, **STILL, **more
    )


def bounced(size: float) -> list[Step]:
    """Return a heel that goes up and down, and the thigh with it."""
    up, down = Foot(heel=11.0 * size), Foot()
    return [
        go(0.15, right_foot=up, **off(UPRIGHT, hips=(0, 0.6 * size, 0)), overshoot=0.0, flow=0.02),
        go(0.15, right_foot=down, **off(UPRIGHT), overshoot=0.0, flow=0.02),
    ]


def set_foot(side: str, leaves: float, arrives: float, heel: float, hold: float = 0.0) -> list[Step]:
    """Return steps that lift a foot, carry it and set it down, metres forwards; its heel stays raised by
    degrees.
    """
    far = arrives - leaves
    up = Foot(forwards=leaves + 0.06 * far, lift=0.024, heel=10.0)
    over = Foot(forwards=arrives - 0.04 * far, lift=0.022, heel=max(8.0, heel))
    return [
        go(0.13, **{f"{side}_foot": up}, overshoot=0.0),
        go(0.22, **{f"{side}_foot": over}, overshoot=0.0),
        go(0.15, hold=hold, **{f"{side}_foot": Foot(forwards=arrives, heel=heel)}, overshoot=0.0),
    ]


CLIPS = (
    Recipe("body_sitting__stance", "body", "stance", UPRIGHT, UPRIGHT, seconds=7.0, **STILL),
    seated(
        UPRIGHT,
        "gesture",
        "lean_in",
        go(0.34, **off(UPRIGHT, hips=(-2, 0, 0), spine=(-2, 0, 0), head=(2, 0, 0)), overshoot=0.0, flow=0.14),
        go(
            0.48,
            hold=0.60,
            **off(UPRIGHT, (0.003, 0, 0.010), (15, 1, 0), (8, 2, -1), (-15, -1, 1)),
            overshoot=0.03,
        ),
        home(0.90),
        tags="interest emphasis",
        likelihood=1.2,
    ),
    seated(
        UPRIGHT,
        "gesture",
        "sit_back",
        go(0.26, **off(UPRIGHT, hips=(2, 0, 0), spine=(2, 0, 0)), overshoot=0.0, flow=0.08),
        go(
            0.46,
            hold=0.55,
            **off(UPRIGHT, (0, 0, -0.008), (-7, 2, 0), (-5, 3, -1), (9, -3, 2)),
            overshoot=0.04,
        ),
        home(0.95),
        tags="doubt surprise",
        likelihood=0.8,
    ),
    seated(
        UPRIGHT,
        "gesture",
        "straighten",
        go(0.30, **off(UPRIGHT, hips=(-3, 0, 0), spine=(5, 0, 0), head=(2, 0, 0)), overshoot=0.0, flow=0.08),
        go(
            0.42,
            hold=0.40,
            **off(UPRIGHT, (0, 0.004, 0.004), (8, 0, 0), (-9, 0, 0), (1, 0, 0)),
            overshoot=0.04,
        ),
        home(0.90),
        tags="proud positive",
        likelihood=0.7,
    ),
    seated(
        UPRIGHT,
        "fidget",
        "shift_weight",
        go(
            0.40,
            **off(UPRIGHT, (0.020, 0.004, 0.006), (5, -1, -5), (2, 0, 7), (0, 1, -2)),
            overshoot=0.0,
            flow=0.12,
        ),
        go(
            0.46,
            **off(UPRIGHT, (-0.014, 0.003, 0.006), (4, 1, 4), (1, 0, -6), (0, -1, 2)),
            overshoot=0.0,
            flow=0.12,
        ),
        go(0.40, **off(UPRIGHT, (-0.002, -0.003, 0), (-2, 0, 1), (2, 0, -1)), overshoot=0.04),
        home(0.70),
    ),
    seated(
        UPRIGHT,
        "fidget",
        "tuck_feet",
        *set_foot("right", 0.0, -0.13, 26.0, hold=0.06),
        *set_foot("left", 0.0, -0.11, 24.0, hold=0.50),
        *set_foot("left", -0.11, 0.0, 0.0),
        *set_foot("right", -0.13, 0.0, 0.0),
        home(0.40),
        likelihood=0.6,
    ),
    seated(
        UPRIGHT,
        "fidget",
        "heel_bounce",
        *(step for size in (0.8, 1.0, 0.9, 1.0, 0.7) for step in bounced(size)),
        home(0.45),
        tags="impatient",
        likelihood=0.5,
    ),
    Recipe("body_sitting_forward__stance", "body", "stance", FORWARD, FORWARD, seconds=6.4, **STILL),
    seated(
        FORWARD,
        "gesture",
        "press_in",
        go(0.28, **off(FORWARD, hips=(-2, 0, 0), spine=(-2, 0, 0), head=(1, 0, 0)), overshoot=0.0, flow=0.08),
        go(
            0.30,
            hold=0.40,
            **off(FORWARD, (0.002, 0, 0.006), (5, 1, 0), (4, 2, 0), (-6, -1, 1)),
            peak=0.52,
            overshoot=0.06,
        ),
        home(0.80),
        tags="emphasis interest",
        likelihood=1.2,
    ),
    seated(
        FORWARD,
        "gesture",
        "ease_back",
        go(0.56, hold=0.50, **off(FORWARD, (0, 0, -0.006), (-10, -1, 0), (-7, -2, 1), (12, 2, -2))),
        home(0.95),
        tags="doubt",
    ),
    seated(
        FORWARD,
        "fidget",
        "settle",
        go(
            0.44,
            **off(FORWARD, (0.014, 0.002, 0.004), (-2, 1, -3), (-1, -1, 4), (2, -1, -1)),
            overshoot=0.0,
            flow=0.1,
        ),
        go(
            0.50, hold=0.1, **off(FORWARD, (-0.006, 0, 0), (1, -1, 1), (1, 1, -1), (-1, 0, 0)), overshoot=0.04
        ),
        home(0.75),
    ),
    way(  # down: the hips go back before they go down, the trunk forwards over the feet
        "weight_both",
        UPRIGHT,
        go(
            0.36,
            shift=(0.0, -0.045, -0.075),
            hips=(16, 0, 0),
            spine=(9, 0, 0),
            head=(2, 0, 0),
            overshoot=0.0,
            flow=0.34,
        ),
        go(
            0.56,
            shift=(0.0, -0.255, -0.295),
            hips=(35, 0, 0),
            spine=(14, 0, 0),
            head=(-16, 0, 0),
            overshoot=0.0,
            flow=0.36,
        ),
        go(
            0.44,
            shift=on_seat(up=-0.004),
            hips=(20, 0, 0),
            spine=(14, 0, 0),
            head=(-11, 0, 0),
            overshoot=0.0,
            flow=0.2,
        ),
        home(0.66, overshoot=0.03),
    ),
    way(  # up: the nose over the toes, then the legs push; nobody gets up without something to do
        UPRIGHT,
        "weight_both",
        go(
            0.44,
            shift=on_seat(ahead=0.015),
            hips=(26, 0, 0),
            spine=(15, 0, 0),
            head=(-12, 0, 0),
            overshoot=0.0,
            flow=0.26,
        ),
        go(
            0.46,
            shift=(0.0, -0.255, -0.245),
            hips=(36, 0, 0),
            spine=(13, 0, 0),
            head=(-18, 0, 0),
            overshoot=0.0,
            flow=0.4,
        ),
        go(
            0.50,
            shift=(0.0, -0.050, -0.062),
            hips=(12, 0, 0),
            spine=(6, 0, 0),
            head=(-5, 0, 0),
            overshoot=0.0,
            flow=0.36,
        ),
        home(0.66, overshoot=0.02),
        likelihood=0.0001,
    ),
    way(UPRIGHT, FORWARD, go(0.30, **off(UPRIGHT, spine=(-2, 0, 0)), overshoot=0.0, flow=0.2), home(0.62)),
    way(FORWARD, UPRIGHT, go(0.28, **off(FORWARD, spine=(2, 0, 0)), overshoot=0.0, flow=0.2), home(0.66)),
)
