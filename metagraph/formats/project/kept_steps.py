"""Write the steps that led to a saved project, so that they can be undone after the project is opened again.

Each line holds one step, the newest first, as what changes when it is *undone*. The project's file is where
they begin, so the steps cost as little as the edits did, however large the project is.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from metagraph.formats.project.data import to_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.history import UNNAMED, UndoStep, project_after
from metagraph.formats.project.journal import find_changes
from metagraph.formats.project.replay import Replay
from metagraph.graph.model import Project

MAX_STEPS = 100
MAX_BYTES = 4_000_000  # of all steps of one project


def encode_steps(steps: Sequence[UndoStep]) -> bytes:
    """Return the last steps as lines of JSON: at most MAX_STEPS of them, and at most MAX_BYTES."""
    lines, size = [], 0
    for step in steps[: -MAX_STEPS - 1 : -1]:
        try:
            record = find_changes(step.after, step.before)
        except DataError:
            break  # no file can hold what it changed, nor what came before
        if not record:
            continue  # clips got their motion back, which no file holds
        line = msgspec.json.encode({**record, "step": step.text})
        size += len(line) + 1
        if size > MAX_BYTES:
            break
        lines.append(line)
    return b"\n".join(lines)


def decode_steps(content: bytes, project: Project) -> tuple[UndoStep, ...]:
    """Return the steps that lead to `project`, without the motion of clips; those that can be read."""
    steps: list[UndoStep] = []
    replay, now = Replay(to_data(project)), project
    for line in content.splitlines():
        try:
            record: Data = msgspec.json.decode(line)
            replay.apply(record)
            before = project_after(now, replay, record)
        except (DataError, msgspec.DecodeError, KeyError, TypeError, AttributeError, ValueError):
            break
        steps.insert(0, UndoStep(str(record.get("step") or UNNAMED), before, now))
        now = before
    return tuple(steps)
