"""The expanded graph of the current layer as a state machine: every state and connection."""

from __future__ import annotations

import math

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetrics,
    QHelpEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
)
from PySide6.QtWidgets import QToolTip, QWidget

from app.look.theme import KIND_MARKS, get_theme
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_plural
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.expand import count_machine_size, find_end_stance, list_connections
from metagraph.graph.model import Action, MetaGraph, Project

MOST = 6000  # connections drawn; more would be one solid disc


def arrange_states(graph: MetaGraph, area: QRectF) -> dict[str, QPointF]:
    """Return where each state is: stances on a ring, their actions on rings round them."""
    stances = list(graph.stances)
    out: dict[str, QPointF] = {}
    centre = area.center() + QPointF(0, 24)
    wide, high = area.width() / 2 - 60, area.height() / 2 - 60
    for n, stance in enumerate(stances):
        turn = 2 * math.pi * n / max(1, len(stances)) - math.pi / 2
        middle = (
            centre
            if len(stances) == 1
            else centre + QPointF(math.cos(turn) * wide * 0.66, math.sin(turn) * high * 0.66)
        )
        loops = graph.of(stance, "stance")
        for k, loop in enumerate(loops):
            out[loop.id] = middle + QPointF((k - (len(loops) - 1) / 2) * 14, 0)
        around = [*graph.of(stance, "gesture"), *graph.of(stance, "fidget")]
        room = min(wide, high) * (0.30 if len(stances) > 1 else 0.7)
        reach = max(24.0, min(room, 26.0 + 2.2 * len(around)))
        for k, action in enumerate(around):
            a = 2 * math.pi * k / max(1, len(around)) + turn
            out[action.id] = middle + QPointF(math.cos(a) * reach, math.sin(a) * reach)
    spread: dict[tuple[str, str], int] = {}
    for action in graph.actions.values():
        if action.kind == "transition" and action.id not in out:
            start, end = graph.of(action.stance, "stance"), graph.of(action.end_stance or "", "stance")
            if not start or not end or start[0].id not in out or end[0].id not in out:
                continue
            begin, stop = out[start[0].id], out[end[0].id]
            key = (action.stance, action.end_stance or "")
            spread[key] = spread.get(key, 0) + 1
            across = QPointF(-(stop - begin).y(), (stop - begin).x())
            length = math.hypot(across.x(), across.y()) or 1.0
            out[action.id] = begin * 0.5 + stop * 0.5 + across * ((8 + 7 * spread[key]) / length)
    return out


