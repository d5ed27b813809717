"""The widget of the lanes: paints the plan and what was asked, and turns the mouse and the keys into edits."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QWheelEvent,
)
from PySide6.QtWidgets import QApplication, QToolTip, QWidget

from app.asks import STAGE, ask_menu
from app.panels.lanes import LANE, LEFT, RULER, TITLES, Mark, Scale, cue_at, elided, lane_at, lanes, mark_at, marks, rows, told
from app.performance import Performance, Shown
from app.session import Session
from app.theme import KIND_MARKS, Theme, theme
from metagraph.graph.model import LAYERS, Layer

NUDGE = 0.1  # seconds an arrow key moves what is selected
CATCH = 3  # pixels the mouse must move for a press to become a drag
INK = "#17181b"  # on the kinds' fills


@dataclass
class Drag:
    """Asks being moved in time: silently until the button is released, then one edit."""

    idents: tuple[str, ...]
    grip: float
    by: float = 0.0
    begun: bool = False


class Lanes(QWidget):
    """A press on a request selects it and a drag moves it, a double click changes it or, in an empty place, asks for something.

    A press on a cue selects its action; anywhere else it moves the playhead. The wheel zooms.
    """

    def __init__(self, session: Session, performance: Performance, parent: QWidget) -> None:
        super().__init__(parent)
        self.session, self.performance = session, performance
        self.each = 44.0
        self.first = 0.0
        self.follow = True
        self.drag: Drag | None = None
        self.setMinimumHeight(RULER + 4 * 40)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setAccessibleName("Timeline")
        performance.changed.connect(self.update)
        session.moved.connect(self._playhead)
        for signal in (session.theme_changed, session.selection_changed, session.performance_changed):
            signal.connect(self.update)

    def scale(self) -> Scale:
        return Scale(self.first, self.each)

    def marks(self) -> list[Mark]:
        """Return the requests as they are drawn now."""
        if self.session.show != "plan":
            return []
        shift = dict.fromkeys(self.drag.idents, self.drag.by) if self.drag is not None and self.drag.begun else None
        p = self.performance
        return marks(p.asks, p.answers(), p.document.project, self.scale(), self.height(), self.font(), shift)

    def _playhead(self, seconds: float) -> None:
        width = self.width() - LEFT
        if self.follow and width > 40 and self.drag is None:
            x = (seconds - self.first) * self.each
            if x > width * 0.85:
                self.first = seconds - 0.15 * width / self.each
            elif x < 0:
                self.first = max(0.0, seconds - 0.15 * width / self.each)
        self.update()

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        t = theme(self.session.theme)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(t.panel))
        scale, shown = self.scale(), self.performance.shown
        self._ruler(painter, t, scale)
        for name, lane in lanes(self.height()).items():
            painter.setPen(QColor(t.line))
            painter.drawLine(QPointF(0, lane.bottom()), QPointF(self.width(), lane.bottom()))
            painter.setPen(QColor(t.text if name == self.session.layer else t.dim))
            painter.drawText(QRectF(14, lane.top(), LEFT - 16, lane.height()), Qt.AlignmentFlag.AlignVCenter, TITLES[name])
        painter.setClipRect(QRectF(LEFT, 0, self.width() - LEFT, self.height()))
        if shown.clip is None:
            self._stage(painter, t, scale, shown)
            for layer in LAYERS:
                self._layer(painter, t, scale, shown, layer)
            found = self.marks()
            self._ties(painter, t, scale, found)
            for mark in found:
                self._mark(painter, t, mark)
        else:
            entry = shown.project.clips[shown.clip]
            rect = QRectF(scale.x(0), RULER + 40, max(2.0, entry.duration * scale.each), LANE - 18)
            self._bar(painter, t, rect, QColor(t.line), entry.name, t.text, False)
        if self.performance.kept is not None:
            self._after(painter, t, scale.x(shown.length))
        self._head(painter, t, scale)
        painter.end()

    def _head(self, painter: QPainter, t: Theme, scale: Scale) -> None:
        x = scale.x(self.session.seconds)
        painter.setPen(QPen(QColor(t.text), 1.6))
        painter.drawLine(QPointF(x, 4), QPointF(x, self.height()))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.text))
        painter.drawPolygon([QPointF(x - 5, 4), QPointF(x + 5, 4), QPointF(x, 11)])

    def _after(self, painter: QPainter, t: Theme, x: float) -> None:
        """Dim what lies after a kept performance's end."""
        if x < self.width():
            veil = QColor(t.ground)
            veil.setAlpha(150)
            painter.fillRect(QRectF(max(x, LEFT), RULER, self.width(), self.height()), veil)

    def _ruler(self, painter: QPainter, t: Theme, scale: Scale) -> None:
        step = scale.step()
        mark = max(0.0, (scale.first // step) * step)
        painter.setPen(QColor(t.dim))
        while scale.x(mark) < self.width():
            x = scale.x(mark)
            if x >= LEFT - 1:
                words = f"{mark:g} s" if step < 60 else f"{mark / 60:g} min"
                painter.drawText(QRectF(x - 40, 0, 80, RULER), Qt.AlignmentFlag.AlignCenter, words)
            mark = round(mark + step, 3)

    def _stage(self, painter: QPainter, t: Theme, scale: Scale, shown: Shown) -> None:
        """Speech as bars with its words, looks as lines under them."""
        area, track = rows(lanes(self.height())[STAGE])[1], shown.plan.track
        for look, following in zip(track.looks, (*track.looks[1:], None), strict=False):
            until = min(look.end, following.start if following else look.end, max(shown.length, look.start))
            left, right = scale.x(look.start), scale.x(until)
            if right > LEFT and left < self.width():
                painter.setPen(QPen(QColor(t.dim), 1.4, Qt.PenStyle.DotLine))
                painter.drawLine(QPointF(max(left, LEFT), area.bottom() - 2), QPointF(min(right, self.width()), area.bottom() - 2))
        for speech in track.speeches:
            left, right = scale.x(speech.start), scale.x(speech.end)
            if right > LEFT and left < self.width():
                rect = QRectF(left, area.top(), max(3.0, right - left - 1), area.height() - 5)
                self._bar(painter, t, rect, QColor(t.hover), speech.text, t.text, False)

    def _layer(self, painter: QPainter, t: Theme, scale: Scale, shown: Shown, layer: Layer) -> None:
        """Stances as a quiet band, cues on it in their kind's colour."""
        plan, area = shown.plan.layers[layer], rows(lanes(self.height())[layer])[1]
        begin = plan.past.free
        edges = [begin, *(cue.end for cue in plan.cues if cue.then != cue.stance), max(shown.length, scale.seconds(self.width()))]
        first = plan.stance_at(-1.0) if plan.rests else None
        stances = [first or "", *(cue.then for cue in plan.cues if cue.then != cue.stance)] if plan.rests else []
        for stance, start, end in zip(stances, edges, edges[1:], strict=False):
            if scale.x(end) < LEFT or scale.x(start) > self.width():
                continue
            found = shown.project.stance(stance)
            fill = t.fill("stance")
            fill.setAlpha(70 if t.name == "dark" else 90)
            left, right = max(scale.x(start), LEFT - 8.0), min(scale.x(end), self.width() + 8.0)
            rect = QRectF(left, area.top(), right - left - 1, area.height())
            self._bar(painter, t, rect, fill, found.name if found else "", t.text, False)
        for cue in plan.cues:
            left, right = scale.x(cue.start), scale.x(cue.end)
            if right < LEFT or left > self.width():
                continue
            rect = QRectF(left, area.top(), max(3.0, right - left - 1), area.height())
            selected = cue.action.id in self.session.actions
            self._bar(painter, t, rect, t.fill(cue.action.kind), f"{KIND_MARKS[cue.action.kind]} {cue.action.name}", INK, selected)

    def _bar(self, painter: QPainter, t: Theme, rect: QRectF, fill: QColor, words: str, ink: str, selected: bool) -> None:
        painter.setPen(QPen(QColor(t.text), 2) if selected else Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawRoundedRect(rect, 4, 4)
        inner = QRectF(max(rect.left(), LEFT) + 8, rect.top(), rect.right() - max(rect.left(), LEFT) - 12, rect.height())
        if inner.width() > 16 and words:
            painter.setPen(QColor(ink))
            painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter, elided(words, painter.font(), inner.width()))

    def _ties(self, painter: QPainter, t: Theme, scale: Scale, found: list[Mark]) -> None:
        """Lead from each request down to what plays for it."""
        painter.setPen(QPen(QColor(t.dim), 1.2))
        places = lanes(self.height())
        for mark in found:
            if mark.answer is None or mark.answer.at is None or mark.kind is None or mark.late <= 0.02:
                continue
            lane = next(n for n, r in places.items() if r.contains(QPointF(1, mark.rect.center().y())))
            x, to = mark.rect.left() + 1, scale.x(mark.answer.at)
            below = rows(places[lane])[1].top()
            painter.drawLine(QPointF(x, mark.rect.bottom()), QPointF(to, below))

    def _mark(self, painter: QPainter, t: Theme, mark: Mark) -> None:
        if mark.rect.right() < LEFT or mark.rect.left() > self.width():
            return
        color = QColor(t.warning) if mark.lost else t.kind(mark.kind) if mark.kind else QColor(t.dim)
        selected = mark.ask.id in self.session.asks
        painter.setPen(QPen(color, 2.0 if selected else 1.2, Qt.PenStyle.DashLine if mark.lost else Qt.PenStyle.SolidLine))
        painter.setBrush(QColor(t.hover if selected else t.card))
        painter.drawRoundedRect(mark.rect, 4, 4)
        inner = mark.rect.adjusted(7, 0, -5, 0)
        painter.setPen(QColor(t.warning if mark.lost else t.text))
        words = f"⚠ {mark.words}" if mark.lost else mark.words
        painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter, elided(words, painter.font(), inner.width()))

    # --- the mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grip = event.position().x()
        if event.button() != Qt.MouseButton.LeftButton or event.position().x() < LEFT:
            return
        mark = mark_at(self.marks(), event.position())
        if mark is not None:
            self._press(mark, event)
            return
        self.session.select_asks(())
        found = cue_at(self.performance.shown, self.scale(), self.height(), event.position())
        if found is not None:
            self.session.jump(action=found[1].action.id)
        else:
            self._scrub(event.position().x())

    def _press(self, mark: Mark, event: QMouseEvent) -> None:
        ident, chosen = mark.ask.id, self.session.asks
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self.session.select_asks(tuple(i for i in chosen if i != ident) if ident in chosen else (*chosen, ident))
        elif ident not in chosen:
            self.session.select_asks((ident,))
        if self.performance.editable:
            self.drag = Drag(self.session.asks, event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        x = event.position().x()
        if self.drag is not None:
            self.drag.begun = self.drag.begun or abs(x - self.drag.grip) >= CATCH
            self.drag.by = round((x - self.drag.grip) / self.each, 2)
            self.update()
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self._scrub(x)
        elif event.buttons() & Qt.MouseButton.MiddleButton:
            self.first = max(0.0, self.first - (x - self._grip) / self.each)
            self.update()
        else:
            over = mark_at(self.marks(), event.position()) is not None and self.performance.editable
            self.setCursor(Qt.CursorShape.SizeHorCursor if over else Qt.CursorShape.ArrowCursor)
        self._grip = x

    _grip = 0.0

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        drag, self.drag = self.drag, None
        if drag is not None and drag.begun and drag.by:
            self.performance.move_asks(drag.idents, drag.by)
        self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        mark = mark_at(self.marks(), event.position())
        if mark is not None:
            self.edit(mark.ask.id)
            return
        found = cue_at(self.performance.shown, self.scale(), self.height(), event.position())
        if found is not None:
            self.session.show_context(found[1].action.id)
        elif event.position().x() >= LEFT:
            self._menu(event.position(), event.globalPosition())

    def _menu(self, at: QPointF, on_screen: QPointF) -> None:
        seconds = round(max(0.0, self.scale().seconds(at.x())), 2)
        ask_menu(self, self.performance, seconds, lane_at(self.height(), at)).popup(on_screen.toPoint())

    def edit(self, ident: str) -> None:
        """Show the fields of a request."""
        from app.panels.ask_editor import AskEditor

        if self.performance.editable:
            AskEditor(self.performance, ident, self).open()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        self._menu(QPointF(event.pos()), QPointF(event.globalPos()))

    def _scrub(self, x: float) -> None:
        self.session.set_playing(False)
        self.session.seek(max(0.0, self.scale().seconds(max(x, LEFT))))

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier or abs(delta.x()) > abs(delta.y()):
            self.first = max(0.0, self.first - (delta.x() or delta.y()) / 2 / self.each)
        else:
            at = self.scale().seconds(event.position().x())
            self.each = min(400.0, max(2.0, self.each * 1.2 ** (delta.y() / 120)))
            self.first = max(0.0, at - (event.position().x() - LEFT) / self.each)
        self.update()
        event.accept()

    # --- keys and tips

    def keyPressEvent(self, event: QKeyEvent) -> None:
        chosen, key = self.session.asks, event.key()
        if key == Qt.Key.Key_Escape and self.drag is not None:
            self.drag = None
            self.update()
        elif chosen and self.performance.editable and key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self.performance.move_asks(chosen, NUDGE if key == Qt.Key.Key_Right else -NUDGE, merge="nudge")
        elif chosen and key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.edit(chosen[0])
        elif key == Qt.Key.Key_Tab and self.performance.asks:
            order = [m.ask.id for m in sorted(self.marks(), key=lambda m: m.at)]
            place = order.index(chosen[0]) + 1 if chosen and chosen[0] in order else 0
            self.session.select_asks((order[place % len(order)],))
        else:
            super().keyPressEvent(event)

    def event(self, event: object) -> bool:
        if isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self._tip(QPointF(event.pos())), self)
            return True
        if isinstance(event, QKeyEvent) and event.type() == QKeyEvent.Type.ShortcutOverride:
            mine = (Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Return)
            if (self.drag is not None and event.key() == Qt.Key.Key_Escape) or (self.session.asks and event.key() in mine):
                event.accept()
                return True
        return super().event(event)  # type: ignore[arg-type]

    def _tip(self, at: QPointF) -> str:
        mark = mark_at(self.marks(), at)
        if mark is not None:
            return told(mark, self.performance.document.project)
        found = cue_at(self.performance.shown, self.scale(), self.height(), at)
        if found is not None:
            cue = found[1]
            words = f"{cue.action.name}\n{cue.action.kind}, {cue.start:.2f} to {cue.end:.2f} s"
            if cue.hold > 0:
                words += f", held {cue.hold:.2f} s"
            return words + "\nClick selects it, double-click plays it in context"
        return "Double-click to ask for something here" if lane_at(self.height(), at) and not QApplication.mouseButtons() else ""
