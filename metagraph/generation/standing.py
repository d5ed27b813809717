"""Find trainings that were started, and how far they got, to continue them after a stop or a crash. This
module does not use torch.
"""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import msgspec
import numpy as np
from msgspec import Struct

from metagraph.errors import FileError
from metagraph.formats.project.kernel_lock import try_hold
from metagraph.generation.stored import SUFFIX
from metagraph.generation.train_plan import FOLDER, PLAN, TrainingPlan, read_training_plan

FORMAT = 1  # of checkpoints
TOLD = "told"
CHECKPOINTS = "checkpoint.*.npz"
LOCK = "lock"
UNREADABLE = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, msgspec.DecodeError)


class CheckpointNote(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a checkpoint keeps beside arrays. plan: fingerprint of the plan that it belongs to. seconds: of
    the processor, minutes: of the clock that were used so far. numbers: last ones shown.
    """

    format: int = FORMAT
    plan: str
    step: int
    seconds: float
    minutes: float
    numbers: dict[str, float] = {}


@dataclass(frozen=True)
class Standing:
    """A training that was begun. out: where its model goes; kept: whether one is there. plan: what it was
    asked to do; step, seconds, minutes: as far as its last checkpoint got, 0 before the first; share: of the
    whole, 0..1.
    """

    out: Path
    kept: bool
    plan: TrainingPlan
    step: int
    seconds: float
    minutes: float

    @property
    def share(self) -> float:
        return measure_training_share(self.plan, self.step, self.seconds, self.minutes)


def measure_training_share(plan: TrainingPlan, step: int, seconds: float, minutes: float) -> float:
    """Return how much of a training is over, 0..1."""
    used = ((seconds, plan.seconds), (minutes, plan.minutes), (float(step), plan.steps))
    return min(1.0, max((value / most for value, most in used if most), default=0.0))


def find_begun_trainings(folder: Path) -> list[Standing]:
    """Return the trainings in a folder of models, those that are not over first, each by name. What cannot be
    gone on with is left out; nothing is raised.
    """
    found = []
    for training in sorted(folder.glob(f"*{SUFFIX}{FOLDER}")):
        standing = read_standing(training)
        if standing is not None:
            found.append(standing)
    return sorted(found, key=lambda s: s.share >= 1)


def read_standing(training: Path) -> Standing | None:
    """Return how far the training in a folder got, or None if there is none to continue."""
    try:
        plan = read_training_plan(training)
    except FileError:
        return None
    out, name = training.with_name(training.name.removesuffix(FOLDER)), plan.fingerprint()
    last = CheckpointNote(plan=name, step=0, seconds=0.0, minutes=0.0)
    for path in training.glob(CHECKPOINTS):
        try:
            with path.open("rb") as content, np.load(content, allow_pickle=False) as file:
                told = read_checkpoint_note(file[TOLD])
        except UNREADABLE:
            continue  # the other one is whole
        if told.plan == name and told.step > last.step:
            last = told
    return Standing(out, out.is_file(), plan, last.step, last.seconds, last.minutes)


def read_checkpoint_note(array: np.ndarray) -> CheckpointNote:
    """Return what a checkpoint's member TOLD says. Raises ValueError, msgspec.DecodeError."""
    told = msgspec.json.decode(array.tobytes(), type=CheckpointNote)
    if told.format != FORMAT:
        raise ValueError(f"it has format {told.format}, this version reads {FORMAT}")
    return told


def hold(training: Path) -> IO[bytes] | None:
    """Take a training's folder for this process until what is returned is closed, or the process ends however
    it ends; None if another process has it. Raises OSError if nothing can be written.
    """
    return try_hold(training / LOCK)


def is_busy(training: Path) -> bool:
    """Whether some process works in a training's folder."""
    if not (training / PLAN).is_file():
        return False
    try:
        held = hold(training)
    except OSError:
        return False
    if held is not None:
        held.close()
    return held is None
