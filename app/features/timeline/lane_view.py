"""The widget of the lanes: shows the plan and what was asked, and turns the mouse and the keys into edits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

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
    QResizeEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from app.features.timeline.camera_lane import CameraLane
from app.features.timeline.drags.request import RequestDrag
from app.features.timeline.lane_keys import LaneKeys
from app.features.timeline.lane_menu import make_request_marks_menu
from app.features.timeline.lane_picture import paint_lanes
from app.features.timeline.lane_span import LaneSpan
from app.features.timeline.lane_spoken import list_lane_items
from app.features.timeline.lane_tips import describe_place
from app.features.timeline.lane_titles import LaneTitles, read_lane_heights
from app.features.timeline.ruler import Ruler
from app.features.timeline.snapping import Magnet, SnapLine, snap_lines
from app.features.timeline.voices import Voices
from app.features.timeline.what_if import WhatIf, get_ghost_seed
from app.look.theme import get_theme
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.translation import tr, tr_noop
from app.widgets.gesture import PointerHand
from app.widgets.lane_geometry import (
    LEFT,
    NUMBERS,
    RULER,
    RequestMark,
    Sizes,
    find_cue_at,
    find_lane_at,
    mark_at,
    place_lanes,
    place_marks,
)
from app.widgets.lane_paint import paint_badge, paint_playhead
from app.widgets.memo import Once
from app.widgets.request_menu import STAGE, make_request_menu
from app.widgets.spoken_items import SpokenItem, tell_spoken_focus
from metagraph.graph.model import LAYERS

LEAST, LEAST_BESIDE = 38, 32  # pixels of a layer in which its two rows are read; just so, beside other seeds'
COPIES = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
TEXT = tr_noop(
    "Requests and the actions that play. Up and Down select a request, Left and Right move "
    "it, Enter edits it, Insert adds one. M adds a marker, I and O set the start and end "
    "of the loop range."
)


class Lanes(LaneSpan):
    """A press on a request selects it and a drag moves it, a double click changes it or, in an empty place,
    asks for something.

    A press on a cue selects its action; anywhere else it moves the playhead. The wheel zooms.
    """

    def __init__(
        self,
        session: StageSession,
        performance: StagePerformance,
        voices: Voices,
        what_if: WhatIf,
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self.session, self.performance, self.voices = session, performance, voices
        self.what_if = what_if
        self.follow = True
        self.hand = PointerHand()
        self.sizes = Sizes(tall=read_lane_heights())
        self.titles, self.ruler = LaneTitles(self, performance), Ruler(self)
        self.cameras = CameraLane(self)
        self.keys, self.magnet = LaneKeys(self), Magnet()
        self._marks: Once[list[RequestMark]] = Once()
        self._still: Once[QPixmap] = Once()  # all but what moves while it plays
        self.painted = 0  # how often that was made
        self.setMinimumHeight(RULER + 4 * LEAST)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Timeline"))
        self.setAccessibleDescription(tr(TEXT))
        performance.changed.connect(self.update)
        performance.timeline.changed.connect(self.update)
        performance.changed.connect(self.show_lanes)
        voices.changed.connect(self.show_lanes)
        what_if.changed.connect(self.show_lanes)
        for signal in (voices.changed, what_if.changed):
            signal.connect(self.update)
        session.transport.moved.connect(self._playhead)
        for signal in (session.look.changed, session.selection.changed, session.onstage.performance_changed):
            signal.connect(self.update)
        session.onstage.performance_changed.connect(lambda: tell_spoken_focus(self))

    def marks(self) -> list[RequestMark]:
        """Return the requests as they are drawn now."""
        if self.session.transport.show != "plan":
            return []
        p, drag = self.performance, self.drag
        asks, answers, project, scale = p.asks, p.answers(), p.document.project, self.scale()

        def make() -> list[RequestMark]:
            shift = dict.fromkeys(drag.idents, drag.by) if drag is not None else None
            found = place_marks(asks, answers, project, scale, self.height(), self.font(), shift, self.sizes)
            if drag is None or not drag.copy:
                return found
            # What is copied stays where it is, under its copies.
            still = place_marks(asks, answers, project, scale, self.height(), self.font(), None, self.sizes)
            return still + [m for m in found if m.ask.id in drag.idents]

        values = (scale, self.height(), self.font().toString(), self.sizes, drag and (drag.by, drag.copy))
        # What is noted beside the requests changes none of them.
        of = (asks, answers, project.graphs, project.lines, project.points)
        return self._marks.of(values, of, make)

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

    def list_spoken_items(self) -> Sequence[SpokenItem]:
        return list_lane_items(self)

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        t, painter = get_theme(self.session.look.name), QPainter(self)
        painter.drawPixmap(0, 0, self._picture())
        painter.setFont(self.font())
        self.ruler.paint(painter, t, self.width(), self.height())
        place = place_lanes(self.height(), self.sizes).get("cameras")
        if place is not None:
            self.cameras.paint(painter, t, place, self.width(), self.performance.shown.length)
        paint_playhead(painter, t, self.scale().x(self.session.transport.seconds), self.height())
        drag = self.drag
        if drag is not None:
            held = next((m for m in reversed(self.marks()) if m.ask.id == drag.ident), None)
            if held is not None:
                font = QFont(self.font())
                font.setFeature(QFont.Tag("tnum"), 1)
                painter.setFont(font)
                line = self.magnet.line
                words = f"{max(0.0, held.at):.2f} s  ({drag.by:+.2f}){tr('  copy') if drag.copy else ''}"
                if line is not None and not line.weak:
                    words += tr("  at {what}", what=line.what)
                paint_badge(painter, t, QPointF(held.rect.left(), 0), words, self.width())
        if self.hasFocus() and self._by_keys:
            painter.setPen(QPen(QColor(t.dim), 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))
        painter.end()

    _by_keys = False

    def _picture(self) -> QPixmap:
        """Return everything but the playhead, made again only when something else than the playhead has
        changed.
        """
        s, p, ratio = self.session, self.performance, self.devicePixelRatioF()
        ends = p.shown.length if p.ends else None
        found, locked = self.marks(), p.timeline.now.locked
        font = self.font()

        def make() -> QPixmap:
            picture = QPixmap(self.size() * ratio)
            picture.setDevicePixelRatio(ratio)
            painter = QPainter(picture)
            painter.setFont(font)
            paint_lanes(self, painter, found, ends, locked)
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
            self.sizes,
            locked,
            self.voices.version,
        )
        return self._still.of(values, (p.shown, found, self.what_if.plans), make)

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
            self.titles.press(event.position(), bool(event.modifiers() & Qt.KeyboardModifier.AltModifier))
            return
        self._hold_off(event.modifiers())
        if event.position().y() >= NUMBERS and self.ruler.press(event.position()):
            self.update()
            return
        if self.cameras.press(event.position()):
            return
        mark = mark_at(self.marks(), event.position())
        if mark is not None:
            self._press(mark, event)
            return
        seed = get_ghost_seed(find_lane_at(self.height(), event.position(), self.sizes))
        if seed is not None:
            self.what_if.take(seed)
            return
        self.session.onstage.select_requests(())
        self.performance.timeline.select(None)
        found = find_cue_at(self.performance.shown, self.scale(), self.height(), event.position(), self.sizes)
        if found is not None:
            self.session.jump(action=found[1].action.id)
        else:
            self.scrub(event.position().x())

    def _press(self, mark: RequestMark, event: QMouseEvent) -> None:
        ident, chosen = mark.ask.id, self.session.onstage.requests
        more = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        lone = more and ident in chosen
        if ident not in chosen:
            self.session.onstage.select_requests((*chosen, ident) if more else (ident,))
        requests = self.performance.requests
        still = requests.still() if requests.editable else frozenset()
        if requests.editable and ident not in still:
            held = tuple(i for i in self.session.onstage.requests if i not in still)
            moved = requests.with_following(held)
            self.magnet.begin(self.snap_lines(moved))
            self.hand.take(RequestDrag(self, held, ident, lone, moved), event.position())
        elif lone:
            self.session.onstage.select_requests(tuple(i for i in chosen if i != ident))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        x = event.position().x()
        self._hold_off(event.modifiers())
        if self.hand.move(event.position(), bool(event.modifiers() & COPIES)):
            self.setCursor(self.hand.cursor or Qt.CursorShape.SizeHorCursor)
            self.update()
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self.scrub(x)
        elif event.buttons() & Qt.MouseButton.MiddleButton:
            self.first = max(0.0, self.first - (x - self._grip) / self.each)
            self.update()
        else:
            over = mark_at(self.marks(), event.position()) is not None and self.performance.requests.editable
            shape = self.ruler.cursor(event.position())
            if self.cameras.edge_at(event.position()) is not None:
                shape = Qt.CursorShape.SizeHorCursor
            if self.titles.border_at(event.position()) is not None:
                shape = Qt.CursorShape.SizeVerCursor
            elif shape is None:
                shape = Qt.CursorShape.SizeHorCursor if over else Qt.CursorShape.ArrowCursor
            self.setCursor(shape)
        self._grip = x

    _grip = 0.0

    @property
    def drag(self) -> RequestDrag | None:
        """The requests that are being dragged; None before the mouse has moved far enough, too."""
        gesture = self.hand.gesture
        return gesture if isinstance(gesture, RequestDrag) and gesture.begun else None

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.hand.release(event)
        self.magnet.end()
        self.magnet.held_off = False
        self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        mark = mark_at(self.marks(), event.position())
        if mark is not None:
            self.edit(mark.ask.id)
            return
        marker = self.ruler.marker_at(event.position())
        if marker is not None:
            self.ruler.rename(marker.id)
        if event.position().y() < RULER:
            return
        found = find_cue_at(self.performance.shown, self.scale(), self.height(), event.position(), self.sizes)
        if found is not None:
            self.session.show_context(found[1].action.id)
        elif event.position().x() >= LEFT:
            self._menu(event.position(), event.globalPosition())

    def _menu(self, at: QPointF, on_screen: QPointF) -> None:
        seconds = round(max(0.0, self.scale().seconds(at.x())), 2)
        if self.cameras.on(at):
            self.cameras.menu(at).popup(on_screen.toPoint())
            return
        mark, lane = mark_at(self.marks(), at), find_lane_at(self.height(), at, self.sizes)
        if mark is not None and self.performance.requests.editable:
            make_request_marks_menu(self, mark).popup(on_screen.toPoint())
        else:
            make_request_menu(self, self.performance, seconds, lane if lane in LAYERS else STAGE).popup(
                on_screen.toPoint()
            )

    def edit(self, ident: str) -> None:
        """Show the fields of a request."""
        from app.features.timeline.request_editor import RequestEditor

        if self.performance.requests.editable and self.performance.requests.free((ident,)):
            RequestEditor(self.performance, ident, self).open()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            self.ask_here()
        elif (lane := self.titles.lane_at(QPointF(event.pos()))) is not None:
            self.titles.menu(lane).popup(event.globalPos())
        elif event.pos().y() < RULER and event.pos().x() >= LEFT:
            self.ruler.menu(QPointF(event.pos())).popup(event.globalPos())
        elif event.pos().x() >= LEFT:
            self._menu(QPointF(event.pos()), QPointF(event.globalPos()))

    def ask_here(self) -> None:
        """Ask for something at the playhead."""
        x = min(max(LEFT, self.scale().x(self.session.transport.seconds)), self.width())
        seconds = round(self.session.transport.seconds, 2) if self.performance.live.stage is None else None
        make_request_menu(self, self.performance, seconds).popup(
            self.mapToGlobal(QPointF(x, RULER).toPoint())
        )

    def scrub(self, x: float) -> None:
        """Go to a place, still; in what is looked at alone to its end at most."""
        transport, seconds = self.session.transport, self.scale().seconds(max(x, LEFT))
        transport.set_playing(False)
        transport.seek(seconds if transport.show == "plan" else min(seconds, self.performance.shown.length))

    def set_sizes(self, sizes: Sizes) -> None:
        """Show other lanes, or lanes of other heights."""
        if sizes != self.sizes:
            self.sizes = sizes
            self.update()

    def show_lanes(self) -> None:
        """Have a lane for everything that there is to show, of words where there is room for one."""
        cameras = ("cameras",) if self.performance.conversation is not None else ()
        spoken = replace(self.sizes, extra=(*cameras, "words", *self.what_if.lanes))
        words = ("words",) if self.voices.wanted and self.height() >= spoken.least(LEAST) else ()
        self.set_sizes(replace(self.sizes, extra=(*cameras, *words, *self.what_if.lanes)))
        needed = replace(self.sizes, extra=(*cameras, *self.what_if.lanes))
        least = LEAST_BESIDE if self.what_if.lanes else LEAST
        self.setMinimumHeight(round(needed.least(least)))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.show_lanes()

    def snap_lines(self, but: tuple[str, ...]) -> list[SnapLine]:
        """Return what a drag of some requests or of a marker holds to."""
        return snap_lines(self.performance, self.marks(), self.words(), self.scale(), self.width(), but)

    def words(self) -> list[tuple[float, float, str]]:
        """Return the words that are said, by time."""
        return self.voices.words()

    # --- keys and tips

    def keyPressEvent(self, event: QKeyEvent) -> None:
        self._hold_off(event.modifiers())
        if not self.keys.press(event):
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        self._hold_off(event.modifiers())
        super().keyReleaseEvent(event)

    def _hold_off(self, held: Qt.KeyboardModifier) -> None:
        """Nothing snaps while Shift is held."""
        self.magnet.held_off = bool(held & Qt.KeyboardModifier.ShiftModifier)

    def break_off(self) -> bool:
        """Break a drag off; return whether there was one."""
        dropped = self.hand.drop("escape")
        self.magnet.end()
        if dropped:
            self.setCursor(Qt.CursorShape.ArrowCursor)
            self.update()
        return dropped

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self.tip(QPointF(event.pos())), self)
            return True
        asked = event.type() == QKeyEvent.Type.ShortcutOverride
        if asked and isinstance(event, QKeyEvent) and self.keys.wants(event):
            event.accept()
            return True
        return super().event(event)

    def tip(self, at: QPointF) -> str:
        return describe_place(self, at)
