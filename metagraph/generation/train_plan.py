"""What a training is asked to do, and the folder it works in: plan, takes, checkpoints. No torch here:
the window and the command line make plans, the training reads them.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta, Struct

from metagraph.common.network_paths import find_refusal
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.generation.features import count_audio
from metagraph.generation.networks import Kind, Size, Sizes, make_sizes
from metagraph.generation.poses import PoseRig
from metagraph.generation.stored import SkeletonCard, TakeCard, make_skeleton_card
from metagraph.generation.takes import Take, TakeMarks, TakeSource, check_split

Loss = Literal["paper", "finished", "matching", "evidence"]
PLAN, TAKES, STOP = "plan.json", "takes.npz", "stop"
FOLDER = ".training"  # what is added to a model's name
_MARKS = ("peaks", "responses", "hesitations")
_REMEDY = "Begin the training anew; the takes are read again."
_Share = Annotated[float, Meta(ge=0, le=1)]
_Positive = Annotated[float, Meta(gt=0)]
_Weight = Annotated[float, Meta(ge=0)]


class TrainingSettings(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a model is trained.

    loss: `paper`, as in the paper; `finished`, the likelihood alone of a code that is finished beforehand;
    None: what suits the sizes. batch: crops a step; frames: of a crop. rate, least, warm: of Noam's decay:
    the largest and smallest rate, steps to the largest. calm: the last share of a training, in which the rate
    goes down. clip: norm of the gradient, 0 for any. past_dropped: share of past frames (of pasts, for
    tokens and codes) not told, while a guess knows them; past_noise: deviation of noise on past codes and
    tokens; sound_dropped: share of chunks (of crops, for a flow that can be guided) that see who speaks and
    hear nothing. alpha: weight of the likelihood, in
    bits; third: of the paper's third term; noise: deviation on a finished code of poses. tuned: steps of an
    autoencoder before it is finished. head: weight of the head that predicts speeds. known: share of
    stretches that know all ahead. kept: of the running mean of weights, a step; 0 for the weights themselves.
    voices: share of crops that sound otherwise (`training.voices`), so that a model does not learn one voice
    in one room. early, spread: flow matching asks for velocities at t = sigmoid(N(-early, spread)): near the
    noise it is settled whether something rare happens. turns: crops in which who speaks changes n times weigh
    (1 + n)^turns; only what is heard decides, so that what is learned of it stays unbiased. unmarked: share
    of crops whose marks are not known, of those that know all ahead; of the others, UNMARKED. Live, marks are
    not known.
    """

    loss: Loss | None = None
    batch: Annotated[int, Meta(ge=1, le=4096)] = 64
    frames: Annotated[int, Meta(ge=8, le=4096)] = 128
    rate: _Positive = 1.5e-3
    least: _Positive = 1.5e-4
    warm: Annotated[int, Meta(ge=1)] = 600
    calm: _Share = 0.2
    clip: _Weight = 5.0
    past_dropped: _Share = 0.4
    past_noise: _Weight = 0.05
    sound_dropped: _Share = 0.1
    alpha: _Weight | None = None
    third: _Weight | None = None
    noise: _Weight = 0.01
    tuned: Annotated[int, Meta(ge=0)] = 1500
    head: _Weight = 0.5
    known: _Share = 0.7
    kept: _Share = 0.999
    voices: _Share = 0.7
    early: float = 0.7
    spread: _Positive = 1.2
    turns: Annotated[float, Meta(ge=0, le=8)] = 1.5
    unmarked: _Share = 0.15


def choose_settings(loss: Loss | None, kind: Kind = "matching") -> TrainingSettings:
    """Return the settings of a training by a loss: by the paper's nothing is done that the paper does not.
    kind: what is trained; a Flow-VAE that is not the paper's learns longer crops at a rate that stays high
    for longer.
    """
    if loss == "paper":
        return TrainingSettings(
            loss=loss,
            calm=0.0,
            clip=0.0,
            past_noise=0.0,
            noise=0.0,
            tuned=0,
            head=0.0,
            known=1.0,
            kept=0.0,
            voices=0.0,
            turns=0.0,
        )
    if kind == "flow-vae":
        return TrainingSettings(
            loss=loss,
            batch=32,
            frames=256,
            rate=2e-3,
            warm=800,
            known=0.9,
            past_dropped=0.3,
            sound_dropped=0.15,
            head=1.0,
            voices=0.3,
        )
    return TrainingSettings(loss=loss)


