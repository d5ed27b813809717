"""A clip as its maker writes it down, and how it becomes motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from metagraph.motion.clip import Clip
from sample_clips.make import key_poses, motion_tracks, secondary
from sample_clips.make.key_poses import Posture
from sample_clips.make.mannequin_rig import FPS, REACH, REST, SIDES, SKELETON, Array, arm_joints, at
from sample_clips.make.motion_tracks import Step
from sample_clips.make.stance_clips import BASE, PINS, STANCES

HOME: Any = object()
"""As a step's `left`, `spine` ...: back to how the stance has it."""


@dataclass(frozen=True)
class Recipe:
    """One clip. kind: stance, gesture, fidget or transition. stance, end: where it begins and ends.

    limb: left, right or both. tags: what it means. seconds: a stance's length. drag: how loosely the hands
    follow. life: how much the holds move. later: the arm that is a little late. together: neither is. pins:
    (side, joint) pairs, hands kept where they lie on a joint, in place of the stance's. sway: how much of the
    usual the hips wander in a stance of the body. over: the body's stance whose legs an arms clip has, where
    hands touch them.
    """

    name: str
    layer: str
    kind: str
    stance: str
    end: str
    steps: tuple[Step, ...] = ()
    limb: str = "both"
    tags: tuple[str, ...] = ()
    likelihood: float = 1.0
    seconds: float = 0.0
    drag: float = 1.0
    life: float = 1.0
    later: str = ""
    together: bool = False
    pins: tuple[tuple[str, str], ...] | None = None
    sway: float = 1.0
    over: str = ""


def go(seconds: float, hold: float = 0.0, **change: Any) -> Step:
    """Return a step; `rt`, `lf`, `spine`, `head`, `hips` ... change the posture, the rest are the step's own
    fields.
    """
    own = {f.name for f in fields(Step)} - {"seconds", "change", "hold"}
    short = {"rt": "right", "lf": "left", "rt_foot": "right_foot", "lf_foot": "left_foot"}
    named = {short.get(k, k): v for k, v in change.items() if k not in own}
    return Step(seconds, named, hold, **{k: v for k, v in change.items() if k in own})


def home(seconds: float = 0.75, **timing: Any) -> Step:
    """Return the step back to the stance, everything at once."""
    return Step(
        seconds, {f.name: HOME for f in fields(Posture)}, **{"peak": 0.44, "overshoot": 0.02, **timing}
    )


def counter(posture: Posture, stance: Posture) -> Posture:
    """Let the torso answer the hands: it turns with the one in front, leans from the one raised; the head
    half undoes it.
    """
    left = np.array(posture.left.at) - stance.left.at
    right = np.array(posture.right.at) - stance.right.at
    forwards, raised = right[2] - left[2], right[1] - left[1]
    turn = float(np.clip(9.0 * forwards, -5, 5))
    lean = float(np.clip(-5.0 * raised, -3, 3))
    pitch = (
        float(np.clip(1.5 - 7.0 * min(left[1], right[1]), -2.5, 1.5))
        if left[1] > 0.05 and right[1] > 0.05
        else 0.0
    )
    spine = tuple(np.array(posture.spine) + (pitch, turn, lean))
    head = tuple(np.array(posture.head) + (-0.7 * pitch, -0.75 * turn, -0.45 * lean))
    return replace(posture, spine=spine, head=head)  # type: ignore[arg-type]


def postures_of(recipe: Recipe) -> list[Posture]:
    """Return the stance's posture and the one at the end of each step."""
    first, last = STANCES[recipe.layer][recipe.stance], STANCES[recipe.layer][recipe.end]
    now, out = first, [first]
    follows = follower(recipe)
    for step in recipe.steps:
        change: Mapping[str, Any] = {k: getattr(last, k) if v is HOME else v for k, v in step.change.items()}
        now = replace(now, **change)
        is_home = now in (first, last)
        out.append(
            counter(
                _followed(now, first, follows, recipe, len(out)),
                last if recipe.kind == "transition" else first,
            )
            if recipe.layer == "arms" and not is_home
            else now
        )
    if now != last:
        raise ValueError(f"{recipe.name} does not end in its stance")
    return out


def follower(recipe: Recipe) -> str:
    """Return the side whose arm follows the other's in a gesture of both, "" for none: of two hands that
    speak, one leads, and the other goes less far.
    """
    if recipe.layer != "arms" or recipe.kind != "gesture" or recipe.limb != "both" or recipe.together:
        return ""
    return recipe.later or ("Left" if motion_tracks.seed_of(recipe.name) % 2 else "Right")


def _followed(now: Posture, stance: Posture, side: str, recipe: Recipe, number: int) -> Posture:
    """Return a posture whose following hand is less far from its stance, and not quite where a mirror would
    have it.
    """
    if not side:
        return now
    hand, rest = getattr(now, side.lower()), getattr(stance, side.lower())
    if hand == rest:
        return now
    generator = np.random.default_rng(motion_tracks.seed_of(recipe.name) + number)
    away = np.array(hand.at) - rest.at
    size = float(np.linalg.norm(away))
    aside = generator.uniform(-1, 1, 3) * (0.012, 0.014, 0.012) * min(1.0, size / 0.15)
    moved = tuple((np.array(rest.at) + away * generator.uniform(0.88, 0.96) + aside).tolist())
    turn = 4.0 * float(generator.uniform(-1, 1))
    return replace(now, **{side.lower(): replace(hand, at=moved, turn=hand.turn + turn)})


