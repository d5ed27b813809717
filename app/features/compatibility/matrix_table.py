"""The table of clips against stances: its cells, their marks and words; searched and sorted a thousand rows
at once.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetrics, QPainter, QPainterPath, QPen
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from app.look.plural import list_in_words
from app.look.theme import KIND_MARKS, WindowTheme, get_theme
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_noop
from metagraph.graph.model import KINDS, Kind, Project

if TYPE_CHECKING:
    from metagraph.suggest.jumps.compatibility import Matrix

Index = QModelIndex | QPersistentModelIndex
CELL = Qt.ItemDataRole.UserRole
CLIP, USES, FIRST = 0, 1, 2  # columns; from FIRST on, stances
BLENDED = 2.0  # times what shows as a jump: what the blend of a dropped clip, 0.2 s, hides
MARK = 15.0  # pixels
ROW = 26


@dataclass(frozen=True)
class Cell:
    """A clip beside a stance: costs of what shows as a jump, and the best moments, seconds. here: kinds it is
    placed there as.
    """

    enter: float
    leave: float
    enter_at: float
    leave_at: float
    here: tuple[Kind, ...] = ()


def grade_jump(cost: float) -> int:
    """Return 0 for what does not show, 1 for what a blend hides, 2 for a jump, 3 for nothing known."""
    return 0 if cost <= 1 else 1 if cost <= BLENDED else 2 if isfinite(cost) else 3


def describe_half_cell(cost: float, seconds: float, what: str) -> str:
    """Say a half: "leaves at 1.24 s: no jump, 0.6 of the visible threshold"."""
    what = tr("enters") if what == "enters" else tr("leaves")
    words = (
        tr_noop("{what} at {seconds:.2f} s: no jump, {cost:.1f} of the visible threshold"),
        tr_noop(
            "{what} at {seconds:.2f} s: jumps, {cost:.1f} times the visible threshold; a usual blend hides it"
        ),
        tr_noop(
            "{what} at {seconds:.2f} s: jumps, {cost:.1f} times the visible threshold; a usual blend does "
            "not hide it"
        ),
    )
    if not isfinite(cost):
        return tr("{what}: nothing to compare", what=what)
    return tr(words[grade_jump(cost)], what=what, seconds=seconds, cost=cost)


def describe_cell(cell: Cell, clip: str, stance: str) -> str:
    """Say a cell in two lines under its names."""
    lines = [
        f"{clip}  ·  {stance}",
        describe_half_cell(cell.enter, cell.enter_at, "enters"),
        describe_half_cell(cell.leave, cell.leave_at, "leaves"),
    ]
    if cell.here:
        lines.append(tr("placed here as {here}", here=list_in_words([tr(kind) for kind in cell.here])))
    return "\n".join(lines)


@dataclass
class Rows:
    """What the table shows. kinds: (clip, stance) -> kinds placed there. place: row of a clip in the
    matrix.
    """

    project: Project
    matrix: Matrix
    kinds: dict[tuple[str, str], tuple[Kind, ...]] = field(default_factory=dict)
    uses: dict[str, tuple[Kind, ...]] = field(default_factory=dict)

    @classmethod
    def of(cls, project: Project, matrix: Matrix) -> Rows:
        out = cls(project, matrix)
        at: dict[tuple[str, str], dict[Kind, None]] = {}
        uses: dict[str, dict[Kind, None]] = {}
        for action in project.graphs[matrix.layer].actions.values():
            at.setdefault((action.clip, action.stance), {})[action.kind] = None
            uses.setdefault(action.clip, {})[action.kind] = None
        out.kinds = {k: tuple(v) for k, v in at.items()}
        out.uses = {k: tuple(v) for k, v in uses.items()}
        return out


class MatrixModel(QAbstractTableModel):
    """Clips down, stances across; searched, narrowed to what is placed on the layer or is not, and sorted,
    here: a thousand rows at once.

    order: the places in the matrix of the rows that are shown.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.rows: Rows | None = None
        self.order: list[int] = []
        self.words: tuple[str, ...] = ()
        self.which = "all"
        self.by, self.falling = USES, False

    def show_rows(self, rows: Rows | None) -> None:
        """Show other rows, sorted and narrowed as those before."""
        self.beginResetModel()
        self.rows = rows
        self._arrange()
        self.endResetModel()

    def narrow(self, text: str, which: str) -> None:
        """Show only clips with all words of a text in their names. which: "all", "placed" on the layer, or
        "free".
        """
        self.words, self.which = tuple(text.lower().split()), which
        self.show_rows(self.rows)

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        self.by, self.falling = column, order == Qt.SortOrder.DescendingOrder
        self.show_rows(self.rows)

    def _arrange(self) -> None:
        self.order = []
        if self.rows is None:
            return
        m, clips, uses = self.rows.matrix, self.rows.project.clips, self.rows.uses
        names = [clips[c].name.lower() if c in clips else "" for c in m.clips]
        shown = [
            n
            for n, c in enumerate(m.clips)
            if c in clips
            and (self.which == "all" or (c in uses) == (self.which == "placed"))
            and all(w in names[n] for w in self.words)
        ]
        if FIRST <= self.by < FIRST + len(m.stances):
            worst = [
                max(a, b)
                for a, b in zip(
                    m.enter_cost[:, self.by - FIRST], m.leave_cost[:, self.by - FIRST], strict=True
                )
            ]
            shown.sort(key=lambda n: (worst[n], names[n]), reverse=self.falling)
        elif self.by == CLIP:
            shown.sort(key=lambda n: names[n], reverse=self.falling)
        else:
            place = {c: KINDS.index(kinds[0]) for c, kinds in uses.items()}
            shown.sort(key=lambda n: (place.get(m.clips[n], len(KINDS)), names[n]), reverse=self.falling)
        self.order = shown

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 - Qt's signature
        return len(self.order) if not parent.isValid() else 0

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 - Qt's signature
        return FIRST + len(self.rows.matrix.stances) if self.rows is not None and not parent.isValid() else 0

    def row_of(self, clip: str) -> int | None:
        """Return the row that shows a clip."""
        if self.rows is None or clip not in self.rows.matrix.clips:
            return None
        place = self.rows.matrix.clips.index(clip)
        return self.order.index(place) if place in self.order else None

    def clip(self, row: int) -> str:
        return self.rows.matrix.clips[self.order[row]] if self.rows is not None else ""

    def stance(self, column: int) -> str | None:
        return self.rows.matrix.stances[column - FIRST] if self.rows is not None and column >= FIRST else None

    def cell(self, row: int, column: int) -> Cell | None:
        """Return what a cell holds, None for the first columns."""
        if self.rows is None or column < FIRST:
            return None
        m, c, row = self.rows.matrix, column - FIRST, self.order[row]
        here = self.rows.kinds.get((m.clips[row], m.stances[c]), ())
        return Cell(
            float(m.enter_cost[row, c]),
            float(m.leave_cost[row, c]),
            float(m.enter_at[row, c]),
            float(m.leave_at[row, c]),
            here,
        )

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if self.rows is None or not index.isValid():
            return None
        row, column = index.row(), index.column()
        clip = self.clip(row)
        entry = self.rows.project.clips.get(clip)
        if entry is None:
            return None  # it was removed meanwhile
        if column == CLIP:
            return entry.name if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole) else None
        if column == USES:
            kinds = self.rows.uses.get(clip, ())
            if role == CELL:
                return kinds
            if role in (Qt.ItemDataRole.ToolTipRole, Qt.ItemDataRole.AccessibleTextRole):
                return ", ".join(kinds) or tr("not placed on this layer")
            return None
        cell = self.cell(row, column)
        if cell is None:
            return None
        if role == CELL:
            return cell
        if role in (Qt.ItemDataRole.ToolTipRole, Qt.ItemDataRole.AccessibleTextRole):
            return describe_cell(cell, entry.name, self._name(column))
        return None

    def _name(self, column: int) -> str:
        found = self.rows.project.stance(self.stance(column)) if self.rows is not None else None
        return found.name if found is not None else "?"

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        if orientation != Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return {CLIP: tr("Clip"), USES: tr("Kind")}.get(section) or self._name(section)
        if role == Qt.ItemDataRole.TextAlignmentRole and section < FIRST:
            return Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        if role == Qt.ItemDataRole.ToolTipRole:
            if section >= FIRST:
                return tr("Click to sort by how well clips fit '{name}'", name=self._name(section))
            return tr("Click to sort") if section == CLIP else tr("What the clip is on this layer")
        return None


