"""The table's cells: keys as in a spreadsheet, and editing in place for all selected cells of a column."""

from __future__ import annotations

from PySide6.QtCore import (
    QEvent,
    QItemSelection,
    QItemSelectionModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QRectF,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCompleter,
    QHeaderView,
    QLineEdit,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from app.features.table.cell_words import list_choices
from app.features.table.frozen_names import NAME, FrozenNames
from app.features.table.table_model import TableModel
from app.translation import tr
from app.widgets.restyling import set_sheet
from metagraph.playback.action_table import COLUMNS, Cell, Column, read_cell

Index = QModelIndex | QPersistentModelIndex
WIDTHS: dict[Column, int] = {
    "name": 230, "clip": 150, "kind": 104, "layer": 70, "stance": 130, "end_stance": 120, "limb": 66,
    "tags": 130, "likelihood": 88, "cooldown": 86, "prominence": 92, "earliest_exit": 96,
}  # fmt: skip
USUAL = 78
ROW = 28  # pixels of a row's height
MAY_BE_EMPTY: tuple[Column, ...] = ("tags", "end", "earliest_exit", "prominence")


class _EnterTakes(QObject):
    """On a list of choices: Enter takes what is chosen in it, or else what was typed. Escape takes nothing.
    Both end editing, where Qt would only close the list.
    """

    def __init__(self, editor: CellEditor, line: QLineEdit) -> None:
        super().__init__(line)
        self.editor, self.line = editor, line

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        key = event.key() if isinstance(event, QKeyEvent) else None
        if key == Qt.Key.Key_Escape and event.type() == QEvent.Type.KeyPress:
            assert isinstance(watched, QAbstractItemView)
            watched.hide()
            self.editor.closeEditor.emit(self.line, QStyledItemDelegate.EndEditHint.RevertModelCache)
            return True
        enters = key in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if not enters or event.type() != QEvent.Type.KeyPress or not isinstance(watched, QAbstractItemView):
            return False
        if watched.currentIndex().isValid():
            self.line.setText(str(watched.currentIndex().data()))
        watched.hide()
        self.editor.commitData.emit(self.line)
        self.editor.closeEditor.emit(self.line, QStyledItemDelegate.EndEditHint.NoHint)
        return True


class CellEditor(QStyledItemDelegate):
    """Edits a cell as a line of text that completes itself."""

    def __init__(self, view: TableView) -> None:
        super().__init__(view)
        self.view = view

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """Put a frame around what was refused: the selection hides the ground of a cell."""
        super().paint(painter, option, index)
        if self.view.rows.is_refused(index):
            painter.save()
            painter.setPen(QPen(QColor(self.view.rows.look.error), 2))
            painter.drawRect(option.rect.adjusted(1, 1, -1, -1))
            painter.restore()

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: Index) -> QWidget:
        line = QLineEdit(parent)
        set_sheet(line, "padding: 0 3px; border-radius: 0")
        model, column = self.view.rows, COLUMNS[index.column()]
        line.setAccessibleName(str(model.headerData(index.column(), Qt.Orientation.Horizontal)))
        layer = read_cell(model.project, model.rows[index.row()], "layer")
        words = list_choices(model.project, column, layer)
        if words:
            completer = QCompleter(list(words), line)
            completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
            completer.setFilterMode(Qt.MatchFlag.MatchContains)
            line.setCompleter(completer)
            choices = completer.popup()
            assert choices is not None
            choices.installEventFilter(_EnterTakes(self, line))
        return line

    def setEditorData(self, editor: QWidget, index: Index) -> None:
        if isinstance(editor, QLineEdit) and not editor.isModified():  # what is being typed stays
            editor.setText(self.view.rows.text(index))
            editor.selectAll()

    def setModelData(self, editor: QWidget, model: object, index: Index) -> None:
        if isinstance(editor, QLineEdit) and editor.text() != self.view.rows.text(index):
            self.view.write_everywhere(self.view.rows.index(index.row(), index.column()), editor.text())