class TrainingPlan(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Everything a training knows beside its takes' arrays, which lie in the same folder. seed: of the first
    weights, of crops and noise. minutes: of the clock, seconds: of the processor, steps: what is over first
    ends it, also over several runs; 0 is no limit. threads: 0 as many as torch likes. takes, held: in the
    order of the arrays. out: path of the model's file.
    """

    format: int = 1
    kind: Kind = "matching"
    size: Size = "small"
    sizes: Sizes
    settings: TrainingSettings = TrainingSettings()
    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)] = 1
    minutes: _Weight = 15.0
    seconds: _Weight = 0.0
    steps: Annotated[int, Meta(ge=0)] = 0
    threads: Annotated[int, Meta(ge=0, le=256)] = 0
    checkpoint: _Positive = 60.0
    judged: _Positive = 60.0
    tracks: Annotated[int, Meta(ge=1, le=2)] = 1
    skeleton: SkeletonCard
    takes: tuple[TakeCard, ...]
    held: tuple[TakeCard, ...]
    out: str

    def fingerprint(self) -> str:
        """Return what is the same for plans that can go on from each other's checkpoints."""
        same = {"minutes": 0.0, "seconds": 0.0, "steps": 0, "threads": 0, "out": ""}
        free = msgspec.structs.replace(self, **same, checkpoint=1.0, judged=1.0)
        return sha256(msgspec.json.encode(free)).hexdigest()


def plan_of(
    rig: PoseRig,
    takes: Sequence[Take],
    held: Sequence[Take],
    out: Path,
    kind: Kind = "matching",
    size: Size = "small",
    tracks: int = 1,
    sizes: Sizes | None = None,
    **options: Any,
) -> TrainingPlan:
    """Return a plan. sizes: those of kind and size unless given; by the paper's loss, as it is published.
    options: further fields of the plan. Raises SplitError if a take held out is learned from.
    """
    check_split(takes, held)
    options = {"settings": choose_settings(None, kind), **options}
    published = options["settings"].loss == "paper"
    return TrainingPlan(
        kind=kind,
        size=size,
        sizes=make_sizes(kind, size, rig.numbers, count_audio(kind, tracks), published)
        if sizes is None
        else sizes,
        tracks=tracks,
        skeleton=make_skeleton_card(rig),
        takes=tuple(make_take_card(t) for t in takes),
        held=tuple(make_take_card(t) for t in held),
        out=str(out.resolve()),
        **options,
    )


def make_take_card(take: Take) -> TakeCard:
    """Return what a model keeps of a take that it has seen."""
    s = take.source
    return TakeCard(
        name=s.name, sha256=s.digests, licence=s.licence, seconds=take.seconds, mirrored=s.mirrored
    )


def find_training_folder(out: Path) -> Path:
    """Return the folder that a model's training works in, beside its file."""
    return out.with_name(out.name + FOLDER)


def write_plan(folder: Path, plan: TrainingPlan) -> None:
    """Write a plan, whole or not at all. Raises FileError."""
    write_atomically(folder / PLAN, msgspec.json.format(msgspec.json.encode(plan), indent=1))


def write_training(folder: Path, plan: TrainingPlan, takes: Sequence[Take], held: Sequence[Take]) -> None:
    """Make the folder of a training that begins: what was in it of another is gone. Raises FileError."""
    arrays: dict[str, Any] = {}
    for n, take in enumerate((*takes, *held)):
        arrays |= {f"{n}.poses": take.poses, f"{n}.features": take.features}
        arrays |= {f"{n}.{mark}": np.array(getattr(take.marks, mark), np.float64) for mark in _MARKS}
        arrays[f"{n}.start"] = np.array(take.source.start)
    content = io.BytesIO()
    np.savez(content, **arrays)
    for old in (folder / PLAN, *folder.glob("checkpoint.*.npz"), folder / STOP):
        old.unlink(missing_ok=True)
    write_atomically(folder / TAKES, content.getvalue())
    write_plan(folder, plan)  # the last one: a folder with a plan is whole


def read_training_plan(folder: Path) -> TrainingPlan:
    """Read a training's plan. Raises FileError."""
    path = folder / PLAN
    try:
        plan = msgspec.json.decode(path.read_bytes(), type=TrainingPlan)
    except FileNotFoundError:
        raise FileError(
            path, "there is no training to go on with", remedy="Begin one: leave 'resume' out."
        ) from None
    except (OSError, msgspec.DecodeError, ValueError) as error:
        raise FileError(path, f"is no training's plan ({error})", remedy=_REMEDY) from None
    if (why := find_refusal(plan.out, folder)) is not None:
        raise FileError(path, f"its model's file is not written: {why}", plan.out[:200], _REMEDY)
    return plan


def read_planned_takes(folder: Path, plan: TrainingPlan) -> tuple[tuple[Take, ...], tuple[Take, ...]]:
    """Read the takes to learn from, and those held out. Raises FileError."""
    path, out = folder / TAKES, []
    try:
        # The file is opened here: NumPy leaves open what it cannot read.
        with path.open("rb") as content, np.load(content, allow_pickle=False) as arrays:
            for n, card in enumerate((*plan.takes, *plan.held)):
                marks = TakeMarks(*(tuple(arrays[f"{n}.{mark}"].tolist()) for mark in _MARKS))
                source = TakeSource(
                    card.name, card.sha256, card.licence, float(arrays[f"{n}.start"]), card.mirrored
                )
                take = Take(source, arrays[f"{n}.poses"], arrays[f"{n}.features"], marks)
                if len(take.poses) != len(take.features) or take.poses.ndim != 2:
                    raise ValueError(f"take {n + 1} has arrays of different lengths")
                out.append(take)
    except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise FileError(path, f"is damaged ({error})", remedy=_REMEDY) from None
    return tuple(out[: len(plan.takes)]), tuple(out[len(plan.takes) :])
