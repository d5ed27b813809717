"""Find a stance of any layer by typing, however many there are."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QDialog, QLabel, QLineEdit, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from app.look.names import make_readable_name
from app.translation import tr, tr_plural
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import LAYERS, Layer, Project

ROLE = Qt.ItemDataRole.UserRole
KEYS = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown)


class StanceFinder(QDialog):
    """Words narrow the list of stances, Up and Down go through it, Enter or a double click goes there. The
    stances of `layer` come first. go: gets the stance's id.
    """

    def __init__(self, project: Project, layer: Layer, go: Callable[[str], object], parent: QWidget) -> None:
        super().__init__(parent)
        self.project, self.go = project, go
        self.setWindowTitle(tr("Find stance"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.layers = (layer, *(x for x in LAYERS if x != layer))
        self.search = QLineEdit(self, placeholderText=tr("Type a stance's name"), clearButtonEnabled=True)
        self.search.setAccessibleName(tr("Search stances"))
        self.search.installEventFilter(self)
        self.search.textChanged.connect(self._narrow)
        self.list = QListWidget(self)
        self.list.setAccessibleName(tr("Stances"))
        self.list.itemActivated.connect(lambda _: self.go_there())
        self.none = QLabel(tr("No stance is called so."), self)
        self.none.setProperty("dim", True)
        layout = QVBoxLayout(self)
        for part in (self.search, self.none, self.list):
            layout.addWidget(part)
        self._narrow("")
        self.resize(420, 420)
        self.search.setFocus()

    def _narrow(self, wanted: str) -> None:
        """List the stances in whose names are all words typed."""
        words = wanted.casefold().split()
        self.list.clear()
        for layer in self.layers:
            graph = self.project.graphs[layer]
            for stance in graph.stances.values():
                name = make_readable_name(stance.name)
                text = f"{stance.name} {name} {get_vocabulary_title(layer)}".casefold()
                if not all(word in text for word in words):
                    continue
                count = sum(len(graph.of(stance.id, k)) for k in ("gesture", "fidget", "transition"))
                actions = tr_plural("{count:,} action", "{count:,} actions", count)
                item = QListWidgetItem(f"{name}  ·  {get_vocabulary_title(layer)}, {actions}", self.list)
                item.setData(ROLE, stance.id)
        self.list.setCurrentRow(0)
        self.none.setVisible(not self.list.count())
        self.list.setVisible(bool(self.list.count()))

    def go_there(self) -> None:
        """Go to the stance that is marked, and close."""
        item = self.list.currentItem()
        if item is not None:
            stance = str(item.data(ROLE))
            self.accept()
            self.go(stance)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.search and isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            if event.key() in KEYS:
                self.list.keyPressEvent(event)
                return True
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self.go_there()
                return True
        return super().eventFilter(watched, event)
