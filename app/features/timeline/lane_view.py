"""The widget of the lanes: shows the plan and what was asked, and turns the mouse and the keys into edits."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFocusEvent,
    QFont,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QWheelEvent,
)
from PySide6.QtWidgets import QApplication, QMenu, QToolTip, QWidget

from app.features.timeline.lane_titles import LaneTitles
from app.features.timeline.request_drag import RequestDrag
from app.look.names import told_names
from app.look.theme import theme
from app.stage.performance import Performance
from app.stage.session import Session
from app.widgets.gesture import Hand
from app.widgets.lane_geometry import LEFT, RULER, Mark, Scale, cue_at, lane_at, mark_at, marks, told
from app.widgets.lane_paint import LaneScene, badge, cue_words, paint, playhead
from app.widgets.memo import Once
from app.widgets.request_menu import request_menu

NUDGE, FAR = 0.1, 1.0  # seconds an arrow key moves what is selected, and with Shift
CATCH = 3  # pixels the mouse must move for a press to become a drag
ZOOM = 1.2
COPIES = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
TEXT = (
    "Requests, and what plays. Up and Down choose a request, Left and Right move it, Enter changes it, "
    "Insert asks for something."
)


class Lanes(QWidget):
    """A press on a request selects it and a drag moves it, a double click changes it or, in an empty place,
    asks for something.

    A press on a cue selects its action; anywhere else it moves the playhead. The wheel zooms.
    """

    def __init__(self, session: Session, performance: Performance, parent: QWidget) -> None:
        super().__init__(parent)
        self.session, self.performance = session, performance
        self.each = 44.0
        self.first = 0.0
        self.follow = True
        self.hand = Hand()
        self.titles = LaneTitles(self, performance)
        self._marks: Once[list[Mark]] = Once()
        self._still: Once[QPixmap] = Once()  # all but what moves while it plays
        self.painted = 0  # how often that was made
        self.setMinimumHeight(RULER + 4 * 40)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Timeline")
        self.setAccessibleDescription(TEXT)
        performance.changed.connect(self.update)
        session.transport.moved.connect(self._playhead)
        for signal in (session.look.changed, session.selection.changed, session.onstage.performance_changed):
            signal.connect(self.update)

    def scale(self) -> Scale:
        return Scale(self.first, self.each)

    def marks(self) -> list[Mark]:
        """Return the requests as they are drawn now."""
        if self.session.transport.show != "plan":
            return []
        p, drag = self.performance, self.drag
        asks, answers, project, scale = p.asks, p.answers(), p.document.project, self.scale()

        def make() -> list[Mark]:
            shift = dict.fromkeys(drag.idents, drag.by) if drag is not None else None
            found = marks(asks, answers, project, scale, self.height(), self.font(), shift)
            if drag is None or not drag.copy:
                return found
            # What is copied stays where it is, under its copies.
            still = marks(asks, answers, project, scale, self.height(), self.font())
            return still + [m for m in found if m.ask.id in drag.idents]

        values = (scale, self.height(), self.font().toString(), drag and (drag.by, drag.copy))
        return self._marks.of(values, (asks, answers, project), make)

    def _playhead(self, seconds: float) -> None:
        width = self.width() - LEFT
        if self.follow and width > 40 and self.hand.gesture is None:
            x = (seconds - self.first) * self.each
            if x > width * 0.85:
                self.first = seconds - 0.15 * width / self.each
            elif x < 0:
                self.first = max(0.0, seconds - 0.15 * width / self.each)
        self.update()

    def reveal(self, ident: str) -> None:
        """Select a request and bring it in sight."""
        self.session.onstage.select_requests((ident,))
        mark = next((m for m in self.marks() if m.ask.id == ident), None)
        if mark is not None and not LEFT <= mark.rect.left() <= self.width() - 60:
            self.first = max(0.0, mark.at - 0.3 * (self.width() - LEFT) / self.each)
        self.update()

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        t, painter = theme(self.session.look.name), QPainter(self)
        painter.drawPixmap(0, 0, self._picture())
        playhead(painter, t, self.scale().x(self.session.transport.seconds), self.height())
        drag = self.drag
        if drag is not None:
            held = next((m for m in reversed(self.marks()) if m.ask.id == drag.ident), None)
            if held is not None:
                font = QFont(self.font())
                font.setFeature(QFont.Tag("tnum"), 1)
                painter.setFont(font)
                words = f"{max(0.0, held.at):.2f} s  ({drag.by:+.2f}){'  copy' if drag.copy else ''}"
                badge(painter, t, QPointF(held.rect.left(), 0), words, self.width())
        if self.hasFocus() and self._by_keys:
            painter.setPen(QPen(QColor(t.dim), 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))
        painter.end()

    _by_keys = False

    def _picture(self) -> QPixmap:
        """Return everything but the playhead, made anew only when something else than the playhead has
        changed.
        """
        s, p, ratio = self.session, self.performance, self.devicePixelRatioF()
        ends = p.shown.length if p.ends else None
        found = self.marks()
        font = self.font()

        def make() -> QPixmap:
            picture = QPixmap(self.size() * ratio)
            picture.setDevicePixelRatio(ratio)
            painter = QPainter(picture)
            painter.setFont(font)
            scene = LaneScene(
                p.shown,
                found,
                self.scale(),
                self.width(),
                self.height(),
                s.place.layer,
                ends,
                set(s.selection.actions),
                set(s.onstage.requests),
            )
            paint(painter, theme(s.look.name), scene)
            painter.end()
            self.painted += 1
            return picture

        values = (
            self.scale(),
            self.size(),
            ratio,
            s.look.name,
            s.place.layer,
            ends,
            s.selection.actions,
            s.onstage.requests,
            font.toString(),
        )
        return self._still.of(values, (p.shown, found), make)

    def focusInEvent(self, event: QFocusEvent) -> None:
        self._by_keys = event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason)
        super().focusInEvent(event)
        self.update()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self.update()

    # --- the mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grip = event.position().x()
        if event.button() != Qt.MouseButton.LeftButton:
            return
        if event.position().x() < LEFT:
            layer = self.titles.at(event.position())
            if layer is not None:
                self.titles.click(layer, bool(event.modifiers() & Qt.KeyboardModifier.AltModifier))
            return
        mark = mark_at(self.marks(), event.position())
        if mark is not None:
            self._press(mark, event)
            return
        self.session.onstage.select_requests(())
        found = cue_at(self.performance.shown, self.scale(), self.height(), event.position())
        if found is not None:
            self.session.jump(action=found[1].action.id)
        else:
            self._scrub(event.position().x())

    def _press(self, mark: Mark, event: QMouseEvent) -> None:
        ident, chosen = mark.ask.id, self.session.onstage.requests
        more = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        lone = more and ident in chosen
        if ident not in chosen:
            self.session.onstage.select_requests((*chosen, ident) if more else (ident,))
        if self.performance.requests.editable:
            self.hand.take(RequestDrag(self, self.session.onstage.requests, ident, lone), event.position())
        elif lone:
            self.session.onstage.select_requests(tuple(i for i in chosen if i != ident))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        x = event.position().x()
        if self.hand.move(event.position(), bool(event.modifiers() & COPIES)):
            copying = self.drag is not None and self.drag.copy
            self.setCursor(Qt.CursorShape.DragCopyCursor if copying else Qt.CursorShape.SizeHorCursor)
            self.update()
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self._scrub(x)
        elif event.buttons() & Qt.MouseButton.MiddleButton:
            self.first = max(0.0, self.first - (x - self._grip) / self.each)
            self.update()
        else:
            over = mark_at(self.marks(), event.position()) is not None and self.performance.requests.editable
            self.setCursor(Qt.CursorShape.SizeHorCursor if over else Qt.CursorShape.ArrowCursor)
        self._grip = x

    _grip = 0.0

    @property
    def drag(self) -> RequestDrag | None:
        """The requests that are being dragged; None before the mouse has moved far enough, too."""
        gesture = self.hand.gesture
        return gesture if isinstance(gesture, RequestDrag) and gesture.begun else None

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.hand.let_go(event.position())
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
        mark = mark_at(self.marks(), at)
        if mark is not None and self.performance.requests.editable:
            self._mark_menu(mark).popup(on_screen.toPoint())
        else:
            request_menu(self, self.performance, seconds, lane_at(self.height(), at)).popup(
                on_screen.toPoint()
            )

    def _mark_menu(self, mark: Mark) -> QMenu:
        """Return what can be done with a request, or with all that are selected with it."""
        ident = mark.ask.id
        if ident not in self.session.onstage.requests:
            self.session.onstage.select_requests((ident,))
        menu, chosen = QMenu(self), self.session.onstage.requests
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("Change…\tReturn", lambda: self.edit(ident))
        menu.addAction("Copy\tCtrl+D", lambda: self.performance.requests.copy(chosen, FAR))
        menu.addAction(
            "Take it back\tDel" if len(chosen) == 1 else "Take them back\tDel",
            lambda: self.performance.requests.withdraw(*chosen),
        )
        return menu

    def edit(self, ident: str) -> None:
        """Show the fields of a request."""
        from app.features.timeline.request_editor import RequestEditor

        if self.performance.requests.editable:
            RequestEditor(self.performance, ident, self).open()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            self._ask_here()
        elif (layer := self.titles.at(QPointF(event.pos()))) is not None:
            self.titles.menu(layer).popup(event.globalPos())
        elif event.pos().x() >= LEFT:
            self._menu(QPointF(event.pos()), QPointF(event.globalPos()))

    def _ask_here(self) -> None:
        """Ask for something at the playhead."""
        x = min(max(LEFT, self.scale().x(self.session.transport.seconds)), self.width())
        seconds = round(self.session.transport.seconds, 2) if self.performance.live.stage is None else None
        request_menu(self, self.performance, seconds).popup(self.mapToGlobal(QPointF(x, RULER).toPoint()))

    def _scrub(self, x: float) -> None:
        self.session.transport.set_playing(False)
        self.session.transport.seek(max(0.0, self.scale().seconds(max(x, LEFT))))

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier or abs(delta.x()) > abs(delta.y()):
            self.first = max(0.0, self.first - (delta.x() or delta.y()) / 2 / self.each)
            self.update()
        else:
            self._zoom(ZOOM ** (delta.y() / 120), event.position().x())
        event.accept()

    def _zoom(self, by: float, x: float) -> None:
        """Zoom about a place on the screen."""
        at = self.scale().seconds(x)
        self.each = min(400.0, max(2.0, self.each * by))
        self.first = max(0.0, at - (x - LEFT) / self.each)
        self.update()

    # --- keys and tips

    def _nudge(self, key: Qt.Key, modifiers: Qt.KeyboardModifier) -> None:
        by = FAR if modifiers & Qt.KeyboardModifier.ShiftModifier else NUDGE
        self.performance.requests.move(
            self.session.onstage.requests, by if key == Qt.Key.Key_Right else -by, merge="nudge"
        )

    def _choose(self, step: int) -> None:
        """Select the request before or after the selected one, in time; without one, the first from the
        playhead on.
        """
        order = sorted(self.marks(), key=lambda m: m.at)
        if not order:
            return
        chosen = self.session.onstage.requests
        place = next((n for n, m in enumerate(order) if chosen and m.ask.id == chosen[-1]), None)
        if place is None:
            place = next(
                (n for n, m in enumerate(order) if m.at >= self.session.transport.seconds), len(order) - 1
            )
        else:
            place = min(max(0, place + step), len(order) - 1)
        self.reveal(order[place].ask.id)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        chosen, key, can = self.session.onstage.requests, event.key(), self.performance.requests.editable
        if key == Qt.Key.Key_Escape and self.hand.drop("escape"):
            self.setCursor(Qt.CursorShape.ArrowCursor)
            self.update()
        elif key == Qt.Key.Key_Escape and chosen:
            self.session.onstage.select_requests(())
        elif self.hand.gesture is not None:
            return  # what is held is not edited by keys as well
        elif chosen and can and key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self._nudge(Qt.Key(key), event.modifiers())
        elif (
            chosen and can and key == Qt.Key.Key_D and event.modifiers() & Qt.KeyboardModifier.ControlModifier
        ):
            self.performance.requests.copy(chosen, FAR)
        elif chosen and key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.edit(chosen[0])
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._choose(1 if key == Qt.Key.Key_Down else -1)
        elif key == Qt.Key.Key_Insert:
            self._ask_here()
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal, Qt.Key.Key_Minus):
            self._zoom(
                1 / ZOOM if key == Qt.Key.Key_Minus else ZOOM,
                min(max(LEFT, self.scale().x(self.session.transport.seconds)), self.width()),
            )
        elif key in (Qt.Key.Key_PageUp, Qt.Key.Key_PageDown):
            page = 0.8 * (self.width() - LEFT) / self.each
            self.first = max(0.0, self.first + (page if key == Qt.Key.Key_PageDown else -page))
            self.update()
        else:
            super().keyPressEvent(event)

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self._tip(QPointF(event.pos())), self)
            return True
        if isinstance(event, QKeyEvent) and event.type() == QKeyEvent.Type.ShortcutOverride:
            mine = (Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Return, Qt.Key.Key_Escape)
            if (self.hand.gesture is not None and event.key() == Qt.Key.Key_Escape) or (
                self.session.onstage.requests and event.key() in mine
            ):
                event.accept()
                return True
        return super().event(event)

    def _tip(self, at: QPointF) -> str:
        titled = self.titles.at(at)
        if titled is not None:
            return self.titles.tip(titled)
        mark = mark_at(self.marks(), at)
        if mark is not None:
            return told(mark, self.performance.requests.editable)
        found = cue_at(self.performance.shown, self.scale(), self.height(), at)
        if found is not None:
            cue = found[1]
            name = told_names(cue_words(self.performance.shown.project, cue.action), cue.action.name)
            words = f"{name}\n{cue.action.kind}, {cue.start:.2f} to {cue.end:.2f} s"
            if cue.hold > 0:
                words += f", held {cue.hold:.2f} s"
            return words + "\nClick selects it, double-click plays it in context"
        lane = lane_at(self.height(), at)
        if lane is None:
            return ""
        shown, here = self.performance.shown, ""
        plan = next((p for layer, p in shown.plan.layers.items() if layer == lane), None)
        if plan is not None:
            stance = shown.project.stance(plan.stance_at(self.scale().seconds(at.x())))
            here = stance.name if stance is not None else ""
        more = "" if QApplication.mouseButtons() else "Double-click to ask for something here"
        return "\n".join(x for x in (here, more) if x)
