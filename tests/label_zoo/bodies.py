"""Recordings of the whole body, put together from takes of its layers, and postures, steps and exercises."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from tests.label_zoo.source import FPS, Array, Motion, base, joint, loop, skeleton, turn

SEATED = ("sit", "sit_back", "sit_forward")
MADE = (*SEATED, "lean_wall")
STEPS = ("walk", "walk_back", "run", "turn_place", "jump", "squat", "jumping_jack", "side_step")
SIDES = (("Left", 1.0), ("Right", -1.0))


@dataclass(frozen=True)
class Whole:
    """A stance of the whole body. body: of the sample's, or of MADE. near: which variant of nearly the same
    pose, 0 none; apart: metres that a variant's hand is away.
    """

    body: str = "weight_both"
    arms: str = "hands_at_sides"
    head: str = "straight"
    near: int = 0
    apart: float = 0.065


def fitted(motion: Motion, frames: int, phase: float = 0.0) -> Motion:
    """Return `frames` of a loop, to and fro where it is too short, from a phase 0..1."""
    count = max(1, motion.frames - 1)
    at = (np.arange(frames) + int(phase * count)) % (2 * count)
    at = np.where(at > count, 2 * count - at, at).clip(0, motion.frames - 1)
    return Motion(motion.turns[at], motion.root[at])


def stretched(motion: Motion, frames: int) -> Motion:
    """Return a motion in another number of frames."""
    at = np.linspace(0, motion.frames - 1, frames)
    low = np.minimum(at.astype(int), max(0, motion.frames - 2))
    high, part = np.minimum(low + 1, motion.frames - 1), at - low
    turns = rotation.nlerp(
        motion.turns[low],
        motion.turns[high],
        np.broadcast_to(part[:, None], (frames, motion.turns.shape[1])),
    )
    return Motion(turns, motion.root[low] * (1 - part[:, None]) + motion.root[high] * part[:, None])


def layered(frames: int, parts: Sequence[Motion], against: Motion | None = None) -> Motion:
    """Return motions on top of each other: what each does beside the base pose, in its turn."""
    ground = base() if against is None else against
    turns = np.repeat(ground.turns, frames, 0)
    root = np.repeat(ground.root, frames, 0)
    for part in parts:
        mine = part if part.frames in (1, frames) else stretched(part, frames)
        turns = rotation.multiply(rotation.multiply(mine.turns, rotation.conjugate(ground.turns)), turns)
        root = root + mine.root - ground.root
    return Motion(rotation.normalize(turns), root)


def breath(stance: str, frames: int, phase: float, size: float = 1.0) -> Motion:
    """Return how the loop of a stance sways, as if it swayed about the base pose."""
    swaying = fitted(loop(stance).motion, frames, phase)
    still = loop(stance).motion
    away = rotation.multiply(swaying.turns, rotation.conjugate(still.turns[:1]))
    return Motion(
        rotation.multiply(rotation.scale_rotation(away, np.full(away.shape[:-1], size)), base().turns),
        base().root + size * (swaying.root - still.root[:1]),
    )


@cache
def posture(stance: str) -> Motion:
    """Return one pose in which the body is in a stance, all else as in the base pose."""
    if stance not in MADE:
        whole = loop(stance).motion
        return Motion(whole.turns[:1], whole.root[:1])
    if stance == "lean_wall":
        bends = {"Hips": -9.0, "Spine": -3.0, "UpperChest": 6.0, "LeftLowerLeg": 14.0, "RightLowerLeg": 4.0}
        bends |= {"LeftUpperLeg": -6.0, "RightUpperLeg": 1.0}
        return _bent(bends, np.array([0.0, -0.02, -0.10]))
    back = {"sit": 0.0, "sit_back": -13.0, "sit_forward": 6.0}[stance]
    bends = {"Hips": back}
    bends |= {f"{s}UpperLeg": -86.0 - back for s, _ in SIDES} | {f"{s}LowerLeg": 88.0 for s, _ in SIDES}
    if stance == "sit_forward":
        bends |= {"Spine": 9.0, "Chest": 9.0, "Neck": -6.0, "Head": -4.0}
    return _bent(bends, np.array([0.0, -0.46, -0.02 + 0.05 * back / 13]))


def _bent(degrees: dict[str, float], shift: Array) -> Motion:
    turns = base().turns.copy()
    for name, angle in degrees.items():
        turns[:, joint(name)] = rotation.multiply(turn("x", angle), turns[:, joint(name)])
    return Motion(turns, base().root + shift)


def hands(motion: Motion) -> Array:
    """Return where the hands are, `[F, 2, 3]`, from the hips."""
    pose = np.repeat(skeleton().rest_translations[None], motion.frames, 0)
    pose[:, 0] = motion.root
    _, at = skeleton().globals(Pose(motion.turns, pose))
    return np.asarray(at[:, [joint("LeftHand"), joint("RightHand")]] - at[:, :1])


@cache
def aside(whole: Whole) -> Motion:
    """Return what else a stance has: hands in the lap of one who sits; of a variant, hands `whole.apart`
    away.
    """
    lap: dict[str, float] = {}
    if whole.body in SEATED and whole.arms == "hands_at_sides":
        lap = {f"{s}UpperArm": -14.0 for s, _ in SIDES} | {f"{s}LowerArm": -48.0 for s, _ in SIDES}
    plain = _bent(lap, np.zeros(3))
    if not whole.near:
        return plain
    draw = np.random.default_rng([77, whole.near])
    axes = {
        f"{s}{part}": draw.normal(size=3) * (1.0 if part == "UpperArm" else 0.7)
        for s, _ in SIDES
        for part in ("UpperArm", "LowerArm")
    }
    stand = layered(1, [posture(whole.body), posture(whole.arms), posture(whole.head), plain])
    low, high, turns = 0.0, 1.0, plain.turns
    for _ in range(24):  # by halves: the farther hand is `apart` away
        size = (low + high) / 2
        turns = plain.turns.copy()
        for name, axis in axes.items():
            turns[:, joint(name)] = rotation.multiply(rotation.exp(axis * size), turns[:, joint(name)])
        moved = layered(
            1, [posture(whole.body), posture(whole.arms), posture(whole.head), Motion(turns, base().root)]
        )
        far = float(np.linalg.norm(hands(moved) - hands(stand), axis=-1).max())
        low, high = (size, high) if far < whole.apart else (low, size)
    return Motion(turns, base().root)


def standing(whole: Whole) -> Motion:
    """Return the one pose of a stance of the whole body."""
    return layered(1, [posture(whole.body), posture(whole.arms), posture(whole.head), aside(whole)])


def resting(whole: Whole, frames: int, draw: np.random.Generator) -> Motion:
    """Return a loop in a stance; it breathes, sways, and ends about as it begins."""
    own = loop(whole.body).stance if whole.body not in MADE else "weight_both"
    size = 0.4 if whole.body in MADE else 1.0
    parts = [breath(own, frames, 0.0, size), breath(whole.arms, frames, 0.0), breath(whole.head, frames, 0.0)]
    cycle = fitted(Motion(layered(frames, parts).turns, layered(frames, parts).root), frames)
    return layered(frames, [standing(whole), _closed(cycle, draw)])


def _closed(motion: Motion, draw: np.random.Generator) -> Motion:
    """Return a motion that comes back to its first pose in its last half second."""
    frames = motion.frames
    ease = np.clip((frames - 1 - np.arange(frames)) / min(15, frames - 1), 0, 1)
    ease = ease * ease * (3 - 2 * ease)
    turns = rotation.slerp(
        np.broadcast_to(motion.turns[:1], motion.turns.shape),
        motion.turns,
        np.broadcast_to(ease[:, None], motion.turns.shape[:2]),
    )
    return Motion(turns, motion.root[:1] + (motion.root - motion.root[:1]) * ease[:, None])


def over(whole: Whole, own: Motion, layer: str, draw: np.random.Generator, sway: float = 1.0) -> Motion:
    """Return an action of one layer over a stance of the whole body, the other layers breathing.

    own: of the sample clips, in the layer's own stance of `whole`.
    """
    frames = own.frames
    held = {"arms": posture(whole.arms), "head": posture(whole.head), "body": posture(whole.body)}
    held[layer] = own
    body = whole.body if whole.body not in MADE else "weight_both"
    idle = {"arms": whole.arms, "head": whole.head, "body": body}
    moving = [breath(idle[x], frames, draw.random(), 0.6 * sway) for x in idle if x != layer]
    return layered(frames, [*held.values(), aside(whole), *moving])


def upper_only(motion: Motion) -> Motion:
    """Return a motion of the body without what its legs, hips and root do, as one who sits does it."""
    turns = np.repeat(base().turns, motion.frames, 0)
    for name in ("Spine", "Chest", "UpperChest", "Neck", "Head", "LeftShoulder", "RightShoulder"):
        turns[:, joint(name)] = motion.turns[:, joint(name)]
    return Motion(turns, np.repeat(base().root, motion.frames, 0))


def between(a: Whole, b: Whole, frames: int, draw: np.random.Generator, arms: Motion | None) -> Motion:
    """Return a change from one stance of the whole body to another: the hips first, then the arms, as they
    come. arms: the sample's own change of the arms, where there is one.
    """
    out = []
    for layer, (one, two) in {
        "body": (posture(a.body), posture(b.body)),
        "arms": (posture(a.arms), posture(b.arms)),
        "head": (posture(a.head), posture(b.head)),
        "near": (aside(a), aside(b)),
    }.items():
        if layer == "arms" and arms is not None:
            out.append(stretched(arms, frames))
            continue
        late = draw.uniform(0, 0.2)
        way = np.clip((np.linspace(0, 1, frames) - late) / (1 - late - draw.uniform(0, 0.15)), 0, 1)
        way = way**3 * (10 - 15 * way + 6 * way * way)
        share = np.broadcast_to(way[:, None], (frames, one.turns.shape[1]))
        shape = (frames, *one.turns.shape[1:])
        turns = rotation.slerp(np.broadcast_to(one.turns, shape), np.broadcast_to(two.turns, shape), share)
        out.append(Motion(turns, one.root + (two.root - one.root) * way[:, None]))
    moving = [breath("weight_both", frames, 0.0, 0.3), breath("straight", frames, 0.0, 0.5)]
    return layered(frames, [*out, *moving])


# -- steps and exercises: none of the four kinds
# --------------------------------------------------------------------------------------------------


def steps(name: str, whole: Whole, draw: np.random.Generator) -> Motion:
    """Return one of STEPS, begun in a stance. Some go over the ground, some stay on the spot."""
    cycle = {"run": 0.7, "jump": 1.3, "squat": 2.2, "jumping_jack": 1.0}.get(name, draw.uniform(0.95, 1.3))
    count = {"jump": 1, "turn_place": 2}.get(name, int(draw.integers(2, 5)))
    t = np.arange(round(cycle * count * FPS) + 1) / FPS
    phase = 2 * np.pi * t / cycle
    turns = np.repeat(layered(1, [standing(whole)]).turns, len(t), 0)
    root = np.repeat(standing(whole).root, len(t), 0)

    def bend(part: str, axis: str, degrees: Array) -> None:
        turns[:, joint(part)] = rotation.multiply(turn(axis, degrees), turns[:, joint(part)])

    onward = draw.random() < 0.6
    if name in ("walk", "walk_back", "run", "side_step", "turn_place"):
        far = {"run": 38.0, "turn_place": 6.0, "side_step": 4.0}.get(name, 25.0) * draw.uniform(0.85, 1.15)
        for side, way in SIDES:
            wave = way * np.sin(phase)
            lift = np.maximum(0, way * np.cos(phase)) * (70 if name == "run" else 34)
            bend(f"{side}UpperLeg", "x", -far * wave - lift / 2)
            bend(f"{side}LowerLeg", "x", lift)
            bend(f"{side}UpperArm", "x", 0.7 * far * wave)
            bend(f"{side}LowerArm", "x", np.full(len(t), -60.0 if name == "run" else -8.0))
        root[:, 1] -= (0.03 if name == "run" else 0.015) * (1 - np.cos(2 * phase)) / 2
    if name in ("walk", "walk_back", "run") and onward:
        root[:, 2] += t * {"walk": 1.2, "walk_back": -0.7, "run": 2.8}[name]
    if name == "side_step":
        way = 1.0 if draw.random() < 0.5 else -1.0
        for side, _ in SIDES:
            bend(f"{side}UpperLeg", "z", way * 9 * np.sin(phase))
        root[:, 0] += way * 0.4 * t
    if name == "turn_place":
        part = t / t[-1]
        yaw = draw.choice([-180.0, -90.0, 90.0, 180.0]) * part * part * (3 - 2 * part)
        turns[:, 0] = rotation.multiply(turn("y", yaw), turns[:, 0])
    if name in ("squat", "jump"):
        deep = 52.0 if name == "squat" else 35.0
        ease = (1 - np.cos(phase)) / 2 if name == "squat" else np.exp(-(((t / cycle - 0.3) / 0.12) ** 2))
        for side, _ in SIDES:
            bend(f"{side}UpperLeg", "x", -deep * ease)
            bend(f"{side}LowerLeg", "x", 2 * deep * ease)
            bend(f"{side}Foot", "x", -deep * ease)
            bend(f"{side}UpperArm", "x", -60.0 * ease)
        root[:, 1] -= 0.83 * (1 - np.cos(np.radians(deep * ease)))
        if name == "jump":
            root[:, 1] += 0.35 * np.maximum(0, 1 - ((t / cycle - 0.6) / 0.18) ** 2)
    if name == "jumping_jack":
        ease = (1 - np.cos(phase)) / 2
        for side, way in SIDES:
            bend(f"{side}UpperLeg", "z", way * 22 * ease)
            bend(f"{side}UpperArm", "z", way * 120 * ease)
        root[:, 1] += 0.08 * np.abs(np.sin(phase))
    return Motion(turns, root)
