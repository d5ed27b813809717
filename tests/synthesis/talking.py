"""Takes of somebody who talks: an arm swings at the stresses of what is said, the head nods with answers."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np

from metagraph.formats.clips import read_clips
from metagraph.graph.conversation import Segment
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.synthesis.constraints import changes, heard
from metagraph.synthesis.extending import DriverGraph, driver_graph
from metagraph.synthesis.graph import build
from metagraph.synthesis.states import key_states, states_of

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


def talking(name: str, segments: list[Segment], seconds: float, seed: int = 1, fps: float = FPS) -> Clip:
    """A take in which the right arm is fastest at the stress of each clause, and answers and hesitations go
    with a nod.
    """
    base = read_clips(CLIPS / "hands_at_sides__stance.glb")[0]
    chance = np.random.default_rng(seed)
    t = np.arange(round(seconds * fps)) / fps
    roles = find_roles(base.skeleton)
    arm, head = np.zeros(len(t)), np.zeros(len(t))
    for s in segments:
        if s.kind == "clause" and s.peak is not None:
            up = 0.5 + 0.5 * np.tanh((t - s.peak) / 0.1)  # fastest at the stress
            down = 0.5 + 0.5 * np.tanh((t - s.end - 0.15) / 0.2)
            arm += chance.uniform(0.7, 0.9) * (up - down)
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
    states = states_of(takes)
    graph = build(states, keys=key_states(states, changes=changes(states, said)))
    return driver_graph(graph, heard(states, said))
