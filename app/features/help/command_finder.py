"""All commands with their keys, in the groups of the menus, found by typing: read as a list of shortcuts, or
done from here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer
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
from app.widgets.tree_items import list_items_below, list_top_items

ROLE = Qt.ItemDataRole.UserRole
SIZE = QSize(620, 560)


@dataclass(frozen=True)
class Entry:
    """Something that can be done, or is only reported about: then `run` is None. also: words it is found
    by, too.
    by_name: it is in the list only while its name is being typed.
    """

    group: str
    words: str
    keys: str = ""
    also: str = ""
    run: Callable[[], object] | None = None
    enabled: bool = True
    by_name: bool = False

    @cached_property
    def name(self) -> str:
        """The words as they are compared."""
        return self.words.casefold()

    def rank(self, wanted: str) -> int | None:
        """Return how well it matches what was typed, 0 best; None if it does not match."""
        sought, name = wanted.casefold().split(), self.name
        if self.by_name and not all(word in name for word in sought):
            return None  # as nearly all of thousands
        words = name.split()
        if words == sought:
            return 0
        if words[: len(sought)] == sought:
            return 1
        if all(word in words for word in sought):
            return 2
        if all(any(w.startswith(word) for w in words) for word in sought):
            return 3
        if all(word in name for word in sought):
            return 4
        text = f"{self.group} {name} {self.keys} {self.also}".casefold()
        if all(word in text for word in sought):
            return 5
        return 6 if _has_letters_in_order("".join(sought), words) else None


def _has_letters_in_order(letters: str, words: list[str]) -> bool:
    """Return whether the letters are in the words in this order, the first one first: "expgr" finds "export
    graph".
    """
    name, at = "".join(words), 0
    for letter in letters:
        found = name.find(letter, at)
        if found < 0 or (at == 0 and found > 0):
            return False
        at = found + 1
    return True


class CommandFinder(QDialog):
    """Words narrow the list, Up and Down go through it, Enter or a double click does it. `recent` has the
    names of the commands done last, the latest first, and is kept up to date.
    """

    def __init__(
        self, title: str, entries: Iterable[Entry], parent: QWidget, recent: list[str] | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.entries = tuple(entries)
        self.recent = [] if recent is None else recent
        self.search = QLineEdit(self, placeholderText=tr("Type what you want to do"), clearButtonEnabled=True)
        self.search.setAccessibleName(tr("Search commands"))
        self.search.textChanged.connect(self._narrow)
        self.search.installEventFilter(self)
        self.tree = QTreeWidget(self)
        self.tree.setColumnCount(3)
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
        for column in (1, 2):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        self.tree.itemActivated.connect(self._do)
        self.none = QLabel(tr("No command matches. Try other words."), self)
        self.none.setProperty("dim", True)
        layout = QVBoxLayout(self)
        layout.addWidget(self.search)
        layout.addWidget(self.none)
        layout.addWidget(self.tree, 1)
        self._narrow("")
        self.resize(SIZE)
        self.search.setFocus()

    def _narrow(self, wanted: str) -> None:
        """Show what matches the words typed: by menu while there are none, else the best match first."""
        self.tree.clear()
        if wanted.strip():
            ranked = [(entry.rank(wanted), entry) for entry in self.entries]
            found = [(rank, self._how_recent(entry), entry) for rank, entry in ranked if rank is not None]
            for *_, entry in sorted(found, key=lambda row: row[:2]):
                self._add(self.tree, entry, entry.group)
        else:
            self._fill_by_group()
        self.none.setVisible(not self.listed())
        items = self._usable()
        if items:
            self.tree.setCurrentItem(items[0])
        self.tree.scrollToTop()

    def _how_recent(self, entry: Entry) -> int:
        """Return 0 for the command done last, and so on."""
        return self.recent.index(entry.words) if entry.words in self.recent else len(self.recent)

    def _fill_by_group(self) -> None:
        groups: dict[str, QTreeWidgetItem] = {}
        for entry in self.entries:
            if entry.by_name:
                continue
            if entry.group not in groups:
                head = groups[entry.group] = QTreeWidgetItem(self.tree, [entry.group])
                font = head.font(0)
                font.setBold(True)
                head.setFont(0, font)
                head.setFlags(Qt.ItemFlag.ItemIsEnabled)
                head.setFirstColumnSpanned(True)
            self._add(groups[entry.group], entry)
        self.tree.expandAll()

    def _add(self, parent: QTreeWidget | QTreeWidgetItem, entry: Entry, group: str = "") -> None:
        item = QTreeWidgetItem(parent, [entry.words, group, entry.keys])
        item.setData(0, ROLE, entry)
        item.setForeground(1, self.palette().placeholderText())
        item.setToolTip(0, "\n".join(x for x in (entry.words, entry.also) if x))
        item.setDisabled(not entry.enabled)

    def _items(self) -> list[QTreeWidgetItem]:
        """Return the items of all entries that are shown."""
        tops = list_top_items(self.tree)
        every = [item for top in tops for item in (top, *list_items_below(top))]
        return [item for item in every if item.data(0, ROLE) is not None]

    def _usable(self) -> list[QTreeWidgetItem]:
        return [item for item in self._items() if not item.isDisabled()]

    def listed(self) -> list[Entry]:
        """Return what is shown now."""
        return [item.data(0, ROLE) for item in self._items()]

    def _do(self, item: QTreeWidgetItem | None, column: int = 0) -> None:
        entry = item.data(0, ROLE) if item is not None else None
        if entry is not None and entry.run is not None and entry.enabled:
            if entry.words in self.recent:
                self.recent.remove(entry.words)
            self.recent.insert(0, entry.words)
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
        items = self._usable()
        if not items:
            return
        current = self.tree.currentItem()
        at = items.index(current) if current in items else -1
        by = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1, Qt.Key.Key_PageUp: -10, Qt.Key.Key_PageDown: 10}[key]
        self.tree.setCurrentItem(items[min(len(items) - 1, max(0, at + by))])
