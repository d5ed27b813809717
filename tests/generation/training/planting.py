"""Takes that take no time: somebody who moves by chance, and a toy of which the truth is known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import torch

from metagraph.generation.features import RATE
from metagraph.generation.networks import Control, FlowSizes, Kind, MatchingSizes, Sizes
from metagraph.generation.takes import Take, TakeMarks, TakeSound, TakeSource, make_take
from metagraph.generation.train_plan import (
    TrainingPlan,
    TrainingSettings,
    find_training_folder,
    plan_of,
    write_training,
)
from metagraph.generation.training.run import Run
from metagraph.motion.clip import Clip
from tests.generation.makers import babble, conversation, moving, rig, tiny

torch.set_num_threads(1)  # tests run beside each other


def take(seconds: float, seed: int, clip: Clip | None = None, tracks: int = 1) -> Take:
    sound = np.stack([babble(seconds, seed), babble(seconds, seed + 50)])
    source = TakeSource(f"take {seed}", (f"motion {seed}", f"sound {seed}"), "made for a test")
    said = conversation(seconds, seed)
    heard = TakeSound(sound, RATE)
    return make_take(rig(), clip or moving(seconds, seed), heard, source, said, tracks=tracks)


def plan(
    takes: tuple[Take, ...],
    held: tuple[Take, ...],
    kind: Kind = "matching",
    out: str = "m.mgmodel",
    **options: Any,
) -> TrainingPlan:
    """A plan of a tiny model that is over after 12 steps unless told."""
    sizes = options.pop("sizes", None) or tiny(kind)
    own = {"steps": 12, "minutes": 0.0, "threads": 1, **options}
    return plan_of(rig(), takes, held, Path(out), kind, sizes=sizes, **own)


def cut_short(models: Path, name: str, steps: int = 0) -> Path:
    """A training of 40 steps that was killed, with a checkpoint after some; return its model's path."""
    out, both = models / f"{name}.mgmodel", (take(8.0, 1), take(8.0, 2))
    own = plan(
        both[:1],
        both[1:],
        out="elsewhere/x.mgmodel",
        steps=40,
        settings=TrainingSettings(batch=4, frames=40, warm=20),
    )
    find_training_folder(out).mkdir(parents=True)
    write_training(find_training_folder(out), own, both[:1], both[1:])
    run = Run(find_training_folder(out), lambda event: None, deserted=lambda: run.learner.step >= steps)
    assert not steps or run.go() is None
    return out


# --- the toy: an impulse in what is heard starts one of two movements

JOINTS, WIDTH = 3, 5.0  # frames: deviation of a movement's speed


def toy(frames: int, seed: int) -> Take:
    """Somebody who moves one of two joints about each impulse, and else hardly."""
    chance = np.random.default_rng(seed)
    told = np.zeros((frames, 31), np.float32)
    told[:, :27] = 0.3 * chance.standard_normal((frames, 27))
    told[:, 30] = 1
    poses = 0.02 * chance.standard_normal((frames // 5 + 2, 6 * JOINTS))
    poses = np.stack([np.interp(np.arange(frames) / 5, np.arange(len(p)), p) for p in poses.T], 1)
    peaks, at = [], 20
    while at < frames - 20:
        which = int(chance.integers(2))
        bump = np.exp(-0.5 * ((np.arange(frames) - at) / WIDTH) ** 2)
        poses[:, 6 * which : 6 * which + 3] += bump[:, None]
        told[at - 1 : at + 2, :27] += 4
        peaks.append(at / 25)
        at += int(chance.integers(35, 60))
    return Take(TakeSource(f"toy {seed}"), poses.astype(np.float32), told, TakeMarks(tuple(peaks)))


GUESSED = FlowSizes(  # as the Flow-VAE is, but small
    pose=18,
    control=Control(width=16, past=2),
    between=40,
    dims=8,
    steps=4,
    units=32,
    span=4,
    guess=True,
    guided=True,
)


def toy_sizes(kind: Kind, guess: bool = False) -> Sizes:
    if guess:
        return GUESSED
    if kind == "matching":
        return MatchingSizes(
            pose=18,
            dims=8,
            past=3,
            new=4,
            ahead=3,
            hidden=32,
            heads=2,
            layers=2,
            ratio=2,
            time=16,
            width=16,
            around=1,
        )
    return FlowSizes(pose=18, control=Control(width=16), code="pca", dims=8, steps=4, units=32, span=4)


def stroke(poses: Any, toys: Take) -> float:
    """How fast somebody moves about impulses, beside always."""
    speed = np.linalg.norm(np.diff(poses, axis=0), axis=1)
    near = np.zeros(len(speed), bool)
    for peak in toys.marks.peaks:
        at = round(peak * 25)
        near[max(0, at - 8) : at + 8] = True
    return float(speed[near].mean() / speed.mean())
