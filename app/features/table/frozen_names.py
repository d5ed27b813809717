"""The names of the rows, which stay in sight when the table is scrolled to the right."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QModelIndex, QObject, Qt
from PySide6.QtWidgets import QAbstractItemView, QTableView

from app.translation import tr
from metagraph.playback.action_table import COLUMNS

NAME = COLUMNS.index("name")


class FrozenNames(QTableView):
    """Lies over the left edge of a table while its column of names is scrolled out of sight. It shares the
    table's rows and selection.
    """

    def __init__(self, table: QTableView) -> None:
        super().__init__(table)
        self.table = table
        self.setModel(table.model())
        self.setSelectionModel(table.selectionModel())
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.doubleClicked.connect(self._edit)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setFrameShape(QTableView.Shape.NoFrame)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setAccessibleName(tr("Names of the rows"))
        self.setProperty("frozen", True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(table.verticalScrollMode())
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(table.verticalHeader().defaultSectionSize())
        head = table.horizontalHeader()
        self.horizontalHeader().setDefaultAlignment(head.defaultAlignment())
        self.horizontalHeader().setSectionsClickable(False)
        for place in range(self.model().columnCount()):
            self.setColumnHidden(place, place != NAME)
        table.verticalScrollBar().valueChanged.connect(self.verticalScrollBar().setValue)
        self.verticalScrollBar().valueChanged.connect(table.verticalScrollBar().setValue)
        table.horizontalScrollBar().valueChanged.connect(self.follow)
        for changed in (head.sectionResized, head.sectionMoved, head.geometriesChanged):
            changed.connect(self.follow)
        table.viewport().installEventFilter(self)
        self.hide()

    def is_needed(self) -> bool:
        """Return whether the table's own column of names is not entirely in sight."""
        head = self.table.horizontalHeader()
        at = head.sectionViewportPosition(NAME)
        return at < 0 or at + head.sectionSize(NAME) > self.table.viewport().width()

    def follow(self) -> None:
        """Lie where the table is now, or hide while its own names are in sight."""
        if not self.is_needed():
            self.hide()
            return
        head, seen = self.table.horizontalHeader(), self.table.viewport().geometry()
        width = min(self.table.columnWidth(NAME), seen.width() // 2)
        self.setColumnWidth(NAME, width)
        self.horizontalHeader().setFixedHeight(head.height())
        self.setGeometry(seen.left(), seen.top() - head.height(), width, seen.height() + head.height())
        self.verticalScrollBar().setValue(self.table.verticalScrollBar().value())
        self.show()
        self.raise_()

    def covered(self) -> int:
        """Return how many pixels of the table's left edge lie beneath this."""
        return self.width() if self.isVisible() else 0

    def _edit(self, index: QModelIndex) -> None:
        """Edit a name in the table, which brings its own names into sight."""
        self.table.setCurrentIndex(index)
        self.table.scrollTo(index)
        self.table.edit(index)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self.follow()
        return False
