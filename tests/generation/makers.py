"""Models that have learned nothing, sounds and takes, for tests."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from metagraph.formats.clips import read_clips
from metagraph.generation.features import FLOOR, MELS, RATE
from metagraph.generation.initial import make_initial_weights
from metagraph.generation.networks import (
    Control,
    CvaeSizes,
    FlowSizes,
    Kind,
    MatchingSizes,
    Sizes,
    Weights,
    count_parameters,
    list_weight_shapes,
)
from metagraph.generation.poses import PoseRig, find_rig
from metagraph.generation.stored import Model, ModelCard, list_versions, make_skeleton_card
from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

Array = Any
CLIPS = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"


def stance() -> Clip:
    return read_clips(CLIPS / "hands_at_sides__stance.glb")[0]


def rig() -> PoseRig:
    return find_rig(stance().skeleton)


def tiny(kind: Kind, pose: int = 78) -> Sizes:
    """Sizes that take no time."""
    if kind == "cvae":
        return CvaeSizes(pose=pose, control=Control(past=0, width=8), dims=5, units=6)
    if kind == "matching":
        return MatchingSizes(
            pose=pose, dims=6, past=2, new=3, ahead=2, hidden=8, layers=2, heads=2, time=4, width=6, around=1
        )
    code = "none" if kind == "moglow" else "variational"
    dims = pose if kind == "moglow" else 7
    return FlowSizes(pose=pose, control=Control(width=8), code=code, between=16, dims=dims, steps=3, units=6)


def shaken(sizes: Sizes, by: float = 0.3, seed: int = 5, dtype: Any = np.float32) -> Weights:
    """Weights that are zero nowhere. Triangles are shaken less, since they soon cannot be inverted."""
    chance = np.random.default_rng(seed)
    fixed = (".p", ".sign", "deviation", "basis", ".mean")
    out: Weights = {}
    for n, w in make_initial_weights(sizes, seed).items():
        far = 0 if n.endswith(fixed) else by / len(w) if n.endswith(("lower", "upper")) else by
        out[n] = (w + far * chance.standard_normal(w.shape)).astype(dtype)
    return out


def untrained(kind: Kind = "flow-vae", by: float = 0.05, sizes: Sizes | None = None) -> Model:
    """A model with weights by chance, whose poses stay near the base pose."""
    own = rig()
    sizes = tiny(kind, own.numbers) if sizes is None else sizes
    assert count_parameters(sizes) and list_weight_shapes(sizes)
    audio = sizes.audio if isinstance(sizes, MatchingSizes) else sizes.control.audio
    identity = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    card = ModelCard(
        kind=kind,
        sizes=sizes,
        skeleton=make_skeleton_card(own),
        pose_mean=identity * (own.numbers // 6),
        pose_deviation=(0.05,) * own.numbers,
        audio_mean=(float(np.log(FLOOR)) / 2,) * MELS + (0.0,) * (audio - MELS),
        audio_deviation=(4.0,) * MELS + (1.0,) * (audio - MELS),
        versions=list_versions(),
    )
    return Model(card, shaken(sizes, by))


def babble(seconds: float, seed: int = 1, level: float = 0.2) -> Array:
    """A sound like a voice that comes and goes, `[N]` at RATE."""
    return _babbled(seconds, seed, level).copy()


@lru_cache(maxsize=64)
def _babbled(seconds: float, seed: int, level: float) -> Array:
    chance = np.random.default_rng(seed)
    t = np.arange(round(seconds * RATE)) / RATE
    knots = chance.uniform(0, 1, int(seconds * 4) + 3)
    loud = np.interp(t * 4, np.arange(len(knots)), np.where(knots > 0.45, knots, 0.0))
    tone = np.cumsum(110 + 30 * np.sin(2 * np.pi * 0.3 * t + seed)) / RATE
    voice = sum(np.sin(2 * np.pi * k * tone) / k for k in range(1, 12))
    return np.asarray(level * loud * voice / 3 + 1e-4 * chance.standard_normal(len(t)))


def conversation(seconds: float, seed: int = 1) -> Conversation:
    """Both say something by turns: clauses with a stress, responses, hesitations."""
    chance = np.random.default_rng(seed)
    at = 0.3
    sides: list[list[Segment]] = [[], []]
    n = 0
    while at + 2.0 < seconds:
        kind = ("clause", "clause", "response", "hesitation")[n % 4]
        length = float(chance.uniform(0.6, 1.4))
        peak = at + length / 2 if kind == "clause" else None
        sides[n % 2].append(
            Segment(kind, at, at + length, peak)  # type: ignore[arg-type]
        )
        at += length + float(chance.uniform(0.1, 0.6))
        n += 1
    both = tuple(Side(segments=tuple(s)) for s in sides)
    return Conversation(name="talk", length=seconds, sides=both)


def moving(seconds: float, seed: int = 1, fps: float = 30.0, skeleton: Skeleton | None = None) -> Clip:
    """Somebody who moves the upper body by chance, smoothly."""
    base = stance()
    skeleton = base.skeleton if skeleton is None else skeleton
    chance = np.random.default_rng(seed)
    count = round(seconds * fps) + 1
    t = np.arange(count) / fps
    rotations = np.repeat(skeleton.rest_rotations[None], count, 0)
    for joint in find_rig(skeleton).joints:
        turn = np.zeros((count, 3))
        for speed in (0.23, 0.61, 1.3):
            phase, size = chance.uniform(0, 7, 3), chance.normal(0, 0.12, 3)
            turn += size * np.sin(2 * np.pi * speed * chance.uniform(0.7, 1.3) * t[:, None] + phase)
        rotations[:, joint] = rotation.multiply(rotations[:, joint], rotation.exp(turn))
    root = np.repeat(skeleton.rest_translations[None, :1], count, 0)
    return Clip(f"take {seed}", skeleton, fps, rotations.astype(np.float32), root)
