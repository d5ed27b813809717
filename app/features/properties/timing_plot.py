"""Timing seen, not typed: the speed of the hands or head over the clip, with handles for start, end, blends
and exit.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
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

from app.features.properties.jump_strip import JumpStrip, Seen
from app.look.theme import Theme, theme
from app.project.document import Document
from app.stage.compatibility_state import Compatibility, proposed_fields
from app.stage.session import Session
from metagraph.graph import anatomy, edits, end_gaps
from metagraph.graph.model import Action, Project
from metagraph.motion import features
from metagraph.playback.phases import phases

HANDLES = ("start", "end", "in", "out", "exit", "stroke", "ready", "hold", "relax")
WORDS = {
    "start": "start",
    "end": "end",
    "in": "blend in",
    "out": "blend out",
    "exit": "earliest exit",
    "stroke": "stroke",
}
PHASES = ("ready", "hold", "relax")  # handles of a gesture's phases
MOMENTS = ("earliest_exit", "ready", "stroke", "stroke_end", "relax")  # of Timing, seconds of the clip
BANDS = ("prepare", "stroke", "hold", "retract")
SNAP = 7  # pixels within which a handle comes to rest at a moment that does not jump


def speed_of(project: Project, action: Action) -> tuple[np.ndarray, str]:
    """Return the speed over an action's clip `[F]`, metres a second, and in words what of."""
    entry = project.clips.get(action.clip)
    motion = entry.motion if entry is not None else None
    if motion is None or motion.skeleton != project.skeleton:
        return np.zeros(0), ""
    roles = anatomy.roles(project)
    if action.layer == "arms":
        sides = ("left", "right") if action.limb == "both" else (action.limb,)
        joints = [roles[f"{s}_hand"] for s in sides if f"{s}_hand" in roles]
        return features.speed(
            motion, joints, roles.get("upper_chest", roles.get("chest", roles.get("spine")))
        ), "hand speed"
    if action.layer == "head":
        joints = [roles["head"]] if "head" in roles else []
        # A turning head's joint stays in place: its eyes or what else hangs on it tell.
        ends = [i for i in range(len(motion.skeleton)) if joints and motion.skeleton.parents[i] == joints[0]]
        return features.speed(motion, ends or joints, roles.get("neck")), "head speed"
    joints = [roles[r] for r in ("hips", "head", "left_foot", "right_foot") if r in roles]
    return features.speed(motion, joints), "body speed"


def times_of(project: Project, action: Action) -> dict[str, float | None]:
    """Return where each handle stands, seconds of the clip; None for one that is not set."""
    start, end = project.span(action)
    t = action.timing
    return {
        "start": start,
        "end": end,
        "in": min(end, start + t.blend_in),
        "out": max(start, end - t.blend_out),
        "exit": t.earliest_exit,
        "stroke": t.stroke,
        **_phases(project, action),
    }


def _phases(project: Project, action: Action) -> dict[str, float | None]:
    if action.kind != "gesture":
        return dict.fromkeys(PHASES)
    found = phases(project, action)
    return {"ready": found.ready, "hold": found.stroke_end, "relax": found.relax}


def moved(project: Project, action: Action, handle: str, seconds: float) -> dict[str, Any]:
    """Return the Timing fields that dragging a handle to `seconds` changes; a pure function of where it is
    dropped.
    """
    entry = project.clips[action.clip]
    start, end = project.span(action)
    shortest = 1 / entry.fps
    at = round(min(max(0.0, seconds), entry.duration), 3)
    if handle == "start":
        at = min(at, round(end - shortest, 3))
        return {"start": at, **_within(action, at, end)}
    if handle == "end":
        at = max(at, round(start + shortest, 3))
        whole = at >= entry.duration - shortest / 2
        return {"end": None if whole else at, **_within(action, start, entry.duration if whole else at)}
    if handle == "in":
        return {"blend_in": round(min(max(0.0, at - start), end - start), 3)}
    if handle == "out":
        return {"blend_out": round(min(max(0.0, end - at), end - start), 3)}
    if handle == "exit":
        return {"earliest_exit": min(max(at, start), end)}
    if handle in PHASES:
        now = times_of(project, action)
        order = (start, *(float(now[p] or start) for p in PHASES), end)
        place = PHASES.index(handle) + 1
        fields = dict(zip(PHASES, ("ready", "stroke_end", "relax"), strict=True))
        return {fields[handle]: round(min(max(at, order[place - 1]), order[place + 1]), 3)}
    return {"stroke": min(max(at, start), end)}


def _within(action: Action, start: float, end: float) -> dict[str, Any]:
    """Return the moments that have to follow when an action is from start to end: those outside."""
    now = {name: getattr(action.timing, name) for name in MOMENTS}
    then = {name: min(max(at, start), end) for name, at in now.items() if at is not None}
    return {name: at for name, at in then.items() if at != now[name]}


FIELDS = {
    "start": "start",
    "end": "end",
    "blend_in": "in",
    "blend_out": "out",
    "earliest_exit": "exit",
    "stroke": "stroke",
}


