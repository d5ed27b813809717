"""The lane of a conversation's cameras: which picture is seen when; cut by keys, its menu and dragging."""

from __future__ import annotations

from functools import partial
from typing import Any

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QMenu

from app.features.timeline.drags.cut import CutDrag
from app.look.theme import WindowTheme
from app.translation import tr, tr_noop
from app.widgets.lane_geometry import LEFT, elide_text, place_lanes
from metagraph.graph.conversation.model import Conversation, get_side_name
from metagraph.graph.timeline import Cut, Shot

EDGE = 4.0  # pixels on either side of a cut that take hold of it
HINT = tr_noop(
    "No camera cuts: you move the camera yourself. Double-click here, or press 1 to 9, to cut to a shot"
)
NAME = "cameras"


def list_camera_shots(talk: Conversation) -> tuple[tuple[Shot, int, str], ...]:
    """Return what can be cut to, in the order of the keys from 1: shot, side and words."""
    sides = range(len(talk.sides))
    return (
        ("two", 0, tr("Two-shot") if len(talk.sides) == 2 else tr("Everyone")),
        *(("over", n, tr("Over the shoulder of {name}", name=get_side_name(talk, n))) for n in sides),
        *(("close", n, tr("Close-up of {name}", name=get_side_name(talk, n))) for n in sides),
    )


def describe_cut(cut: Cut, talk: Conversation) -> str:
    """Return a cut's picture in a few words."""
    known = list_camera_shots(talk)
    found = (w for shot, side, w in known if shot == cut.shot and (shot == "two" or side == cut.side))
    return next(found, tr("Nobody"))


def describe_cut_briefly(cut: Cut, talk: Conversation) -> str:
    """Return the same in fewer words, for the lane."""
    if cut.shot == "two" or cut.side >= len(talk.sides):
        return describe_cut(cut, talk)
    name = get_side_name(talk, cut.side)
    return tr("Over: {name}", name=name) if cut.shot == "over" else tr("Close: {name}", name=name)


