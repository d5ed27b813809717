"""The body layer: where the weight is, and what hips and torso say. Thirty-six clips; the feet stay planted
unless they step.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from sample_clips.make.key_poses import Foot, Posture
from sample_clips.make.mannequin_rig import Angles
from sample_clips.make.motion_tracks import Step
from sample_clips.make.recipe import HOME, Recipe, go, home
from sample_clips.make.stance_clips import BODY, STANCES

NONE: Angles = (0.0, 0.0, 0.0)
HEEL_TO_BALL = 0.150  # metres


def off(
    stance: str,
    shift: Angles = NONE,
    hips: Angles = NONE,
    spine: Angles = NONE,
    head: Angles = NONE,
    **feet: Any,
) -> dict[str, Any]:
    """Return the fields of a posture that differs from the stance's by metres (left, up, forwards) and
    degrees.
    """
    posture = STANCES["body"][stance]
    added = {"shift": shift, "hips": hips, "spine": spine, "head": head}
    return {k: tuple(np.array(getattr(posture, k)) + v) for k, v in added.items()} | feet


def body_clip(stance: str, kind: str, action: str, *steps: Step, tags: str = "", **more: Any) -> Recipe:
    """Return a recipe named `body_stance__action_01`."""
    return Recipe(
        f"body_{stance}__{action}_01",
        "body",
        kind,
        stance,
        stance,
        steps,
        "both",
        tuple(tags.split()),
        **more,
    )


def lifted(foot: Foot, other: Foot, lift: float = 0.022, heel: float = 13.0) -> Foot:
    """Return a foot in the air, half way between two places."""
    mean = {f: (getattr(foot, f) + getattr(other, f)) / 2 for f in ("out", "forwards", "turn")}
    return Foot(**mean, lift=lift, heel=heel)


def on_its_heel(foot: Foot, degrees: float) -> Foot:
    """Return a foot whose toes are raised while its heel stays."""
    return replace(foot, heel=-degrees, lift=HEEL_TO_BALL * float(np.sin(np.radians(degrees))))


LEFT, RIGHT = BODY["weight_left"], BODY["weight_right"]
PLAIN = Foot()

BOTH = (
    Recipe("body_weight_both__stance", "body", "stance", "weight_both", "weight_both", seconds=7.2),
    body_clip(
        "weight_both",
        "gesture",
        "lean_in",
        go(
            0.42,
            **off("weight_both", (0, 0.001, 0.006), (-1, 0, 0), (-2.5, 0, 0), (1.5, 0, 0)),
            overshoot=0.0,
            flow=0.14,
        ),
        go(
            0.48,
            hold=0.60,
            **off("weight_both", (0.004, -0.014, -0.030), (9, 1, 0), (14, 1, -1), (-13, 0, 1)),
        ),
        home(0.85),
        tags="interest emphasis",
        likelihood=1.2,
    ),
    body_clip(
        "weight_both",
        "gesture",
        "bow",
        go(
            0.30,
            **off("weight_both", (0, 0.002, 0.004), (-1, 0, 0), (-1.5, 0, 0), (-1, 0, 0)),
            overshoot=0.0,
            flow=0.06,
        ),
        go(
            0.52,
            hold=0.32,
            **off("weight_both", (0, -0.008, -0.045), (9, 0, 0), (13, 0, 0), (5, 0, 0)),
            overshoot=0.02,
        ),
        home(0.95),
        tags="greeting polite",
        likelihood=0.4,
    ),
    body_clip(
        "weight_both",
        "gesture",
        "recoil",
        go(
            0.24,
            hold=0.34,
            **off("weight_both", (0.006, -0.010, -0.026), (-3, 3, 0), (-8, 4, -2), (6, -5, 2)),
            peak=0.38,
            overshoot=0.07,
        ),
        home(1.0, peak=0.38),
        tags="surprise negative",
        likelihood=0.5,
    ),
    body_clip(
        "weight_both",
        "gesture",
        "straighten",
        go(
            0.30,
            **off("weight_both", (0, -0.024, -0.006), (2, 0, 0), (8, 0, 0), (4, 0, 0)),
            overshoot=0.0,
            flow=0.08,
        ),
        go(
            0.44,
            hold=0.42,
            **off(
                "weight_both",
                (0, 0.0240, 0.020),
                (-2.5, 0, 0),
                (-8, 0, 0),
                (2, 0, 0),
                left_foot=replace(PLAIN, heel=10.0),
                right_foot=replace(PLAIN, heel=9.2),
            ),
            overshoot=0.04,
        ),
        home(0.85),
        tags="proud positive",
        likelihood=0.7,
    ),
    body_clip(
        "weight_both",
        "fidget",
        "shift_feet",
        go(
            0.36,
            **off("weight_both", (0.045, -0.004, 0), (0, 2, 2.5), (0, -1, -4), (0, -1, 1.5)),
            overshoot=0.0,
            flow=0.06,
        ),
        go(0.20, right_foot=lifted(PLAIN, Foot(out=0.026, forwards=0.02, turn=12)), overshoot=0.0, flow=0.03),
        go(0.20, right_foot=Foot(out=0.020, forwards=0.012, turn=13), overshoot=0.0),
        go(
            0.46,
            **off("weight_both", (-0.040, -0.004, 0.004), (0, -2, -2.5), (0, 1, 4), (0, 1, -1.5)),
            overshoot=0.0,
            flow=0.06,
        ),
        go(0.20, left_foot=lifted(PLAIN, PLAIN, 0.024), overshoot=0.0, flow=0.03),
        go(0.20, left_foot=PLAIN, overshoot=0.0),
        go(
            0.40,
            **off("weight_both", (0.038, -0.004, 0.002), (0, 2, 2), (0, -1, -3), (0, -1, 1)),
            overshoot=0.0,
            flow=0.06,
        ),
        go(
            0.18,
            right_foot=lifted(PLAIN, Foot(out=0.020, forwards=0.012, turn=13), 0.016, 9),
            overshoot=0.0,
            flow=0.03,
        ),
        go(0.20, right_foot=HOME, overshoot=0.0, flow=0.06),
        home(0.5),
        likelihood=0.7,
    ),
    body_clip(
        "weight_both",
        "fidget",
        "knee_bounce",
        go(
            0.30,
            **off("weight_both", (0.022, -0.003, 0), (0, 1, 1.5), (0, 0, -2), (0, 0, 0.8)),
            overshoot=0.0,
            flow=0.08,
        ),
        *(
            step
            for size in (1.0, 0.85, 1.0, 0.6)
            for step in (
                go(
                    0.17,
                    **off(
                        "weight_both",
                        (0.023, -0.0045 * size, 0.001),
                        (0, 2 * size, 1.5 - size),
                        (0, -1.2 * size, -2),
                        (0, 0, 0.8),
                    ),
                    right_foot=replace(PLAIN, heel=9.0 * size),
                    overshoot=0.0,
                    flow=0.02,
                ),
                go(
                    0.17,
                    **off("weight_both", (0.022, -0.003, 0), (0, 1, 1.5), (0, 0, -2), (0, 0, 0.8)),
                    right_foot=PLAIN,
                    overshoot=0.0,
                    flow=0.02,
                ),
            )
        ),
        home(0.55),
        tags="impatient",
        likelihood=0.5,
    ),
    body_clip(
        "weight_both",
        "fidget",
        "roll_shoulders",
        go(
            0.42,
            **off("weight_both", (0, -0.003, -0.006), (1, 0, 0), (7, -3, 2), (1, 2, 2)),
            overshoot=0.0,
            flow=0.14,
        ),
        go(
            0.44,
            **off("weight_both", (0.003, 0, 0.0), (0, 1, 0), (1, 4, 5), (-1, -3, -3)),
            overshoot=0.0,
            flow=0.16,
        ),
        go(
            0.46,
            **off("weight_both", (0, 0.002, 0.010), (-2, 0, 0), (-7, 1, -3), (4, 0, 2)),
            overshoot=0.0,
            flow=0.12,
        ),
        home(0.75, overshoot=0.05),
        tags="stretch",
        likelihood=0.5,
    ),
    body_clip(
        "weight_both",
        "fidget",
        "sway",
        go(
            0.62,
            **off("weight_both", (0.020, -0.002, 0.006), (0.5, 1, 1.2), (0, -0.5, -2.2), (0, -1, 0.6)),
            overshoot=0.0,
            flow=0.08,
        ),
        go(
            0.84,
            **off("weight_both", (-0.024, -0.003, 0.010), (1, -1.5, -1.5), (0.5, 1, 2.6), (0, 1, -0.8)),
            overshoot=0.0,
            flow=0.10,
        ),
        go(
            0.62,
            **off("weight_both", (-0.004, -0.002, -0.010), (-0.5, -0.5, 0), (1, 0, 0.5), (0, 0, 0)),
            overshoot=0.0,
            flow=0.10,
        ),
        home(0.7),
    ),
    body_clip(
        "weight_both",
        "fidget",
        "look_down",
        go(
            0.60,
            hold=0.55,
            **off("weight_both", (-0.010, -0.005, -0.012), (1, -2, -0.8), (8, -2, 2), (13, -4, -2)),
            overshoot=0.02,
        ),
        go(
            0.40,
            **off("weight_both", (-0.006, -0.004, -0.008), (0.5, -1, -0.4), (4, -1, 1), (2, 3, 0)),
            overshoot=0.0,
            flow=0.14,
        ),
        home(0.8),
        tags="thinking sad",
        likelihood=0.5,
    ),
)

LEANING = (
    Recipe("body_weight_left__stance", "body", "stance", "weight_left", "weight_left", seconds=6.6),
    body_clip(
        "weight_left",
        "gesture",
        "dip",
        go(
            0.28,
            **off("weight_left", (0.002, 0.003, 0), (-0.5, 0, -0.5), (-2, 0, 0), (-1, 0, 0)),
            overshoot=0.0,
            flow=0.06,
        ),
        go(
            0.28,
            hold=0.36,
            **off("weight_left", (0.002, -0.036, 0.006), (5, -2, 0.5), (10, -2, 0), (-5, 2, 0)),
            peak=0.52,
            overshoot=0.07,
        ),
        home(0.8),
        tags="emphasis",
        likelihood=1.2,
    ),
    body_clip(
        "weight_left",
        "gesture",
        "turn_away",
        go(
            0.52, hold=0.6, **off("weight_left", (0.008, -0.004, -0.008), (0, 11, 0), (-3, 20, -2), (1, 9, 1))
        ),
        home(1.05),
        tags="other aside",
    ),
    body_clip(
        "weight_left",
        "fidget",
        "settle",
        go(
            0.42,
            **off("weight_left", (-0.022, 0.004, 0.002), (0, -1.5, -2.2), (0, 1, 3), (0, 0.5, -1)),
            overshoot=0.0,
            flow=0.08,
        ),
        go(
            0.50,
            hold=0.1,
            **off("weight_left", (0.009, -0.006, 0.0), (0, 1, 0.8), (1, -0.5, -1.2), (1, 0, 0.5)),
            overshoot=0.05,
        ),
        home(0.75),
    ),
    body_clip(
        "weight_left",
        "fidget",
        "heel_lift",
        go(
            0.34,
            **off("weight_left", (0.008, -0.003, 0), (0, 2, 0), (0, -1, -0.5), (0, 0, 0)),
            right_foot=replace(LEFT.right_foot, heel=16),
            overshoot=0.0,
            flow=0.02,
        ),
        go(
            0.36,
            right_foot=replace(LEFT.right_foot, heel=20, turn=25),
            **off("weight_left", (0.009, -0.003, 0), (0, 0, 0), (0, 0, -0.5), NONE),
            overshoot=0.0,
            flow=0.02,
        ),
        go(
            0.34,
            right_foot=replace(LEFT.right_foot, heel=14, turn=15),
            **off("weight_left", (0.008, -0.003, 0), (0, 2, 0), (0, -1, -0.5), NONE),
            overshoot=0.0,
            flow=0.04,
        ),
        home(0.6),
        likelihood=0.6,
    ),
    Recipe("body_weight_right__stance", "body", "stance", "weight_right", "weight_right", seconds=7.0),
    body_clip(
        "weight_right",
        "gesture",
        "dip",
        go(
            0.28,
            **off("weight_right", (-0.002, 0.003, 0), (-0.5, 0, 0.5), (-2, 0, 0), (-1, 0, 0)),
            overshoot=0.0,
            flow=0.06,
        ),
        go(
            0.27,
            hold=0.34,
            **off("weight_right", (-0.002, -0.037, 0.006), (5, 2, -0.5), (10.5, 2, 0), (-5, -2, 0)),
            peak=0.52,
            overshoot=0.07,
        ),
        home(0.8),
        tags="emphasis",
        likelihood=1.2,
    ),
    body_clip(
        "weight_right",
        "gesture",
        "lean_back",
        go(
            0.56,
            hold=0.55,
            **off("weight_right", (-0.010, -0.014, 0.036), (-7, -1, -0.5), (-15, -1, 1), (12, 1, -2)),
        ),
        home(0.95),
        tags="doubt negative",
    ),
    body_clip(
        "weight_right",
        "fidget",
        "settle",
        go(
            0.40,
            **off("weight_right", (0.020, 0.004, 0.002), (0, 1.5, 2.0), (0, -1, -2.8), (0, -0.5, 1)),
            overshoot=0.0,
            flow=0.08,
        ),
        go(
            0.52,
            hold=0.1,
            **off("weight_right", (-0.008, -0.006, 0.0), (0, -1, -0.8), (1, 0.5, 1.2), (1, 0, -0.5)),
            overshoot=0.05,
        ),
        home(0.75),
    ),
    body_clip(
        "weight_right",
        "fidget",
        "tap_foot",
        go(
            0.30,
            **off("weight_right", (-0.010, -0.002, 0), (0, -1, 0), (0, 0.5, 0), (4, 3, 0)),
            overshoot=0.0,
            flow=0.02,
        ),
        *(
            step
            for degrees in (31, 28, 32, 29)
            for step in (
                go(0.17, left_foot=on_its_heel(RIGHT.left_foot, degrees), overshoot=0.0, flow=0.02),
                go(0.16, hold=0.07, left_foot=RIGHT.left_foot, overshoot=0.0),
            )
        ),
        home(0.5),
        tags="impatient",
        likelihood=0.6,
    ),
    Recipe("body_lean_forward__stance", "body", "stance", "lean_forward", "lean_forward", seconds=6.2),
    body_clip(
        "lean_forward",
        "gesture",
        "press_in",
        go(
            0.30,
            **off("lean_forward", (0, 0.002, 0), (-1.5, 0, 0), (-2, 0, 0), (1, 0, 0)),
            overshoot=0.0,
            flow=0.08,
        ),
        go(
            0.30,
            hold=0.40,
            **off("lean_forward", (0.004, -0.014, 0.006), (4.5, 2, 0), (8, 3, 0), (-6, -1, 2)),
            peak=0.52,
            overshoot=0.06,
        ),
        home(0.8),
        tags="emphasis interest",
        likelihood=1.2,
    ),
    body_clip(
        "lean_forward",
        "gesture",
        "ease_back",
        go(
            0.58,
            hold=0.50,
            **off("lean_forward", (-0.006, 0.006, 0.034), (-8, -2, 0), (-12, -3, 1.5), (13, 3, -3)),
        ),
        home(0.95),
        tags="doubt",
    ),
    body_clip(
        "lean_forward",
        "fidget",
        "settle",
        go(
            0.44,
            **off("lean_forward", (0.016, 0.002, 0.008), (-2, 2, 1.5), (-2, -1, -2.5), (2, -1, 1)),
            overshoot=0.0,
            flow=0.10,
        ),
        go(
            0.52,
            hold=0.1,
            **off("lean_forward", (-0.012, -0.004, -0.004), (1, -1, -1), (1.5, 1, 2), (-1, 0, -1)),
            overshoot=0.04,
        ),
        home(0.75),
    ),
)


def _feet_back(posture: Posture) -> list[Step]:
    """Return steps that set a turned-out foot back beneath the body while the weight is on the other one."""
    for side in ("left_foot", "right_foot"):
        foot = getattr(posture, side)
        if foot != PLAIN:
            up = {side: lifted(foot, PLAIN)}
            return [
                go(0.16, **up, overshoot=0.0, flow=0.1),
                go(0.17, **{side: PLAIN}, overshoot=0.0, flow=0.4),
            ]
    return []


def _feet_out(posture: Posture) -> list[Step]:
    """Return steps that set the free foot where the stance has it, once the weight has left it."""
    for side in ("left_foot", "right_foot"):
        foot = getattr(posture, side)
        if foot != PLAIN:
            up = {side: lifted(PLAIN, foot)}
            return [
                go(0.16, **up, overshoot=0.0, flow=0.1),
                go(0.17, **{side: foot}, overshoot=0.0, flow=0.5),
            ]
    return []


def way(leaves: str, arrives: str) -> Recipe:
    """Return the transition between two stances: foot back, weight over, foot out, settle."""
    a, b = BODY[leaves], BODY[arrives]
    away = abs(b.shift[0] - a.shift[0])
    middle = tuple((np.array(a.head) + b.head) / 2 + (2.5 if away > 0.05 else 0.0, 0, 0))
    low = (np.array(a.shift) + b.shift) / 2 + (0, -0.006, 0)
    steps = _feet_back(a)
    seconds = 0.52 + 1.6 * away
    across = {k: tuple((np.array(getattr(a, k)) + getattr(b, k)) / 2) for k in ("hips", "spine")}
    steps.append(
        go(seconds * 0.6, shift=tuple(low), head=middle, **across, overshoot=0.0, flow=seconds * 0.25)
    )
    steps.append(
        go(
            seconds * 0.7,
            shift=b.shift,
            hips=b.hips,
            spine=b.spine,
            head=b.head,
            overshoot=0.04,
            flow=0.35 if _feet_out(b) else 0.0,
        )
    )
    steps += _feet_out(b)
    steps.append(home(0.1, overshoot=0.0))
    return Recipe(f"body_{leaves}__to__{arrives}", "body", "transition", leaves, arrives, tuple(steps))


WAYS = tuple(way(a, b) for a in BODY for b in BODY if a != b)
CLIPS = (*BOTH, *LEANING, *WAYS)
