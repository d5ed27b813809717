"""Which of the character's meshes are drawn: a list to tick, each tick a step that can be undone."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.project.document import Document
from app.stage.figures import Figures
from app.translation import tr, tr_plural
from metagraph.graph import edits

TICKED, OPEN = Qt.CheckState.Checked, Qt.CheckState.Unchecked


class MeshesDialog(QDialog):
    """Ticking one of several selected meshes ticks them all."""

    def __init__(self, document: Document, figures: Figures, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.figures = document, figures
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Meshes of the character"))
        self.resize(360, 440)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        self.list = QListWidget(self)
        self.list.setAccessibleName(tr("Meshes"))
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.list.itemChanged.connect(self._ticked)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.every = self.buttons.addButton(tr("Show all"), QDialogButtonBox.ButtonRole.ResetRole)
        self.every.clicked.connect(lambda: self._hide_meshes((), tr("Show all meshes")))
        self.buttons.rejected.connect(self.reject)
        for part in (self.words, self.list, self.buttons):
            layout.addWidget(part, 1 if part is self.list else 0)
        document.changed.connect(self._fill)
        document.loaded.connect(self.reject)
        figures.changed.connect(self._fill)
        self._fill()

    def _fill(self, *_: object) -> None:
        project = self.document.project
        figure = self.figures.figure(project.skeleton) if project.skeleton is not None else None
        meshes, hidden = figure.meshes if figure is not None else (), set(project.hidden)
        self.list.blockSignals(True)
        if [self.list.item(n).text() for n in range(self.list.count())] != list(meshes):
            self.list.clear()
            for mesh in meshes:
                item = QListWidgetItem(mesh, self.list)
                item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
        for n in range(self.list.count()):
            item = self.list.item(n)
            item.setCheckState(OPEN if item.text() in hidden else TICKED)
        self.list.blockSignals(False)
        count = sum(mesh in hidden for mesh in meshes)
        self.words.setText(
            (
                tr_plural(
                    "{count:,} of {every:,} meshes is hidden in the preview, thumbnails, pictures, videos "
                    "and exports.",
                    "{count:,} of {every:,} meshes are hidden in the preview, thumbnails, pictures, videos "
                    "and exports.",
                    count,
                    every=len(meshes),
                )
            )
            if meshes
            else tr("No character mesh is drawn. Choose a character first.")
        )
        self.every.setEnabled(count > 0)

    def _ticked(self, item: QListWidgetItem) -> None:
        names = [item.text()]
        if item.isSelected():
            names = [other.text() for other in self.list.selectedItems()]
        shown = item.checkState() == TICKED
        hidden = [mesh for mesh in self.document.project.hidden if mesh not in names]
        if len(names) == 1:
            words = tr("Show '{mesh}'", mesh=names[0]) if shown else tr("Hide '{mesh}'", mesh=names[0])
        else:
            count = len(names)
            words = (
                tr_plural("Show {count:,} mesh", "Show {count:,} meshes", count)
                if shown
                else tr_plural("Hide {count:,} mesh", "Hide {count:,} meshes", count)
            )
        self._hide_meshes(hidden if shown else [*hidden, *names], words)

    def _hide_meshes(self, meshes: list[str] | tuple[str, ...], words: str) -> None:
        self.document.edit(words, lambda project: edits.hide_meshes(project, meshes))
