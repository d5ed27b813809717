"""Keep where in the graph the user works: the layer, its current stance, and the other stance, where
transitions end.
"""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from metagraph.graph.model import Layer


class CurrentPlace(QObject):
    """The current place.

    `layer_changed` is emitted for another layer's tab, `stance_changed` for another current stance, or
    another other stance for transitions.
    """

    layer_changed = Signal()
    stance_changed = Signal()

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.layer: Layer = "arms"
        self.stances: dict[Layer, str] = {}  # the current stance of each layer
        self.others: dict[Layer, str] = {}  # the other stance, where a dropped transition ends

    def forget(self) -> None:
        """Discard the choices, because another project is shown."""
        self.stances.clear()
        self.others.clear()

    def set_layer(self, layer: Layer) -> None:
        if layer != self.layer:
            self.layer = layer
            self.layer_changed.emit()
            self.stance_changed.emit()

    def stance(self, layer: Layer | None = None) -> str | None:
        """Return the current stance's id: the chosen one, else the layer's start."""
        layer = layer or self.layer
        graph = self.document.project.graphs[layer]
        chosen = self.stances.get(layer)
        if chosen in graph.stances:
            return chosen
        return graph.start if graph.start in graph.stances else next(iter(graph.stances), None)

    def set_stance(self, stance: str) -> None:
        found = self.document.project.stance(stance)
        if found is None:
            return
        self.stances[found.layer] = stance
        if found.layer != self.layer:
            self.set_layer(found.layer)
        else:
            self.stance_changed.emit()

    def set_stances(self, stances: Iterable[str]) -> None:
        """Make stances of several layers the current ones, and show the layer of the first."""
        known = [s for i in stances if (s := self.document.project.stance(i)) is not None]
        for found in known[1:]:
            self.stances[found.layer] = found.id
        if known:
            self.set_stance(known[0].id)

    def other(self, layer: Layer | None = None) -> str | None:
        """Return where a dropped transition ends: the chosen other stance, else the first that is not the
        current one.
        """
        layer = layer or self.layer
        stances = self.document.project.graphs[layer].stances
        current, chosen = self.stance(layer), self.others.get(layer)
        if chosen in stances and chosen != current:
            return chosen
        return next((s for s in stances if s != current), None)

    def set_other(self, stance: str) -> None:
        self.others[self.layer] = stance
        self.stance_changed.emit()