class MachinePanel(QWidget):
    """Draws the machine when it is looked at; click a state to go to its action."""

    def __init__(self, document: Document, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self._picture: QPixmap | None = None
        self._places: dict[str, QPointF] = {}
        self.setMinimumSize(280, 240)
        self.setMouseTracking(True)
        self.setAccessibleName(tr("Expanded state machine"))
        document.changed.connect(self._edited)
        for signal in (session.place.layer_changed, session.look.changed, session.selection.changed):
            signal.connect(self._stale)

    def _edited(self, before: Project, after: Project) -> None:
        if before.graphs is not after.graphs:
            self._stale()

    def _stale(self) -> None:
        self._picture = None
        self.update()

    def resizeEvent(self, event: object) -> None:
        self._stale()

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._picture is None:
            self._picture = self._draw()
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._picture)
        painter.end()

    def _draw(self) -> QPixmap:
        t = get_theme(self.session.look.name)
        ratio = self.devicePixelRatioF()
        out = QPixmap(round(self.width() * ratio), round(self.height() * ratio))
        out.setDevicePixelRatio(ratio)
        out.fill(QColor(t.panel))
        painter = QPainter(out)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        graph = self.document.project.graphs[self.session.place.layer]
        self._places = arrange_states(graph, QRectF(self.rect()))
        chosen = set(self.session.selection.actions)
        line = QColor(t.text)
        whole = count_machine_size(self.document.project, self.session.place.layer)
        line.setAlpha(max(14, min(70, 4200 // max(1, whole.connections))))
        painter.setPen(QPen(line, 0.8))
        strong = []
        for n, c in enumerate(list_connections(self.document.project, graph)):
            if n >= MOST:
                break
            if c.source in self._places and c.target in self._places:
                if c.source in chosen or c.target in chosen:
                    strong.append(c)
                painter.drawLine(self._places[c.source], self._places[c.target])
        painter.setPen(QPen(QColor(t.text), 1.2))
        for c in strong:
            painter.drawLine(self._places[c.source], self._places[c.target])
        for ident, at in self._places.items():
            action = graph.actions[ident]
            radius = 8.0 if action.kind == "stance" else 4.5
            painter.setPen(QPen(QColor(t.text if ident in chosen else t.panel), 1.6))
            painter.setBrush(t.fill(action.kind))
            painter.drawEllipse(at, radius, radius)
        taken = self._words(painter, whole.clips, whole.states, whole.connections)
        painter.setFont(self.font())
        painter.setPen(QColor(t.text))
        for stance, box in self._names(graph, painter.fontMetrics(), taken):
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, stance)
        painter.end()
        return out

    def _names(
        self, graph: MetaGraph, measure: QFontMetrics, taken: list[QRectF]
    ) -> list[tuple[str, QRectF]]:
        """Return each stance's name and where it stands: beneath its actions, or as near to that as it comes
        without lying on another. taken: where words are already.
        """
        out: list[tuple[str, QRectF]] = []
        room = QRectF(self.rect()).adjusted(4, 4, -4, -4)
        for stance in graph.stances.values():
            own = [self._places[a.id] for a in graph.of(stance.id, "stance") if a.id in self._places]
            if not own:
                continue
            around = [self._places[a.id].y() for a in graph.of(stance.id, "gesture") if a.id in self._places]
            name = measure.elidedText(stance.name, Qt.TextElideMode.ElideMiddle, round(room.width()))
            wide, high = measure.horizontalAdvance(name) + 6, float(measure.height())
            top = max(max(around, default=own[0].y()), own[0].y() + 4) + 7
            box = QRectF(own[0].x() - wide / 2, top, wide, high)
            box.moveLeft(min(max(box.left(), room.left()), room.right() - wide))
            steps = (QRectF(box).translated(0, n * 0.5 * high * (-1) ** n) for n in range(80))
            inside = (s for s in steps if room.contains(s))
            box = next((s for s in inside if not any(s.intersects(x) for x in taken)), box)
            taken.append(box)
            out.append((name, box))
        return out

    def _words(self, painter: QPainter, clips: int, states: int, links: int) -> list[QRectF]:
        """Say how large the machine is; return where that stands."""
        t = get_theme(self.session.look.name)
        lines = [
            (22, t.text, tr_plural("{count:,} connection", "{count:,} connections", links)),
            (
                13,
                t.dim,
                tr_plural(
                    "between {count:,} state, only in the {layer} layer.",
                    "between {count:,} states, only in the {layer} layer.",
                    states,
                    layer=get_vocabulary_word(self.session.place.layer),
                ),
            ),
            (13, t.dim, tr_plural("You placed {count:,} clip.", "You placed {count:,} clips.", clips)),
        ]
        if links > MOST:
            lines.append((13, t.dim, tr("Only the first {most:,} connections are drawn.", most=MOST)))
        out: list[QRectF] = []
        left, top = 20.0, 14.0
        for size_, color, words in lines:
            font = QFont(self.font())
            font.setPixelSize(size_)
            font.setBold(size_ > 13)
            painter.setFont(font)
            painter.setPen(QColor(color))
            room = QRectF(left, top, max(80.0, self.width() - left - 8), 200)
            flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
            box = painter.boundingRect(room, flags, words)
            painter.drawText(room, flags, words)
            out.append(box)
            top = box.bottom() + 3
        return out

    def _at(self, point: QPointF) -> Action | None:
        near = min(self._places.items(), key=lambda item: (item[1] - point).manhattanLength(), default=None)
        if near is None or (near[1] - point).manhattanLength() > 12:
            return None
        return self.document.project.graphs[self.session.place.layer].actions.get(near[0])

    def mousePressEvent(self, event: QMouseEvent) -> None:
        action = self._at(event.position())
        if action is not None:
            self.session.jump(action=action.id)

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent):
            action = self._at(QPointF(event.pos()))
            words = ""
            if action is not None:
                end = self.document.project.stance(find_end_stance(action))
                words = tr(
                    "{mark} {name}\nleads to {stance}",
                    mark=KIND_MARKS[action.kind],
                    name=action.name,
                    stance=end.name if end else "?",
                )
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)
