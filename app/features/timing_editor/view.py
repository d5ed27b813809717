"""The widget of the editor: shows the rows of the selected actions over one axis, and is where the mouse and
the keys are.
"""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QWheelEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from app.features.timing_editor import filmstrip, overlay, paint
from app.features.timing_editor.axis import Axis
from app.features.timing_editor.drags.kept import KeptDrag
from app.features.timing_editor.drags.loop import LoopDrag
from app.features.timing_editor.drags.pan import Panning
from app.features.timing_editor.drags.scrub import Scrubbing
from app.features.timing_editor.drags.stay import StayDrag
from app.features.timing_editor.drags.timing import TimingDrag, handle_change, make_block_change
from app.features.timing_editor.hits import Hit, find_timing_hit
from app.features.timing_editor.kept_rows import hit_kept, paint_kept
from app.features.timing_editor.rows import (
    GUTTER,
    RIGHT,
    TrackRows,
    TrackWants,
    lay_out_rows,
    measure_least_rows_height,
)
from app.features.timing_editor.subject import Subject
from app.features.timing_editor.track import Facts, KeptHand, describe_handle
from app.look.theme import get_theme
from app.project.document import Document
from app.stage.session import StageSession
from app.stage.transport import Transport
from app.translation import tr, tr_noop
from app.widgets.gesture import PointerHand
from app.widgets.memo import Once
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.suggest.jumps.snapping import Snap, list_snaps

ZOOM = 1.2
TEXT = tr_noop(
    "Timing of the selected actions. Left and Right move the playhead by one frame. I and "
    "O set the start and end of the action there. Plus and minus zoom, 0 shows everything."
)


