"""All commands with their keys, in the groups of the menus, found by typing: read as a list of shortcuts, or
done from here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QModelIndex, QObject, QSize, Qt, QTimer
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHeaderView,
    QLabel,
    QLineEdit,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.translation import tr
from app.widgets.tree_items import items_below, top_items

ROLE = Qt.ItemDataRole.UserRole
SIZE = QSize(620, 560)


@dataclass(frozen=True)
class Entry:
    """Something that can be done, or is only told of: then `run` is None. also: words it is found by, too."""

    group: str
    words: str
    keys: str = ""
    also: str = ""
    run: Callable[[], object] | None = None
    enabled: bool = True

    def matches(self, wanted: str) -> bool:
        """Return whether each word that is wanted is in it."""
        text = f"{self.group} {self.words} {self.keys} {self.also}".casefold()
        return all(word in text for word in wanted.casefold().split())


class CommandFinder(QDialog):
    """Words narrow the list, Up and Down go through it, Enter or a double click does it."""

    def __init__(self, title: str, entries: Iterable[Entry], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.entries = tuple(entries)
        self.search = QLineEdit(self, placeholderText=tr("Type what you want to do"), clearButtonEnabled=True)
        self.search.setAccessibleName(tr("Search commands"))
        self.search.textChanged.connect(self._narrow)
        self.search.installEventFilter(self)
        self.tree = QTreeWidget(self)
        self.tree.setColumnCount(2)
        self.tree.setHeaderHidden(True)
        self.tree.setRootIsDecorated(False)
        self.tree.setIndentation(14)
        self.tree.setUniformRowHeights(True)
        self.tree.setAccessibleName(tr("Commands"))
        self.tree.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.tree.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        header = self.tree.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.tree.itemActivated.connect(self._do)
        self.none = QLabel(tr("No command matches. Try other words."), self)
        self.none.setProperty("dim", True)
        layout = QVBoxLayout(self)
        layout.addWidget(self.search)
        layout.addWidget(self.none)
        layout.addWidget(self.tree, 1)
        self._fill()
        self._narrow("")
        self.resize(SIZE)
        self.search.setFocus()

    def _fill(self) -> None:
        groups: dict[str, QTreeWidgetItem] = {}
        for entry in self.entries:
            if entry.group not in groups:
                head = groups[entry.group] = QTreeWidgetItem(self.tree, [entry.group, ""])
                font = head.font(0)
                font.setBold(True)
                head.setFont(0, font)
                head.setFlags(Qt.ItemFlag.ItemIsEnabled)
                head.setFirstColumnSpanned(True)
            item = QTreeWidgetItem(groups[entry.group], [entry.words, entry.keys])
            item.setData(0, ROLE, entry)
            item.setToolTip(0, "\n".join(x for x in (entry.words, entry.also) if x))
            item.setDisabled(not entry.enabled)
        self.tree.expandAll()

    def _narrow(self, wanted: str) -> None:
        first: QTreeWidgetItem | None = None
        for head in top_items(self.tree):
            shown = 0
            for item in items_below(head):
                fits = item.data(0, ROLE).matches(wanted)
                item.setHidden(not fits)
                shown += fits
                if fits and first is None and not item.isDisabled():
                    first = item
            head.setHidden(not shown)
        self.none.setVisible(not self.listed())
        if first is None:
            self.tree.clearSelection()
            self.tree.setCurrentIndex(QModelIndex())
            return
        self.tree.setCurrentItem(first)
        if not wanted:
            self.tree.scrollToTop()

    def listed(self) -> list[Entry]:
        """Return what is shown now."""
        return [i.data(0, ROLE) for h in top_items(self.tree) for i in items_below(h) if not i.isHidden()]

    def _do(self, item: QTreeWidgetItem | None, column: int = 0) -> None:
        entry = item.data(0, ROLE) if item is not None else None
        if entry is not None and entry.run is not None and entry.enabled:
            self.accept()  # first: what is done may look at what has the keyboard
            QTimer.singleShot(0, entry.run)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keys that go through the list work while words are typed."""
        if watched is self.search and event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self._do(self.tree.currentItem())
                return True
            if event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown):
                self._step(Qt.Key(event.key()))
                return True
        return super().eventFilter(watched, event)

    def _step(self, key: Qt.Key) -> None:
        items = [
            i for h in top_items(self.tree) for i in items_below(h) if not i.isHidden() and not i.isDisabled()
        ]
        if not items:
            return
        current = self.tree.currentItem()
        at = items.index(current) if current in items else -1
        by = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1, Qt.Key.Key_PageUp: -10, Qt.Key.Key_PageDown: 10}[key]
        self.tree.setCurrentItem(items[min(len(items) - 1, max(0, at + by))])
