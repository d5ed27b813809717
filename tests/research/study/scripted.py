"""Goes through a sitting without a window, as fast as it can, again and again: what is killed to see whether
anything is lost.

`python scripted.py STUDY PARTICIPANT`. Reads from standard input how many bytes of log to live for, and
milliseconds on top: a child is made that works on the sitting and is killed then, and "killed" is printed;
"ended" when the sitting was over before.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

from metagraph.formats.project.journal import Journal, make_journal_path
from metagraph.formats.store import save_project
from metagraph.graph import edits
from metagraph.research.study.plan.task_projects import make_task_project, reopen, write_task_project
from metagraph.research.study.sitting import Sitting
from metagraph.research.study.study_plan import read_study

EDITS = 40  # in each task, each of them another stance


def go_through(study_path: Path, participant: str) -> None:
    study = read_study(study_path)
    sitting = Sitting(study, participant)
    while (phase := sitting.phase) is not None:
        if not phase.works:
            sitting.begin()
            for item in phase.questionnaire.items if phase.questionnaire else ():
                sitting.answer(item.id, 3 if item.scale else "nothing")
            sitting.end()
            continue
        if not sitting.now.begun:
            write_task_project(make_task_project(study, phase.clips, "work"), sitting.file)
            sitting.begin()
        project = reopen(sitting.file)[0].project
        journal = Journal(make_journal_path(sitting.file), sitting.file)
        while len(project.graphs["arms"].stances) < EDITS:
            before, project = (
                project,
                edits.add_stance(project, "arms", f"stance {len(project.graphs['arms'].stances)}"),
            )
            journal.edit(before, project)
            sitting.writer.add("edit", what="stance", words="New stance", clips=[])
            time.sleep(0.001)  # on a fast machine, too, there are moments to be killed at
        save_project(project, sitting.file)
        journal.remove()
        sitting.keep()
    sitting.close()


def main() -> None:
    log = read_study(Path(sys.argv[1])).log(sys.argv[2])
    for line in sys.stdin:
        grown, more = map(float, line.split())
        start = size(log)
        child = os.fork()
        if child == 0:
            go_through(Path(sys.argv[1]), sys.argv[2])
            os._exit(0)
        while size(log) - start < grown and not over(child):
            time.sleep(0.001)
        time.sleep(more / 1000)
        os.kill(child, signal.SIGKILL)  # it waits to be reported about, so that the number is still its own
        status = os.waitpid(child, 0)[1]
        print("killed" if os.WIFSIGNALED(status) else f"ended {os.WEXITSTATUS(status)}", flush=True)


def size(path: Path) -> int:
    return path.stat().st_size if path.exists() else 0


def over(child: int) -> bool:
    return os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None


if __name__ == "__main__":
    main()
