"""The rows and columns of the table, as Qt asks for them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt
from PySide6.QtGui import QBrush, QColor

from app.features.table.cell_words import NUMBERS, TITLES, describe_column, parse_typed, translate_cell
from app.features.table.table_filter import TableFilter
from app.look.theme import KIND_MARKS, WindowTheme
from app.translation import tr
from metagraph.graph.editing.half_labels import find_half_label, has_half_label
from metagraph.graph.model import Project
from metagraph.playback.action_table import COLUMNS, ActionRow, Cell, Column, can_write, list_rows, read_cell

Index = QModelIndex | QPersistentModelIndex
Role = Qt.ItemDataRole


class TableModel(QAbstractTableModel):
    """Rows keep their order while they are edited; `sort` and `show_filter` arrange them again. refused: the
    cells whose last text could not be written, with the reason.
    """

    def __init__(self, look: WindowTheme) -> None:
        super().__init__()
        self.look, self.project = look, Project()
        self.filter = TableFilter()
        self.rows: list[ActionRow] = []
        self.refused: Mapping[Cell, str] = {}
        self._sorted: tuple[Column | None, bool] = (None, False)

    # --- what is shown

    def show_project(self, project: Project) -> None:
        """Show another state of the project. Rows stay where they are, and new ones come last; what a clip
        became stands in the clip's place.
        """
        old, self.project = self.rows, project
        every = {row.ident: row for row in list_rows(project)}
        seen = {row.ident for row in old}  # an edited row stays, even where the filter would not take it now
        became = {row.clip for row in old if row.ident not in every}
        found = {
            ident: row
            for ident, row in every.items()
            if ident in seen or row.clip in became or self.filter.takes(project, row)
        }
        rows = [found.pop(row.ident) for row in old if row.ident in found]
        if len(rows) == len(old) and not found:
            self.rows = rows
            if rows:
                self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, len(COLUMNS) - 1))
            return
        by_clip: dict[str, list[ActionRow]] = {}
        for row in found.values():
            by_clip.setdefault(row.clip, []).append(row)
        kept = {row.ident: row for row in rows}
        self.beginResetModel()
        self.rows = []
        for row in old:
            self.rows += [kept[row.ident]] if row.ident in kept else by_clip.pop(row.clip, [])
        self.rows += [row for some in by_clip.values() for row in some]
        self.endResetModel()

    def show_filter(self, rule: TableFilter) -> None:
        """Show the rows that a filter takes, sorted as they were."""
        self.filter = rule
        self._arrange()

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        wanted = COLUMNS[column] if 0 <= column < len(COLUMNS) else None
        self._sorted = wanted, order == Qt.SortOrder.DescendingOrder
        self._arrange()

    def _arrange(self) -> None:
        self.beginResetModel()
        self.rows = [row for row in list_rows(self.project) if self.filter.takes(self.project, row)]
        column, down = self._sorted
        if column is not None:
            self.rows.sort(key=lambda row: self._sort_key(row, column), reverse=down)
        self.endResetModel()

    def _sort_key(self, row: ActionRow, column: Column) -> tuple[Any, ...]:
        text = read_cell(self.project, row, column)
        if column in NUMBERS:
            return (text == "", float(text or 0.0))
        parts = re.split(r"(\d+)", translate_cell(column, text).casefold())
        return (text == "", *((int(p) if n % 2 else p) for n, p in enumerate(parts)))

    def is_refused(self, index: Index) -> bool:
        """Return whether a cell could not be written."""
        return (self.rows[index.row()].ident, COLUMNS[index.column()]) in self.refused

    def show_refused(self, refused: Mapping[Cell, str]) -> None:
        """Mark the cells that could not be written."""
        self.refused = refused
        if self.rows:
            self.dataChanged.emit(self.index(0, 0), self.index(len(self.rows) - 1, len(COLUMNS) - 1))

    # --- cells

    def cell(self, index: Index) -> Cell:
        return self.rows[index.row()].ident, COLUMNS[index.column()]

    def text(self, index: Index) -> str:
        """Return what a cell says, as it is typed."""
        row, column = self.rows[index.row()], COLUMNS[index.column()]
        return translate_cell(column, read_cell(self.project, row, column))

    def typed(self, index: Index, words: str) -> str:
        """Return the text that typed words stand for in a cell."""
        return parse_typed(COLUMNS[index.column()], words)

    def find(self, idents: Iterable[str]) -> list[int]:
        """Return the rows of some ids."""
        wanted = set(idents)
        return [n for n, row in enumerate(self.rows) if row.ident in wanted]

    # --- what Qt asks for

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008  as Qt declares it
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008  as Qt declares it
        return 0 if parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Role.DisplayRole) -> Any:
        if orientation == Qt.Orientation.Horizontal:
            if role == Role.DisplayRole:
                return TITLES[COLUMNS[section]]
            if role == Role.ToolTipRole:
                return describe_column(COLUMNS[section])
        return section + 1 if role == Role.DisplayRole else None

    def flags(self, index: Index) -> Qt.ItemFlag:
        usual = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        writable = can_write(self.rows[index.row()], COLUMNS[index.column()])
        return usual | Qt.ItemFlag.ItemIsEditable if writable else usual

    def data(self, index: Index, role: int = Role.DisplayRole) -> Any:
        row, column = self.rows[index.row()], COLUMNS[index.column()]
        if role == Role.EditRole:
            return self.text(index)
        if role == Role.DisplayRole:
            return self._shown(row, column)
        if role == Role.TextAlignmentRole and column in NUMBERS:
            return Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        if role == Role.ForegroundRole:
            return self._ink(row, column)
        if role == Role.BackgroundRole and self.is_refused(index):
            fill = QColor(self.look.error)
            fill.setAlpha(60)
            return QBrush(fill)
        if role == Role.ToolTipRole:
            return self.refused.get((row.ident, column)) or self._tip(row, column)
        return None

    def _shown(self, row: ActionRow, column: Column) -> str:
        text = read_cell(self.project, row, column)
        if column == "kind" and text:
            return f"{KIND_MARKS[text]} {translate_cell(column, text)}"
        return translate_cell(column, text) or (tr("needed") if self._is_needed(row, column) else "")

    def _is_needed(self, row: ActionRow, column: Column) -> bool:
        """Return whether a half labelled clip waits for what a cell would say."""
        if row.action is not None or not has_half_label(self.project, row.clip):
            return False
        known = find_half_label(self.project, row.clip)
        if column == "layer":
            return bool(known.kind and known.stance and not known.layer)
        needed = ("kind", "stance", "end_stance") if known.kind == "transition" else ("kind", "stance")
        return column in needed and not getattr(known, column)

    def _ink(self, row: ActionRow, column: Column) -> QBrush | None:
        if self._is_needed(row, column):
            return QBrush(QColor(self.look.warning))
        text = read_cell(self.project, row, column)
        if column == "kind" and text:
            return QBrush(self.look.kind(text))
        return QBrush(QColor(self.look.dim)) if row.action is None or column == "clip" else None

    def _tip(self, row: ActionRow, column: Column) -> str:
        if row.action is None and column not in ("name", "clip"):
            return tr("This clip has no action yet. It gets one when its kind and stance are known.")
        return ""
