"""The window of generated motion: learning from takes, and using what was learned."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QHBoxLayout, QLabel, QPushButton, QTabWidget, QVBoxLayout, QWidget

from app.features.generation.learn_page import LearnPage
from app.features.generation.training_run import begin_training
from app.features.generation.use_page import UsePage
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.within_screen import resize_within_screen
from metagraph.graph.model import Project


class GenerationDialog(QDialog):
    """The dialog of generated motion, which stays open beside the window. Closing it stops a training and
    keeps its last checkpoint.
    """

    def __init__(
        self, document: Document, session: StageSession, jobs: Jobs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document = document
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Generate motion"))
        resize_within_screen(self, 1120, 680)
        self.use = UsePage(document, session, jobs, self)
        self.learn = LearnPage(document, session, jobs, begin_training, self)
        self.tabs = QTabWidget(self)
        self.tabs.setAccessibleName(tr("Generate or learn"))
        self.tabs.addTab(self.use, tr("Generate"))
        self.tabs.addTab(self.learn, tr("Learn from takes"))
        self.said = QLabel(self, wordWrap=True)
        self.said.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        close = QPushButton(tr("Close"), self, autoDefault=False)
        close.clicked.connect(self.close)
        foot = QHBoxLayout()
        foot.addWidget(self.said, 1)
        foot.addWidget(close)
        box = QVBoxLayout(self)
        box.setContentsMargins(14, 12, 14, 12)
        box.setSpacing(10)
        box.addWidget(self.tabs, 1)
        box.addLayout(foot)
        self._words: dict[QWidget, str] = {}  # of each page, the last ones
        for page in (self.use, self.learn):
            page.said.connect(lambda words, page=page: self._say(page, words))
        self.tabs.currentChanged.connect(
            lambda _: self.said.setText(self._words.get(self.tabs.currentWidget(), ""))
        )
        self.learn.trained.connect(self._trained)
        self.finished.connect(self._ended)
        document.changed.connect(self._follow)
        document.loaded.connect(self._leave)
        self._say_begun()
        if self.use.model.count() == 0:
            self.tabs.setCurrentWidget(self.learn)

    def _trained(self, model: Path) -> None:
        self.use.show_model(model)

    def _say(self, page: QWidget, words: str) -> None:
        """Show what a page says, and again whenever that page is looked at."""
        self._words[page] = words
        self.said.setText(words)

    def _say_begun(self) -> None:
        """Report a training that was cut short: it may have been forgotten."""
        cut = self.learn.begun.cut_short()
        if cut:
            for page in (self.use, self.learn):
                self._say(
                    page,
                    tr(
                        "The training of '{cut}' is not finished. Continue it under Learn from takes.",
                        cut=cut,
                    ),
                )

    def _follow(self, before: Project, after: Project) -> None:
        if (
            before.conversations is not after.conversations
            or before.graphs is not after.graphs
            or before.skeleton is not after.skeleton
        ):
            self.use.fill()

    def _leave(self) -> None:
        """Another project comes: what is being made for the one before is not for it."""
        self.use.close_down()
        self.use.table.show_pieces([])
        self.use.fill()
        self.learn.fill()
        self._words.clear()
        self.said.setText("")
        self._say_begun()

    def _ended(self) -> None:
        """It closes: nothing goes on unseen."""
        self.use.close_down()
        self.learn.close_down()
