"""A Qt model of the clips in the library: those that match the filter, in groups and in order.
`arrange_clips` selects them; the rest notifies Qt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from PySide6.QtCore import QAbstractListModel, QMimeData, QModelIndex, QPersistentModelIndex, Qt

from app.features.library.clip_columns import format_stars
from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_filter import Filter
from app.features.library.clip_groups import GROUPS, NONE
from app.features.library.clip_layout import Section
from app.features.library.clip_order import GIVEN, ORDERS
from app.translation import tr, tr_phrase
from app.widgets.mime import make_mime
from metagraph.graph.generated import describe_origin
from metagraph.graph.model import ClipEntry, Project

Index = QModelIndex | QPersistentModelIndex
ENTRY = Qt.ItemDataRole.UserRole
EVERYTHING = Filter()


@dataclass(frozen=True)
class ClipListing:
    """What is shown of the clips, and how: filter, groups (of `GROUPS`), order (of `ORDERS`)."""

    filter: Filter = EVERYTHING
    group: str = NONE
    order: str = GIVEN
    backwards: bool = False

    @property
    def follows_marks(self) -> bool:
        """Whether a changed label or rating may change the rows."""
        return self.filter.marked or self.order in ("rating", "color", "favourite")

    @property
    def follows_problems(self) -> bool:
        return self.filter.broken or self.order == "problems"


def arrange_clips(facts: ClipFacts, listing: ClipListing) -> tuple[list[ClipEntry], list[Section]]:
    """Return the clips that a listing shows, in their order, and the groups they are in."""
    rule = listing.filter
    entries = list(facts.project.clips.values())
    if rule != EVERYTHING:
        entries = [e for e in entries if rule.takes(facts, e)]
    entries = order_clips(facts, listing, entries)
    group = GROUPS[listing.group][1]
    if group is None:
        return entries, [Section("", 0, len(entries))]
    found: dict[str, tuple[object, list[ClipEntry]]] = {}
    for entry in entries:
        key, title = group(facts, entry)
        found.setdefault(title, (key, []))[1].append(entry)
    out: list[ClipEntry] = []
    sections: list[Section] = []
    for title, (_, some) in sorted(found.items(), key=lambda item: item[1][0]):  # type: ignore[arg-type, return-value]
        sections.append(Section(title, len(out), len(some)))
        out += some
    return out, sections


def order_clips(facts: ClipFacts, listing: ClipListing, entries: list[ClipEntry]) -> list[ClipEntry]:
    """Return clips in a listing's order, ignoring groups. Equal ones keep the project's order."""
    if listing.order != GIVEN:
        key = ORDERS[listing.order][1]
        entries = sorted(entries, key=lambda entry: key(facts, entry))
    return entries[::-1] if listing.backwards else entries


class ClipRows(QAbstractListModel):
    """The model's rows. entries: the shown clips, by row. sections: their groups. closed: titles of closed
    groups. The model is reset when other clips are shown, or when clips move.
    """

    def __init__(self, facts: ClipFacts) -> None:
        super().__init__(facts.document)
        self.facts, self.document = facts, facts.document
        self.listing = ClipListing()
        self.closed: frozenset[str] = frozenset()
        self.entries: list[ClipEntry] = []
        self.sections: list[Section] = []
        self._row: dict[str, int] = {}
        self.arrange()
        self.document.changed.connect(self._follow)

    @property
    def filter(self) -> Filter:
        return self.listing.filter

    def show(self, listing: ClipListing) -> None:
        """Show what a listing says."""
        if listing != self.listing:
            if listing.group != self.listing.group:
                self.closed = frozenset()
            self.listing = listing
            self.arrange()

    def arrange(self) -> None:
        """Compute the shown clips, and notify Qt if they changed."""
        entries, sections = arrange_clips(self.facts, self.listing)
        sections = [replace(s, closed=s.title in self.closed) for s in sections]
        if sections == self.sections and [e.id for e in entries] == [e.id for e in self.entries]:
            self.entries = entries
            return
        self.beginResetModel()
        self.entries, self.sections = entries, sections
        self._row = {e.id: n for n, e in enumerate(entries)}
        self.endResetModel()

    def close_groups(self, titles: frozenset[str]) -> None:
        """Close these groups, and open all others."""
        self.closed = titles
        self.sections = [replace(s, closed=s.title in titles) for s in self.sections]
        self.layoutChanged.emit()

    def row_of(self, clip: str) -> int | None:
        """Return the row of a clip; None if it is not shown."""
        return self._row.get(clip)

    def listed(self) -> list[str]:
        """Return all clips of the project in this order, also those that are not shown."""
        return [e.id for e in order_clips(self.facts, self.listing, list(self.facts.project.clips.values()))]

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
            return self._tip(entry)
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return tr(
                "{name}, {duration:.1f} seconds{marks}",
                name=entry.name,
                duration=entry.duration,
                marks=self._marks(entry),
            )
        return None

    def _tip(self, entry: ClipEntry) -> str:
        motion = entry.motion
        told = motion.notes if motion else (tr("The file is missing."),)
        notes = "".join(f"\n{tr_phrase(n)}" for n in told)
        uses = ", ".join(f"{tr(a.kind)} ({tr(a.layer)})" for a in self.facts.uses(entry))
        drawn = entry.id in self.document.project.drawn
        uses = uses or (tr("used as a state") if drawn else tr("not placed yet"))
        made = f"\n{describe_origin(entry)}" if entry.made_by else ""
        moves = self.facts.moved_words(entry)
        mark = self.facts.mark(entry)
        return tr(
            "{name}\n{duration:.2f} s, {frames} frames at {fps:g} fps{moves}\n{path}{made}\n"
            "{uses}{marks}{note}{notes}",
            name=entry.name,
            duration=entry.duration,
            frames=entry.frames,
            fps=entry.fps,
            moves=tr(", moves {moves}", moves=moves) if moves else "",
            path=entry.path,
            made=made,
            uses=uses,
            marks=self._marks(entry).replace(", ", chr(10), 1),
            note=chr(10) + mark.note if mark.note else "",
            notes=notes,
        )

    def _marks(self, entry: ClipEntry) -> str:
        """Return a clip's label, rating and heart in words, after a comma each."""
        mark = self.facts.mark(entry)
        some = (tr("{color} label", color=mark.color) if mark.color else "", format_stars(mark.rating))
        return "".join(f", {w}" for w in (*some, tr("a favourite") if mark.favourite else "") if w)

    def flags(self, index: Index) -> Qt.ItemFlag:
        return super().flags(index) | Qt.ItemFlag.ItemIsDragEnabled

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        return make_mime(clips=[self.entries[i.row()].id for i in indexes])

    def _follow(self, before: Project, after: Project) -> None:
        listing = self.listing
        rows = find_changed_rows(before, after, self.entries)
        placed = before.graphs is not after.graphs or before.manual is not after.manual
        again = before.clips is not after.clips
        again |= before.marks is not after.marks and listing.follows_marks
        sorted_by = listing.group, listing.order
        if placed and (listing.filter.placed or sorted_by != (NONE, GIVEN)):
            again |= bool(rows) or listing.filter.placed
        if again:
            self.arrange()
            rows = find_changed_rows(before, after, self.entries)
        for first, last in rows:
            self.dataChanged.emit(self.index(first), self.index(last))


def find_changed_rows(before: Project, after: Project, entries: Sequence[ClipEntry]) -> list[tuple[int, int]]:
    """Return the first and last rows of clips that now look different or match another search."""
    if before is after or not entries:
        return []
    names = [[(s.id, s.name) for g in p.graphs.values() for s in g.stances.values()] for p in (before, after)]
    if names[0] != names[1] or before.base is not after.base or before.manual is not after.manual:
        return [(0, len(entries) - 1)]
    uses = [(before.graphs[layer].uses, after.graphs[layer].uses) for layer in after.graphs]
    same_marks = before.marks is after.marks
    out: list[tuple[int, int]] = []
    for row, entry in enumerate(entries):
        ident = entry.id
        same = before.clips.get(ident) is entry and all(
            (old := was.get(ident, ())) is (new := now.get(ident, ()))
            or [(a.layer, a.kind, a.stance, a.tags) for a in old]
            == [(a.layer, a.kind, a.stance, a.tags) for a in new]
            for was, now in uses
        )
        same = same and (same_marks or before.marks.get(ident) == after.marks.get(ident))
        if not same:
            if out and out[-1][1] == row - 1:
                out[-1] = out[-1][0], row
            else:
                out.append((row, row))
    return out
