"""Phrases that serve in several stances: beats, drumming fingers; and how an arms clip is named."""

from __future__ import annotations

from typing import Any

from sample_clips.make.key_poses import Hand
from sample_clips.make.motion_tracks import Step
from sample_clips.make.recipe import Recipe, go
from sample_clips.make.stage_places import lifted

LIMBS = {"lf": "left", "rt": "right", "bt": "both"}


def arms_clip(
    stance: str, kind: str, action: str, limb: str, *steps: Step, tags: str = "", **more: Any
) -> Recipe:
    """Return a recipe named `stance__action_limb_01`; tags are words with spaces between."""
    name = f"{stance}__{action}_{limb}_01"
    return Recipe(name, "arms", kind, stance, stance, steps, LIMBS[limb], tuple(tags.split()), **more)


def beat(limb: str, ready: Hand, low: Hand, times: int = 1, quick: float = 0.24) -> list[Step]:
    """Raise the hand (or both), strike `times` times, hold. The first strike is the strongest."""
    which = {"lf": ("left",), "rt": ("right",), "bt": ("left", "right")}[limb]
    up = dict.fromkeys(which, ready)
    steps = [go(0.46, **up, head=(-1.5, 0, 0), flow=0.12, overshoot=0.0)]
    for i in range(times):
        last = i == times - 1
        down = {side: low.moved(0.012 * i, 0.028 * i, -0.01 * i) for side in which}
        steps.append(
            go(
                quick,
                hold=0.34 if last else 0.06,
                **down,
                spine=(2.0, 0, 0),
                head=(3.5, 0, 0),
                peak=0.56,
                overshoot=0.09,
            )
        )
        if not last:
            rise = {side: ready.moved(0.01, -0.03, 0.015) for side in which}
            steps.append(go(0.25, **rise, spine=(0.5, 0, 0), head=(0, 0, 0), flow=0.08, overshoot=0.0))
    return steps


_TAP = ({1: 14.0}, {2: 14.0}, {3: 12.0}, {4: 12.0})


def finger_roll(side: str, hand: Hand, shape: str, rounds: int = 2, size: float = 1.0) -> list[Step]:
    """Drum the fingers, the little one first, each up and down while the next is rising; `size` scales how
    far.
    """
    steps = []
    for _ in range(rounds):
        for lifts in reversed(_TAP):
            steps.append(
                go(
                    0.13,
                    **{side: hand.moved(shape=lifted(shape, {k: v * size for k, v in lifts.items()}))},
                    overshoot=0.0,
                    flow=0.045,
                )
            )
        steps.append(go(0.16, hold=0.10, **{side: hand}, overshoot=0.0))
    return steps
