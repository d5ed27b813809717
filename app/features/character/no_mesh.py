"""What stands over the preview while the default body or a stick figure is drawn: why that is, and a way to
choose a character.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QToolButton, QWidget

from app.translation import tr
from app.widgets.making import make_widget

EDGE = 10  # pixels from the view's corner


class NoMesh(QFrame):
    """In the lower left corner of a view; hidden where a character's mesh is drawn, and where none may be
    chosen.

    choose: asks for a character. may: whether that can be done now.
    """

    def __init__(self, view: QWidget, choose: Callable[[], object], may: Callable[[], bool]) -> None:
        super().__init__(view)
        self._view, self._may = view, may
        self.setProperty("card", True)
        row = QHBoxLayout(self)
        row.setContentsMargins(4, 4, 4, 4)
        row.setSpacing(8)
        self.words = QLabel(self, wordWrap=True)
        self.words.setContentsMargins(6, 0, 0, 0)
        self.words.hide()
        self.button = make_widget(
            QToolButton,
            self,
            text=tr("Choose character…"),
            toolTip=tr("Choose who is drawn: Ada, Ben, the default body or a GLB, glTF or VRM file of yours"),
        )
        self.button.setAccessibleName(tr("Choose character"))
        self.button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.button.clicked.connect(choose)
        row.addWidget(self.words, 1)
        row.addWidget(self.button)
        self.hide()

    def tell(self, words: str | None) -> None:
        """Show why no mesh of a character is drawn, "" if no character is chosen; hide for None."""
        shown = words is not None and self._may()
        if words is not None and self.words.text() != words:
            self.words.setText(words)
            self.words.setVisible(bool(words))
        if shown:
            text = self.words.fontMetrics().horizontalAdvance(words) + 16 if words else 0
            wide = min(self._view.width() - 2 * EDGE, text + self.button.sizeHint().width() + 20)
            high = max(self.heightForWidth(wide), self.button.sizeHint().height() + 8)
            self.setGeometry(EDGE, self._view.height() - high - EDGE, wide, high)
        if shown == self.isHidden():
            self.setVisible(shown)
