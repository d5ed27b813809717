"""The layers as tabs in the header."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.shell.context import Shell
from app.translation import tr
from app.widgets.choice_row import ChoiceRow
from app.widgets.vocabulary import get_vocabulary_title, get_vocabulary_word
from metagraph.graph.model import LAYERS, Layer

LAYER_KEYS: dict[Layer, str] = {"body": "Alt+1", "arms": "Alt+2", "head": "Alt+3"}


class LayerTabs(ChoiceRow):
    """The layers, each with how many actions it has; the current one is pressed."""

    def __init__(self, shell: Shell, parent: QWidget) -> None:
        tips = (
            (
                get_vocabulary_title(x),
                tr("The {layer} layer ({key})", layer=get_vocabulary_word(x), key=LAYER_KEYS[x]),
            )
            for x in LAYERS
        )
        super().__init__(parent, tips, least_width=56)
        self.document, self.session = shell.document, shell.stage.session
        self.chosen.connect(lambda n: self.session.place.set_layer(LAYERS[n]))
        self.session.place.layer_changed.connect(self.refresh)
        self.document.changed.connect(
            lambda before, after: self.refresh() if before.graphs is not after.graphs else None
        )
        self.refresh()

    def refresh(self) -> None:
        """Show the layer and the counts as they are now."""
        for number, layer in enumerate(LAYERS):
            count = len(self.document.project.graphs[layer].actions)
            self.button(number).setText(
                f"{get_vocabulary_title(layer)}  {count}" if count else get_vocabulary_title(layer)
            )
        self.show_choice(LAYERS.index(self.session.place.layer))
