"""The list of takes: which clips are chosen, and what was heard during them."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QMenu,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.features.motion_graph.synthesis_jobs import (
    FOLDER,
    LONG,
    describe_unusable_clips,
    find_recorded_side,
    list_usable_clips,
)
from app.project.document import Document
from app.translation import format_number, tr, tr_noop
from metagraph.graph.conversation.edits import change_side
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.model import Project

NONE = tr_noop("not known")
ROW = 30  # pixels
HEARD = 2  # the column of what was heard


class TakesList(QWidget):
    """changed: other takes are chosen, or what was heard. cut_wanted, rates_wanted: its buttons."""

    changed = Signal()
    cut_wanted = Signal()
    rates_wanted = Signal()

    def __init__(self, document: Document, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document = document
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(6)
        self.title = QLabel(tr("Takes"), self)
        self.title.setProperty("heading", True)
        self.list = QTableWidget(0, 3, self)
        self.list.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.list.setHorizontalHeaderLabels([tr("Clip"), tr("Length"), tr("Speech heard")])
        self.list.setAccessibleName(tr("Takes"))
        self.list.verticalHeader().hide()
        self.list.setShowGrid(False)
        self.list.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.list.setSelectionBehavior(QTableWidget.SelectionBehavior.SelectRows)
        self.list.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        header = self.list.horizontalHeader()
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        header.resizeSection(2, 150)
        self.list.verticalHeader().setDefaultSectionSize(ROW)
        header.setHighlightSections(False)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.list.itemChanged.connect(self._checked)
        self.menu = QMenu(self)
        self.list.cellClicked.connect(self.ask_speech)
        self.list.cellActivated.connect(self.ask_speech)  # Enter
        self.note = QLabel(self, wordWrap=True)
        self.note.setProperty("dim", True)
        self.note.hide()
        self.cut_button = QPushButton(tr("Cut selected takes into clips"), self, autoDefault=False)
        self.cut_button.setToolTip(
            tr(
                "Cuts at still moments in a pose that returns, so that no jump is visible. Label the "
                "new clips afterwards."
            )
        )
        self.cut_button.clicked.connect(self.cut_wanted)
        box.addWidget(self.title)
        box.addWidget(self.list, 1)
        box.addWidget(self.note)
        self.rates_button = QPushButton(tr("Count movements with speech…"), self, autoDefault=False)
        self.rates_button.setToolTip(tr("Count how often hands and head moved with the speech"))
        self.rates_button.clicked.connect(self.rates_wanted)
        row = QHBoxLayout()
        row.addWidget(self.cut_button)
        row.addWidget(self.rates_button)
        row.addStretch(1)
        box.addLayout(row)

    def fill(self) -> None:
        """List the clips that can be takes; the long ones are chosen, all where none is long."""
        project, chosen = self.document.project, set(self.chosen())
        found = list_usable_clips(project)
        self.note.setText(describe_unusable_clips(project))
        self.note.setVisible(bool(self.note.text()))
        if not self.list.rowCount():
            recorded = [i for i in found if not project.clips[i].path.startswith(f"{FOLDER}/")]
            chosen = {i for i in recorded if project.clips[i].duration >= LONG} or set(recorded)
        self.list.blockSignals(True)
        self.list.setRowCount(len(found))
        for row, ident in enumerate(found):
            entry = project.clips[ident]
            item = QTableWidgetItem(entry.name)
            item.setToolTip(entry.name)
            item.setData(Qt.ItemDataRole.UserRole, ident)
            item.setFlags(
                Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsUserCheckable
            )
            item.setCheckState(Qt.CheckState.Checked if ident in chosen else Qt.CheckState.Unchecked)
            length = QTableWidgetItem(f"{format_number(entry.duration, '.1f')} s")
            length.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            self.list.setItem(row, 0, item)
            self.list.setItem(row, 1, length)
            self.list.setItem(row, 2, self._heard(project, ident))
        self.list.blockSignals(False)
        self.changed.emit()

    def _heard(self, project: Project, clip: str) -> QTableWidgetItem:
        """Say which side of which conversation was recorded along with a clip; a click asks for another."""
        recorded = find_recorded_side(project, clip)
        words = tr(NONE)
        if recorded is not None:
            talk = project.conversations[recorded[0]]
            words = describe_side(talk, recorded[1])
        item = QTableWidgetItem(f"{words}  ▾" if project.conversations else words)
        tip = tr("Click to choose which speaker of which conversation was recorded with this take")
        item.setToolTip(f"{item.text()}\n{tip}")
        return item

    def ask_speech(self, row: int, column: int = HEARD) -> None:
        """Offer the sides of the project's conversations below the cell."""
        project = self.document.project
        if column != HEARD or not project.conversations:
            return
        clip = self._clip(row)
        now = find_recorded_side(project, clip)
        self.menu.clear()
        sides = [
            ((ident, n), describe_side(talk, n))
            for ident, talk in project.conversations.items()
            for n in range(len(talk.sides))
        ]
        for key, words in [(None, tr(NONE)), *sides]:
            action = self.menu.addAction(words, partial(self._tell_speech, clip, key))
            action.setCheckable(True)
            action.setChecked(key == now)
        below = self.list.visualRect(self.list.model().index(row, HEARD)).bottomLeft()
        self.menu.popup(self.list.viewport().mapToGlobal(below))

    def _tell_speech(self, clip: str, chosen: tuple[str, int] | None) -> None:
        def edit(project: Project) -> Project:
            for ident, talk in project.conversations.items():
                for n, side in enumerate(talk.sides):
                    if side.take == clip:
                        project = change_side(project, ident, n, take=None)
            return project if chosen is None else change_side(project, *chosen, take=clip)

        self.document.edit(tr("Set speech heard"), edit)

    def chosen(self) -> list[str]:
        """Return the ids of the takes that are checked."""
        rows = (self.list.item(row, 0) for row in range(self.list.rowCount()))
        return [
            i.data(Qt.ItemDataRole.UserRole)
            for i in rows
            if i is not None and i.checkState() == Qt.CheckState.Checked
        ]

    def _checked(self, item: QTableWidgetItem) -> None:
        if item.column() == 0:
            self.changed.emit()

    def _clip(self, row: int) -> str:
        return str(self.list.model().index(row, 0).data(Qt.ItemDataRole.UserRole))

    def selected(self) -> list[str]:
        """Return the ids of the takes in selected rows; of those that are checked where none is selected."""
        rows = sorted({index.row() for index in self.list.selectionModel().selectedRows()})
        return [self._clip(row) for row in rows] or self.chosen()


def describe_side(talk: Conversation, side: int) -> str:
    """Return a side of a conversation in words."""
    return f"{talk.name}: {talk.sides[side].name or tr('speaker {number}', number=side + 1)}"
