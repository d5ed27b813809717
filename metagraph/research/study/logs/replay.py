"""A sitting seen again from its log: what the project was at any moment, and what was looked at."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.replay import Replay
from metagraph.graph.model import Project
from metagraph.research.study.plan.task_projects import make_task_project
from metagraph.research.study.scores.tasks import Event, list_event_steps
from metagraph.research.study.study_plan import Study

CHANGES = frozenset({"edit", "undo", "redo"})
DETAILED = "change"  # the field of an edit that says what became of the project


@dataclass(frozen=True)
class SittingPart:
    """One task, or practice, of a sitting. times: seconds of each event from its begin, ascending; pauses and
    gaps count, the time between two runs of the program does not.
    """

    condition: str
    task: str | None
    title: str
    events: tuple[Event, ...]
    times: tuple[float, ...]

    @property
    def seconds(self) -> float:
        return self.times[-1] if self.times else 0.0

    @property
    def silent(self) -> int:
        """Return how many edits do not say what they changed, as logs of older versions do not."""
        return sum(e["type"] == "edit" and DETAILED not in e for e in self.events)

    def until(self, seconds: float) -> int:
        """Return how many events there were up to a moment."""
        return bisect_right(self.times, seconds)


def list_sitting_parts(study: Study, events: Sequence[Event]) -> list[SittingPart]:
    """Return what somebody worked on, in its order."""
    out: list[SittingPart] = []
    begun: Event | None = None
    kept: list[Event] = []
    times: list[float] = []
    at = 0.0
    for event, seconds, _ in list_event_steps(events):
        at += seconds
        if begun is not None:
            kept.append(event)
            times.append(at)
        if event["type"] != "phase":
            continue
        if begun is not None:
            out.append(_part(study, begun, kept, times))
        starts = event.get("state") == "begin" and event.get("name") in ("task", "training")
        begun = event if starts else None
        kept, times, at = [], [], 0.0
    if begun is not None:
        out.append(_part(study, begun, kept, times))
    return out


def _part(study: Study, begun: Event, events: Sequence[Event], times: Sequence[float]) -> SittingPart:
    task = str(begun["task"]) if "task" in begun else None
    try:
        title = study.plan.task(task).name if task is not None else "Practice"
    except KeyError:
        title = str(task)
    return SittingPart(str(begun.get("condition", "")), task, title, tuple(events), tuple(times))


def load_first_project(study: Study, part: SittingPart) -> Project:
    """Return the project the work began with, its clips with their motion and absolute paths. Raises
    FileError, also where the study has no such task any more.
    """
    plan = study.plan
    if part.task is not None:
        task = next((t for t in plan.tasks if t.id == part.task), None)
        clips = task.clips if task is not None else ()
        return make_task_project(
            study, clips, part.title, study.reference(part.task) if task is not None else None
        )
    training = next((t for t in plan.training if t.condition == part.condition), None)
    return make_task_project(study, training.clips if training is not None else (), part.title)


@dataclass
class Again:
    """A project as it was, event by event. folder: of the sitting, which paths are relative to. failed:
    events whose change did not fit, from where on the work may look differently.
    """

    first: Project
    folder: Path
    done: int = 0
    failed: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.rewind()

    def rewind(self) -> None:
        """Go back to the begin."""
        self._data = Replay(to_data(self.first))
        self.done = 0
        self.failed.clear()

    def step(self, event: Event) -> bool:
        """Work an event in; return whether the project is another one now."""
        self.done += 1
        change = event.get(DETAILED)
        if event["type"] not in CHANGES or not isinstance(change, dict):
            return False
        try:
            self._data.apply(_absolute(change, self.folder))
        except (KeyError, TypeError, AttributeError):
            self.failed.append(int(event["n"]))
            return False
        return True

    def project(self) -> Project:
        """Return the project as it is now, its clips without motion. Raises DataError."""
        return from_data(self._data.data())


def _absolute(change: Data, folder: Path) -> Data:
    """Return a change whose clips have absolute paths, as the project has."""
    clips = change.get("clips")
    if not isinstance(clips, dict):
        return change
    moved: dict[str, Any] = {
        ident: {**clip, "path": (folder / clip["path"]).resolve().as_posix()}
        if clip and "path" in clip
        else clip
        for ident, clip in clips.items()
    }
    return {**change, "clips": moved}


def replay_to(
    study: Study, participant: str, part: SittingPart, seconds: float, first: Project | None = None
) -> Project:
    """Return the project as it was at a moment of a part. Raises FileError, DataError."""
    again = Again(first if first is not None else load_first_project(study, part), study.data(participant))
    for event in part.events[: part.until(seconds)]:
        again.step(event)
    return again.project()


__all__ = [
    "CHANGES",
    "Again",
    "DataError",
    "SittingPart",
    "list_sitting_parts",
    "load_first_project",
    "replay_to",
]
