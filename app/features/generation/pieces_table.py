"""The list of pieces that were cut from what a model made, to be looked at and labelled; those that are
checked are kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QHeaderView, QTableWidget, QTableWidgetItem, QWidget

from app.features.generation.generation_jobs import GeneratedPiece
from app.features.generation.sample_preview import FigurePreview
from app.project.document import Document
from app.translation import format_number, make_lazy_texts, tr, tr_noop
from app.widgets.quiet_fields import ComboBox
from metagraph.generation.landmarks import place_landmarks
from metagraph.generation.networks import FPS
from metagraph.generation.poses import encode_clip
from metagraph.graph.model import Kind, Limb

HEADS = make_lazy_texts(lambda: (tr("Piece"), tr("Length"), tr("Kind"), tr("Confidence"), tr("Arm")))
KIND, SURE, LIMB = 2, 3, 4  # columns
KINDS: tuple[Kind, ...] = ("gesture", "fidget")
LIMBS: tuple[Limb, ...] = ("both", "left", "right")
EMPTY = tr_noop("Generated pieces appear here. Check them before you add them.")


class PiecesTable(QTableWidget):
    """itemChanged: another piece is checked. pieces: as they are labelled by now."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, len(HEADS), parent)
        self.pieces: list[GeneratedPiece] = []
        self.setHorizontalHeaderLabels(list(HEADS))
        self.setAccessibleName(tr("Pieces"))
        self.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.verticalHeader().hide()
        self.setShowGrid(False)
        self.setSelectionBehavior(QTableWidget.SelectionBehavior.SelectRows)
        self.setSelectionMode(QTableWidget.SelectionMode.SingleSelection)
        self.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        sample = ComboBox(self)  # rows and columns have room for choices, whatever the font
        sample.addItems([*KINDS, *LIMBS])
        wanted = sample.sizeHint()
        sample.deleteLater()
        self.verticalHeader().setDefaultSectionSize(wanted.height() + 6)
        for column in (KIND, LIMB):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Fixed)
            self.setColumnWidth(column, wanted.width() + 24)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self.rowCount() == 0:
            painter = QPainter(self.viewport())
            painter.setPen(self.palette().placeholderText().color())
            painter.drawText(
                self.viewport().rect(), Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, tr(EMPTY)
            )
            painter.end()

    def show_pieces(self, pieces: Sequence[GeneratedPiece]) -> None:
        """List pieces, all checked, the first one selected."""
        self.pieces = list(pieces)
        self.blockSignals(True)
        self.clearSelection()
        self.setRowCount(0)  # the choices in it as well
        self.setRowCount(len(pieces))
        for n, piece in enumerate(pieces):
            name = QTableWidgetItem(piece.clip.name)
            name.setFlags(
                Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsUserCheckable
            )
            name.setCheckState(Qt.CheckState.Checked)
            self.setItem(n, 0, name)
            self.setItem(n, 1, QTableWidgetItem(f"{format_number(piece.clip.duration, '.1f')} s"))
            self.setItem(
                n,
                SURE,
                QTableWidgetItem(f"{100 * piece.sure:.0f} %" if piece.sure > 0 else ""),
            )
            self._offer(n, KIND, KINDS, piece.kind, tr("Kind of {name}", name=piece.clip.name))
            self._offer(n, LIMB, LIMBS, piece.limb, tr("Arm of {name}", name=piece.clip.name))
        self.blockSignals(False)
        self.viewport().update()
        if pieces:
            self.itemChanged.emit(self.item(0, 0))
            self.selectRow(0)
        else:
            self.itemSelectionChanged.emit()

    def _offer(self, row: int, column: int, values: Sequence[str], now: str, name: str) -> None:
        box = ComboBox(self)
        box.setAccessibleName(name)
        box.setFrame(False)
        box.addItems([tr(value) for value in values])
        box.setCurrentIndex(values.index(now))
        box.currentIndexChanged.connect(lambda _: self._labelled(row))
        self.setCellWidget(row, column, box)

    def _labelled(self, row: int) -> None:
        """A kind or an arm was chosen: whoever did that is sure of it."""
        kind, limb = self._choice(row, KIND), self._choice(row, LIMB)
        self.pieces[row] = replace(self.pieces[row], kind=KINDS[kind], limb=LIMBS[limb], sure=0.0)
        self.setItem(row, SURE, QTableWidgetItem(""))
        self.selectRow(row)

    def _choice(self, row: int, column: int) -> int:
        box = self.cellWidget(row, column)
        assert isinstance(box, ComboBox)
        return max(0, box.currentIndex())

    def chosen(self) -> list[GeneratedPiece]:
        """Return the pieces that are checked."""
        out = []
        for n, piece in enumerate(self.pieces):
            item = self.item(n, 0)
            if item is not None and item.checkState() == Qt.CheckState.Checked:
                out.append(piece)
        return out

    def selected(self) -> GeneratedPiece | None:
        """Return the piece whose row is selected."""
        rows = {i.row() for i in self.selectedItems()}
        return self.pieces[min(rows)] if rows and min(rows) < len(self.pieces) else None


class PiecesView(QWidget):
    """The list, and how the selected piece moves."""

    def __init__(self, document: Document, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.table = PiecesTable(self)
        self.preview = FigurePreview(("",), tr("Select a piece to see it move here."), FPS, self)
        self.preview.setAccessibleName(tr("Preview of the selected piece"))
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.table, 3)
        row.addWidget(self.preview, 1)
        self.table.itemSelectionChanged.connect(self._show)

    def _show(self) -> None:
        piece = self.table.selected()
        if piece is None:
            self.preview.show_moves(0, None)
            return
        from metagraph.generation.performing import project_rig

        rig = project_rig(self.document.project)
        self.preview.words = (piece.clip.name,)
        self.preview.show_moves(0, place_landmarks(rig, encode_clip(rig, piece.clip, FPS)))
