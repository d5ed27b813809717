"""Timing seen, not typed: the speed of the hands or head over the clip, with handles for start, end, blends
and exit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QApplication,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.features.properties.jump_strip import JumpStrip
from app.features.properties.page_form import ANY
from app.look.theme import WindowTheme, get_theme
from app.project.document import Document
from app.stage.compatibility_state import Compatibility, compare_proposed_timing
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_phrase
from app.widgets.restyling import set_sheet
from app.widgets.still_plot import make_number_axes
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.model import Action, Project
from metagraph.motion.clip import Clip
from metagraph.playback.timing.handles import BLOCKS, HANDLES, PHASES, handle_times, move_handle
from metagraph.playback.timing.speed_curves import measure_action_speed

WORDS = make_lazy_texts(
    lambda: {
        "start": tr("start"),
        "end": tr("end"),
        "in": tr("blend in"),
        "out": tr("blend out"),
        "exit": tr("earliest exit"),
        "stroke": tr("stroke"),
    }
)
SNAP = 7  # pixels within which a handle comes to rest at a moment that does not jump


LABEL, FIRST = 17.0, 12.0  # pixels of a row of words over the curves, and to the middle of the first
HEIGHT, LEAST = 132, 84  # pixels of the curves in a form; and where they have the room to themselves
WORDED = 80.0  # pixels of height from which words over the curves leave something of them to be seen


class TimingPlot(QWidget):
    """Emits changed(fields) while a handle is dragged and finished when it is let go."""

    changed = Signal(object)
    finished = Signal()

    def __init__(self, document: Document, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.action: Action | None = None
        self._setting = False
        self.plot = pg.PlotWidget(self, axisItems=make_number_axes(), enableMenu=False)
        self.plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # the fields beside it have keys
        self.plot.setMouseEnabled(False, False)
        self.plot.hideButtons()
        self.set_large(False)
        self.plot.getAxis("left").setWidth(30)
        self.curve = self.plot.plot(antialias=True)
        self.blends = [pg.LinearRegionItem(movable=False) for _ in range(2)]
        for blend in self.blends:
            blend.setZValue(-5)
            self.plot.addItem(blend)
        self.hold = pg.LinearRegionItem(movable=False)
        self.hold.setZValue(-6)
        self.plot.addItem(self.hold)
        self.bands = [pg.TextItem(get_vocabulary_word(phase), anchor=(0.5, 0.0)) for phase in BLOCKS]
        for band in self.bands:
            band.span = None
            self.plot.addItem(band, ignoreBounds=True)
        self.lines: dict[str, pg.InfiniteLine] = {}
        for name in HANDLES:
            line = pg.InfiniteLine(movable=True, label=WORDS.get(name))
            line.setCursor(Qt.CursorShape.SizeHorCursor)
            line.sigDragged.connect(lambda item, n=name: self._dragged(n, item.value()))
            line.sigPositionChangeFinished.connect(lambda _: self._let_go())
            self.plot.addItem(line)
            self.lines[name] = line
        self.playhead = pg.InfiniteLine(movable=False)
        self.plot.addItem(self.playhead)
        self.plot.scene().sigMouseClicked.connect(self._clicked)
        self.plot.plotItem.vb.sigResized.connect(lambda _: self._line_up_soon())
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addWidget(self.plot)
        self.strip = JumpStrip(self, self.plot)
        layout.addWidget(self.strip)
        self.verdict = QLabel(self, wordWrap=True)
        self.use = QPushButton(tr("Use proposed times"), self)
        self.use.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the space bar still plays
        self.use.clicked.connect(self.use_proposed)
        row = QHBoxLayout()
        row.addWidget(self.verdict, 1)
        row.addWidget(self.use)
        layout.addLayout(row)
        session.transport.moved.connect(self._playhead)
        session.look.changed.connect(self._restyle)
        self._restyle()

    def set_large(self, on: bool) -> None:
        """Let the curves have all the height there is, or as much as a form has for them."""
        self.plot.setMinimumHeight(LEAST if on else HEIGHT)
        self.plot.setMaximumHeight(ANY if on else HEIGHT)

    def set_curves(self, on: bool) -> None:
        """Show the curves over what is said of them, or that alone."""
        self.plot.setVisible(on)
        self.strip.setVisible(on)

    def set_compatibility(self, compatibility: Compatibility) -> None:
        """Show what it knows of the action's jumps."""
        self.compatibility = compatibility
        compatibility.seen.connect(
            lambda ident: self._show_seen() if self.action is not None and ident == self.action.id else None
        )
        compatibility.changed.connect(self._show_seen)
        self._show_seen()

    compatibility: Compatibility | None = None
    _motion: Clip | None = None  # whose speed is drawn

    def _show_seen(self) -> None:
        """Show where the action can begin and end without a jump, as far as that is known by now."""
        project, action, t = self.document.project, self.action, get_theme(self.session.look.name)
        curves = (
            self.compatibility.curves(action)
            if self.compatibility is not None and action is not None
            else None
        )
        if action is None or project.action(action.id) is None:
            return
        from metagraph.suggest.jumps.seen_jumps import SeenJumps, describe_ends, describe_times, find_far_ends

        seen = SeenJumps(action, curves) if curves is not None else None
        self.strip.show_seen(project, action, seen)
        self.use.setEnabled(seen is not None and bool(self._proposed()))
        if seen is None:
            self.verdict.setText("")
            return
        start, end = project.span(action)
        first, last = seen.cost("start", start), seen.cost("end", end)
        costs = {"Repeats": last} if seen.loops else {"Begins": first, "ends": last}
        far = find_far_ends(project, action)
        self.verdict.setText(tr_phrase(describe_ends(costs, far)))
        fine = max(costs.values()) <= 1 and not far
        set_sheet(self.verdict, f"color: {t.dim if fine else t.warning}")
        times, reason = describe_times(seen), seen.proposed.reason
        self.use.setToolTip(tr("{times}: {reason}", times=times, reason=reason))

    def _proposed(self) -> dict[str, Any]:
        """Return the Timing fields that the proposed times would change."""
        project, action, seen = self.document.project, self.action, self.strip.seen
        if action is None or seen is None or action.clip not in project.clips:
            return {}
        fields = compare_proposed_timing(action, seen.proposed, project.clips[action.clip].duration)
        return {name: value for name, value in fields.items() if getattr(action.timing, name) != value}

    def use_proposed(self) -> None:
        """Take the times over that do not jump, in one step."""
        if self.compatibility is not None and self.action is not None:
            self.compatibility.use_proposed([self.action.id])

    def _restyle(self) -> None:
        t = get_theme(self.session.look.name)
        self.plot.setBackground(t.panel)
        for name in ("left", "bottom"):
            axis = self.plot.getAxis(name)
            axis.setPen(t.line)
            axis.setTextPen(t.dim)
        self.playhead.setPen(pg.mkPen(t.text, width=1, style=Qt.PenStyle.DotLine))
        if self.action is not None:
            self.show_action(self.action)

    def show_action(self, action: Action) -> None:
        """Show an action's timing."""
        t = get_theme(self.session.look.name)
        project = self.document.project
        fresh = (
            self.action is None
            or self.action.id != action.id
            or self.action.clip != action.clip
            or self.action.limb != action.limb
        )
        self.action = action
        entry = project.clips.get(action.clip)
        fresh = fresh or (entry is not None and entry.motion is not self._motion)
        self._motion = entry.motion if entry is not None else None
        if entry is None:
            return
        color = t.kind(action.kind)
        if fresh:
            speeds, words = measure_action_speed(project, action)
            self.curve.setData(np.arange(len(speeds)) / entry.fps, speeds)
            # In one go: each change of a range lets all lines and words find their places again.
            across = -0.02 * entry.duration, max(entry.duration, 0.1) * 1.02
            top = max(0.2, float(speeds.max()) * 1.15 if len(speeds) else 1.0)
            self.plot.plotItem.vb.setRange(xRange=across, yRange=(0, top), padding=0)
            self.plot.setToolTip(
                tr(
                    "{words}, m/s. Drag the lines to change the times. Click to move the playhead.",
                    words=words,
                )
            )
            if project.action(action.id) is None:
                self.strip.show_seen(project, action, None)
                self.verdict.setText("")
        if self._colors != (t.name, action.kind):
            self.curve.setPen(pg.mkPen(color, width=2))
        self.strip.restyle(t, t.fill(action.kind))
        self._place(project, action, t, color)
        self._show_seen()

    def _place(self, project: Project, action: Action, t: WindowTheme, color: QColor) -> None:
        """Put lines and shades where the action's times are. What stays as it is is not touched: whatever is
        lets all of the plot be painted again.
        """
        self._setting = True
        at = handle_times(project, action)
        self._color(action, t, color)
        for name, line in self.lines.items():
            value = at[name]
            loop = action.kind == "stance"
            line.setVisible(value is not None and not (loop and name in ("out", "exit", "stroke")))
            if value is not None:
                line.setValue(value)
        self._bands(at)
        self._line_up()
        for blend, (a, b) in zip(self.blends, ((at["start"], at["in"]), (at["out"], at["end"])), strict=True):
            blend.setRegion((a, b))
        self.blends[1].setVisible(action.kind != "stance")
        self._setting = False

    _colors: tuple[str, str] = ("", "")  # theme and kind they are of
    _owns: tuple[object, ...] = ()  # and which phases are the action's own

    def _color(self, action: Action, t: WindowTheme, color: QColor) -> None:
        """Give lines and shades their colours, where others are wanted than they have."""
        timing = action.timing
        own = dict(zip(PHASES, (timing.ready, timing.stroke_end, timing.relax), strict=True))
        owns = (t.name, *(value is None for value in own.values()))
        if owns != self._owns:
            self._owns = owns
            for name, value in own.items():
                pen = pg.mkPen(t.dim if value is None else t.text, width=1.2, style=Qt.PenStyle.DotLine)
                self.lines[name].setPen(pen)
        if (t.name, action.kind) == self._colors:
            return
        self._colors = t.name, action.kind
        for name, line in self.lines.items():
            line.setHoverPen(pg.mkPen(t.text, width=3))
            if name in PHASES:
                continue
            strong = name in ("start", "end")
            style = Qt.PenStyle.SolidLine if strong else Qt.PenStyle.DashLine
            line.setPen(pg.mkPen(t.text if strong else color, width=2 if strong else 1.4, style=style))
            line.label.setColor(t.dim)
        for band in self.bands:
            band.setColor(t.dim)
        for shade, of, alpha in ((self.hold, t.text, 22), *((blend, color, 46) for blend in self.blends)):
            fill = QColor(of)
            fill.setAlpha(alpha)
            shade.setBrush(fill)
            for line in shade.lines:
                line.setPen(pg.mkPen(None))

    def _bands(self, at: dict[str, float | None]) -> None:
        """Take over where the phases are named along the top, and shade the hold."""
        whole = at["ready"] is not None
        self.hold.setVisible(whole)
        edges = [at[x] for x in ("start", "ready", "hold", "relax", "end")]
        for band, a, b in zip(self.bands, edges, edges[1:], strict=False):
            band.span = (a, b) if whole and a is not None and b is not None else None
        if whole:
            self.hold.setRegion((edges[2], edges[3]))

    def _line_up_soon(self) -> None:
        if self.action is not None and self.action.clip in self.document.project.clips:
            self._bands(handle_times(self.document.project, self.action))
            self._line_up()

    def _line_up(self) -> None:
        """Give words rows in which none lies on another: the phases on top, where each has room in its span,
        then the handles. What finds no row is not written, nor anything over low curves; the pointer's
        tooltip names it.
        """
        box = self.plot.plotItem.vb
        (low, high), (_, top) = self.plot.viewRange()
        wide, tall = max(1.0, box.width()), max(1.0, box.height())
        each, measure = wide / max(high - low, 1e-6), self.fontMetrics()
        taken: dict[int, list[tuple[float, float]]] = {}
        worded = tall >= WORDED
        for band, phase in zip(self.bands, BLOCKS, strict=True):
            if band.span is None:
                band.setVisible(False)
                continue
            a, b = band.span
            middle, half = (
                ((a + b) / 2 - low) * each,
                measure.horizontalAdvance(get_vocabulary_word(phase)) / 2 + 3,
            )
            seen = worded and 2 * half <= (b - a) * each
            band.setVisible(seen)
            if seen:
                band.setPos((a + b) / 2, top)
                taken.setdefault(0, []).append((middle - half, middle + half))
        last = int((tall - FIRST - LABEL / 2) // LABEL)
        for name, line in self.lines.items():
            if name in PHASES:
                continue
            x, length = (line.value() - low) * each, measure.horizontalAdvance(WORDS[name]) + 10
            left, right = (x, x + length) if x < wide / 2 else (x - length, x)
            free = (
                row
                for row in range(min(1, last), last + 1)
                if all(right <= a or left >= b for a, b in taken.get(row, ()))
            )
            row = next(free, None) if worded and line.isVisible() else None
            line.label.setVisible(row is not None)
            if row is not None:
                taken.setdefault(row, []).append((left, right))
                place = 1 - (FIRST + row * LABEL) / tall
                if line.label.orthoPos != place:
                    line.label.setPosition(place)

    def _dragged(self, name: str, seconds: float) -> None:
        if self._setting or self.action is None:
            return
        seconds = self._snapped(name, seconds)
        fields = move_handle(self.document.project, self.action, name, seconds)
        # The character follows the handle.
        self.session.transport.show_clip(self.action.clip)
        self.session.transport.set_playing(False)
        self.session.transport.seek(
            min(max(0.0, seconds), self.document.project.clips[self.action.clip].duration)
        )
        self._moving = True
        self.changed.emit(fields)

    def _snapped(self, name: str, seconds: float) -> float:
        """Let the ends come to rest if nothing shows, unless Alt is held."""
        seen = self.strip.seen
        if seen is None or QApplication.keyboardModifiers() & Qt.KeyboardModifier.AltModifier:
            return seconds
        pixel = self.plot.plotItem.vb.viewPixelSize()[0]
        near = min(seen.snaps(name), key=lambda t: abs(t - seconds), default=seconds)
        return near if abs(near - seconds) <= SNAP * pixel else seconds

    _moving = False

    def _let_go(self) -> None:
        if self._moving and self.action is not None:
            self._moving = False
            self.finished.emit()
            self.show_action(self.document.project.action(self.action.id) or self.action)
            self.session.show_context(self.action.id)

    def _clicked(self, event: Any) -> None:
        if self.action is None or event.button() != Qt.MouseButton.LeftButton or event.isAccepted():
            return
        seconds = self.plot.plotItem.vb.mapSceneToView(event.scenePos()).x()
        self.session.transport.show_clip(self.action.clip)
        self.session.transport.set_playing(False)
        self.session.transport.seek(max(0.0, float(seconds)))

    def _playhead(self, seconds: float) -> None:
        mine = (
            self.action is not None
            and self.session.transport.show == "clip"
            and self.session.transport.shown == self.action.clip
        )
        self.playhead.setVisible(mine)
        if mine:
            self.playhead.setValue(seconds)