def draw_half_disc(rect: QRectF, side: str) -> QPainterPath:
    """Return half a disc: "in" is the left one, its arrow's way into the clip, "out" the right one."""
    path = QPainterPath(rect.center())
    path.arcTo(rect, 90, 180 if side == "in" else -180)
    path.closeSubpath()
    return path


def draw_half(painter: QPainter, t: WindowTheme, rect: QRectF, side: str, cost: float) -> None:
    """Draw one half of a mark: filled, outlined, a cross, or a dot; shape says it as well as colour."""
    moved = rect.translated(-1.5 if side == "in" else 1.5, 0)
    level = grade_jump(cost)
    if level == 0:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(t.kind("stance"))
        painter.drawPath(draw_half_disc(moved, side))
    elif level == 1:
        painter.setPen(QPen(QColor(t.warning), 1.4))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(draw_half_disc(moved.adjusted(0.7, 0.7, -0.7, -0.7), side))
    else:
        x = rect.center().x() + (-0.32 if side == "in" else 0.32) * rect.width()
        y, r = rect.center().y(), 3.2 if level == 2 else 0.8
        painter.setPen(QPen(QColor(t.dim), 1.5))
        painter.drawLine(round(x - r), round(y - r), round(x + r), round(y + r))
        painter.drawLine(round(x - r), round(y + r), round(x + r), round(y - r))


