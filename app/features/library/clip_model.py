"""The project's clips as Qt lists them, and those of them that are looked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import (
    QAbstractListModel,
    QMimeData,
    QModelIndex,
    QPersistentModelIndex,
    QSortFilterProxyModel,
    Qt,
)

from app.features.library.clip_order import GIVEN, ORDERS
from app.project.document import Document
from app.widgets.mime import mime
from metagraph.graph.generated import origin
from metagraph.graph.model import ClipEntry, Project
from metagraph.graph.name_search import fits

Index = QModelIndex | QPersistentModelIndex
ENTRY = Qt.ItemDataRole.UserRole
UP, DOWN = Qt.SortOrder.AscendingOrder, Qt.SortOrder.DescendingOrder


@dataclass(frozen=True)
class Filter:
    """What the library shows. labelled: None for both. kind, layer: None for any; they look at the actions
    that use a clip.
    """

    text: str = ""
    labelled: bool | None = None
    layer: str | None = None
    kind: str | None = None

    def takes(self, project: Project, entry: ClipEntry) -> bool:
        if (
            self.labelled is not None
            and (entry.id in project.uses or entry.id in project.drawn) != self.labelled
        ):
            return False
        if (self.layer or self.kind) and not any(
            (not self.layer or a.layer == self.layer) and (not self.kind or a.kind == self.kind)
            for a in project.uses.get(entry.id, ())
        ):
            return False
        return not self.text.strip(" -|") or fits(self.text, f"{entry.name} {entry.path}")


class ClipModel(QAbstractListModel):
    """The project's clips, in their order."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self.document = document
        self.entries: list[ClipEntry] = list(document.project.clips.values())
        document.changed.connect(self._follow)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 - Qt's signature
        return 0 if parent.isValid() else len(self.entries)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        if not index.isValid() or index.row() >= len(self.entries):
            return None
        entry = self.entries[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return entry.name
        if role == ENTRY:
            return entry
        if role == Qt.ItemDataRole.ToolTipRole:
            notes = "".join(
                f"\n{note}"
                for note in (entry.motion.notes if entry.motion is not None else ("The file is missing.",))
            )
            uses = ", ".join(f"{a.kind} ({a.layer})" for a in self.document.project.uses.get(entry.id, ()))
            uses = uses or (
                "drawn as a state" if entry.id in self.document.project.drawn else "not placed yet"
            )
            made = f"\n{origin(entry)}" if entry.made_by else ""
            return (
                f"{entry.name}\n{entry.duration:.2f} s, {entry.frames} frames at {entry.fps:g} "
                f"fps\n{entry.path}{made}\n{uses}{notes}"
            )
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return f"{entry.name}, {entry.duration:.1f} seconds"
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        return super().flags(index) | Qt.ItemFlag.ItemIsDragEnabled

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        return mime(clips=[self.entries[i.row()].id for i in indexes])

    def _follow(self, before: Project, after: Project) -> None:
        if before.clips is not after.clips:
            fresh = list(after.clips.values())
            same = [e.id for e in fresh] == [e.id for e in self.entries]
            if same:
                self.entries = fresh
            else:
                self.beginResetModel()
                self.entries = fresh
                self.endResetModel()
            if not same:
                return
        rows = _changed_rows(before, after, self.entries)
        for first, last in rows:
            self.dataChanged.emit(self.index(first), self.index(last))


def _changed_rows(before: Project, after: Project, entries: Sequence[ClipEntry]) -> list[tuple[int, int]]:
    """Return the first and last rows of clips that look otherwise, or are found otherwise, than before."""
    if before is after or not entries:
        return []
    stances = [
        [(s.id, s.name) for g in p.graphs.values() for s in g.stances.values()] for p in (before, after)
    ]
    if stances[0] != stances[1] or before.base is not after.base or before.manual is not after.manual:
        return [(0, len(entries) - 1)]
    uses = [(before.graphs[layer].uses, after.graphs[layer].uses) for layer in after.graphs]
    out: list[tuple[int, int]] = []
    for row, entry in enumerate(entries):
        same = before.clips.get(entry.id) is entry and all(
            (old := was.get(entry.id, ())) is (new := now.get(entry.id, ()))
            or [(a.layer, a.kind) for a in old] == [(a.layer, a.kind) for a in new]
            for was, now in uses
        )
        if not same:
            if out and out[-1][1] == row - 1:
                out[-1] = out[-1][0], row
            else:
                out.append((row, row))
    return out


class FilterModel(QSortFilterProxyModel):
    def __init__(self, model: ClipModel) -> None:
        super().__init__(model)
        self.filter = Filter()
        self.order, self.backwards = GIVEN, False
        self._keys: dict[str, Any] = {}  # of clips, what they are compared by
        self.setSourceModel(model)
        model.document.changed.connect(lambda *_: self._keys.clear())

    def set_filter(self, rule: Filter) -> None:
        if rule != self.filter:
            if hasattr(self, "beginFilterChange"):
                self.beginFilterChange()
                self.filter = rule
                self.endFilterChange()
            else:
                self.filter = rule
                self.invalidateFilter()

    def set_order(self, order: str, backwards: bool = False) -> None:
        """List clips in one of ORDERS, or the other way round."""
        self.order, self.backwards = order, backwards
        self._keys.clear()
        sorted_at_all = order != GIVEN or backwards
        self.sort(0 if sorted_at_all else -1, DOWN if backwards else UP)
        self.invalidate()

    def listed(self) -> list[str]:
        """Return all clips of the project in this order, those that are not shown, too."""
        entries = list(self.document.project.clips.values())
        if self.order != GIVEN:
            entries.sort(key=self._key)
        return [entry.id for entry in (reversed(entries) if self.backwards else entries)]

    @property
    def document(self) -> Document:
        model = self.sourceModel()
        assert isinstance(model, ClipModel)
        return model.document

    def _key(self, entry: ClipEntry) -> Any:
        if entry.id not in self._keys:
            self._keys[entry.id] = ORDERS[self.order][1](self.document.project, entry)
        return self._keys[entry.id]

    def lessThan(self, left: Index, right: Index) -> bool:
        if self.order == GIVEN:
            return left.row() < right.row()
        one, other = self._key(left.data(ENTRY)), self._key(right.data(ENTRY))
        return bool(one < other or (one == other and left.row() < right.row()))

    def filterAcceptsRow(self, row: int, parent: Index) -> bool:
        model = self.sourceModel()
        assert isinstance(model, ClipModel)
        return self.filter.takes(model.document.project, model.entries[row])

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        return mime(clips=[i.data(ENTRY).id for i in indexes])
