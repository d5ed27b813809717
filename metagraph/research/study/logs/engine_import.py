"""Logs of people who did a study's tasks in an engine itself: a third condition beside the two of this
program.

The scripts in `engine_logs` write them, in the form of a sitting's log; what they cannot see (operators,
what an edit was about, the machine that came of it) is not there.
"""

from __future__ import annotations

from pathlib import Path

from metagraph.common.budgets import LOG_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.research.study.logs.log import StudyLog, read_log
from metagraph.research.study.study_plan import Study

ENGINES = ("unreal", "unity", "godot", "blender")
REMEDY = "Take the file that the script for the engine told of, whole."


def list_engine_logs(study: Study, participant: str) -> list[Path]:
    """Return the logs of engines that were imported for a participant."""
    return [p for e in ENGINES if (p := study.data(participant) / f"engine-{e}.jsonl").is_file()]


def import_engine(study: Study, participant: str, path: Path) -> tuple[StudyLog, list[str]]:
    """Copy an engine's log to a participant's data; return it, and what is odd about it in words. Raises
    FileError if it is none, is another's, or one of that engine is there already; ValueError for a stranger.
    """
    study.plan.known(participant)
    log = read_log(path)
    begin = next((e for e in log.events if e["type"] == "begin"), {})
    engine = begin.get("engine")
    if engine not in ENGINES:
        raise FileError(path, "is no log of Unreal, Unity, Godot or Blender", "its begin", REMEDY)
    if begin.get("participant") != participant:
        raise FileError(
            path, f"is of '{begin.get('participant')}', not of '{participant}'", "its begin", REMEDY
        )
    runs = log.tasks()
    if not runs:
        raise FileError(path, "no task was begun in it", "its phases", REMEDY)
    known = {t.id for t in study.plan.tasks}
    odd = [*log.problems]
    odd += [f"the study has no task '{r.task}'" for r in runs if r.task not in known]
    odd += [f"task '{r.task}' was not finished" for r in runs if not r.finished]
    target = study.data(participant) / f"engine-{engine}.jsonl"
    if target.is_file():
        raise FileError(
            target, "is there already", participant, "Delete it first, if it is to be another one."
        )
    write_atomically(target, read_file(path, LOG_FILE))
    return log, odd
