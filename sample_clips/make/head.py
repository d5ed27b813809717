"""The head layer: nods, shakes, looks. Thirty-six clips; neck and upper spine follow the head."""

from __future__ import annotations

from typing import Any

import numpy as np

from sample_clips.make.motion_tracks import Step
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stance_clips import HEAD


def head_clip(
    stance: str,
    kind: str,
    action: str,
    *steps: Step,
    number: int = 1,
    limb: str = "both",
    tags: str = "",
    **more: Any,
) -> Recipe:
    """Return a recipe named `stance__action_01`."""
    return Recipe(
        f"{stance}__{action}_{number:02d}",
        "head",
        kind,
        stance,
        stance,
        steps,
        limb,
        tuple(tags.split()),
        **more,
    )


def to(
    stance: str, seconds: float, pitch: float = 0.0, turn: float = 0.0, lean: float = 0.0, **more: Any
) -> Step:
    """Return a step of the head by degrees from its stance; the spine goes a little of the way unless told
    otherwise.
    """
    posture = HEAD[stance]
    spine = more.pop("spine", (0.08 * pitch, 0.10 * turn, 0.08 * lean))
    head = tuple(np.array(posture.head) + (pitch, turn, lean))
    return go(seconds, head=head, spine=tuple(np.array(posture.spine) + spine), **more)


def nod(
    stance: str,
    depths: tuple[float, ...],
    quick: float = 0.19,
    rise: float = 2.5,
    turn: float = 0.0,
    lean: float = 0.0,
    **more: Any,
) -> list[Step]:
    """Return a nod's steps: a small lift, then down and up once for each depth (degrees), each less quick
    than the last.
    """
    steps = [
        to(
            stance,
            0.20,
            -rise,
            0.3 * turn,
            0.3 * lean,
            overshoot=0.0,
            flow=0.03,
            brows=more.get("brows", 0.0),
        )
    ]
    for i, depth in enumerate(depths):
        slow = 1 + 0.14 * i
        steps.append(
            to(
                stance,
                quick * slow,
                depth,
                turn,
                lean,
                hold=more.get("hold", 0.0),
                overshoot=0.04,
                peak=0.46,
                lids=more.get("lids", 6.0),
            )
        )
        if i + 1 < len(depths):
            steps.append(
                to(
                    stance,
                    quick * slow * 1.1,
                    -0.25 * depth,
                    turn * 0.6,
                    lean * 0.6,
                    overshoot=0.0,
                    flow=0.02,
                    lids=1.0,
                )
            )
    return [
        *steps,
        to(
            stance,
            quick * 1.5,
            -0.16 * depths[-1],
            0.2 * turn,
            0.3 * lean,
            overshoot=0.0,
            flow=0.10,
            lids=0.0,
        ),
        home(0.42),
    ]


def shake(
    stance: str, sizes: tuple[float, ...], quick: float = 0.20, pitch: float = 2.0, lean: float = 0.0
) -> list[Step]:
    """Return a shake's steps: turns to one side and the other (degrees, left is plus), with the chin a little
    down.
    """
    steps = []
    for i, size in enumerate(sizes):
        first = 0.75 if i == 0 else 1.0
        steps.append(
            to(
                stance,
                quick * (1.2 - 0.4 * (1 - first)) * (1 + 0.06 * i),
                pitch,
                size,
                lean - 0.12 * size,
                overshoot=0.0,
                flow=0.015,
                lids=3.0,
            )
        )
    return [*steps, home(0.46, overshoot=0.04)]


