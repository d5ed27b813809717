"""The titles of the timeline's layers: a click mutes a layer, with Alt it leaves it alone."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QMenu, QWidget

from app.stage.performance import Performance
from app.widgets.lane_geometry import LEFT, lanes
from metagraph.graph.model import LAYERS, Layer


class LaneTitles:
    """What the titles left of the lanes do. view: the widget of the lanes."""

    def __init__(self, view: QWidget, performance: Performance) -> None:
        self.view, self.performance = view, performance

    def at(self, place: QPointF) -> Layer | None:
        """Return the layer whose title a point is on."""
        if place.x() >= LEFT:
            return None
        beside = QPointF(LEFT, place.y())
        return next((n for n in LAYERS if lanes(self.view.height())[n].contains(beside)), None)

    def click(self, layer: Layer, alone: bool) -> None:
        """Mute a layer or let it be seen; alone: it and no other."""
        self.performance.mute(self._others(layer) if alone else self.performance.muted ^ {layer})

    def _others(self, layer: Layer) -> set[Layer]:
        """Return the layers to mute for one to be seen alone; none where it is alone already."""
        others = set(LAYERS) - {layer}
        return set() if self.performance.muted == others else others

    def menu(self, layer: Layer) -> QMenu:
        menu, muted = QMenu(self.view), self.performance.muted
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        mute = menu.addAction("Mute\tclick", lambda: self.click(layer, False))
        mute.setCheckable(True)
        mute.setChecked(layer in muted)
        alone = menu.addAction("Solo\tAlt+click", lambda: self.click(layer, True))
        alone.setCheckable(True)
        alone.setChecked(muted == set(LAYERS) - {layer})
        menu.addSeparator()
        menu.addAction("Let all be seen", lambda: self.performance.mute(())).setEnabled(bool(muted))
        return menu

    def tip(self, layer: Layer) -> str:
        state = "rests while you look" if layer in self.performance.muted else "is seen"
        how = "Click mutes it, Alt+click leaves it alone; exports do not change"
        return f"The {layer} layer {state}\n{how}"
