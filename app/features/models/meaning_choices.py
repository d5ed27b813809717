"""A table whose last column is chosen from a menu: as light for a thousand rows as for ten."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QEvent, QModelIndex, QPersistentModelIndex, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPen
from PySide6.QtWidgets import (
    QHeaderView,
    QMenu,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTreeWidget,
    QTreeWidgetItem,
    QWidget,
)

from app.look.theme import get_theme
from app.stage.session import StageSession

HIGH = 34  # pixels of a row
_OPENING = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space, Qt.Key.Key_F4)
Entries = Sequence[tuple[str, object, str]]  # words, value, tooltip


@dataclass(frozen=True)
class MeaningRow:
    """cells: the texts of all but the last column. chosen: the words of the last. dim: of what does not
    count. tip: tells more.
    """

    cells: tuple[str, ...]
    chosen: str
    dim: bool = False
    tip: str = ""


class _Field(QStyledItemDelegate):
    """Draws the last column as the field it behaves like."""

    def __init__(self, table: ChoiceTable) -> None:
        super().__init__(table)
        self.table = table

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        t = get_theme(self.table.session.look.name)
        words = str(index.data(Qt.ItemDataRole.DisplayRole) or "")
        if not words:
            return
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(option.rect).adjusted(2.5, 3.5, -4.5, -3.5)
        current = self.table.hasFocus() and self.table.currentIndex().row() == index.row()
        painter.setPen(QPen(QColor(t.dim if current else t.line), 1))
        painter.setBrush(QColor(t.field))
        painter.drawRoundedRect(box, 6, 6)
        ink = QColor(index.data(Qt.ItemDataRole.ForegroundRole).color())
        painter.setPen(ink)
        inner = box.adjusted(9, 0, -24, 0)
        text = QFontMetricsF(painter.font()).elidedText(words, Qt.TextElideMode.ElideRight, inner.width())
        painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter, text)
        painter.setPen(QPen(ink, 1.3))
        x, y = box.right() - 13, box.center().y() - 1.5
        painter.drawPolyline([QPointF(x - 3.5, y), QPointF(x, y + 3.5), QPointF(x + 3.5, y)])
        painter.restore()

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(80, HIGH)


class ChoiceTable(QTreeWidget):
    """A click on a row's field, or Enter on the row, opens what can be chosen. chosen: (row, value)."""

    chosen = Signal(int, object)

    def __init__(
        self,
        session: StageSession,
        title: str,
        heads: Sequence[str],
        wide: int,
        entries: Callable[[int], Entries],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self.session, self.entries = session, entries
        self.rows: tuple[MeaningRow, ...] = ()
        self.last = len(heads) - 1
        self.setColumnCount(len(heads))
        self.setHeaderLabels(list(heads))
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setAccessibleName(title)
        self.setItemDelegateForColumn(self.last, _Field(self))
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionsClickable(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        for column in range(1, self.last):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(self.last, QHeaderView.ResizeMode.Fixed)
        header.resizeSection(self.last, wide)
        self.headerItem().setTextAlignment(
            self.last - 1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        )

    def show_rows(self, rows: Sequence[MeaningRow], otherwise: str = "") -> None:
        """Show rows, or the words `otherwise` if there are none. The current row and the scroll stay where
        they are.
        """
        t, place, scroll = (
            get_theme(self.session.look.name),
            self.currentIndex().row(),
            self.verticalScrollBar().value(),
        )
        self.rows = tuple(rows)
        self.clear()
        items = []
        for row in rows:
            item = QTreeWidgetItem([*row.cells, row.chosen])
            item.setTextAlignment(self.last - 1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            for column in range(self.last + 1):
                item.setForeground(column, QColor(t.dim if row.dim else t.text))
            if row.tip:
                item.setToolTip(0, row.tip)
            items.append(item)
        self.addTopLevelItems(items)
        if otherwise and not rows:
            item = QTreeWidgetItem([otherwise])
            item.setForeground(0, QColor(t.dim))
            item.setFlags(Qt.ItemFlag.ItemIsEnabled)
            self.addTopLevelItem(item)
            item.setFirstColumnSpanned(True)
        elif 0 <= place < len(rows):
            self.setCurrentItem(items[place])
        self.verticalScrollBar().setValue(scroll)

    def menu(self, row: int) -> QMenu:
        """Return what can be chosen in a row, what it is now marked."""
        menu = QMenu(self)
        menu.setToolTipsVisible(True)
        for words, value, tip in self.entries(row):
            action = menu.addAction(words, partial(self.chosen.emit, row, value))
            action.setToolTip(tip)
            action.setCheckable(True)
            action.setChecked(words == self.rows[row].chosen)
        menu.aboutToHide.connect(menu.deleteLater)
        return menu

    def open_menu(self, row: int) -> None:
        if 0 <= row < len(self.rows):
            rect = self.visualRect(self.model().index(row, self.last))
            menu = self.menu(row)
            menu.setMinimumWidth(rect.width() - 6)
            menu.popup(self.viewport().mapToGlobal(rect.bottomLeft()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        super().mouseReleaseEvent(event)
        index = self.indexAt(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and index.column() == self.last:
            self.open_menu(index.row())

    def event(self, event: QEvent) -> bool:
        # In a dialog, Enter would press the default button.
        opens = (
            event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent) and event.key() in _OPENING
        )
        if opens and self.currentIndex().isValid():
            self.open_menu(self.currentIndex().row())
            return True
        return super().event(event)