LIFE = {  # degrees of drift in a stance, by layer; gestures drift a little less
    "arms": {"Spine": 0.35, "Chest": 0.45, "UpperChest": 0.5, "Neck": 0.5, "Head": 0.8}
    | {
        s + j: d
        for s in SIDES
        for j, d in (("Shoulder", 0.35), ("UpperArm", 0.45), ("LowerArm", 0.55), ("Hand", 1.1))
    },
    "head": {"Chest": 0.12, "UpperChest": 0.2, "Neck": 0.7, "Head": 1.0},
    "body": {"Hips": 0.35, "Spine": 0.45, "Chest": 0.5, "UpperChest": 0.5, "Neck": 0.4, "Head": 0.55},
}
FINGER_LIFE = {
    s + f + b: d
    for s in SIDES
    for f in ("Thumb", "Index", "Middle", "Ring", "Little")
    for b, d in (("1", 1.2), ("2", 1.6))
}
STILL_HANDS = {
    "arms_crossed",
    "hands_clasped",
    "hand_to_chin",
    "on_hips",
    "on_lap",
    "hands_folded",
}  # hands that rest on something


def drifts(recipe: Recipe) -> dict[str, float]:
    """Return how many degrees each joint drifts in a clip."""
    sizes = dict(LIFE[recipe.layer])
    if recipe.layer == "arms":
        if recipe.stance in STILL_HANDS and recipe.kind == "stance":
            # All that moves a resting arm is its shoulder: the hands must stay where they lie.
            sizes = {k: v for k, v in sizes.items() if not k.endswith(("Arm", "Hand"))}
            sizes |= FINGER_LIFE
        elif recipe.kind == "stance":
            sizes |= FINGER_LIFE
        else:
            sizes |= {
                k: v * 0.7
                for k, v in FINGER_LIFE.items()
                if k.endswith("1") and recipe.limb in ("both", ("left" if k.startswith("Left") else "right"))
            }
    scale = recipe.life * (1.0 if recipe.kind == "stance" else 0.6)
    return {k: v * scale for k, v in sizes.items()}


SITS = {"sitting", "sitting_forward"}
HANGS = 0.85  # of a lean of the trunk of one who sits, the arms do not take part in


def animate(recipe: Recipe) -> Clip:
    """Return the clip. It begins and ends exactly in its stances, and moves only the joints its layer
    reaches.
    """
    postures = postures_of(recipe)
    if recipe.steps:
        moves, seconds = motion_tracks.schedule(recipe.steps, motion_tracks.lead_of(recipe.layer))
    else:
        moves, seconds = [], recipe.seconds
    frames = round(seconds * FPS) + 1
    times = np.arange(frames) / FPS
    seed = motion_tracks.seed_of(recipe.name)
    later = recipe.later or ("Left" if seed % 2 else "Right")
    lags = motion_tracks.lag_array(
        recipe.layer,
        later,
        (0.02 + 0.04 * (seed % 97) / 97) if recipe.limb == "both" and not recipe.together else 0.0,
    )
    follows = follower(recipe)
    others = dict.fromkeys(
        (at(name) for name in arm_joints(follows)) if follows else (), motion_tracks.unlike(moves, seed)
    )
    rotations, numbers = motion_tracks.blend(postures, moves, times, lags, others)
    rotations = secondary.life(rotations, seed, drifts(recipe), recipe.kind == "stance")
    if recipe.layer == "arms":
        rotations = _arms(recipe, rotations)
    # The legs as they are beneath hips that are upright: the arms' layer knows no other.
    under = replace(STANCES["body"][recipe.over], hips=BASE.hips) if recipe.over else BASE
    base, _ = key_poses.legs(key_poses.solve(BASE)[None], key_poses.channels(under)[None])
    root = np.broadcast_to(REST[0] + key_poses.channels(under)[:3], (frames, 3))
    if recipe.layer == "body":
        if recipe.kind == "stance":
            sway = motion_tracks.wander(np.random.default_rng(seed + 1), frames, 0.9, 3, True)
            numbers[:, :3] += sway * (0.0065, 0.0012, 0.0045) * (recipe.life * recipe.sway)
        rotations, root = key_poses.legs(rotations, numbers)
    only = [at(name) for name in REACH[recipe.layer]]
    if recipe.layer == "body" and SITS & {recipe.stance, recipe.end}:
        rotations = secondary.hanging(rotations, base[0], HANGS)
        only += [at(side + "UpperArm") for side in SIDES]
    out = np.broadcast_to(base, (frames, len(SKELETON), 4)).copy()
    out[:, only] = rotations[:, only]
    return Clip(recipe.name, SKELETON, FPS, out, root[:, None])


def _arms(recipe: Recipe, rotations: Array) -> Array:
    if recipe.kind != "stance":
        rotations = secondary.drag(rotations, recipe.drag)
    if recipe.pins is not None or recipe.stance != recipe.end:
        pins = recipe.pins or ()
    else:
        moved = {
            side for side in SIDES for step in recipe.steps if step.change.get(side.lower(), HOME) is not HOME
        }
        pins = tuple((side, joint) for side, joint in PINS.get(recipe.stance, ()) if side not in moved)
    for side, joint in pins:
        rotations = secondary.pin(rotations, side, joint)
    return rotations