class TimingView(QWidget):
    """typed: a handle of an action (id) is to be given a number, with the room its number has."""

    typed = Signal(str, str, QRectF)

    def __init__(self, document: Document, session: StageSession, subject: Subject, parent: QWidget) -> None:
        super().__init__(parent)
        self.document, self.session, self.subject = document, session, subject
        self.length = 1.0  # seconds of the longest clip
        self._near: Axis | None = None  # the part that is seen; None for everything
        self.hand = PointerHand()
        self.snapped: Snap | None = None
        self.snaps: tuple[Snap, ...] = ()
        self.held = ""
        self.stretched: tuple[str, KeptHand] | None = None
        self.numbers: dict[str, dict[str, QRectF]] = {}
        self._clip = ""
        self._still: Once[tuple[QPixmap, dict[str, dict[str, QRectF]]]] = Once()
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Timing"))
        self.setAccessibleDescription(tr(TEXT))
        subject.changed.connect(self.refresh)
        session.look.changed.connect(self.refresh)
        session.transport.moved.connect(lambda _: self.update())
        session.transport.show_changed.connect(self.update)
        session.transport.part_changed.connect(self.update)

    @property
    def axis(self) -> Axis:
        room = self.width() - GUTTER - RIGHT
        if self._near is None:
            return Axis.whole(GUTTER, room, self.length)
        return self._near.fitted(GUTTER, room, self.length)

    @axis.setter
    def axis(self, axis: Axis) -> None:
        self._near = None if axis.is_whole else axis

    @property
    def transport(self) -> Transport:
        return self.session.transport

    def idents(self) -> tuple[str, ...]:
        return self.subject.idents

    # --- what is where

    def refresh(self) -> None:
        """Take over what the subject is now."""
        shown = self.subject.facts()
        self.length = max([f.entry.duration for f in shown.values()], default=1.0)
        clip = next((f.action.clip for f in shown.values()), "")
        if not shown:
            self.numbers = {}
        if clip != self._clip:
            self._clip, self._near = clip, None
        self.setMinimumHeight(round(measure_least_rows_height(self.wants())) + 2)
        self.update()

    def wants(self) -> list[TrackWants]:
        """Return what is shown of each action."""
        return [
            TrackWants(ident, self.subject.row_names(n), len(self.subject.sheet(ident).names))
            for n, ident in enumerate(self.subject.facts())
        ]

    def tracks(self) -> tuple[TrackRows, ...]:
        return lay_out_rows(self.wants(), self.width(), self.height())

    def minimumSizeHint(self) -> QSize:
        return QSize(320, self.minimumHeight())

    def hit(self, at: QPointF) -> Hit | None:
        """Return what is under a point."""
        tracks, facts, axis = self.tracks(), self.subject.facts(), self.axis
        for rows in tracks:
            numbers = self.numbers.get(rows.ident, {})
            if facts[rows.ident].kept and (kept := hit_kept(rows, facts[rows.ident], axis, numbers, at)):
                return kept
        return find_timing_hit(tracks, facts, axis, self.numbers, at)

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        picture, self.numbers = self._picture()
        painter.drawPixmap(0, 0, picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look, tracks, facts = self._look(), self.tracks(), self.subject.facts()
        seconds = self.subject.playhead()
        if seconds is not None:
            overlay.paint_timing_playhead(painter, look, self.axis, tracks, facts, seconds)
        overlay.paint_looped_part(painter, look, self.axis, self.transport.part, facts)
        if self.stretched is not None:
            overlay.paint_stretched_hand(painter, look, self.axis, tracks, facts, *self.stretched)
        if self.held:
            overlay.paint_held(
                painter, look, self.axis, self.width(), tracks, self.snaps, self.snapped, self.held
            )
        painter.end()

    def _look(self) -> paint.TimingLook:
        small = QFont(self.font())
        small.setPixelSize(13)
        small.setFeature(QFont.Tag("tnum"), 1)
        return paint.TimingLook(get_theme(self.session.look.name), small)

    def _picture(self) -> tuple[QPixmap, dict[str, dict[str, QRectF]]]:
        """Return what only an edit, zooming or a new size changes, and where the numbers stand."""
        facts, before = self.subject.facts(), self.subject.before_facts()
        films = [self.subject.film(ident) for ident in facts]
        ratio = self.devicePixelRatioF()
        values = (
            self.axis, self.size(), ratio, self.font().toString(), self.session.look.name,
            tuple(self.wants()), tuple(len(film) for film in films), self.subject.said,
        )  # fmt: skip
        objects = (*facts.values(), *before.values(), *(film[0] for film in films if film))
        return self._still.of(values, (len(facts), *objects), lambda: self._painted(facts, before, ratio))

    def _painted(
        self, facts: dict[str, Facts], before: dict[str, Facts], ratio: float
    ) -> tuple[QPixmap, dict[str, dict[str, QRectF]]]:
        picture = QPixmap(self.size() * ratio)
        picture.setDevicePixelRatio(ratio)
        look, axis, out = self._look(), self.axis, {}
        picture.fill(QColor(look.t.panel))
        painter = QPainter(picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if not facts:
            painter.setPen(QColor(look.t.dim))
            painter.drawText(
                QRectF(self.rect()).adjusted(20, 0, -20, 0),
                Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap,
                tr("Select an action to see its timing."),
            )
            painter.end()
            return picture, {}
        paint.paint_ruler(painter, look, axis)
        for rows in self.tracks():
            shown = facts[rows.ident]
            paint.paint_row_names(painter, look, rows, shown)
            painter.setClipRect(QRectF(axis.left - 1, rows.top, axis.width + 2, self.height()))
            paint.paint_row_ground(painter, look, axis, rows, shown)
            if "poses" in rows.rows:
                own = self.subject.clip_axis(axis, shown)
                filmstrip.paint_poses(painter, look, rows.rows["poses"], own, self.subject.film(rows.ident))
            if "line" in rows.rows:
                wave = self.subject.wave(axis, shown)
                paint.paint_wave(painter, look, rows.rows["line"], axis, *wave)
            paint.paint_blends(painter, look, axis, rows, shown)
            if rows.ident in before:
                paint.paint_action_before(painter, look, axis, rows, before[rows.ident], shown.top)
            paint.paint_speed_curves(painter, look, axis, rows, shown)
            if "phases" in rows.rows:
                paint.paint_phase_blocks(painter, look, axis, rows, shown)
            if "stance" in rows.rows:
                paint.paint_stance_distance(painter, look, axis, rows, shown)
            out[rows.ident] = paint.paint_handles(painter, look, axis, rows, shown)
            paint.paint_stays(painter, look, axis, rows, shown)
            out[rows.ident].update(paint_kept(painter, look, axis, rows, shown))
            painter.setClipping(False)
            sheet = self.subject.sheet(rows.ident)
            if sheet.names:
                own = self.subject.clip_axis(axis, shown)
                filmstrip.paint_dope_sheet(
                    painter, look, rows.dope, own, sheet, look.t.kind(shown.action.kind)
                )
        painter.end()
        return picture, out

    # --- the mouse

    def wheelEvent(self, event: QWheelEvent) -> None:
        turn, shift = event.angleDelta(), bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if turn.x() or shift:
            self.axis = self.axis.moved(-(turn.x() or turn.y()))
        else:
            self.axis = self.axis.zoomed(event.position().x(), ZOOM ** (turn.y() / 120))
        self.update()
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        at, button = event.position(), event.button()
        if button == Qt.MouseButton.MiddleButton:
            self.hand.take(Panning(self), at)
            return
        hit = self.hit(at) if button == Qt.MouseButton.LeftButton else None
        if hit is None:
            event.ignore()
            return
        facts = self.subject.facts()[hit.ident]
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if hit.what == "handle":
            self.hand.take(self._handle_drag(facts, hit.name), at)
        elif hit.what == "stay":
            stay = next(s for s in facts.stays if f"{s.hold.at}" == hit.name)
            self.hand.take(StayDrag(self, facts, stay), at)
        elif hit.what == "kept":
            self.hand.take(KeptDrag(self, facts, hit.name, self.subject.playhead()), at)
        elif hit.what == "block":
            self.hand.take(self._block_drag(facts, "" if shift or not facts.blocks else hit.name), at)
        elif hit.what == "ruler" and shift:
            self.hand.take(LoopDrag(self, facts), at)
        else:
            self.hand.take(Scrubbing(self, facts), at)

    def _handle_drag(self, facts: Facts, name: str) -> TimingDrag:
        grip = next(h.at for h in facts.handles if h.name == name)
        project, now = self.document.project, self.subject.playhead()
        snaps = list_snaps(
            project, facts.action, name, facts.seen, facts.speeds, self.subject.stresses(facts), now
        )

        def words(_: float) -> str:
            shown = self.subject.facts().get(facts.action.id, facts)
            handle = shown.handle(name)
            return f"{describe_handle(handle)} s" if handle is not None else name

        done = partial(self.subject.play_blend, facts.action.id, name)
        return TimingDrag(self, facts, grip, snaps, handle_change(self.idents(), name), words, done)

    def _block_drag(self, facts: Facts, name: str) -> TimingDrag:
        first = next((b.first for b in facts.blocks if b.name == name), facts.span[0])

        def words(_: float) -> str:
            shown = self.subject.facts().get(facts.action.id, facts)
            ends = next(((b.first, b.last) for b in shown.blocks if b.name == name), shown.span)
            return tr(
                "{what} {start:.2f} to {end:.2f} s",
                what=get_vocabulary_word(name) if name else tr("plays"),
                start=ends[0],
                end=ends[1],
            )

        snaps = list_snaps(self.document.project, facts.action, "ready", None, facts.speeds) if name else ()
        return TimingDrag(self, facts, first, snaps, make_block_change(self.idents(), name), words)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        free = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        if not self.hand.move(event.position(), free):
            hit = self.hit(event.position())
            wide = Qt.CursorShape.SizeHorCursor
            shapes = {"handle": wide, "stay": wide, "kept": wide, "block": Qt.CursorShape.OpenHandCursor}
            self.setCursor(shapes.get(hit.what if hit else "", Qt.CursorShape.ArrowCursor))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.hand.release(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        hit = self.hit(event.position())
        box = self.numbers.get(hit.ident, {}).get(hit.name) if hit is not None else None
        if hit is not None and hit.what in ("handle", "kept") and box is not None:
            self.typed.emit(hit.ident, hit.name, box)
        elif hit is not None and hit.what == "ruler":
            self.transport.set_part(None)

    # --- keys

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, text = event.key(), event.text()
        facts = next(iter(self.subject.facts().values()), None)
        if key == Qt.Key.Key_Escape and self.hand.drop("escape"):
            return
        if facts is None:
            super().keyPressEvent(event)
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self._step(facts, -1 if key == Qt.Key.Key_Left else 1)
        elif text in ("+", "-", "="):
            middle = self.axis.left + self.axis.width / 2
            now = self.subject.playhead()
            about = self.axis.x(now) if now is not None else middle
            self.axis = self.axis.zoomed(about, 1 / ZOOM if text == "-" else ZOOM)
            self.update()
        elif text == "0":
            self.show_all()
        elif text.lower() in ("i", "o") and text:
            self.subject.move_here(facts, "start" if text.lower() == "i" else "end")
        else:
            super().keyPressEvent(event)

    def show_all(self) -> None:
        """Show the whole clip again."""
        self._near = None
        self.update()

    def _step(self, facts: Facts, frames: int) -> None:
        now = self.subject.playhead()
        frame = round((facts.span[0] if now is None else now) * facts.entry.fps) + frames
        self.transport.scrub(facts.action.clip, min(max(0, frame), facts.entry.frames - 1) / facts.entry.fps)

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            taken = event.text() in ("+", "-", "=", "0") or event.text().lower() in ("i", "o")
            arrows = event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right)
            if event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier) and (
                (taken and event.text()) or arrows or (event.key() == Qt.Key.Key_Escape and self.hand.gesture)
            ):
                event.accept()
                return True
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            QToolTip.showText(event.globalPos(), self.tip(QPointF(event.pos())), self)
            return True
        return super().event(event)

    def tip(self, at: QPointF) -> str:
        """Say what is under a point."""
        hit = self.hit(at)
        if hit is None:
            return ""
        return overlay.describe_timing_hit(self.subject.facts()[hit.ident], hit, self.axis.seconds(at.x()))
