"""The titles of the timeline's lanes: a click mutes a layer, with Alt it leaves it alone; the padlock locks a
lane's requests; the border below makes a lane taller or lower.
"""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from typing import Any, cast

from PySide6.QtCore import QPointF, QRectF, QSettings, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QMenu

from app.features.timeline.drags.border import BorderDrag
from app.look.theme import WindowTheme
from app.stage.performance import StagePerformance
from app.translation import make_lazy_texts, tr, tr_noop
from app.widgets.lane_geometry import LEFT, NAMES, RULER, TITLES, Sizes, place_lanes
from metagraph.graph.model import LAYERS, Layer
from metagraph.graph.timeline import Lane

SETTING = "timeline/heights"
HEIGHTS = make_lazy_texts(
    lambda: {tr("Compact"): 0.6, tr("Normal"): 1.0, tr("Tall"): 1.8}
)  # of a lane's usual height
SAID = (tr_noop("body"), tr_noop("arms"), tr_noop("head"))  # of layers, within a sentence
GRIP = 4.0  # pixels on either side of a border that take hold of it
LOCK = 20.0  # pixels at the right of a title that are its padlock's


def read_lane_heights() -> tuple[tuple[str, float], ...]:
    """Return the heights of lanes from the user's settings."""
    try:
        found = json.loads(str(QSettings().value(SETTING, "{}")))
        held = Sizes()
        for name, factor in found.items():
            held = held.with_factor(str(name), float(factor))
    except (ValueError, AttributeError, TypeError):
        return ()
    return held.tall


class LaneTitles:
    """Handles the mouse on the titles of the lanes. view: the widget of the lanes."""

    def __init__(self, view: Any, performance: StagePerformance) -> None:
        self.view, self.performance = view, performance

    def places(self) -> dict[str, QRectF]:
        return place_lanes(self.view.height(), self.view.sizes)

    def lane_at(self, place: QPointF) -> str | None:
        """Return the lane whose title a point is on."""
        if place.x() >= LEFT:
            return None
        beside = QPointF(LEFT, place.y())
        return next((n for n, lane in self.places().items() if lane.contains(beside)), None)

    def at(self, place: QPointF) -> Layer | None:
        """Return the layer whose title a point is on."""
        lane = self.lane_at(place)
        return lane if lane in LAYERS else None

    def border_at(self, place: QPointF) -> str | None:
        """Return the lane whose lower border a point beside the lanes is on."""
        if place.x() >= LEFT or place.y() <= RULER + GRIP:
            return None
        return next((n for n, lane in self.places().items() if abs(lane.bottom() - place.y()) <= GRIP), None)

    def lock_at(self, place: QPointF) -> Lane | None:
        """Return the lane whose padlock a point is on."""
        lane = self.lane_at(place)
        on = lane in NAMES and place.x() >= LEFT - LOCK
        return cast(Lane, lane) if on else None

    def press(self, place: QPointF, alone: bool) -> None:
        border, locked = self.border_at(place), self.lock_at(place)
        if border is not None:
            self.view.hand.take(BorderDrag(self.view, border, self.keep), place)
        elif locked is not None:
            self.performance.timeline.lock(locked, locked not in self.performance.timeline.now.locked)
        elif (layer := self.at(place)) is not None:
            self.click(layer, alone)

    def click(self, layer: Layer, alone: bool) -> None:
        """Mute or unmute a layer. alone: mute all others."""
        self.performance.mute(self._others(layer) if alone else self.performance.muted ^ {layer})

    def _others(self, layer: Layer) -> set[Layer]:
        """Return the layers to mute for one to be seen alone; none where it is alone already."""
        others = set(LAYERS) - {layer}
        return set() if self.performance.muted == others else others

    def size(self, lane: str | None, factor: float = 1.0) -> None:
        """Scale the height of a lane by a factor. None resets all lanes."""
        sizes = self.view.sizes
        if lane is None:
            sizes = replace(sizes, tall=())
        sizes = sizes.with_factor(lane, factor) if lane is not None else sizes
        self.view.set_sizes(sizes)
        self.keep()

    def keep(self) -> None:
        QSettings().setValue(SETTING, json.dumps(dict(self.view.sizes.tall)))

    def menu(self, lane: str) -> QMenu:
        menu, muted = QMenu(self.view), self.performance.muted
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        if lane in LAYERS:
            layer = lane
            mute = menu.addAction(tr("Mute\tclick"), lambda: self.click(layer, False))
            mute.setCheckable(True)
            mute.setChecked(layer in muted)
            alone = menu.addAction(tr("Solo\tAlt+click"), lambda: self.click(layer, True))
            alone.setCheckable(True)
            alone.setChecked(muted == set(LAYERS) - {layer})
        if lane in NAMES:
            of, timeline = cast(Lane, lane), self.performance.timeline
            lock = menu.addAction(tr("Lock"), lambda: timeline.lock(of, of not in timeline.now.locked))
            lock.setCheckable(True)
            lock.setChecked(of in timeline.now.locked)
        menu.addSeparator()
        now = dict(self.view.sizes.tall).get(lane, 1.0)
        for words, factor in HEIGHTS.items():
            size = menu.addAction(words, partial(self.size, lane, factor))
            size.setCheckable(True)
            size.setChecked(now == factor)
        menu.addAction(tr("Reset the height of all lanes"), lambda: self.size(None)).setEnabled(
            bool(self.view.sizes.tall)
        )
        menu.addSeparator()
        menu.addAction(tr("Unmute all layers"), lambda: self.performance.mute(())).setEnabled(bool(muted))
        return menu

    def tip(self, place: QPointF) -> str:
        lane = self.lane_at(place)
        if self.border_at(place) is not None:
            return tr("Drag to change the height of the lane")
        locked = self.lock_at(place)
        if locked is not None:
            name = TITLES[locked]
            if locked in self.performance.timeline.now.locked:
                return tr(
                    "{name} is locked: you cannot move or remove its requests\nClick to unlock it",
                    name=name,
                )
            return tr("{name} is not locked\nClick to lock it", name=name)
        if lane not in LAYERS:
            return ""
        how = tr("Click to mute or unmute it, Alt+click to solo it. Exports do not change.")
        if lane in self.performance.muted:
            return tr("The {layer} layer is muted in this view\n{how}", layer=tr(lane), how=how)
        return tr("The {layer} layer is visible\n{how}", layer=tr(lane), how=how)


def paint_padlock(painter: QPainter, t: WindowTheme, at: QPointF, locked: bool) -> None:
    """Paint a padlock with its middle at `at`: shut, or open and faint."""
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    color = QColor(t.text if locked else t.dim)
    color.setAlphaF(1.0 if locked else 0.45)
    body = QRectF(at.x() - 4.5, at.y() - 0.5, 9, 6.5)
    painter.setPen(QPen(color, 1.5))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    shift = 0.0 if locked else 4.5  # an open one has its bow beside
    bow = QRectF(at.x() - 3 + shift, at.y() - 6, 6, 8)
    painter.drawArc(bow, 0, 180 * 16)
    painter.drawLine(QPointF(bow.left(), bow.center().y()), QPointF(bow.left(), body.top()))
    if locked:
        painter.drawLine(QPointF(bow.right(), bow.center().y()), QPointF(bow.right(), body.top()))
        painter.setBrush(color)
    painter.drawRoundedRect(body, 1.5, 1.5)
    painter.restore()
