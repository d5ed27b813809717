"""What came of an import, in one line over the status bar, with a button for everything there is to do
about it.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QSizePolicy, QToolBar, QToolButton, QWidget

from app.look.theme import strengthen
from app.project.document import Document
from app.project.importing import Importing
from app.widgets.making import make_widget
from metagraph.formats.import_words import Remedy, counted, head, remedies, said
from metagraph.formats.imports import Imported


class ImportLine(QToolBar):
    """Hidden while there is nothing to say but how many clips came in, which the status bar tells.

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
        super().__init__("Import", parent)
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
        self.why = make_widget(QToolButton, held, text="Details…", toolTip="What was left out, and why")
        self.why.clicked.connect(self._details)
        self.close_button = make_widget(QToolButton, held, text="✕", toolTip="Close this line")
        self.close_button.setAccessibleName("Close")
        self.close_button.clicked.connect(self.forget)
        row.addWidget(self.why)
        row.addWidget(self.close_button)
        self.addWidget(held)
        self.hide()
        importing.ended.connect(self.tell)
        document.loaded.connect(self.forget)

    def tell(self, result: Imported) -> None:
        """Show what came of an import."""
        self.forget()
        words = said(result)
        if words == head(result) and not result.failures:
            return
        self.result = result
        self.words.setText(words)
        self.words.setToolTip(words)
        self.why.setVisible(bool(result.failures or result.notes))
        for remedy in remedies(result):
            button = make_widget(QPushButton, self, text=remedy.label)
            strengthen(button)
            button.clicked.connect(lambda _=False, r=remedy: self._mend(r))
            self.buttons.addWidget(button)
            self.offered.append(button)
        self.show()

    def forget(self) -> None:
        """Hide it; what it said is done, or of another project."""
        self.result = None
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
            self._show(head(self.result), counted([*self.result.failures, *self.result.notes]))