def retimed(project: Project, actions: Iterable[str], name: str, value: float) -> Project:
    """Return the project with a Timing field of actions set, each kept within its own clip as a dragged
    handle is.
    """
    changes: dict[str, dict[str, Any]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is None or action.clip not in project.clips:
            continue
        start, end = project.span(action)
        at = {"blend_in": start + value, "blend_out": end - value}.get(name, value)
        changes[ident] = {"timing": moved(project, action, FIELDS[name], at)}
    return edits.update_each(project, changes)


def verdict(costs: Mapping[str, float], far: Mapping[str, str] | None = None) -> str:
    """Say what beginning and ending cost: "Begins without a jump, ends 2.7 times what shows as one". far: of
    those that begin or end too far from their stance, what the problems say of it.
    """
    far = far or {}
    if max(costs.values()) <= 1 and not far:
        return f"{' and '.join(costs)} without a jump"
    told: list[str] = []
    for what, cost in costs.items():
        of = "one" if any("jump" in words for words in told) else "a jump"
        if what in far:
            told.append(far[what][:1].upper() + far[what][1:] if not told else far[what])
        else:
            told.append(
                f"{what} without {of}" if cost <= 1 else f"{what} {cost:.1f} times what shows as {of}"
            )
    return ", ".join(told)


def far_ends(project: Project, action: Action) -> dict[str, str]:
    """Return which ends of an action are too far from their stance, by how `verdict` calls them, in words."""
    graph = project.graphs[action.layer]
    return {
        "Begins" if gap.edge == "begins" else "ends": end_gaps.gap_words(gap, graph.stances[gap.stance].name)
        for gap in end_gaps.gaps(project, graph, action)
        if gap.far and gap.stance in graph.stances
    }


def times_words(seen: Seen) -> str:
    """Say proposed times."""
    p = seen.proposed
    if seen.loops:
        return (
            f"All of it, its seam blended over {p.blend_in:.2f} s"
            if p.blend_in > 0
            else "All of it, without a blend"
        )
    return f"{p.start:.2f} to {p.end:.2f} s, blended over {p.blend_in:.2f} and {p.blend_out:.2f} s"


LABEL, FIRST = 17.0, 12.0  # pixels of a row of words over the curves, and to the middle of the first
ANY = 16_777_215  # Qt's largest height of a widget
HEIGHT, LEAST = 132, 84  # pixels of the curves in a form; and where they have the room to themselves


class TimingPlot(QWidget):
    """Emits changed(fields) while a handle is dragged and finished when it is let go."""

    changed = Signal(object)
    finished = Signal()

    def __init__(self, document: Document, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.action: Action | None = None
        self._setting = False
        self.plot = pg.PlotWidget(self)
        self.plot.setMenuEnabled(False)
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
        self.bands = [pg.TextItem(word, anchor=(0.5, 0.0)) for word in BANDS]
        for band in self.bands:
            band.span = 0.0, 0.0
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
        self.use = QPushButton("Use proposed times", self)
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

    def _show_seen(self) -> None:
        """Show where the action can begin and end without a jump, as far as that is known by now."""
        project, action, t = self.document.project, self.action, theme(self.session.look.name)
        curves = (
            self.compatibility.curves(action)
            if self.compatibility is not None and action is not None
            else None
        )
        if action is None or project.action(action.id) is None:
            return
        seen = Seen(action, curves) if curves is not None else None
        self.strip.show_seen(project, action, seen)
        self.use.setEnabled(seen is not None and bool(self._proposed()))
        if seen is None:
            self.verdict.setText("")
            return
        start, end = project.span(action)
        first, last = seen.cost("start", start), seen.cost("end", end)
        costs = {"Repeats": last} if seen.loops else {"Begins": first, "ends": last}
        far = far_ends(project, action)
        self.verdict.setText(verdict(costs, far))
        fine = max(costs.values()) <= 1 and not far
        self.verdict.setStyleSheet(f"color: {t.dim if fine else t.warning}")
        self.use.setToolTip(f"{times_words(seen)}: it {seen.proposed.reason}")

    def _proposed(self) -> dict[str, Any]:
        """Return the Timing fields that the proposed times would change."""
        project, action, seen = self.document.project, self.action, self.strip.seen
        if action is None or seen is None or action.clip not in project.clips:
            return {}
        fields = proposed_fields(action, seen.proposed, project.clips[action.clip].duration)
        return {name: value for name, value in fields.items() if getattr(action.timing, name) != value}

    def use_proposed(self) -> None:
        """Take the times over that do not jump, in one step."""
        if self.compatibility is not None and self.action is not None:
            self.compatibility.use_proposed([self.action.id])

    def _restyle(self) -> None:
        t = theme(self.session.look.name)
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
        t = theme(self.session.look.name)
        project = self.document.project
        fresh = (
            self.action is None
            or self.action.id != action.id
            or self.action.clip != action.clip
            or self.action.limb != action.limb
        )
        self.action = action
        entry = project.clips.get(action.clip)
        if entry is None:
            return
        color = t.kind(action.kind)
        if fresh:
            speeds, words = speed_of(project, action)
            self.curve.setData(np.arange(len(speeds)) / entry.fps, speeds)
            self.plot.setXRange(-0.02 * entry.duration, max(entry.duration, 0.1) * 1.02, padding=0)
            self.plot.setYRange(0, max(0.2, float(speeds.max()) * 1.15 if len(speeds) else 1.0), padding=0)
            self.plot.setToolTip(f"{words}, m/s. Drag the lines; a click moves the playhead.")
            self.strip.show_seen(project, action, None)
            self.verdict.setText("")
        self.curve.setPen(pg.mkPen(color, width=2))
        self.strip.restyle(t, t.fill(action.kind))
        self._place(project, action, t, color)
        self._show_seen()

    def _place(self, project: Project, action: Action, t: Theme, color: QColor) -> None:
        self._setting = True
        at = times_of(project, action)
        for name, line in self.lines.items():
            value = at[name]
            loop = action.kind == "stance"
            line.setVisible(value is not None and not (loop and name in ("out", "exit", "stroke")))
            if value is not None:
                line.setValue(value)
            strong = name in ("start", "end")
            style = Qt.PenStyle.SolidLine if strong else Qt.PenStyle.DashLine
            line.setPen(pg.mkPen(t.text if strong else color, width=2 if strong else 1.4, style=style))
            line.setHoverPen(pg.mkPen(t.text, width=3))
            if name in PHASES:
                own = {
                    "ready": action.timing.ready,
                    "hold": action.timing.stroke_end,
                    "relax": action.timing.relax,
                }[name]
                line.setPen(pg.mkPen(t.dim if own is None else t.text, width=1.2, style=Qt.PenStyle.DotLine))
            else:
                line.label.setColor(t.dim)
        self._bands(t, at)
        self._line_up()
        fill = QColor(color)
        fill.setAlpha(46)
        for blend, (a, b) in zip(self.blends, ((at["start"], at["in"]), (at["out"], at["end"])), strict=True):
            blend.setRegion((a, b))
            blend.setBrush(fill)
            for line in blend.lines:
                line.setPen(pg.mkPen(None))
        self.blends[1].setVisible(action.kind != "stance")
        self._setting = False

    def _bands(self, t: Theme, at: dict[str, float | None]) -> None:
        """Name the phases along the top, and shade the hold."""
        whole = at["ready"] is not None
        self.hold.setVisible(whole)
        edges = [at[x] for x in ("start", "ready", "hold", "relax", "end")]
        for band, a, b in zip(self.bands, edges, edges[1:], strict=False):
            band.setVisible(whole)
            if whole and a is not None and b is not None:
                band.setColor(t.dim)
                band.span = a, b
        if whole:
            fill = QColor(t.text)
            fill.setAlpha(22)
            self.hold.setBrush(fill)
            self.hold.setRegion((edges[2], edges[3]))
            for line in self.hold.lines:
                line.setPen(pg.mkPen(None))

    def _line_up_soon(self) -> None:
        if self.action is not None and self.action.clip in self.document.project.clips:
            self._bands(theme(self.session.look.name), times_of(self.document.project, self.action))
            self._line_up()

    def _line_up(self) -> None:
        """Give words rows in which none lies on another: the phases on top, where each has room in its span,
        then the handles. What finds no row is not written; the pointer's tooltip names it.
        """
        box = self.plot.plotItem.vb
        (low, high), (_, top) = self.plot.viewRange()
        wide, tall = max(1.0, box.width()), max(1.0, box.height())
        each, measure = wide / max(high - low, 1e-6), self.fontMetrics()
        taken: dict[int, list[tuple[float, float]]] = {}
        for band, word in zip(self.bands, BANDS, strict=True):
            if not band.isVisible():
                continue
            a, b = band.span
            middle, half = ((a + b) / 2 - low) * each, measure.horizontalAdvance(word) / 2 + 3
            seen = 2 * half <= (b - a) * each
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
            row = next(free, None) if line.isVisible() else None
            line.label.setVisible(row is not None)
            if row is not None:
                taken.setdefault(row, []).append((left, right))
                line.label.setPosition(1 - (FIRST + row * LABEL) / tall)

    def _dragged(self, name: str, seconds: float) -> None:
        if self._setting or self.action is None:
            return
        seconds = self._snapped(name, seconds)
        fields = moved(self.document.project, self.action, name, seconds)
        # The character follows the handle.
        self.session.transport.show_clip(self.action.clip)
        self.session.transport.set_playing(False)
        self.session.transport.seek(
            min(max(0.0, seconds), self.document.project.clips[self.action.clip].duration)
        )
        self._moving = True
        self.changed.emit(fields)

    def _snapped(self, name: str, seconds: float) -> float:
        """Let the ends come to rest where nothing shows, unless Alt is held."""
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
