"""Hold the session: what the user looks at. It is never saved with the project. Its parts are objects of
their own, which are connected here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.look.theme_choice import ThemeChoice
from app.project.document import Document
from app.stage.current_place import CurrentPlace
from app.stage.on_stage import Mode, OnStage
from app.stage.onion import Onion
from app.stage.selection import Selection
from app.stage.transport import Transport
from app.stage.watch import Watch
from app.translation import tr_error
from metagraph.errors import FileError
from metagraph.graph.manual.machine import Manual
from metagraph.graph.model import LAYERS, Layer, Project

if TYPE_CHECKING:
    from preview.scene import SceneTheme

OPENED_ON: tuple[Layer, ...] = ("arms", "body", "head")


class StageSession(QObject):
    """The session.

    `place` is the layer and stance, `selection` what is selected, `onstage` what is on stage and in which
    mode, `transport` the playhead, `look` the theme, `onion` the other moments shown beside the present one,
    `watch` the aids for watching the character.
    """

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.place = CurrentPlace(document, self)
        self.selection = Selection(document, self)
        self.onstage = OnStage(self)
        self.transport = Transport(self)
        self.look = ThemeChoice(self)
        self.onion = Onion(self)
        self.watch = Watch(self)
        self._told = ""  # why the background cannot be drawn
        document.changed.connect(self._follow)

    def make_view_look(self) -> SceneTheme:
        """Return how the character is lit, and what is behind it: what the project has, else what the user
        likes.
        """
        look, document = self.watch.now.look(self.look.name), self.document
        if not document.project.backdrop.kind:
            return look
        from app.stage.backdrop import set_backdrop

        try:
            return set_backdrop(look, document.project, document.folder)
        except FileError as error:
            if self._told != str(error):
                self._told = str(error)
                document.failed.emit(tr_error(error))
            return look

    def set_mode(self, mode: Mode) -> None:
        """Edit and play the meta-graph, or the manual state machine; this clears the selection."""
        if mode != self.onstage.mode:
            self.onstage.set_mode(mode)
            self.selection.clear()
            self.transport.show_plan()
            self.transport.seek(0.0)

    def show_context(self, ident: str, tried: str | None = None) -> None:
        """Play a clip or an action in context. `tried` is a stance, current from then on, on which a clip is
        shown as if it were placed there.
        """
        if tried is not None:
            self.place.set_stance(tried)
        self.transport.show_context(ident, tried)

    def open_project(self) -> None:
        """Go to the start of a newly opened project: its meta-graph or manual machine, on a layer that has
        something.
        """
        place, project = self.place, self.document.project
        place.forget()
        self.selection.clear()
        drawn = [layer for layer in LAYERS if project.manual.get(layer, Manual(layer)).states]
        if any(True for _ in project.actions()):
            self.set_mode("meta")
        elif drawn:  # an empty one keeps the mode
            self.set_mode("manual")
            if place.layer not in drawn:
                place.set_layer(drawn[0])
        if self.onstage.mode == "meta" and not project.graphs[place.layer].actions:
            first = next((x for x in OPENED_ON if project.graphs[x].actions), None)
            if first is not None:
                place.set_layer(first)
        place.stance_changed.emit()
        self.transport.show_plan()
        self.transport.seek(0.0)

    def jump(
        self,
        layer: Layer | None = None,
        stance: str | None = None,
        action: str | None = None,
        clip: str | None = None,
    ) -> None:
        """Go to a place in the project, for the problems panel and the timeline."""
        project = self.document.project
        found = project.action(action) if action else None
        drawn = (project.state(action) or project.alias(action)) if action else None
        if drawn is not None:  # what the manual state machine plays is named by its states
            self.place.set_layer(drawn.layer)
            self.selection.select_states((drawn.id,))
            return
        link = project.link(action) if action else None
        if link is not None and layer is not None:
            self.place.set_layer(layer)
            self.selection.select_states((), (link.id,))
            return
        if found is not None:
            stance, layer = found.stance, found.layer
        if layer is not None:
            self.place.set_layer(layer)
        if stance is not None:
            self.place.set_stance(stance)
        if found is not None:
            self.selection.select_actions((found.id,))
        elif clip is not None and clip in project.clips:
            self.selection.select_clips((clip,))

    def _follow(self, before: Project, after: Project) -> None:
        self.selection.follow(after)
        self.onstage.follow(before, after)
        self.transport.follow(after)
        if before.backdrop != after.backdrop or (after.backdrop.kind and before.props is not after.props):
            self.watch.changed.emit()
        if any(before.graphs[layer].stances is not after.graphs[layer].stances for layer in LAYERS):
            self.place.stance_changed.emit()
