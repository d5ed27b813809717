"""A model's matrix as a heat map that is edited in place: rows are what is done now, columns what comes
next.
"""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QLineEdit, QWidget

from app.features.models.state_names import describe_tag, name_state_in_sentence
from app.look.theme import KIND_MARKS, WindowTheme, get_theme
from app.translation import tr
from metagraph.graph.model import Layer, Markov
from metagraph.playback.learning.learn import State, list_model_states

HEAD = 38.0  # pixels above the columns
SIDE = 104.0  # left of the rows
DRAG = 160.0  # pixels of dragging from 0 to 100 %
INKS = ("#17181b", "#f4f5f7")
SIDES = {"left": "L", "right": "R", "both": "LR"}  # as in the paper's figure 11
_SHORT = {"positive": "+", "negative": "−"}
_GAP = 18.0  # from a mark to what stands behind it
_TWO_LINES = 32.0  # pixels of a row in which tags have a line of their own
_CORNER = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignBottom


@dataclass(frozen=True)
class HeatmapGrid:
    """Where the cells are: n rows and columns of `wide` x `high` pixels."""

    count: int
    wide: float
    high: float

    def cell(self, row: int, column: int) -> QRectF:
        return QRectF(SIDE + column * self.wide, HEAD + row * self.high, self.wide, self.high)

    def at(self, point: QPointF) -> tuple[int, int] | None:
        """Return (row, column) under a point; column -1 for a row's head, row -1 for a column's."""
        row = int((point.y() - HEAD) // self.high) if point.y() >= HEAD else -1
        column = int((point.x() - SIDE) // self.wide) if point.x() >= SIDE else -1
        if (
            row >= self.count
            or column >= self.count
            or (row < 0 and column < 0)
            or min(point.x(), point.y()) < 0
        ):
            return None
        return row, column


def fit_grid(count: int, width: float, height: float) -> HeatmapGrid:
    """Return cells that fill a widget, within what is pleasant to look at."""
    wide = min(92.0, max(40.0, (width - SIDE - 4) / max(1, count)))
    high = min(44.0, max(19.0, (height - HEAD - 4) / max(1, count)))
    return HeatmapGrid(count, wide, high)


def shade(color: QColor, ground: QColor, probability: float) -> QColor:
    """Return the colour of a cell: from the ground to the kind's colour; differences between small numbers
    are seen, too.
    """
    part = 0.0 if probability <= 0 else 0.10 + 0.82 * min(1.0, probability) ** 0.75
    mix = [round(255 * (g + (c - g) * part)) for c, g in zip(_rgb(color), _rgb(ground), strict=True)]
    return QColor(*mix)


def _rgb(color: QColor) -> tuple[float, float, float]:
    return color.redF(), color.greenF(), color.blueF()


def choose_ink(ground: QColor) -> QColor:
    """Return dark or light, whichever reads better on a ground; on middling ones black or white, since no
    other gives 4.5:1.
    """
    soft = max(map(QColor, INKS), key=lambda c: measure_contrast(c, ground))
    return (
        soft
        if measure_contrast(soft, ground) >= 4.5
        else max(QColor("#000000"), QColor("#ffffff"), key=lambda c: measure_contrast(c, ground))
    )


def measure_contrast(a: QColor, b: QColor) -> float:
    """Return the contrast of two colours, 1..21 (WCAG 2)."""

    def light(color: QColor) -> float:
        parts = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in _rgb(color)]
        return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

    bright, dark = sorted((light(a), light(b)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def format_percent(probability: float) -> str:
    """Return a probability as it stands in a cell: "·" for none, "<1" for next to none."""
    if probability <= 0:
        return "·"
    return "<1" if probability < 0.005 else f"{probability * 100:.0f}"


def describe_matrix_cell(model: Markov, layer: Layer, row: int, column: int) -> str:
    """Say a cell: "After a left gesture, a right fidget follows in 13 % of cases."."""
    states = list_model_states(model)
    p = model.matrix[row][column]
    before = name_state_in_sentence(states[row], layer)
    what = tr("the same") if row == column else name_state_in_sentence(states[column], layer)
    again = tr(" again") if row == column else ""
    if p <= 0:
        return tr("After {before}, {what} never follows{again}.", before=before, what=what, again=again)
    if p >= 1:
        return tr("After {before}, {what} always follows{again}.", before=before, what=what, again=again)
    share = f"{p:.1%}".replace(".0%", "%").replace("%", " %")
    return tr(
        "After {before}, {what} follows{again} in {share} of cases.",
        before=before,
        what=what,
        again=again,
        share=share,
    )


class HeatMap(QWidget):
    """Drag a number up or down, or type one; arrow keys go from cell to cell, + and - change by 1 %.

    edited: (row, column, probability, whether it is still being dragged). cancelled: a drag was given up.
    pointed: the sentence of the cell that is hovered over or current. menu: (row or -1, global position) was
    asked for.
    """

    edited = Signal(int, int, float, bool)
    cancelled = Signal()
    pointed = Signal(str)
    menu = Signal(int, object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model: Markov | None = None
        self.layer: Layer = "arms"
        self.look = "dark"
        self.closed: frozenset[int] = frozenset()  # states that are passed over
        self.current = (0, 0)
        self.hovered: tuple[int, int] | None = None
        self._from: tuple[float, float] | None = None  # where a drag began: y, probability
        self._moved = False
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Transition probabilities, in percent"))
        self.setAccessibleDescription(
            tr(
                "Each row is an action, each column the action that follows. Arrow keys select a cell; "
                "plus, minus or digits change it."
            )
        )
        self.field = QLineEdit(self)
        self.field.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.field.setAccessibleName(tr("Percent"))
        self.field.hide()
        self.field.installEventFilter(self)

    def show_model(
        self, model: Markov, layer: Layer, look: str, closed: frozenset[int] = frozenset()
    ) -> None:
        """Show a model; closed: its states that the planner passes over."""
        same = self.model is not None and len(self.model.states) == len(model.states) and layer == self.layer
        self.model, self.layer, self.look, self.closed = model, layer, look, closed
        if not same:
            self.current, self.hovered = (0, 0), None
            self.field.hide()
        self.updateGeometry()
        self.update()
        self._tell()

    def sizeHint(self) -> QSize:
        n = len(self.model.states) if self.model else 3
        return QSize(round(SIDE + 62 * n + 4), round(HEAD + 26 * n + 4))

    def minimumSizeHint(self) -> QSize:
        n = len(self.model.states) if self.model else 3
        return QSize(round(SIDE + 40 * n + 4), round(HEAD + 19 * n + 4))

    def grid(self) -> HeatmapGrid:
        return fit_grid(len(self.model.states) if self.model else 0, self.width(), self.height())

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        if self.model is None:
            return
        t, cells, states = get_theme(self.look), self.grid(), list_model_states(self.model)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        lit = self.hovered or (self.current if self.hasFocus() else (-2, -2))
        painter.setPen(QColor(t.dim))
        small = QFont(self.font())
        small.setPixelSize(11)
        painter.setFont(small)
        painter.drawText(QRectF(0, 0, SIDE - 12, HEAD - 6), _CORNER, tr("after ↓  then →"))
        metrics = QFontMetricsF(self.font())
        widest = max(metrics.horizontalAdvance(self._row_words(s, cells.high)) for s in states) + _GAP
        margin = max(0.0, SIDE - 14 - widest)
        for n, state in enumerate(states):
            self._row_head(
                painter,
                t,
                QRectF(margin, cells.cell(n, 0).top(), SIDE - 8 - margin, cells.high),
                state,
                n,
                lit[0] == n,
            )
            self._column_head(
                painter, t, QRectF(cells.cell(0, n).left(), 0, cells.wide, HEAD - 4), state, n, lit[1] == n
            )
        ground, number = QColor(t.field), QFont(painter.font())
        number.setPixelSize(13 if cells.high >= 22 else 12)
        painter.setFont(number)
        for row, line in enumerate(self.model.matrix):
            for column, p in enumerate(line):
                fill = shade(t.fill(states[column][1]), ground, p)
                rect = cells.cell(row, column).adjusted(1, 1, -1, -1)
                painter.setOpacity(0.35 if {row, column} & self.closed else 1.0)
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(fill)
                painter.drawRoundedRect(rect, 3, 3)
                painter.setPen(QColor(t.dim) if p <= 0 else choose_ink(fill))
                painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, format_percent(p))
        painter.setOpacity(1.0)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if self.hovered is not None and min(self.hovered) >= 0:
            painter.setPen(QPen(QColor(t.dim), 1.2))
            painter.drawRoundedRect(cells.cell(*self.hovered).adjusted(1, 1, -1, -1), 3, 3)
        if self.hasFocus():
            painter.setPen(QPen(QColor(t.text), 1.8))
            painter.drawRoundedRect(cells.cell(*self.current).adjusted(1, 1, -1, -1), 3, 3)
        painter.end()

    def _name(self, state: State) -> str:
        """What tells a state from others of its kind: the limb, or the kind itself if there are no sides."""
        return tr(state[0] if self.layer == "arms" else state[1])

    def _row_words(self, state: State, high: float) -> str:
        tags = describe_tag(state) if high >= _TWO_LINES or state[2] not in _SHORT else _SHORT[state[2]]
        return (
            f"{self._name(state)} {tags}".strip()
            if high < _TWO_LINES
            else max(self._name(state), tags, key=len)
        )

    def _row_head(
        self, painter: QPainter, t: WindowTheme, box: QRectF, state: State, n: int, lit: bool
    ) -> None:
        """Paint a state left of its row: its kind's mark in its colour, what tells it from others, tags below
        or behind it.
        """
        two = bool(state[2]) and box.height() >= _TWO_LINES
        line = QRectF(
            box.left(), box.top() + (3 if two else 0), box.width(), box.height() / 2 if two else box.height()
        )
        self._words(
            painter,
            t,
            line,
            state,
            n,
            lit,
            self._name(state) if two else self._row_words(state, box.height()),
        )
        if two:
            below = QRectF(box.left() + _GAP, box.center().y() - 3, box.width() - _GAP, box.height() / 2)
            self._tags(painter, t, below, state, n, Qt.AlignmentFlag.AlignLeft)

    def _column_head(
        self, painter: QPainter, t: WindowTheme, box: QRectF, state: State, n: int, lit: bool
    ) -> None:
        metrics, name = QFontMetricsF(self.font()), self._name(state)
        room = box.width() - _GAP - 2
        if self.layer == "arms":  # all sides short where one has no room
            widest = max(metrics.horizontalAdvance(tr(limb)) for limb in SIDES)
            name = SIDES[state[0]] if widest > room else name
        elif metrics.horizontalAdvance(name) > room:
            name = metrics.elidedText(name, Qt.TextElideMode.ElideRight, room)
        width = _GAP + metrics.horizontalAdvance(name)
        line = QRectF(box.center().x() - width / 2, box.bottom() - (34 if state[2] else 18), width + 4, 18)
        self._words(painter, t, line, state, n, lit, name)
        if state[2]:
            self._tags(
                painter,
                t,
                QRectF(box.left() + 1, line.bottom() - 3, box.width() - 2, 18),
                state,
                n,
                Qt.AlignmentFlag.AlignHCenter,
            )

    def _words(
        self, painter: QPainter, t: WindowTheme, line: QRectF, state: State, n: int, lit: bool, words: str
    ) -> None:
        painter.setOpacity(0.45 if n in self.closed else 1.0)
        painter.setFont(self.font())
        painter.setPen(t.kind(state[1]))
        painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, KIND_MARKS[state[1]])
        painter.setPen(QColor(t.text if lit else t.dim))
        painter.drawText(line.adjusted(_GAP, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, words)
        painter.setOpacity(1.0)

    def _tags(
        self, painter: QPainter, t: WindowTheme, line: QRectF, state: State, n: int, side: Qt.AlignmentFlag
    ) -> None:
        small = QFont(self.font())
        small.setPixelSize(11)
        painter.setOpacity(0.45 if n in self.closed else 1.0)
        painter.setFont(small)
        painter.setPen(QColor(t.dim))
        told = QFontMetricsF(small).elidedText(describe_tag(state), Qt.TextElideMode.ElideRight, line.width())
        painter.drawText(line, side | Qt.AlignmentFlag.AlignVCenter, told)
        painter.setOpacity(1.0)

    # --- the mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        found = self.grid().at(event.position())
        self.field.hide()
        if (
            self.model is None
            or event.button() != Qt.MouseButton.LeftButton
            or found is None
            or min(found) < 0
        ):
            return
        self.current = found
        self._from, self._moved = (event.position().y(), self.model.matrix[found[0]][found[1]]), False
        self.update()
        self._tell()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._from is not None and self.model is not None:
            y, before = self._from
            if self._moved or abs(event.position().y() - y) >= 3:
                self._moved = True
                self.edited.emit(
                    *self.current,
                    round(min(1.0, max(0.0, before + (y - event.position().y()) / DRAG)), 3),
                    True,
                )
            return
        found = self.grid().at(event.position())
        if found != self.hovered:
            self.hovered = found
            inside = found is not None and min(found) >= 0
            self.setCursor(Qt.CursorShape.SizeVerCursor if inside else Qt.CursorShape.ArrowCursor)
            self.update()
            self._tell()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._from is not None and self._moved and self.model is not None:
            self.edited.emit(*self.current, self.model.matrix[self.current[0]][self.current[1]], False)
        self._from, self._moved = None, False

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        found = self.grid().at(event.position())
        if found is not None and min(found) >= 0:
            self._from = None
            self.current = found
            self._type("")

    def leaveEvent(self, event: QEvent) -> None:
        self.hovered = None
        self.update()
        self._tell()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            self.menu.emit(
                self.current[0], self.mapToGlobal(self.grid().cell(*self.current).bottomLeft().toPoint())
            )
            return
        found = self.grid().at(QPointF(event.pos()))
        row = -1 if found is None else found[0] if found[0] >= 0 else found[1]
        self.menu.emit(row, event.globalPos())

    # --- the keyboard

    def event(self, event: QEvent) -> bool:
        # Digits, signs and Escape are the map's while it has the keyboard, not the window's shortcuts.
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            dragging = event.key() == Qt.Key.Key_Escape and self._from is not None
            if (
                (event.text() and event.text() in "0123456789.,+-")
                or dragging
                or event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
            ):
                event.accept()
                return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self.model is None:
            return
        moves = {
            Qt.Key.Key_Left: (0, -1),
            Qt.Key.Key_Right: (0, 1),
            Qt.Key.Key_Up: (-1, 0),
            Qt.Key.Key_Down: (1, 0),
        }
        last, (row, column) = len(self.model.states) - 1, self.current
        if event.key() == Qt.Key.Key_Escape and self._from is not None:
            self._from, self._moved = None, False
            self.cancelled.emit()
        elif event.key() in moves:
            down, right = moves[Qt.Key(event.key())]
            self.current = min(last, max(0, row + down)), min(last, max(0, column + right))
            self.update()
            self._tell()
        elif event.text() and event.text() in "+-":
            step = 0.01 if event.text() == "+" else -0.01
            self.edited.emit(
                row, column, min(1.0, max(0.0, round(self.model.matrix[row][column] + step, 3))), False
            )
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._type("")
        elif event.text() and event.text() in "0123456789.,":
            self._type(event.text())
        else:
            super().keyPressEvent(event)

    def _type(self, text: str) -> None:
        """Open the field on the current cell; with text, that is typed already."""
        if self.model is None:
            return
        p = self.model.matrix[self.current[0]][self.current[1]]
        cell = self.grid().cell(*self.current).toRect()
        self.field.setGeometry(cell.adjusted(-4, -3, 4, 3))
        self.field.setText(text or f"{p * 100:.1f}".rstrip("0").rstrip("."))
        if not text:
            self.field.selectAll()
        self.field.show()
        self.field.setFocus()

    def _typed(self) -> None:
        try:
            p = float(self.field.text().replace(",", ".").strip(" %")) / 100
        except ValueError:
            p = -1.0
        self.field.hide()
        self.setFocus()
        if 0 <= p <= 1:
            self.edited.emit(*self.current, p, False)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.field:
            if (
                event.type() == QEvent.Type.ShortcutOverride
                and isinstance(event, QKeyEvent)
                and event.key() == Qt.Key.Key_Escape
            ):
                event.accept()
                return True
            if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
                if event.key() in (
                    Qt.Key.Key_Return,
                    Qt.Key.Key_Enter,
                ):  # which a line of text would let through to the map as well
                    self._typed()
                    return True
                if event.key() == Qt.Key.Key_Escape:
                    self.field.hide()
                    self.setFocus()
                    return True
            if event.type() == QEvent.Type.FocusOut:
                self.field.hide()
        return super().eventFilter(watched, event)

    def focusInEvent(self, event: object) -> None:
        self.update()
        self._tell()

    def focusOutEvent(self, event: object) -> None:
        self.update()

    def _tell(self) -> None:
        if self.model is not None:
            at = self.hovered if self.hovered is not None and self._from is None else self.current
            self.pointed.emit(
                describe_matrix_cell(self.model, self.layer, *at)
                if min(at) >= 0
                else self._state_sentence(max(at))
            )

    def _state_sentence(self, n: int) -> str:
        assert self.model is not None
        words = name_state_in_sentence(list_model_states(self.model)[n], self.layer)
        out = words[:1].upper() + words[1:]
        if self.model.lengths:
            mean, deviation = self.model.lengths[n]
            out += tr(
                " lasts {mean:.1f} ± {deviation:.1f} s on average.",
                mean=mean,
                deviation=deviation,
            )
        else:
            out += tr(" lasts 1 to 3 s.")
        if n in self.closed:
            out += tr(" It is skipped because the graph has no such action yet.")
        return out
