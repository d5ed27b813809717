"""Find the current problems of the project on a thread after each edit, merge them with flagged jumps, and
find what fixes them with a press.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import is_

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.compatibility_state import Compatibility, merge_problems
from app.stage.fixes import Fix, fix_unreachable
from app.stage.remedies import fix_clips
from app.stage.session import StageSession
from app.translation import tr, tr_phrase
from metagraph.graph.check import check_project
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem
from metagraph.playback.rehearsal import rehearse

Checked = tuple[list[Problem], dict[Problem, Fix]]

AFTER = 250  # milliseconds without edits before problems are searched


class ProblemWatch(QObject):
    """Watches the project's problems. `changed` is emitted when `problems` and `misfits` are up to date.
    `misfits` has words for each action with problems, by id. `fixes` has fixes for some of the problems.
    """

    changed = Signal()
    played = Signal(bool)  # begun, or over
    progressed = Signal(int)  # percent of the playing that is done

    def __init__(
        self,
        document: Document,
        session: StageSession,
        jobs: Jobs,
        compatibility: Compatibility,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs, self.compatibility = document, session, jobs, compatibility
        self.problems: tuple[Problem, ...] = ()
        self.misfits: dict[str, str] = {}
        self.fixes: dict[Problem, Fix | None] = {}
        self._bridges: dict[Problem, Fix] = {}
        self._found: tuple[Problem, ...] = ()  # by `check_project`, without the flagged jumps
        self._busy = False
        self._seen: tuple[tuple[Problem, tuple[object, ...]], ...] = ()  # as it played, with what was played
        self._seen_fixes: dict[Problem, Fix] = {}
        self.is_playing = False
        self._soon = QTimer(self, singleShot=True, interval=AFTER)
        self._soon.timeout.connect(self._check)
        document.changed.connect(lambda before, after: self._soon.start())
        session.onstage.mode_changed.connect(self._merge)
        compatibility.changed.connect(self._merge)

    def stop(self) -> None:
        self._soon.stop()

    def play(self) -> None:
        """Play ten minutes and each action once, and add what a viewer would see go wrong; it takes about a
        minute. What is found stays until the action it is about, or its clip, is edited.
        """
        if self.is_playing:
            return
        self.is_playing = True
        project = self.document.project
        job = self.jobs.start(
            tr("Playing the character and checking what is seen"),
            lambda job: rehearse(project, progress=job.tell, cancelled=lambda: job.cancelled),
            lambda problems: self._show_seen(project, problems),
        )
        job.progress.connect(self._progress)
        job.ended.connect(self._over)
        self.played.emit(True)

    def _show_seen(self, project: Project, problems: Sequence[Problem]) -> None:
        self._seen = tuple((p, _subject(project, p)) for p in problems)
        self._seen_fixes = fix_clips(project, problems)
        self._merge()

    def _progress(self, done: int, total: int, words: str = "") -> None:
        if self.is_playing and total > 0:
            self.progressed.emit(100 * done // total)

    def _over(self) -> None:
        self.is_playing = False
        self.played.emit(False)

    def _check(self) -> None:
        if self._busy:
            self._soon.start()
            return
        self._busy = True
        project = self.document.project

        def work(_: object) -> Checked:
            problems = check_project(project)
            return problems, {**fix_unreachable(project, problems), **fix_clips(project, problems)}

        self.jobs.start("check", work, self._checked, lambda e: self._checked(([], {})), quick=True)

    def _checked(self, result: Checked) -> None:
        self._busy = False
        problems, self._bridges = result
        self._found = tuple(problems)
        self._merge()

    def _merge(self) -> None:
        """Merge the problems; those of the graph that is not edited now are left out."""
        meta = self.session.onstage.mode == "meta"
        found = tuple(p for p in self._found if not (p.state or p.link if meta else p.stance or p.action))
        flags = self.compatibility.flags if meta else {}
        project = self.document.project
        seen = tuple(p for p, about in self._seen if meta and _same(_subject(project, p), about))
        self.problems = merge_problems((*seen, *found), flags)
        self.fixes = {**flags, **self._bridges, **self._seen_fixes}
        self.misfits = {
            p.action: f"{tr_phrase(p.message)}. {tr_phrase(p.remedy)}"
            for p in self.problems
            if p.action and p.severity != "hint"
        }
        self.changed.emit()


def _subject(project: Project, problem: Problem) -> tuple[object, ...]:
    """Return what a problem is about: the action and its clip, else the stance, else the project's graphs; of
    arms inside the body also what the project says of hands.
    """
    action = project.action(problem.action or "")
    touch = (project.touch,) if problem.code == "play-arm-inside" else ()
    if action is not None:
        return action, project.clips.get(action.clip), *touch
    return project.stance(problem.stance) or project.graphs, *touch


def _same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    return len(one) == len(other) and all(map(is_, one, other))
