"""How often people of the chosen takes moved when something was said, and letting a conversation's characters
do as they did.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.document import Document
from app.translation import group_thousands, make_lazy_texts, tr, tr_noop
from app.widgets.quiet_fields import ComboBox
from metagraph.graph.conversation.edits import set_rates
from metagraph.graph.conversation.model import Rates

HEADS = make_lazy_texts(
    lambda: (
        tr("Pair"),
        tr("Matched"),
        tr("Total"),
        tr("Rate"),
        tr("95 % interval"),
        tr("By chance"),
    )
)
FIELDS = {
    tr_noop("clause with either hand"): "clause",
    tr_noop("response with a nod"): "response",
    tr_noop("partner's hesitation with a nod"): "hesitation",
}


def count_rates(rows: Sequence[Any], before: Rates) -> dict[str, float]:
    """Return what rows of `cooccurrence.table` say of a side's rates; what nothing was seen of stays as
    before.
    """
    found = {FIELDS[row.hypothesis]: row for row in rows if row.hypothesis in FIELDS}
    return {
        name: round(found[name].rate, 4) if name in found and found[name].total else getattr(before, name)
        for name in FIELDS.values()
    }


class CooccurrenceDialog(QDialog):
    """Shows what was counted, and sets it as the rates of a side of a conversation."""

    def __init__(self, document: Document, rows: Sequence[Any], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.rows = document, tuple(rows)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Speech and movement"))
        self.resize(720, 320)
        box = QVBoxLayout(self)
        box.setContentsMargins(14, 12, 14, 12)
        box.setSpacing(8)
        words = QLabel(
            tr(
                "A segment is matched if a hand moves near it, or if the head moves up and down. By "
                "chance: the rate if the same speech is shifted against the same motion. Only a rate "
                "well above that shows that speech and motion belong together."
            ),
            self,
            wordWrap=True,
        )
        words.setProperty("dim", True)
        box.addWidget(words)
        self.table = QTableWidget(len(self.rows), len(HEADS), self)
        self.table.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.table.setHorizontalHeaderLabels(list(HEADS))
        self.table.setAccessibleName(tr("How often people move with the speech"))
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setSelectionMode(QTableWidget.SelectionMode.NoSelection)
        self.table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.table.horizontalHeader().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.table.horizontalHeader().setHighlightSections(False)
        for n, row in enumerate(self.rows):
            seen = row.total > 0
            texts = (
                tr(row.hypothesis)[:1].upper() + tr(row.hypothesis)[1:],
                group_thousands(row.matched),
                group_thousands(row.total),
                _share(row.rate) if seen else "–",
                f"{_share(row.low)} – {_share(row.high)}" if seen else "–",
                _share(row.chance) if seen else "–",
            )
            for column, text in enumerate(texts):
                item = QTableWidgetItem(text)
                if column:
                    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.table.setItem(n, column, item)
        box.addWidget(self.table, 1)
        row_box = QHBoxLayout()
        row_box.addWidget(QLabel(tr("Apply to"), self))
        self.who = ComboBox(self)
        self.who.setAccessibleName(tr("Speaker whose rates to change"))
        for ident, talk in document.project.conversations.items():
            everyone = tr("both") if len(talk.sides) == 2 else tr("all")
            self.who.addItem(f"{talk.name}: {everyone}", (ident, tuple(range(len(talk.sides)))))
            for side, one in enumerate(talk.sides):
                self.who.addItem(
                    f"{talk.name}: {one.name or tr('side {number}', number=side + 1)}", (ident, (side,))
                )
        row_box.addWidget(self.who)
        row_box.addStretch(1)
        self.go = QPushButton(tr("Use these rates"), self, autoDefault=False)
        self.go.setEnabled(self.who.count() > 0 and any(row.total for row in self.rows))
        self.go.clicked.connect(self.use)
        strengthen(self.go)
        close = QPushButton(tr("Close"), self, autoDefault=False)
        close.clicked.connect(self.close)
        row_box.addWidget(self.go)
        row_box.addWidget(close)
        box.addLayout(row_box)

    def use(self) -> None:
        """Set the rates, one undo step."""
        ident, sides = self.who.currentData()

        def edit(project: Any) -> Any:
            for side in sides:
                project = set_rates(
                    project,
                    ident,
                    side,
                    **count_rates(self.rows, project.conversations[ident].sides[side].rates),
                )
            return project

        self.document.edit(tr("Use observed rates"), edit)
        self.close()


def _share(value: float) -> str:
    return f"{100 * value:.0f} %"
