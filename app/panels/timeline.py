"""The timeline: what each layer does and will do, requests above, the playhead across."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QContextMenuEvent, QFontMetricsF, QHelpEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QSpinBox, QToolButton, QToolTip, QVBoxLayout, QWidget

from app.document import Document
from app.performance import Performance, Shown
from app.session import Session
from app.theme import KIND_MARKS, Theme, theme
from app.words import many
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Layer
from metagraph.playback.plan import Cue, Request

LEFT, RULER, LANE = 84, 24, 34
STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0)


@dataclass(frozen=True)
class Scale:
    """Seconds to pixels: `first` seconds stand at the left of the lanes, `each` pixels a second."""

    first: float
    each: float

    def x(self, seconds: float) -> float:
        return LEFT + (seconds - self.first) * self.each

    def seconds(self, x: float) -> float:
        return self.first + (x - LEFT) / self.each

    def step(self) -> float:
        """Seconds between marks of the ruler, at least 64 pixels apart."""
        return next((s for s in STEPS if s * self.each >= 64), STEPS[-1])


def lanes(height: float) -> dict[str, QRectF]:
    """Return where each lane is, from the top: requests, then the layers."""
    names = ("requests", *LAYERS)
    each = min(LANE, max(20.0, (height - RULER) / len(names)))
    return {name: QRectF(0, RULER + n * each, 1e6, each) for n, name in enumerate(names)}


def cue_at(shown: Shown, scale: Scale, height: float, at: QPointF) -> tuple[Layer, Cue] | None:
    """Return the cue under a point."""
    seconds = scale.seconds(at.x())
    for layer in LAYERS:
        if at.x() >= LEFT and lanes(height)[layer].contains(at):
            cue = shown.plan.layers[layer].cue_at(seconds)
            return (layer, cue) if cue is not None else None
    return None


class Lanes(QWidget):
    """Draws the plan. Click or drag moves the playhead, the wheel zooms, a click on a cue selects its action."""

    def __init__(self, session: Session, performance: Performance, parent: QWidget) -> None:
        super().__init__(parent)
        self.session, self.performance = session, performance
        self.each = 44.0
        self.first = 0.0
        self.follow = True
        self.setMinimumHeight(RULER + 4 * 24)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setAccessibleName("Timeline")
        performance.changed.connect(self.update)
        session.moved.connect(self._playhead)
        session.theme_changed.connect(self.update)
        session.selection_changed.connect(self.update)

    def scale(self) -> Scale:
        return Scale(self.first, self.each)

    def _playhead(self, seconds: float) -> None:
        width = self.width() - LEFT
        if self.follow and width > 40:
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
            painter.drawText(QRectF(14, lane.top(), LEFT - 18, lane.height()), Qt.AlignmentFlag.AlignVCenter, name.capitalize())
        painter.setClipRect(QRectF(LEFT, 0, self.width() - LEFT, self.height()))
        if shown.clip is None:
            for layer in LAYERS:
                self._layer(painter, t, scale, shown, layer)
            for request in self.performance.requests if self.session.show == "plan" else ():
                self._request(painter, t, scale, request)
        else:
            entry = shown.project.clips[shown.clip]
            rect = QRectF(scale.x(0), RULER + 40, max(2.0, entry.duration * scale.each), LANE - 8)
            self._bar(painter, t, rect, QColor(t.line), entry.name, t.text, False)
        x = scale.x(self.session.seconds)
        painter.setPen(QPen(QColor(t.text), 1.6))
        painter.drawLine(QPointF(x, 4), QPointF(x, self.height()))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.text))
        painter.drawPolygon([QPointF(x - 5, 4), QPointF(x + 5, 4), QPointF(x, 11)])
        painter.end()

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

    def _layer(self, painter: QPainter, t: Theme, scale: Scale, shown: Shown, layer: Layer) -> None:
        """Stances as a quiet band, cues on it in their kind's colour, blends as slopes at their ends."""
        plan, lane = shown.plan.layers[layer], lanes(self.height())[layer]
        area = lane.adjusted(0, 3, 0, -3)
        edges = [0.0, *(cue.end for cue in plan.cues if cue.then != cue.stance), max(shown.length, scale.seconds(self.width()))]
        stances = [plan.rests[0].stance, *(cue.then for cue in plan.cues if cue.then != cue.stance)] if plan.rests else []
        for stance, start, end in zip(stances, edges, edges[1:], strict=False):
            if scale.x(end) < LEFT or scale.x(start) > self.width():
                continue
            found = shown.project.stance(stance)
            fill = t.fill("stance")
            fill.setAlpha(70 if t.name == "dark" else 90)
            left, right = max(scale.x(start), LEFT - 8.0), min(scale.x(end), self.width() + 8.0)
            self._bar(
                painter, t, QRectF(left, area.top(), right - left - 1, area.height()), fill, found.name if found else "", t.text, False
            )
        for cue in plan.cues:
            left, right = scale.x(cue.start), scale.x(cue.end)
            if right < LEFT or left > self.width():
                continue
            rect = QRectF(left, area.top(), max(3.0, right - left - 1), area.height())
            selected = cue.action.id in self.session.actions
            self._bar(painter, t, rect, t.fill(cue.action.kind), f"{KIND_MARKS[cue.action.kind]} {cue.action.name}", "#17181b", selected)

    def _bar(self, painter: QPainter, t: Theme, rect: QRectF, fill: QColor, words: str, ink: str, selected: bool) -> None:
        painter.setPen(QPen(QColor(t.text), 2) if selected else Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawRoundedRect(rect, 4, 4)
        inner = QRectF(max(rect.left(), LEFT) + 8, rect.top(), rect.right() - max(rect.left(), LEFT) - 12, rect.height())
        if inner.width() > 16 and words:
            painter.setPen(QColor(ink))
            text = QFontMetricsF(painter.font()).elidedText(words, Qt.TextElideMode.ElideRight, inner.width())
            painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter, text)

    def _request(self, painter: QPainter, t: Theme, scale: Scale, request: Request) -> None:
        lane = lanes(self.height())["requests"].adjusted(0, 5, 0, -5)
        words = request_words(request, self.performance)
        told = next((r for r in self.performance.shown.plan.reports if r.request == request.id and not r.played), None)
        width = QFontMetricsF(painter.font()).horizontalAdvance(words) + 20
        rect = QRectF(scale.x(request.start), lane.top(), width, lane.height())
        painter.setPen(QPen(QColor(t.warning if told else t.dim), 1.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(rect, rect.height() / 2, rect.height() / 2)
        painter.setPen(QColor(t.warning if told else t.text))
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)

    # --- events

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton or event.position().x() < LEFT:
            return
        found = cue_at(self.performance.shown, self.scale(), self.height(), event.position())
        if found is not None:
            self.session.jump(action=found[1].action.id)
        else:
            self._scrub(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._scrub(event.position().x())
        elif event.buttons() & Qt.MouseButton.MiddleButton:
            self.first = max(0.0, self.first - (event.position().x() - self._grip) / self.each)
            self.update()
        self._grip = event.position().x()

    _grip = 0.0

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        found = cue_at(self.performance.shown, self.scale(), self.height(), event.position())
        if found is not None:
            self.session.show_context(found[1].action.id)

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

    def event(self, event: object) -> bool:
        if isinstance(event, QHelpEvent):
            found = cue_at(self.performance.shown, self.scale(), self.height(), QPointF(event.pos()))
            words = ""
            if found is not None:
                cue = found[1]
                words = f"{cue.action.name}\n{cue.action.kind}, {cue.start:.2f} to {cue.end:.2f} s\n"
                words += "Click selects it, double-click plays it in context"
            elif lanes(self.height())["requests"].contains(QPointF(event.pos())):
                told = [r.message for r in self.performance.shown.plan.reports if not r.written]
                words = "\n".join(told[:6]) or "Requests: right-click to ask for something here"
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)  # type: ignore[arg-type]

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        seconds = round(max(0.0, self.scale().seconds(event.pos().x())), 2)
        request_menu(self, self.performance, seconds).exec(event.globalPos())


def request_menu(parent: QWidget, performance: Performance, seconds: float | None) -> QMenu:
    """Return a menu of everything that can be asked for at a time (None: now)."""
    menu = QMenu(parent)
    project = performance.document.project
    for layer in LAYERS:
        graph = project.graphs[layer]
        if not graph.stances:
            continue
        inner = menu.addMenu(layer.capitalize())
        for kind in ("gesture", "fidget"):
            if any(a.kind == kind for a in graph.actions.values()):
                inner.addAction(f"A {kind}", lambda x=layer, k=kind: performance.request(x, k, seconds))
        tags = sorted({tag for a in graph.actions.values() if a.kind == "gesture" for tag in a.tags})
        if tags:
            tagged = inner.addMenu("A gesture that is …")
            for tag in tags:
                tagged.addAction(tag, lambda x=layer, tag=tag: performance.request(x, "gesture", seconds, tags=(tag,)))
        inner.addSeparator()
        for stance in graph.stances.values():
            inner.addAction(f"Go to {stance.name}", lambda x=layer, s=stance.id: performance.request(x, "transition", seconds, stance=s))
    if performance.requests:
        menu.addSeparator()
        menu.addAction("Withdraw all requests", lambda: performance.withdraw())
    if menu.isEmpty():
        menu.addAction("Make a stance first").setEnabled(False)
    return menu


def request_words(request: Request, performance: Performance) -> str:
    project = performance.document.project
    if request.stance is not None:
        found = project.stance(request.stance)
        return f"go to {found.name if found else '?'}"
    if request.action is not None:
        action = project.action(request.action)
        return action.name if action else "?"
    return ", ".join((request.kind, *request.tags))


class TimelinePanel(QWidget):
    """The lanes, with what can be asked for, the seed and the zoom above them."""

    def __init__(self, document: Document, session: Session, performance: Performance, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.lanes = Lanes(session, performance, self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 4, 0, 0)
        layout.setSpacing(0)
        row = QHBoxLayout()
        row.setContentsMargins(12, 0, 12, 2)
        self.title = QLabel(self)
        self.title.setProperty("dim", True)
        row.addWidget(self.title, 1)
        self.ask = QToolButton(self, text="Ask for…", toolTip="Ask the character for something now")
        self.ask.clicked.connect(self._ask)
        row.addWidget(self.ask)
        row.addWidget(QLabel("Seed", self))
        self.seed = QSpinBox(self, toolTip="Another seed gives another performance of the same graph")
        self.seed.setFixedWidth(84)
        self.seed.setRange(0, 999999)
        self.seed.setAccessibleName("Seed")
        self.seed.valueChanged.connect(self._seeded)
        row.addWidget(self.seed)
        layout.addLayout(row)
        layout.addWidget(self.lanes, 1)
        performance.changed.connect(self._words)
        session.show_changed.connect(self._words)
        document.changed.connect(lambda before, after: self._show_seed())
        self._show_seed()
        self._words()

    def _ask(self) -> None:
        request_menu(self, self.performance, None).exec(self.ask.mapToGlobal(self.ask.rect().bottomLeft()))

    def _seeded(self, seed: int) -> None:
        if seed != self.document.project.settings.seed:
            self.document.edit("Change seed", lambda p: edits.set_settings(p, seed=seed), merge="seed")

    def _show_seed(self) -> None:
        if self.seed.value() != self.document.project.settings.seed:
            self.seed.setValue(self.document.project.settings.seed)

    def _words(self) -> None:
        shown = self.performance.shown
        if shown.clip is not None:
            self.title.setText("A clip alone. Click it again to play it in context, Esc for the performance.")
        elif self.session.show == "context":
            self.title.setText("In context: stance, action, back to the stance. Esc for the performance.")
        else:
            count = sum(len(shown.plan.layers[layer].cues) for layer in LAYERS)
            lost = sum(1 for r in shown.plan.reports if not r.played and not r.written)
            words = (
                f"{many(count, 'action')} in {shown.length:g} s"
                if count
                else "Nothing plays yet: drop a clip on a stance and some around it."
            )
            self.title.setText(words + (f", {many(lost, 'request')} could not be met" if lost else ""))