class MatrixMarks(QStyledItemDelegate):
    """Draws cells and kinds."""

    def __init__(self, session: StageSession, parent: QWidget) -> None:
        super().__init__(parent)
        self.session = session

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        return QSize(84, ROW)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        t, rect = get_theme(self.session.look.name), QRectF(option.rect)
        painter.save()
        if option.state & QStyle.StateFlag.State_Selected:
            painter.fillRect(rect, QColor(t.hover))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        value = index.data(CELL)
        if isinstance(value, Cell):
            if value.here:
                painter.setPen(QPen(t.kind(value.here[0]), 1.3))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawRoundedRect(QRectF(rect.center().x() - 17, rect.center().y() - 11, 34, 22), 5, 5)
            disc = QRectF(rect.center().x() - MARK / 2, rect.center().y() - MARK / 2, MARK, MARK)
            draw_half(painter, t, disc, "in", value.enter)
            draw_half(painter, t, disc, "out", value.leave)
            if option.state & QStyle.StateFlag.State_HasFocus:
                painter.setPen(QPen(QColor(t.text), 1.4))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawRoundedRect(rect.adjusted(2, 2, -2, -2), 4, 4)
        elif value:
            x = rect.left() + 8
            for kind in value:
                painter.setPen(t.kind(kind))
                painter.drawText(
                    QRectF(x, rect.top(), 18, rect.height()), Qt.AlignmentFlag.AlignVCenter, KIND_MARKS[kind]
                )
                x += 17
        painter.restore()


class Legend(QWidget):
    """What the marks mean."""

    PARTS = make_lazy_texts(lambda: ((0.5, tr("no jump")), (2.0, tr("a blend hides it")), (9.0, tr("jumps"))))

    def __init__(self, session: StageSession, parent: QWidget) -> None:
        super().__init__(parent)
        self.session = session
        self.setFixedHeight(24)
        self.setAccessibleName(tr("Left half: entry from the stance. Right half: exit to it."))
        session.look.changed.connect(self.update)

    def paintEvent(self, event: object) -> None:
        t = get_theme(self.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        x, y = 2.0, self.height() / 2
        metrics = QFontMetrics(self.font())

        def say(words: str, gap: float) -> None:
            nonlocal x
            painter.setPen(QColor(t.dim))
            wide = metrics.horizontalAdvance(words)
            painter.drawText(QRectF(x, 0, wide + 4, self.height()), Qt.AlignmentFlag.AlignVCenter, words)
            x += wide + gap

        for side, words in (("in", tr("entry from the stance")), ("out", tr("exit to it"))):
            draw_half(painter, t, QRectF(x, y - MARK / 2, MARK, MARK), side, 0.0)
            x += MARK + 5
            say(words, 16)
        x += 10
        for cost, words in self.PARTS:
            disc = QRectF(x, y - MARK / 2, MARK, MARK)
            draw_half(painter, t, disc, "in", cost)
            draw_half(painter, t, disc, "out", cost)
            x += MARK + 6
            say(words, 16)
        painter.end()
