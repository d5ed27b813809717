"""Show the result of an import in one line above the status bar, with a button for each remedy."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QSizePolicy, QToolBar, QToolButton, QWidget

from app.look.theme import strengthen
from app.project.document import Document
from app.project.importing import Importing
from app.translation import tr, tr_noop, tr_phrase
from app.widgets.making import make_widget
from metagraph.common.extras import find_missing_extra
from metagraph.formats.import_words import (
    Remedy,
    count_alike,
    describe_import,
    describe_imported,
    list_remedies,
)
from metagraph.formats.imports import Imported
from metagraph.graph.model import Project

NEXT = tr_noop("Next: choose Label clips, or drag them onto the nodes of the graph.")


class ImportLine(QToolBar):
    """What was left out and what to do about it; where all came in, what to do next, until that is begun.

    do: what the remedies that concern no clips are done by, by name. show: shows (title, lines).
    """

    def __init__(
        self,
        document: Document,
        importing: Importing,
        do: Callable[[str], object],
        show: Callable[[str, list[str]], object],
        parent: QWidget,
    ) -> None:
        super().__init__(tr("Import"), parent)
        self.importing, self._do, self._show = importing, do, show
        self.setObjectName("import line")
        self.setMovable(False)
        self.toggleViewAction().setVisible(False)
        self.result: Imported | None = None
        self.offered: list[QPushButton] = []  # the remedies, in order
        held = QWidget(self)
        row = QHBoxLayout(held)
        row.setContentsMargins(8, 2, 2, 2)
        row.setSpacing(6)
        self.words = QLabel(held)
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        row.addWidget(self.words, 1)
        self.buttons = QHBoxLayout()
        self.buttons.setSpacing(6)
        row.addLayout(self.buttons)
        self.why = make_widget(
            QToolButton, held, text=tr("Details…"), toolTip=tr("Show what was not imported, and why")
        )
        self.why.clicked.connect(self._details)
        self.close_button = make_widget(QToolButton, held, text="✕", toolTip=tr("Dismiss this message"))
        self.close_button.setAccessibleName(tr("Close"))
        self.close_button.clicked.connect(self.forget)
        row.addWidget(self.why)
        row.addWidget(self.close_button)
        self.addWidget(held)
        self.hide()
        importing.ended.connect(self.tell)
        document.loaded.connect(self.forget)
        document.changed.connect(self._edited)
        self._document = document

    def tell(self, result: Imported) -> None:
        """Show the result of an import."""
        self.forget()
        words = describe_import(result)
        unlabelled = self._unlabelled(result)
        fresh = not result.failures and not result.apart and unlabelled
        if not fresh and not result.failures and words == describe_imported(result):
            return
        if fresh and self.importing.guided and words == describe_imported(result):
            return
        if fresh:
            words = f"{tr_phrase(words)}. {tr(NEXT)}"
            self._offer(tr("Label clips…"), lambda: self._do("propose"))
        self.result, self._fresh = result, fresh
        self.words.setText(tr_phrase(words))
        self.words.setToolTip(tr_phrase(words))
        self.why.setVisible(bool(result.failures or result.notes))
        if any(find_missing_extra(line) for line in result.failures):
            self._offer(tr("Extras…"), lambda: self._do("extras"))
        for remedy in list_remedies(result):
            self._offer(tr_phrase(remedy.label), partial(self._mend, remedy))
        if unlabelled and not fresh:  # what came in goes on all the same
            self._offer(tr("Label clips…"), lambda: self._do("propose"))
        self.show()

    def _offer(self, label: str, do: Callable[[], object]) -> None:
        button = make_widget(QPushButton, self, text=label)
        strengthen(button)
        button.clicked.connect(lambda: do())
        self.buttons.addWidget(button)
        self.offered.append(button)

    def _unlabelled(self, result: Imported) -> bool:
        """Return whether anything came in that serves as nothing yet."""
        return bool(result.loaded) and bool(self.importing.load_for(result).clips) and not self._placed()

    def _placed(self) -> bool:
        project = self._document.project
        return all(clip in project.uses or clip in project.drawn for clip in project.clips)

    def _edited(self, before: Project, after: Project) -> None:
        """What was to be done next has begun."""
        if self._fresh and before.graphs is not after.graphs:
            self.forget()

    _fresh = False  # all came in, and it says what to do next

    def forget(self) -> None:
        """Hide the line, when its task is done or another project is opened."""
        self.result, self._fresh = None, False
        self.words.clear()
        for button in self.offered:
            self.buttons.removeWidget(button)
            button.deleteLater()
        self.offered = []
        self.hide()

    def _mend(self, remedy: Remedy) -> None:
        result = self.result
        if result is None:
            return
        if remedy.do == "character":
            self._do("character")
            return
        self.forget()
        self.importing.remedy(result, remedy)

    def _details(self) -> None:
        if self.result is not None:
            lines = count_alike([*self.result.failures, *self.result.notes])
            self._show(tr_phrase(describe_imported(self.result)), [tr_phrase(line) for line in lines])
