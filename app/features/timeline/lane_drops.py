"""What a drop on a layer's lane does: actions are asked for at that moment, clips and files are placed first
if nothing plays them yet. Said in words before it happens.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from PySide6.QtCore import QEvent, QObject, QPointF, Qt
from PySide6.QtGui import (
    QColor,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QWidget

from app.features.timeline.lane_view import Lanes
from app.look.names import make_readable_name
from app.look.theme import get_theme
from app.project.importing import Importing
from app.project.load import Load
from app.translation import tr, tr_error, tr_plural
from app.widgets.lane_geometry import find_lane_at
from app.widgets.lane_paint import paint_badge
from app.widgets.mime import load_of
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.graph.repeating import seconds_played
from metagraph.graph.requests import Play

GAP = 0.1  # seconds between two that are dropped at once


@dataclass(frozen=True)
class LaneDrop:
    """layer, seconds: where. stance: of the layer then, None if it has none. words: what will happen, or why
    not.
    """

    layer: Layer | None
    seconds: float
    stance: str | None = None
    possible: bool = False
    words: str = field(default_factory=lambda: tr("drop on the lane of a layer"))


def plan_lane_drop(
    project: Project, layer: Layer | None, stance: str | None, seconds: float, load: Load
) -> LaneDrop:
    """Return what dropping a load on a layer's lane does. stance: the layer's at that moment."""
    if layer is None or not load:
        return LaneDrop(layer, seconds, stance)
    found = project.stance(stance)
    name, at = (
        make_readable_name(found.name) if found is not None else "",
        tr("at {seconds:.2f} s", seconds=seconds),
    )
    if load.actions:
        actions = [a for i in load.actions if (a := project.action(i)) is not None]
        if any(a.kind == "stance" for a in actions):
            return LaneDrop(
                layer,
                seconds,
                stance,
                False,
                tr("a stance loop cannot be requested: request its stance instead"),
            )
        what = (
            make_readable_name(actions[0].name)
            if len(actions) == 1
            else tr_plural("{count:,} action", "{count:,} actions", len(actions))
        )
        return LaneDrop(layer, seconds, stance, True, tr("request {what} {at}", what=what, at=at))
    if load.clips and all(find_playing_action(project, layer, clip) is not None for clip in load.clips):
        first = make_readable_name(project.clips[load.clips[0]].name)
        what = first if load.count == 1 else tr_plural("{count:,} clip", "{count:,} clips", load.count)
        return LaneDrop(layer, seconds, stance, True, tr("request {what} {at}", what=what, at=at))
    if found is None:
        return LaneDrop(
            layer, seconds, None, False, tr("make a stance in the {layer} layer first", layer=tr(layer))
        )
    if load.count == 1:
        what = tr("this clip") if load.clips else tr("this file")
        words = tr("add {what} as a gesture of {name} and request it {at}", what=what, name=name, at=at)
    else:
        what = (
            tr_plural("{count:,} clip", "{count:,} clips", load.count)
            if load.clips
            else tr_plural("{count:,} file", "{count:,} files", load.count)
        )
        words = tr("add {what} as gestures of {name} and request them {at}", what=what, name=name, at=at)
    return LaneDrop(layer, seconds, stance, True, words)


def find_playing_action(project: Project, layer: Layer, clip: str) -> Action | None:
    """Return the action of a layer that plays a clip, no loop of a stance."""
    found = (a for a in project.uses.get(clip, ()) if a.layer == layer and a.kind != "stance")
    return next(found, None)


def ask_for_drop(project: Project, drop: LaneDrop, load: Load) -> tuple[Project, list[Play]]:
    """Return the project with clips placed that nothing plays, and the requests for all that was dropped, one
    after the other. Raises EditError.
    """
    assert drop.layer is not None
    new = [clip for clip in load.clips if find_playing_action(project, drop.layer, clip) is None]
    if new:
        project = edits.place_clips(project, new, drop.layer, "gesture", drop.stance)
    some = [project.action(i) for i in load.actions]
    some += [find_playing_action(project, drop.layer, clip) for clip in load.clips]
    out, at = [], drop.seconds
    for action in some:
        if action is not None:
            out.append(Play(action=action.id, at=round(at, 2)))
            start, end = project.span(action)
            at += seconds_played(action.kind, action.timing, start, end) + GAP
    return project, out


class LaneDrops(QObject):
    """Takes drops for lanes. importing: reads files that are dropped."""

    def __init__(self, lanes: Lanes, importing: Importing) -> None:
        super().__init__(lanes)
        self.lanes, self.importing = lanes, importing
        self.document = lanes.performance.document
        self.mark = _Mark(lanes)
        lanes.setAcceptDrops(True)
        lanes.installEventFilter(self)
        importing.imported.connect(self._imported)

    def what(self, at: QPointF, load: Load) -> LaneDrop:
        """Return what letting a load go at a point would do."""
        lanes = self.lanes
        name = find_lane_at(lanes.height(), at)
        layer = name if name in LAYERS else None
        seconds = round(max(0.0, lanes.scale().seconds(at.x())), 2)
        plan = lanes.performance.shown.plan
        stance = plan.layers[layer].stance_at(seconds) if layer is not None else None
        if lanes.session.transport.show != "plan" or lanes.session.onstage.mode != "meta":
            return LaneDrop(None, seconds, None, False, tr("show the performance first"))
        return plan_lane_drop(self.document.project, layer, stance, seconds, load)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if kind == QEvent.Type.Drop and isinstance(event, QDropEvent):
            self._drop(event)
        elif isinstance(event, QDragEnterEvent | QDragMoveEvent) and kind != QEvent.Type.Drop:
            load = load_of(event.mimeData())
            if not load:
                return False  # sounds, for the window
            drop = self.what(QPointF(event.position()), load)
            self.mark.show_at(QPointF(event.position()), drop)
            event.setDropAction(Qt.DropAction.CopyAction)
            event.setAccepted(drop.possible or kind == QEvent.Type.DragEnter)
        elif kind == QEvent.Type.DragLeave:
            self.mark.rest()
            return False
        else:
            return False
        return True

    def _drop(self, event: QDropEvent) -> None:
        self.mark.rest()
        load = load_of(event.mimeData())
        drop = self.what(QPointF(event.position()), load)
        event.setDropAction(Qt.DropAction.CopyAction)
        event.setAccepted(drop.possible)
        if drop.possible and load.files:
            self.importing.import_paths(list(load.files), drop)
        elif drop.possible:
            self.do(drop, load)

    def do(self, drop: LaneDrop, load: Load) -> None:
        """Place what nothing plays, and ask for it."""
        requests = self.lanes.performance.requests
        try:
            project, asked = ask_for_drop(self.document.project, drop, load)
        except EditError as error:
            self.importing.told.emit(tr_error(error))
            return
        if project is not self.document.project:
            self.document.edit(
                tr("Place {clips}", clips=tr_plural("{count:,} clip", "{count:,} clips", len(load.clips))),
                lambda p: ask_for_drop(p, drop, load)[0],
            )
        for ask in asked:
            requests.ask(ask)

    def _imported(self, result: object, place: object) -> None:
        if isinstance(place, LaneDrop):
            load = self.importing.load_for(result)  # type: ignore[arg-type]
            if load.clips:
                self.do(place, load)


class _Mark(QWidget):
    """Where a drop would go, over the lanes: a line, and words."""

    def __init__(self, lanes: Lanes) -> None:
        super().__init__(lanes)
        self.lanes = lanes
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._at, self._drop = QPointF(), LaneDrop(None, 0.0)
        self.hide()

    def show_at(self, at: QPointF, drop: LaneDrop) -> None:
        self._at, self._drop = at, drop
        self.setGeometry(self.lanes.rect())
        self.show()
        self.raise_()
        self.update()

    def rest(self) -> None:
        """Nothing is held over the lanes any more."""
        self._at, self._drop = QPointF(), LaneDrop(None, 0.0)
        self.hide()

    def paintEvent(self, event: QPaintEvent) -> None:
        look, painter = get_theme(self.lanes.session.look.name), QPainter(self)
        color = QColor(look.text if self._drop.possible else look.warning)
        if self._drop.possible:
            x = self.lanes.scale().x(self._drop.seconds)
            painter.setPen(QPen(color, 1.4))
            painter.drawLine(QPointF(x, 0), QPointF(x, self.height()))
        paint_badge(painter, look, QPointF(self._at.x(), 0), self._drop.words, self.width())
        painter.end()
