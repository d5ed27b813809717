"""The list of pieces that were cut from what a model made; those that are checked are kept."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHeaderView, QTableWidget, QTableWidgetItem, QWidget

from app.features.generation.generation_jobs import Piece

HEADS = ("Piece", "Length", "Taken for", "Arm")


class PiecesTable(QTableWidget):
    """itemChanged: another piece is checked."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, len(HEADS), parent)
        self.pieces: tuple[Piece, ...] = ()
        self.setHorizontalHeaderLabels(list(HEADS))
        self.setAccessibleName("Pieces")
        self.verticalHeader().hide()
        self.setShowGrid(False)
        self.setSelectionBehavior(QTableWidget.SelectionBehavior.SelectRows)
        self.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)

    def show_pieces(self, pieces: Sequence[Piece]) -> None:
        """List pieces, all checked."""
        self.pieces = tuple(pieces)
        self.blockSignals(True)
        self.setRowCount(len(pieces))
        for n, piece in enumerate(pieces):
            name = QTableWidgetItem(piece.clip.name)
            name.setFlags(
                Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsUserCheckable
            )
            name.setCheckState(Qt.CheckState.Checked)
            self.setItem(n, 0, name)
            sure = f", {100 * piece.sure:.0f} % sure" if piece.sure > 0 else ""
            texts = (f"{piece.clip.duration:.1f} s", f"{piece.kind}{sure}", piece.limb)
            for column, text in enumerate(texts, 1):
                self.setItem(n, column, QTableWidgetItem(text))
        self.blockSignals(False)
        self.viewport().update()
        if pieces:
            self.itemChanged.emit(self.item(0, 0))

    def chosen(self) -> list[Piece]:
        """Return the pieces that are checked."""
        out = []
        for n, piece in enumerate(self.pieces):
            item = self.item(n, 0)
            if item is not None and item.checkState() == Qt.CheckState.Checked:
                out.append(piece)
        return out
