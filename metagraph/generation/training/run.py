"""The training loop: what it learns, tells and keeps, and when it ends."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import torch

from metagraph.errors import FileError
from metagraph.generation.calibration import fit_lengths
from metagraph.generation.networks import count_parameters
from metagraph.generation.standing import CheckpointNote, measure_training_share
from metagraph.generation.train_plan import STOP, TrainingPlan, read_planned_takes, read_training_plan
from metagraph.generation.training.checkpoint import Checkpoint, read_checkpoint, write_checkpoint
from metagraph.generation.training.export import export_model, make_model_so_far
from metagraph.generation.training.judge import LONGEST, SHORT, judge_held_out
from metagraph.generation.training.learner import Learner

Tell = Callable[[Mapping[str, Any]], None]
EVERY = 1.0  # seconds between numbers told
_SMOOTH = 0.95  # of numbers told


class Run:
    """A training in a folder. Raises FileError for one that cannot be read, ValueError for settings that do
    not fit its takes. tell: is given what happens, as `train_process.Event` has it. stopped, deserted: asked
    after each step; deserted: whether nobody is there any more who wants the model.
    """

    def __init__(
        self,
        folder: Path,
        tell: Tell,
        stopped: Callable[[], bool] = lambda: False,
        resume: bool = True,
        deserted: Callable[[], bool] = lambda: False,
    ) -> None:
        self.folder, self.tell, self._stopped, self._deserted = folder, tell, stopped, deserted
        self.plan: TrainingPlan = read_training_plan(folder)
        if self.plan.threads:
            torch.set_num_threads(self.plan.threads)
        self.takes, self.held = read_planned_takes(folder, self.plan)
        self.learner = Learner(self.plan, self.takes)
        self.seconds = self.minutes = 0.0
        self.numbers: dict[str, float] = {}
        point, notes = read_checkpoint(folder, self.plan.fingerprint()) if resume else (None, [])
        for note in notes:
            tell({"event": "note", "text": note})
        if point is not None:
            self.learner.restore(point.told.step, point.arrays)
            self.seconds, self.minutes = point.told.seconds, point.told.minutes
            self.numbers = dict(point.told.numbers)
        self._kept = self.learner.step  # at the last checkpoint

    @property
    def share(self) -> float:
        """How much of the training is over, 0..1."""
        return measure_training_share(self.plan, self.learner.step, self.seconds, self.minutes)

    def go(self) -> Path | None:
        """Learn until it is over or stopped; return the model's file, None if it was deserted: there is a
        checkpoint then, and no model. Raises FileError if it cannot be written, TrainingError if nothing is
        learned; the last checkpoint stays.
        """
        plan, learner = self.plan, self.learner
        self.tell(
            {
                "event": "begin",
                "step": learner.step,
                "parameters": count_parameters(plan.sizes),
                "frames": int(learner.corpus.counts.sum()),
                "threads": torch.get_num_threads(),
                "kind": plan.kind,
            }
        )
        told = kept = shown = time.monotonic()
        stopped = False
        while self.share < 1 and not stopped:
            clock, used = time.monotonic(), time.process_time()
            found = learner.advance(self.share)
            for name, value in found.items():
                before = self.numbers.get(name, value)
                self.numbers[name] = value if name == "rate" else _SMOOTH * before + (1 - _SMOOTH) * value
            self.seconds += time.process_time() - used
            self.minutes += (time.monotonic() - clock) / 60
            if self._deserted():
                self.keep()
                return None
            now = time.monotonic()
            stopped = self._stopped() or (self.folder / STOP).exists()
            if now - told >= EVERY or self.share >= 1 or stopped:
                told = now
                self.tell(self._told("step", frames=round(learner.step * learner.objective.frames)))
            if now - kept >= plan.checkpoint:
                self.keep()
                kept = time.monotonic()
            if now - shown >= plan.judged and self.held:
                self.judge()
                shown = time.monotonic()
        self.keep()
        (self.folder / STOP).unlink(missing_ok=True)
        return self.finish(stopped)

    def _told(self, event: str, **more: Any) -> dict[str, Any]:
        return {
            "event": event,
            "step": self.learner.step,
            "seconds": round(self.seconds, 2),
            "minutes": round(self.minutes, 4),
            "share": round(self.share, 4),
            "numbers": {n: round(v, 6) for n, v in self.numbers.items()},
            **more,
        }

    def keep(self) -> None:
        """Write a checkpoint where there is something new. One that cannot be written is reported, and tried
        again the next time: what was learned is still in memory, and the one before is as it was.
        """
        if self._kept == self.learner.step:
            return
        told = CheckpointNote(
            plan=self.plan.fingerprint(),
            step=self.learner.step,
            seconds=self.seconds,
            minutes=self.minutes,
            numbers=self.numbers,
        )
        try:
            path = write_checkpoint(self.folder, Checkpoint(told, self.learner.state()))
        except FileError as error:
            self.tell({"event": "note", "text": f"The training goes on, but is not kept: {error}"})
            return
        self._kept = self.learner.step
        self.tell({"event": "checkpoint", "step": self.learner.step, "path": str(path)})

    def judge(self) -> None:
        """Report the statistics of a short sample, and some of its poses."""
        found, poses = judge_held_out(make_model_so_far(self.learner), self.held, SHORT)
        self.tell(self._told("statistics", statistics=found))
        self.tell(self._told("poses", landmarks=poses))

    def finish(self, stopped: bool = False) -> Path:
        """Write the model's file of what was learned so far."""
        self.tell(self._told("finish", stopped=stopped))
        notes = ("stopped before its time was over",) if stopped else ()
        model = fit_lengths(make_model_so_far(self.learner, notes=notes), self.takes)
        found: dict[str, float] = {}
        if self.held:
            found, _ = judge_held_out(model, self.held, SHORT if stopped else LONGEST)
        out = Path(self.plan.out)
        export_model(replace(model, card=msgspec.structs.replace(model.card, statistics=found)), out)
        self.tell(self._told("end", path=str(out), statistics=found, stopped=stopped))
        return out