class CameraLane:
    """view: the widget of the lanes."""

    def __init__(self, view: Any) -> None:
        self.view = view

    @property
    def talk(self) -> Conversation | None:
        performance = self.view.performance
        found: Conversation | None = performance.document.project.conversations.get(
            performance.conversation or ""
        )
        return found

    @property
    def cuts(self) -> tuple[Cut, ...]:
        cuts: tuple[Cut, ...] = self.view.performance.timeline.now.cuts
        return cuts

    def _place(self) -> QRectF | None:
        return place_lanes(self.view.height(), self.view.sizes).get(NAME)

    def on(self, at: QPointF) -> bool:
        place = self._place()
        return place is not None and at.x() >= LEFT - EDGE and place.contains(QPointF(LEFT, at.y()))

    def edge_at(self, at: QPointF) -> int | None:
        """Return the number of the cut under a point."""
        if not self.on(at):
            return None
        scale = self.view.scale()
        return next((n for n, c in enumerate(self.cuts) if abs(scale.x(c.at) - at.x()) <= EDGE), None)

    def cut_at(self, at: QPointF) -> int | None:
        """Return the number of the cut whose picture is seen at a point."""
        seconds = self.view.scale().seconds(at.x())
        return next((n for n in range(len(self.cuts) - 1, -1, -1) if self.cuts[n].at <= seconds), None)

    def press(self, at: QPointF) -> bool:
        """Take hold of a cut; False if there is none."""
        number = self.edge_at(at)
        if number is None:
            return False
        self.view.magnet.begin(self.view.snap_lines(()))
        self.view.hand.take(CutDrag(self.view, number), at)
        return True

    def key(self, number: int) -> bool:
        """Cut to a picture at the playhead, from 1; False if there is no such one."""
        talk = self.talk
        if talk is None or not 1 <= number <= len(list_camera_shots(talk)):
            return False
        shot, side, _ = list_camera_shots(talk)[number - 1]
        self.view.performance.timeline.cut_to(shot, side, self.view.session.transport.seconds)
        return True

    def remove_seen(self) -> None:
        """Take away the cut whose picture is seen at the playhead."""
        here = self.cut_at(QPointF(self.view.scale().x(self.view.session.transport.seconds), 0))
        if here is not None:
            self.view.performance.timeline.remove_cut(here)

    def menu(self, at: QPointF) -> QMenu:
        menu, talk, timeline = QMenu(self.view), self.talk, self.view.performance.timeline
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        if talk is None:
            return menu
        seconds = round(max(0.0, self.view.scale().seconds(at.x())), 2)
        for n, (shot, side, words) in enumerate(list_camera_shots(talk), 1):
            key = f"\t{n}" if n < 10 else ""
            menu.addAction(f"{words}{key}", partial(timeline.cut_to, shot, side, seconds))
        menu.addSeparator()
        here = self.cut_at(at)
        remove = menu.addAction(tr("Remove this cut\t0 at the playhead"), lambda: timeline.remove_cut(here))
        remove.setEnabled(here is not None)
        menu.addAction(tr("Automatic cuts"), lambda: timeline.automatic(talk))
        menu.addAction(tr("No cuts"), lambda: timeline.set_cuts(tr("Remove cuts"), ())).setEnabled(
            bool(self.cuts)
        )
        menu.addSeparator()
        captions = menu.addAction(tr("Captions"), lambda: timeline.show_captions(not timeline.now.captions))
        captions.setCheckable(True)
        captions.setChecked(timeline.now.captions)
        return menu

    def tip(self, at: QPointF) -> str:
        talk, here = self.talk, self.cut_at(at)
        if talk is None:
            return ""
        if here is None:
            return tr(HINT)
        cut = self.cuts[here]
        return tr(
            "{picture}, from {at:.2f} s\nDrag a border to move the cut. Double-click or press 1 to "
            "9 to add a cut",
            picture=describe_cut(cut, talk),
            at=cut.at,
        )

    def paint(self, painter: QPainter, t: WindowTheme, lane: QRectF, width: float, end: float) -> None:
        """Paint the pictures that are cut to; end: seconds at which all ends."""
        talk, scale, held = self.talk, self.view.scale(), self.view.hand.gesture
        if talk is None:
            return
        cuts = list(self.cuts)
        if isinstance(held, CutDrag) and held.begun:
            cuts = [
                c if n != held.number else Cut(at=held.at, shot=c.shot, side=c.side)
                for n, c in enumerate(cuts)
            ]
        painter.save()
        painter.setClipRect(QRectF(LEFT, lane.top(), width - LEFT, lane.height()))
        font = painter.font()
        font.setPixelSize(min(12, max(9, int(lane.height() - 6))))
        painter.setFont(font)
        if not cuts:
            painter.setPen(QColor(t.dim))
            words = elide_text(tr(HINT), font.toString(), int(width - LEFT - 14))
            painter.drawText(
                QRectF(LEFT + 7, lane.top(), width, lane.height()), Qt.AlignmentFlag.AlignVCenter, words
            )
        for n, cut in enumerate(cuts):
            left = scale.x(cut.at)
            right = scale.x(cuts[n + 1].at if n + 1 < len(cuts) else max(end, cut.at))
            if right < LEFT or left > width:
                continue
            rect = QRectF(left, lane.top() + 2, max(2.0, right - left - 1), lane.height() - 5)
            painter.setPen(QPen(QColor(t.line), 1))
            painter.setBrush(QColor(t.hover if cut.shot == "two" else t.card))
            painter.drawRoundedRect(rect, 3, 3)
            painter.setPen(QPen(QColor(t.text), 2))
            painter.drawLine(QPointF(left + 1, rect.top() + 1), QPointF(left + 1, rect.bottom() - 1))
            inner = QRectF(max(left, LEFT) + 7, rect.top(), 0, rect.height())
            inner.setRight(min(rect.right(), width) - 3)
            if inner.width() > 12:
                painter.setPen(QColor(t.text))
                words = elide_text(describe_cut_briefly(cut, talk), font.toString(), int(inner.width()))
                painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter, words)
        painter.restore()
