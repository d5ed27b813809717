"""Takes of somebody who talks: an arm swings at the stresses of what is said, the head nods with answers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from metagraph.formats.clips import read_clips
from metagraph.graph.conversation.model import Segment, Word
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.synthesis.constraints import find_change_states, find_heard_at
from metagraph.synthesis.extending.path import DriverGraph, make_driver_graph
from metagraph.synthesis.graph import build_graph
from metagraph.synthesis.states import key_states, read_states

VOICE = 8000  # samples a second
WORDS = ("we", "went", "round", "along", "there", "big", "nothing", "river")
CLIPS = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"
FPS = 30.0


def speech(seconds: float, seed: int) -> list[Segment]:
    """Clauses with a stress, answers and hesitations, with silence between them or none; on frames."""
    chance = np.random.default_rng(seed)
    at, out = float(chance.uniform(0.3, 1.0)), []
    while True:
        kind = str(chance.choice(["clause", "clause", "clause", "response", "hesitation"]))
        length = float(chance.uniform(0.7, 1.6) if kind == "clause" else chance.uniform(0.4, 0.7))
        a, b = round(at * FPS) / FPS, round((at + length) * FPS) / FPS
        if b > seconds - 0.3:
            return out
        peak = (
            round((a + float(chance.uniform(0.3, 0.7)) * (b - a)) * FPS) / FPS if kind == "clause" else None
        )
        out.append(Segment(kind, a, b, peak))  # type: ignore[arg-type]
        at = b + (0.0 if kind == "clause" and chance.random() < 0.3 else float(chance.uniform(0.25, 1.1)))


def talking(
    name: str,
    segments: list[Segment],
    seconds: float,
    seed: int = 1,
    fps: float = FPS,
    sizes: Sequence[float] = (),
) -> Clip:
    """A take in which the right arm is fastest at the stress of each clause, and answers and hesitations go
    with a nod. sizes: how large the swing of each segment is, 1 if nothing is said.
    """
    base = read_clips(CLIPS / "hands_at_sides__stance.glb")[0]
    chance = np.random.default_rng(seed)
    t = np.arange(round(seconds * fps)) / fps
    roles = find_roles(base.skeleton)
    arm, head = np.zeros(len(t)), np.zeros(len(t))
    for n, s in enumerate(segments):
        if s.kind == "clause" and s.peak is not None:
            up = 0.5 + 0.5 * np.tanh((t - s.peak) / 0.1)  # fastest at the stress
            down = 0.5 + 0.5 * np.tanh((t - s.end - 0.15) / 0.2)
            arm += chance.uniform(0.7, 0.9) * (up - down) * (sizes[n] if len(sizes) else 1.0)
        elif s.kind != "clause":
            inside = (t >= s.start) & (t <= s.end)
            head[inside] += 0.3 * np.sin(np.pi * (t[inside] - s.start) / (s.end - s.start)) ** 2
    arm += 0.03 * np.sin(0.9 * t + seed)
    rotations = np.repeat(base.rotations[:1], len(t), 0).copy()
    for joint, bend in ((roles["right_upper_arm"], arm), (roles["head"], head)):
        turn = np.stack([np.sin(bend / 2), np.zeros(len(t)), np.zeros(len(t)), np.cos(bend / 2)], axis=-1)
        rotations[:, joint] = rotation.multiply(rotations[:, joint], turn)
    return Clip(
        name,
        base.skeleton,
        fps,
        rotations.astype(np.float32),
        np.repeat(base.translations[:1], len(t), 0),
        base.translated,
    )


@lru_cache(maxsize=1)
def talkers(
    count: int = 4, seconds: float = 20.0
) -> tuple[tuple[Clip, ...], tuple[tuple[Segment, ...], ...]]:
    """Takes of somebody who talks, and what is said in each; made once a process."""
    said = tuple(tuple(speech(seconds, n)) for n in range(count))
    return tuple(talking(f"take{n}", list(s), seconds, n) for n, s in enumerate(said)), said


@lru_cache(maxsize=1)
def talkers_graph() -> DriverGraph:
    """The motion graph of `talkers`, made ready to drive; made once a process."""
    takes, said = talkers()
    states = read_states(takes)
    graph = build_graph(states, keys=key_states(states, changes=find_change_states(states, said)))
    return make_driver_graph(graph, find_heard_at(states, said))


def aloud(
    segments: Sequence[Segment], seconds: float, seed: int, gain: float = 0.0
) -> tuple[list[float], tuple[Word, ...], np.ndarray]:
    """How each segment is said: louder or softer by steps of 6 dB (-1 .. 1), a word of WORDS at each stress
    among others, fast or slow by another chance; and the sound of it `[N]`, all of it louder by `gain` dB.
    """
    chance = np.random.default_rng([seed, 1])
    samples = 0.001 * chance.standard_normal(round(seconds * VOICE))
    steps, words = [float(chance.integers(-1, 2)) for _ in segments], []
    for s, step in zip(segments, steps, strict=True):
        a, b = round(s.start * VOICE), round(s.end * VOICE)
        tone = np.sin(2 * np.pi * 400 * np.arange(b - a) / VOICE)
        samples[a:b] += 0.05 * 10 ** (step * 6 / 20) * tone
        if s.kind == "hesitation":  # the partner's
            continue
        edges = np.linspace(s.start, s.end, int(chance.integers(2, 6)))
        parts = [(float(x), float(y), str(chance.choice(WORDS[:2]))) for x, y in pairwise(edges)]
        for x, y, text in parts:
            stressed = s.peak is not None and x <= s.peak < y
            words.append(Word(text=str(chance.choice(WORDS)) if stressed else text, start=x, end=y))
    return steps, tuple(words), samples * 10 ** (gain / 20)
