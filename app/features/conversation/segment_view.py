"""The widget of a conversation's lanes: paints them, and turns the mouse and the keys into edits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, Qt
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
from PySide6.QtWidgets import QMenu, QToolTip, QWidget

from app.features.conversation.addressees import describe_addressee, offer_addressees
from app.features.conversation.drags.choice import begin_segment_gesture
from app.features.conversation.drags.pan import SegmentPan
from app.features.conversation.drags.segment import SegmentDrag
from app.features.conversation.segment_editing import Editing
from app.features.conversation.segment_hits import NOTHING, SegmentHit, find_segment_hit, is_on_arrow
from app.features.conversation.segment_keys import DEEDS, find_deed
from app.features.conversation.segment_lanes import (
    NEAREST,
    describe_segment,
    find_least_scale,
    find_words_between,
    measure_least_lane_height,
)
from app.features.conversation.segment_paint import SegmentScene, paint_empty_conversation, paint_segments
from app.features.conversation.segment_spoken import list_segment_items
from app.features.conversation.sound_reading import Sounds
from app.look.theme import get_theme
from app.project.document import Edit
from app.translation import make_lazy_texts, tr, tr_noop
from app.widgets.gesture import PointerHand
from app.widgets.lane_geometry import LEFT, LaneScale
from app.widgets.lane_paint import paint_badge, paint_playhead
from app.widgets.memo import Once
from app.widgets.spoken_items import SpokenItem, tell_spoken_focus
from metagraph.graph.conversation.model import Conversation, get_side_name
from metagraph.graph.edit_error import EditError

ZOOM, USUAL = 1.2, 100.0  # of a turn of the wheel; pixels a second to begin with: most words have room
EMPTY = make_lazy_texts(
    lambda: (
        tr("Drop the sound of a conversation here"),
        tr(
            "Use one file with a channel for each speaker, or one file for each. Add transcripts "
            "if you have them: TextGrid, ELAN, subtitles or JSON."
        ),
        tr("The speech appears here as clauses, responses and hesitations, and moves the characters."),
    )
)
UNCHOSEN = make_lazy_texts(
    lambda: (
        tr("No conversation on stage"),
        tr("Choose a conversation above, or drop the sound of a new one here."),
    )
)
TEXT = tr_noop(
    "Segments of a conversation. Left and Right select a segment, Up and Down the speaker. "
    "1 to 3 label the segment, S splits it, M merges it, Delete removes it."
)


class SegmentView(QWidget):
    """A press on a segment selects it, a drag moves it, or its edge, or its stress; a drag in a gap makes
    one; elsewhere it moves the playhead. The wheel zooms, with Shift, or the middle button, it moves along.
    """

    def __init__(self, editing: Editing, sounds: Sounds, parent: QWidget) -> None:
        super().__init__(parent)
        self.editing, self.sounds = editing, sounds
        self.document, self.session = editing.document, editing.session
        self.each, self.first = USUAL, 0.0
        self.hand = PointerHand()
        self.held: Conversation | None = None  # as it would be if what is dragged were let go
        self.over: SegmentHit = NOTHING
        self.pointer = QPointF(-1, -1)
        self.painted = 0  # how often the lanes were painted, not only the playhead over them
        self._still: Once[QPixmap] = Once()
        self._came = 0  # how often more of a sound has come
        self._by_keys = False
        self._ident: str | None = None  # of the conversation on stage
        self.setMinimumHeight(measure_least_lane_height(2))
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Conversation"))
        self.setAccessibleDescription(tr(TEXT))
        sounds.changed.connect(self._read)
        editing.changed.connect(self._chosen)
        self.document.changed.connect(lambda before, after: self._changed())
        self.session.transport.moved.connect(self._playhead)
        self.session.look.changed.connect(self.update)
        self.session.onstage.conversation_changed.connect(self._staged)

    # --- what is in sight

    def conversation(self) -> Conversation | None:
        """Return the conversation as it is drawn: with what is being dragged."""
        return self.held or self.editing.conversation

    def scale(self) -> LaneScale:
        return LaneScale(self.first, self.each)

    def look_at(self, first: float) -> None:
        """Begin at a time, but never leave the conversation."""
        of = self.editing.conversation
        length = of.length if of is not None else 0.0
        self.first = min(max(0.0, first), max(0.0, length - 0.5 * max(0, self.width() - LEFT) / self.each))
        self.update()

    def zoom(self, by: float, x: float) -> None:
        """Zoom about a place on the screen."""
        of = self.editing.conversation
        at, least = (
            self.scale().seconds(x),
            find_least_scale(self.width(), of.length if of is not None else 60.0),
        )
        self.each = min(NEAREST, max(least, self.each * by))
        self.look_at(at - (x - LEFT) / self.each)

    def hold(self, edit: Edit | None) -> None:
        """Show what an edit would make, without making it; None shows what is."""
        self.held = None
        ident = self.session.onstage.conversation
        if edit is not None and ident is not None:
            try:
                self.held = edit(self.document.project).conversations[ident]
            except EditError:
                self.held = None
        self.update()

    def reveal(self) -> None:
        """Bring the selected segment in sight."""
        found = self.editing.segment(self.editing.last)
        if found is not None and self.hand.gesture is None:
            left, right = self.scale().x(found.start), self.scale().x(found.end)
            if left < LEFT or right > self.width():
                self.look_at(found.start - 0.3 * (self.width() - LEFT) / self.each)

    def list_spoken_items(self) -> Sequence[SpokenItem]:
        of, size = self.conversation(), (float(self.width()), float(self.height()))
        return list_segment_items(of, self.scale(), size, self.editing) if of is not None else ()

    def _changed(self) -> None:
        self._make_room()
        self.update()

    def _chosen(self) -> None:
        self.reveal()
        self.update()
        tell_spoken_focus(self)

    def _staged(self) -> None:
        self._stop_dragging()
        if (
            self.session.onstage.conversation != self._ident
        ):  # else it is another of those who talk that the timeline shows
            self._ident = self.session.onstage.conversation
            self.first, self.each = 0.0, USUAL
        self._make_room()
        self.update()

    def _make_room(self) -> None:
        """Be as high as the lanes need; the panel scrolls where there is less."""
        of = self.editing.conversation
        self.setMinimumHeight(measure_least_lane_height(len(of.sides) if of is not None else 2))

    def _read(self) -> None:
        self._came += 1
        self.update()

    def _playhead(self, seconds: float) -> None:
        width = self.width() - LEFT
        if width > 40 and self.hand.gesture is None and self.editing.conversation is not None:
            x = (seconds - self.first) * self.each
            if not 0 <= x <= width * (0.85 if self.session.transport.playing else 1.0):
                self.look_at(seconds - 0.15 * width / self.each)
        self.update()

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        t, painter, of = get_theme(self.session.look.name), QPainter(self), self.conversation()
        if of is None:
            painter.fillRect(self.rect(), QColor(t.panel))
            paint_empty_conversation(
                painter, t, QRectF(self.rect()), UNCHOSEN if self.document.project.conversations else EMPTY
            )
            painter.end()
            return
        painter.drawPixmap(0, 0, self._picture(of))
        x = self.scale().x(self.session.transport.seconds)
        if x >= LEFT - 1:
            paint_playhead(painter, t, x, self.height())
        drag = self.hand.gesture
        if isinstance(drag, SegmentDrag) and drag.begun and drag.words:
            font = QFont(self.font())
            font.setFeature(QFont.Tag("tnum"), 1)
            painter.setFont(font)
            paint_badge(painter, t, QPointF(self.scale().x(drag.seconds), 0), drag.words, self.width())
        if self.hasFocus() and self._by_keys:
            painter.setPen(QPen(QColor(t.dim), 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))
        painter.end()

    def _picture(self, of: Conversation) -> QPixmap:
        """Return everything but the playhead, made again only when something else than the playhead has
        changed.
        """
        ratio, chosen, s = self.devicePixelRatioF(), self.editing.chosen, self.session
        heard = tuple(self.sounds.of(of, side) for side in range(len(of.sides)))

        def make() -> QPixmap:
            picture = QPixmap(self.size() * ratio)
            picture.setDevicePixelRatio(ratio)
            painter = QPainter(picture)
            painter.setFont(self.font())
            scene = SegmentScene(
                of, heard, self.scale(), self.width(), self.height(), ratio, chosen, self.over, s.onstage.side
            )
            paint_segments(painter, get_theme(s.look.name), scene)
            painter.end()
            self.painted += 1
            return picture

        values = (
            self.scale(),
            self.size(),
            ratio,
            s.look.name,
            s.onstage.side,
            chosen,
            self.over,
            self._came,
            self.font().toString(),
        )
        return self._still.of(values, (of, *heard), make)

    # --- the mouse

    def _hit(self, at: QPointF) -> SegmentHit:
        of = self.editing.conversation
        return (
            find_segment_hit(of, self.scale(), (self.width(), self.height()), at)
            if of is not None
            else NOTHING
        )

    def mousePressEvent(self, event: QMouseEvent) -> None:
        at, hit = event.position(), self._hit(event.position())
        self.pointer = at
        if self.hand.gesture is not None or hit.part == "nothing":
            return
        if event.button() == Qt.MouseButton.MiddleButton:
            self.hand.take(SegmentPan(self), at)
        elif event.button() == Qt.MouseButton.LeftButton and hit.part == "title":
            self.session.onstage.set_side(hit.side)
            if is_on_arrow(at, (self.width(), self.height()), self.editing.conversation, hit.side):
                self._partner(hit.side, event.globalPosition().toPoint())
        elif event.button() == Qt.MouseButton.LeftButton:
            if hit.at >= 0:
                self._select(hit, event.modifiers())
            elif not event.modifiers():
                self.editing.select(())
            self.hand.take(begin_segment_gesture(self, hit), at)
        self._show_cursor(hit)

    def _select(self, hit: SegmentHit, modifiers: Qt.KeyboardModifier) -> None:
        editing, place = self.editing, (hit.side, hit.at)
        last = editing.last
        if modifiers & Qt.KeyboardModifier.ShiftModifier and last is not None and last[0] == hit.side:
            run = range(min(last[1], hit.at), max(last[1], hit.at) + 1)
            editing.select(editing.chosen | {(hit.side, n) for n in run}, last)
        elif modifiers & Qt.KeyboardModifier.ControlModifier:
            editing.select(editing.chosen ^ {place}, place)
        elif place not in editing.chosen:
            editing.select({place})
        else:
            editing.select(editing.chosen, place)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.pointer = event.position()
        if self.hand.move(event.position(), bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)):
            return
        hit = self._hit(event.position())
        if hit != self.over:
            self.over = hit
            self._show_cursor(hit)
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self.hand.release(event):
            self.over = self._hit(event.position())
            self._show_cursor(self.over)
            self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        hit = self._hit(event.position())
        if event.button() == Qt.MouseButton.LeftButton and hit.at >= 0 and hit.part != "peak":
            self.editing.select({(hit.side, hit.at)})
            self.editing.relabel_next()

    def leaveEvent(self, event: object) -> None:
        self.over, self.pointer = NOTHING, QPointF(-1, -1)
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier or abs(delta.x()) > abs(delta.y()):
            self.look_at(self.first - (delta.x() or delta.y()) / 2 / self.each)
        else:
            self.zoom(ZOOM ** (delta.y() / 120), event.position().x())
        event.accept()

    def _show_cursor(self, hit: SegmentHit) -> None:
        shape = Qt.CursorShape
        by_part = dict.fromkeys(("start", "end", "peak"), shape.SizeHorCursor)
        by_part |= {"gap": shape.CrossCursor, "title": shape.PointingHandCursor}
        self.setCursor(self.hand.cursor or by_part.get(hit.part, shape.ArrowCursor))

    def _stop_dragging(self) -> bool:
        """Cancel what is being dragged; return whether something was."""
        dropped = self.hand.drop("escape")
        if dropped:
            self._show_cursor(NOTHING)
        return dropped

    # --- menu, keys and tips

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if self.editing.conversation is None or self.hand.gesture is not None:
            return
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            x = min(max(LEFT, self.scale().x(self.session.transport.seconds)), self.width())
            self.menu(self.session.transport.seconds).popup(self.mapToGlobal(QPointF(x, 40).toPoint()))
            return
        hit = self._hit(QPointF(event.pos()))
        if hit.at >= 0 and (hit.side, hit.at) not in self.editing.chosen:
            self.editing.select({(hit.side, hit.at)})
        if hit.part == "title":
            self._partner(hit.side, event.globalPos())
        elif hit.part != "nothing":
            self.menu(self.scale().seconds(event.pos().x())).popup(event.globalPos())

    def _partner(self, side: int, at: QPoint) -> None:
        """Offer another character, body or voice for one who talks."""
        from app.features.conversation.partner_menu import make_partner_menu

        ident = self.session.onstage.conversation
        if ident is not None and ident in self.editing.document.project.conversations:
            menu = make_partner_menu(self, self.editing.document, ident, side, self.more)
            menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
            menu.popup(at)

    more: Callable[[], object] | None = None  # opens the dialog of all sounds and names

    def menu(self, seconds: float) -> QMenu:
        """Return what can be done with the selected segments, at a time."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for deed in DEEDS:
            if deed.hidden:
                continue
            if deed.line:
                menu.addSeparator()
            action = menu.addAction(f"{deed.text}\t{deed.shown}", partial(deed.run, self.editing, seconds))
            action.setEnabled(bool(self.editing.chosen) or not deed.needs)
        offer_addressees(menu, self.editing)
        return menu

    def _seconds(self) -> float:
        """Return the time keys are about: under the pointer if that is on a segment, else the playhead."""
        hit = self._hit(self.pointer)
        return (
            self.scale().seconds(self.pointer.x())
            if hit.at >= 0 and hit.part != "peak"
            else self.session.transport.seconds
        )

    def keyPressEvent(self, event: QKeyEvent) -> None:
        deed, key = find_deed(event.key(), event.modifiers()), event.key()
        if key == Qt.Key.Key_Escape and (self._stop_dragging() or self.editing.chosen):
            self.editing.select(())
            self.update()
        elif self.hand.gesture is not None or self.editing.conversation is None:
            event.ignore()  # what is held is not edited by keys as well
        elif deed is not None and (self.editing.chosen or not deed.needs):
            deed.run(self.editing, self._seconds())
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal, Qt.Key.Key_Minus):
            self.zoom(
                1 / ZOOM if key == Qt.Key.Key_Minus else ZOOM,
                min(max(LEFT, self.scale().x(self.session.transport.seconds)), self.width()),
            )
        elif key in (Qt.Key.Key_PageUp, Qt.Key.Key_PageDown):
            page = 0.8 * (self.width() - LEFT) / self.each
            self.look_at(self.first + (page if key == Qt.Key.Key_PageDown else -page))
        else:
            super().keyPressEvent(event)

    def focusNextPrevChild(self, following: bool) -> bool:
        """Tab goes from segment to segment, and on to the next panel at the last."""
        return self.editing.step(1 if following else -1) or super().focusNextPrevChild(following)

    def focusInEvent(self, event: QFocusEvent) -> None:
        self._by_keys = event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason)
        super().focusInEvent(event)
        self.update()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self.update()

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self.tip(QPointF(event.pos())), self)
            return True
        if (
            isinstance(event, QKeyEvent)
            and event.type() == QKeyEvent.Type.ShortcutOverride
            and self.editing.conversation is not None
        ):
            deed = find_deed(event.key(), event.modifiers())
            escapes = event.key() == Qt.Key.Key_Escape and (
                self.hand.gesture is not None or self.editing.chosen
            )
            if escapes or (deed is not None and (self.editing.chosen or not deed.needs)):
                event.accept()  # here it is about segments, not about what is selected elsewhere
                return True
        return super().event(event)

    def tip(self, at: QPointF) -> str:
        """Return what to say about what is under a point."""
        of, hit = self.editing.conversation, self._hit(at)
        if of is None or self.hand.gesture is not None:
            return ""
        if hit.at >= 0:
            words = describe_segment(of.sides[hit.side].segments[hit.at]) + describe_addressee(
                of, hit.side, hit.at
            )
            return words + (tr("\nDrag it to another peak of the pitch") if hit.part == "peak" else "")
        if hit.part == "wave":
            seconds = self.scale().seconds(at.x())
            said = [
                w
                for w in find_words_between(of.sides[hit.side].words, seconds, seconds)
                if w.start <= seconds <= w.end
            ]
            return (
                tr(
                    "{word}\n{start:.2f} to {end:.2f} s",
                    word=said[0].text,
                    start=said[0].start,
                    end=said[0].end,
                )
                if said
                else ""
            )
        if hit.part == "title":
            side, whose = of.sides[hit.side], hit.side == self.session.onstage.side
            channel = tr(", channel {number}", number=side.channel + 1) if side.channel is not None else ""
            sound = [f"{side.audio}{channel}"] if side.audio else []
            mover = [tr("Moved by {project}", project=side.project)] if side.project else []
            shown = (
                tr("The Performance panel shows this speaker's plan")
                if whose
                else tr("Click to see this speaker's plan in the Performance panel")
            )
            other = tr("Click the arrow to change the character, body language or voice")
            return "\n".join((get_side_name(of, hit.side), *sound, *mover, shown, other))
        return tr("Drag to add a segment") if hit.part == "gap" else ""
