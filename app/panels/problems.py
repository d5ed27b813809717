"""The problems panel: what is wrong, where, and what to do; a click goes there."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QHeaderView, QLabel, QStackedLayout, QTreeWidget, QTreeWidgetItem, QWidget

from app import icons
from app.session import Session
from app.theme import theme
from metagraph.graph.check import Problem

MOST = 500  # rows; a project with more has one cause, seen long before


class ProblemsPanel(QWidget):
    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.problems: tuple[Problem, ...] = ()
        self._shown: object = None
        self.tree = QTreeWidget(self)
        self.tree.setColumnCount(3)
        self.tree.setHeaderLabels(["Problem", "Where", "What to do"])
        self.tree.setRootIsDecorated(False)
        self.tree.setUniformRowHeights(True)
        self.tree.setAccessibleName("Problems")
        self.tree.header().setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        self.tree.itemActivated.connect(self._go)
        self.tree.itemClicked.connect(self._go)
        self.none = QLabel("No problems. Every stance rests, leads somewhere and comes back.", self)
        self.none.setProperty("dim", True)
        self.none.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.stack = QStackedLayout(self)
        self.stack.addWidget(self.none)
        self.stack.addWidget(self.tree)
        session.theme_changed.connect(lambda: self.show_problems(self.problems))

    def show_problems(self, problems: Sequence[Problem]) -> None:
        look = theme(self.session.theme)
        state = tuple(problems), look.name, self.session.document.project.graphs
        if state == self._shown:
            return
        self.problems, self._shown = tuple(problems), state
        self.tree.clear()
        colors = {"error": look.error, "warning": look.warning, "hint": look.dim}
        project = self.session.document.project
        for problem in self.problems[:MOST]:
            stance = project.stance(problem.stance)
            place = ", ".join(x for x in (problem.layer or "", stance.name if stance else "") if x) or "project"
            item = QTreeWidgetItem([problem.message, place, problem.remedy])
            item.setIcon(0, icons.icon("warning", colors[problem.severity]))
            item.setForeground(0, QColor(look.text if problem.severity != "hint" else look.dim))
            item.setToolTip(0, f"{problem.severity}: {problem.message}. {problem.remedy}")
            item.setData(0, Qt.ItemDataRole.UserRole, problem)
            self.tree.addTopLevelItem(item)
        self.tree.setColumnWidth(0, 620)
        self.tree.setColumnWidth(1, 190)
        self.stack.setCurrentIndex(1 if self.problems else 0)

    def _go(self, item: QTreeWidgetItem, column: int = 0) -> None:
        problem = item.data(0, Qt.ItemDataRole.UserRole)
        if isinstance(problem, Problem):
            self.session.jump(problem.layer, problem.stance, problem.action, problem.clip)