S = "head_straight"
STRAIGHT = (
    Recipe("head_straight__stance", "head", "stance", S, S, seconds=6.0),
    head_clip(S, "gesture", "nod_single", *nod(S, (10.0,)), tags="positive agree", likelihood=1.4),
    head_clip(
        S,
        "gesture",
        "nod_single",
        *nod(S, (8.0,), 0.27, 1.5, turn=-2, lean=3, hold=0.12),
        number=2,
        tags="positive acknowledge",
    ),
    head_clip(S, "gesture", "nod_double", *nod(S, (11.0, 7.5)), tags="positive agree", likelihood=1.2),
    head_clip(
        S,
        "gesture",
        "nod_small",
        *nod(S, (4.5, 3.2), 0.17, 1.0, lean=1),
        tags="positive listen",
        likelihood=1.4,
    ),
    head_clip(
        S,
        "gesture",
        "nod_emphatic",
        *nod(S, (16.0, 9.0, 6.5), 0.20, 4.0, brows=5.0),
        tags="positive emphasis",
        likelihood=0.7,
    ),
    head_clip(S, "gesture", "shake", *shake(S, (15, -17, 14, -10)), tags="negative disagree"),
    head_clip(S, "gesture", "shake_small", *shake(S, (6, -7, 4.5), 0.18, 1.0, 1.5), tags="negative doubt"),
    head_clip(
        S,
        "gesture",
        "question",
        to(S, 0.22, 2.5, 0, -1.5, overshoot=0.0, flow=0.05),
        to(S, 0.34, -4.0, 4.0, 9.5, hold=0.55, brows=7.0, overshoot=0.05, spine=(1.0, 0.5, 1.2)),
        home(0.62),
        tags="question",
    ),
    *(
        head_clip(
            S,
            "gesture",
            "look_aside_" + side,
            to(S, 0.16, 2.5, 4 * sign, 0, overshoot=0.0, flow=0.05, lids=9.0),
            to(S, 0.36, down, size * sign, tilt * sign, hold=hold, overshoot=0.04, lids=0.0),
            to(S, 0.30, down + 1.5, size * 0.5 * sign, tilt * 0.4 * sign, overshoot=0.0, flow=0.14, lids=6.0),
            home(0.5, overshoot=0.035),
            limb={"lf": "left", "rt": "right"}[side],
            tags="thinking aside",
        )
        for side, sign, size, down, tilt, hold in (
            ("lf", 1, 27, 1.0, -3.0, 0.60),
            ("rt", -1, 24, 4.0, -4.0, 0.72),
        )
    ),
    head_clip(
        S,
        "gesture",
        "think_up",
        to(S, 0.18, 2.0, -2, 0, overshoot=0.0, flow=0.05, lids=8.0),
        to(S, 0.46, -11.0, -12.0, 5.0, hold=0.65, overshoot=0.03, brows=3.5, lids=0.0),
        to(S, 0.30, -6.0, -4.0, 2.0, overshoot=0.0, flow=0.15, brows=2.0),
        home(0.55, overshoot=0.03),
        tags="thinking",
        likelihood=0.8,
    ),
    head_clip(
        S,
        "gesture",
        "double_take",
        to(S, 0.34, 3.0, 22.0, -2.0, hold=0.10, overshoot=0.02),
        to(S, 0.30, 1.0, 3.0, 0.0, hold=0.05, overshoot=0.0),
        to(
            S,
            0.20,
            -5.0,
            26.0,
            2.0,
            hold=0.50,
            peak=0.38,
            overshoot=0.07,
            brows=9.0,
            lids=-4.0,
            spine=(-1.5, 4.0, 0),
        ),
        home(0.7),
        tags="surprise",
        limb="left",
        likelihood=0.4,
    ),
    head_clip(
        S,
        "fidget",
        "neck_stretch",
        to(S, 0.62, 3.0, 0.0, 25.0, hold=0.22, overshoot=0.02, spine=(0, 0, 1.5)),
        to(S, 0.56, 18.0, 0.0, 4.0, overshoot=0.0, flow=0.16, spine=(1.5, 0, 0), lids=10.0),
        to(S, 0.60, 2.0, 0.0, -24.0, hold=0.22, overshoot=0.02, spine=(0, 0, -1.5), lids=4.0),
        home(0.72),
        tags="stretch",
        likelihood=0.4,
    ),
    head_clip(
        S,
        "fidget",
        "glance",
        to(S, 0.28, 0.0, 29.0, -2.0, hold=0.50, lids=2.0),
        to(S, 0.26, 0.5, 12, 0, overshoot=0.0, flow=0.1),
        home(0.42),
        limb="left",
    ),
    head_clip(
        S,
        "fidget",
        "settle",
        to(S, 0.42, 3.5, -3.0, 3.0, overshoot=0.0, flow=0.1),
        to(S, 0.44, -1.5, 1.5, -2.0, hold=0.1),
        home(0.55),
    ),
)


def tilted(stance: str, sign: int) -> tuple[Recipe, ...]:
    """Return the clips of a tilted head; sign is 1 for a head tilted to its right."""
    t = stance
    return (
        Recipe(f"{t}__stance", "head", "stance", t, t, seconds=5.6 if sign > 0 else 6.2),
        head_clip(
            t,
            "gesture",
            "nod_single",
            *nod(t, (8.5,), 0.21, 2.0, turn=2.0 * sign, lean=-2.0 * sign),
            tags="positive agree",
            likelihood=1.3,
        ),
        head_clip(
            t,
            "gesture",
            "nod_double",
            *nod(t, (8.0, 5.5), 0.18, 1.5, lean=-1.5 * sign),
            tags="positive listen",
            likelihood=1.2,
        ),
        head_clip(
            t,
            "gesture",
            "shake_small",
            *shake(t, (6.5 * sign, -8.0 * sign, 5.0 * sign), 0.19, 1.5),
            tags="negative doubt",
        ),
        head_clip(
            t,
            "gesture",
            "question",
            to(t, 0.20, 2.0, 0, 2.0 * -sign, overshoot=0.0, flow=0.05),
            to(t, 0.32, -5.0, 3.0 * sign, 4.5 * sign, hold=0.5, brows=6.0, overshoot=0.05),
            home(0.6),
            tags="question",
        ),
        head_clip(
            t,
            "fidget",
            "glance",
            to(t, 0.28, 0.0, -27.0 * sign, 2.0 * -sign, hold=0.48, lids=2.0),
            to(t, 0.26, 0.5, -11.0 * sign, 0, overshoot=0.0, flow=0.1),
            home(0.42),
            limb="left" if sign > 0 else "right",
        ),
        head_clip(
            t,
            "fidget",
            "settle",
            to(t, 0.42, 2.5, 2.0 * sign, -4.5 * sign, overshoot=0.0, flow=0.1),
            to(t, 0.42, -1.0, 0.0, 1.5 * sign),
            home(0.5),
        ),
    )


def way(leaves: str, arrives: str) -> Recipe:
    """Return the transition between two stances: the chin dips on the way across."""
    a, b = HEAD[leaves], HEAD[arrives]
    far = abs(b.head[2] - a.head[2])
    middle = (np.array(a.head) + b.head) / 2 + (3.0 + 0.08 * far, 0, 0)
    spine = tuple((np.array(a.spine) + b.spine) / 2)
    steps = (
        go(0.30 + 0.004 * far, head=tuple(middle), spine=spine, overshoot=0.0, flow=0.14, lids=7.0),
        home(0.44, overshoot=0.05),
    )
    return Recipe(
        f"{leaves}__to__{arrives.removeprefix('head_')}", "head", "transition", leaves, arrives, steps
    )


WAYS = tuple(way(a, b) for a in HEAD for b in HEAD if a != b)
CLIPS = (*STRAIGHT, *tilted("head_tilt_left", -1), *tilted("head_tilt_right", 1), *WAYS)
