"""The manual in a window of its own: contents and search on the left, a page on the right."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, QUrl, SignalInstance
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QSplitter,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.features.help.manual_browser import ManualBrowser
from app.features.help.manual_pages import DOCS, ManualEntry, list_manual_entries, search_pages
from app.translation import tr
from app.widgets.within_screen import resize_within_screen

ROLE = Qt.ItemDataRole.UserRole
Standard = QKeySequence.StandardKey


class ManualWindow(QDialog):
    """Stays open beside the work; one for each window of the program."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Manual"))
        resize_within_screen(self, 1180, 780)
        self.tree = QTreeWidget(self)
        self.tree.setHeaderHidden(True)
        self.tree.setAccessibleName(tr("Contents"))
        self.tree.itemClicked.connect(self._chosen)
        self.tree.itemActivated.connect(self._chosen)
        self.search = QLineEdit(self, placeholderText=tr("Search the manual"), clearButtonEnabled=True)
        self.search.setAccessibleName(tr("Search the manual"))
        self.search.textChanged.connect(self._fill)
        self.search.returnPressed.connect(lambda: self._chosen(self.tree.topLevelItem(0)))
        self.browser = ManualBrowser(self)
        self.browser.sourceChanged.connect(self._mark)
        QShortcut(Standard.Find, self, self.search.setFocus)
        left, right, bar = QWidget(self), QWidget(self), QHBoxLayout()
        column, page = QVBoxLayout(left), QVBoxLayout(right)
        column.addWidget(self.search)
        column.addWidget(self.tree, 1)
        pages = self.browser
        bar.addWidget(self._turner(tr("Back"), Standard.Back, pages.backward, pages.backwardAvailable))
        bar.addWidget(self._turner(tr("Forward"), Standard.Forward, pages.forward, pages.forwardAvailable))
        bar.addStretch(1)
        page.addLayout(bar)
        page.addWidget(self.browser, 1)
        split = QSplitter(self)
        for side, layout in ((left, column), (right, page)):
            layout.setContentsMargins(0, 0, 0, 0)
            split.addWidget(side)
        split.setSizes([290, 890])
        split.setChildrenCollapsible(False)
        QHBoxLayout(self).addWidget(split)
        self._fill("")

    def _turner(
        self, words: str, key: Standard, turn: Callable[[], object], can: SignalInstance
    ) -> QPushButton:
        button = QPushButton(words, self)
        button.setAutoDefault(False)
        button.setEnabled(False)
        button.setToolTip(QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText))
        button.clicked.connect(turn)
        can.connect(button.setEnabled)
        QShortcut(key, self, turn)
        return button

    def open_page(self, page: str) -> None:
        """Show a page, and the window in front."""
        self.show()
        self.raise_()
        self.activateWindow()
        self.browser.go(page)

    def _fill(self, words: str) -> None:
        """List the contents, or what has the words that are searched for."""
        self.tree.clear()
        above: list[QTreeWidget | QTreeWidgetItem] = [self.tree]
        for entry in search_pages(words) if words.strip() else list_manual_entries():
            del above[entry.depth + 1 :]
            above.append(self._item(above[-1], entry))
        if words.strip() and not self.tree.topLevelItemCount():
            self._item(self.tree, ManualEntry(0, tr("No page has these words."), ""))
        self.tree.expandAll()

    def _item(self, above: QTreeWidget | QTreeWidgetItem, entry: ManualEntry) -> QTreeWidgetItem:
        words = f"{entry.heading} – {entry.title}" if entry.heading else entry.title
        item = QTreeWidgetItem(above, [words])
        item.setData(0, ROLE, entry)
        item.setToolTip(0, words)
        if not entry.page:
            item.setFlags(Qt.ItemFlag.ItemIsEnabled)
        return item

    def _chosen(self, item: QTreeWidgetItem | None) -> None:
        if item is not None and item.data(0, ROLE).page:
            self.browser.go(item.data(0, ROLE).page, item.data(0, ROLE).heading)

    def _mark(self, url: QUrl) -> None:
        """Mark the page that is shown in the contents."""
        every = Qt.MatchFlag.MatchContains | Qt.MatchFlag.MatchRecursive
        for item in self.tree.findItems("", every) if not self.search.text().strip() else ():
            if url.toLocalFile() == str(DOCS / (item.data(0, ROLE).page or "no page")):
                self.tree.setCurrentItem(item)