class TableView(QTableView):
    """written: texts by cell, for one step. Typing replaces a cell, and all selected cells of its column."""

    written = Signal(object)

    def __init__(self, rows: TableModel, parent: QWidget) -> None:
        super().__init__(parent)
        self.rows = rows
        self.setModel(rows)
        self.setItemDelegate(CellEditor(self))
        trigger = QAbstractItemView.EditTrigger
        self.setEditTriggers(trigger.DoubleClicked | trigger.AnyKeyPressed | trigger.EditKeyPressed)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setTabKeyNavigation(False)
        self.setAccessibleName(tr("Actions and clips"))
        side = self.verticalHeader()
        side.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        side.setDefaultSectionSize(ROW)
        head = self.horizontalHeader()
        head.setSortIndicatorShown(True)
        head.setSortIndicatorClearable(True)
        head.setSortIndicator(-1, Qt.SortOrder.AscendingOrder)
        head.setSectionsMovable(True)
        head.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        for place, column in enumerate(COLUMNS):
            self.setColumnWidth(place, WIDTHS.get(column, USUAL))
        self.setSortingEnabled(True)
        self.names = FrozenNames(self)
        self._empty = ""

    def show_empty_words(self, words: str) -> None:
        """Say what is to be done where there are no rows."""
        if words != self._empty:
            self._empty = words
            self.viewport().update()

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if not self.rows.rows:
            painter = QPainter(self.viewport())
            painter.setPen(self.palette().placeholderText().color())
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(QRectF(self.viewport().rect()).adjusted(16, 0, -16, 0), flags, self._empty)
            painter.end()

    def scrollTo(
        self, index: Index, hint: QAbstractItemView.ScrollHint = QAbstractItemView.ScrollHint.EnsureVisible
    ) -> None:
        """Bring a cell into sight, also from beneath the names that stay."""
        super().scrollTo(index, hint)
        hidden = self.names.covered() - self.columnViewportPosition(index.column())
        if hidden > 0 and index.column() != NAME:
            bar = self.horizontalScrollBar()
            bar.setValue(bar.value() - hidden)

    # --- keys

    def event(self, event: QEvent) -> bool:
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and self._keeps(event)
        ):
            event.accept()
            return True
        return super().event(event)

    def _keeps(self, event: QKeyEvent) -> bool:
        """Return whether a key is the table's: what is typed, and what fills down. The space bar plays."""
        held = event.modifiers() & ~(Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.KeypadModifier)
        if held == Qt.KeyboardModifier.ControlModifier:
            return event.key() == Qt.Key.Key_D
        arrows = (Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Home, Qt.Key.Key_End)
        typed = event.text().isprintable() and bool(event.text().strip())
        return not held and (typed or event.key() in (Qt.Key.Key_F2, Qt.Key.Key_Return, *arrows))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_D and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self.fill_down()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and not self.is_editing():
            self.edit_current()
        elif event.key() == Qt.Key.Key_Space:
            event.ignore()
        elif (
            event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right) and not event.modifiers() and self._is_column()
        ):
            self._move_column(1 if event.key() == Qt.Key.Key_Right else -1)
        else:
            super().keyPressEvent(event)

    def _is_column(self) -> bool:
        """Return whether several cells are selected, all in one column."""
        chosen = self.selectedIndexes()
        return len(chosen) > 1 and len({i.column() for i in chosen}) == 1

    def _move_column(self, step: int) -> None:
        """Select the same rows in the next column."""
        head, flags = self.horizontalHeader(), QItemSelectionModel.SelectionFlag
        place = head.visualIndex(self.currentIndex().column()) + step
        while 0 <= place < head.count() and head.isSectionHidden(head.logicalIndex(place)):
            place += step
        if not 0 <= place < head.count():
            return
        column, current, model = head.logicalIndex(place), self.currentIndex(), self.selectionModel()
        chosen = QItemSelection()
        for row in self.selected_rows():
            chosen.select(self.rows.index(row, column), self.rows.index(row, column))
        model.select(chosen, flags.ClearAndSelect)
        model.setCurrentIndex(self.rows.index(current.row(), column), flags.NoUpdate)
        self.scrollTo(self.currentIndex())

    def edit_current(self) -> None:
        """Edit the current cell in place."""
        if self.currentIndex().isValid() and self.currentIndex().flags() & Qt.ItemFlag.ItemIsEditable:
            self.edit(self.currentIndex())

    def is_editing(self) -> bool:
        """Return whether a cell is being edited."""
        return self.state() == QAbstractItemView.State.EditingState

    # --- many cells at once

    def chosen(self) -> list[QModelIndex]:
        """Return the selected cells that can be written, by row and column as they are shown."""
        head = self.horizontalHeader()
        cells = [i for i in self.selectedIndexes() if i.flags() & Qt.ItemFlag.ItemIsEditable]
        return sorted(cells, key=lambda i: (i.row(), head.visualIndex(i.column())))

    def write_everywhere(self, index: QModelIndex, words: str) -> None:
        """Write words into a cell and into all selected cells of its column."""
        cells = [i for i in self.chosen() if i.column() == index.column()]
        if index not in cells:
            cells = [index]
        self.written.emit({self.rows.cell(i): self.rows.typed(i, words) for i in cells})

    def fill_down(self) -> None:
        """Write what the first selected cell of each column says into the others below it."""
        first: dict[int, QModelIndex] = {}
        texts: dict[Cell, str] = {}
        for index in self.chosen():
            top = first.setdefault(index.column(), index)
            if top is not index:
                texts[self.rows.cell(index)] = self.rows.typed(index, self.rows.text(top))
        if texts:
            self.written.emit(texts)

    def clear_cells(self) -> None:
        """Empty the selected cells that may be empty."""
        texts = {
            self.rows.cell(i): ""
            for i in self.chosen()
            if COLUMNS[i.column()] in MAY_BE_EMPTY or self.rows.rows[i.row()].action is None
        }
        if texts:
            self.written.emit(texts)

    def copy_text(self) -> str:
        """Return the selected cells as a spreadsheet takes them: tabs between columns, lines for rows."""
        chosen = self.selectedIndexes()
        columns = self._shown_columns({i.column() for i in chosen})
        picked = {(i.row(), i.column()) for i in chosen}
        return "\n".join(
            "\t".join(
                self.rows.text(self.rows.index(row, column)) if (row, column) in picked else ""
                for column in columns
            )
            for row in sorted({row for row, _ in picked})
        )

    def paste_text(self, text: str) -> int:
        """Write the cells of a spreadsheet from the first selected cell on, to the right and down. One cell,
        or one line, goes into all selected rows. Return how many cells of the text had no place.
        """
        lines = [line.split("\t") for line in text.rstrip("\r\n").split("\n")]
        lines = [[word.rstrip("\r") for word in line] for line in lines]
        chosen = self.chosen()
        if not chosen or not text.strip("\r\n"):
            return 0
        shown = self._shown_columns(set(range(len(COLUMNS))))
        left = min(shown.index(i.column()) for i in chosen)
        rows = sorted({i.row() for i in chosen})
        if len(lines) == 1 and len(lines[0]) == 1:
            places = [(i.row(), i.column(), lines[0][0]) for i in chosen]
            lost = 0
        else:
            first = rows[0]
            targets = rows if len(lines) == 1 else range(first, first + len(lines))
            full = lines * len(rows) if len(lines) == 1 else lines
            places, lost = [], 0
            for row, line in zip(targets, full, strict=True):
                for n, word in enumerate(line):
                    if row < len(self.rows.rows) and left + n < len(shown):
                        places.append((row, shown[left + n], word))
                    else:
                        lost += 1
        texts: dict[Cell, str] = {}
        for row, column, word in places:
            index = self.rows.index(row, column)
            if index.flags() & Qt.ItemFlag.ItemIsEditable or word.strip() not in ("", self.rows.text(index)):
                texts[self.rows.cell(index)] = self.rows.typed(index, word)
        if texts:
            self.written.emit(texts)
        return lost

    def _shown_columns(self, some: set[int]) -> list[int]:
        """Return columns from left to right, without hidden ones."""
        head = self.horizontalHeader()
        return sorted((c for c in some if not head.isSectionHidden(c)), key=head.visualIndex)

    # --- rows

    def select_column(self, column: int) -> None:
        """Select the cells of a column in all rows, the first to be edited."""
        flags = QItemSelectionModel.SelectionFlag
        first, last = self.rows.index(0, column), self.rows.index(len(self.rows.rows) - 1, column)
        model = self.selectionModel()
        model.select(QItemSelection(first, last), flags.ClearAndSelect)
        model.setCurrentIndex(first, flags.NoUpdate)
        self.scrollTo(first)

    def select_rows(self, rows: list[int]) -> None:
        """Select whole rows, and show the first."""
        flags = QItemSelectionModel.SelectionFlag
        model = self.selectionModel()
        model.clearSelection()
        for row in rows:
            model.select(self.rows.index(row, 0), flags.Select | flags.Rows)
        if rows:
            model.setCurrentIndex(self.rows.index(rows[0], 0), flags.NoUpdate)
            self.scrollTo(self.rows.index(rows[0], max(0, self.columnAt(0))))

    def selected_rows(self) -> list[int]:
        """Return the rows in which something is selected."""
        return sorted({i.row() for i in self.selectedIndexes()})
