"""Find the current problems of the project on a thread after each edit, merge them with flagged jumps, and
find what fixes them with a press.
"""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.compatibility_state import Compatibility, merge_problems
from app.stage.fixes import Fix, fix_clips, fix_unreachable
from app.stage.session import StageSession
from app.translation import tr_phrase
from metagraph.graph.check import check_project
from metagraph.graph.problem import Problem

Checked = tuple[list[Problem], dict[Problem, Fix]]

AFTER = 250  # milliseconds without edits before problems are searched


class ProblemWatch(QObject):
    """Watches the project's problems. `changed` is emitted when `problems` and `misfits` are up to date.
    `misfits` has words for each action with problems, by id. `fixes` has fixes for some of the problems.
    """

    changed = Signal()

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
        self._soon = QTimer(self, singleShot=True, interval=AFTER)
        self._soon.timeout.connect(self._check)
        document.changed.connect(lambda before, after: self._soon.start())
        session.onstage.mode_changed.connect(self._merge)
        compatibility.changed.connect(self._merge)

    def stop(self) -> None:
        self._soon.stop()

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
        self.problems = merge_problems(found, flags)
        self.fixes = {**flags, **self._bridges}
        self.misfits = {
            p.action: f"{tr_phrase(p.message)}. {tr_phrase(p.remedy)}"
            for p in self.problems
            if p.action and p.severity != "hint"
        }
        self.changed.emit()
