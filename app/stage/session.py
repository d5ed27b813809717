"""The session: what the user looks at - layer, stances, selection, playhead. Never saved with the project."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from metagraph.graph.model import LAYERS, Action, Layer, Project

Show = Literal["plan", "clip", "context"]
Mode = Literal["meta", "manual"]


class Session(QObject):
    """layer_changed: another layer's tab. stance_changed: another current stance, or another other stance for transitions.
    selection_changed: other clips or actions are selected. show_changed: the preview shows something else (see `show`).
    playing_changed, moved: transport. theme_changed: dark or light. performance_changed: another kept performance is on stage, or
    other asks of it are selected. mode_changed: the meta-graph or the manual state machine is edited and played.
    conversation_changed: another conversation is on stage.
    """

    layer_changed = Signal()
    stance_changed = Signal()
    selection_changed = Signal()
    show_changed = Signal()
    playing_changed = Signal()
    moved = Signal(float)
    theme_changed = Signal()
    performance_changed = Signal()
    mode_changed = Signal()
    conversation_changed = Signal()

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.layer: Layer = "arms"
        self.stances: dict[Layer, str] = {}  # the current stance of each layer
        self.others: dict[Layer, str] = {}  # the other stance, where a dropped transition ends
        self.clips: tuple[str, ...] = ()  # selected in the library
        self.actions: tuple[str, ...] = ()  # selected in the graph
        self.states: tuple[str, ...] = ()  # selected in the manual state machine
        self.links: tuple[str, ...] = ()
        self.mode: Mode = "meta"
        self.show: Show = "plan"
        self.shown: str | None = None  # the clip (or action) shown alone or in context
        self.tried: str | None = None  # the stance a clip is shown on as if it were placed there
        self.playing = True
        self.speed = 1.0
        self.loop = True
        self.seconds = 0.0
        self.performance: str | None = None  # the kept performance on stage, None while the models improvise
        self.asks: tuple[str, ...] = ()  # selected in the timeline
        self.conversation: str | None = None  # the conversation on stage, None for none; never while a kept performance is
        self.side = 0  # of its two, whose plan the timeline shows
        self.copied: str | None = None  # the action whose properties can be pasted
        self.theme: Literal["dark", "light"] = "dark"
        document.changed.connect(self._follow)

    def set_mode(self, mode: Mode) -> None:
        """Edit and play the meta-graph, or the manual state machine."""
        if mode != self.mode:
            self.mode = mode
            self.clips = self.actions = self.states = self.links = ()
            self.mode_changed.emit()
            self.selection_changed.emit()
            self.show_plan()
            self.seek(0.0)

    # --- layer and stance

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

    def other(self, layer: Layer | None = None) -> str | None:
        """Return where a dropped transition ends: the chosen other stance, else the first that is not the current one."""
        layer = layer or self.layer
        stances = self.document.project.graphs[layer].stances
        current, chosen = self.stance(layer), self.others.get(layer)
        if chosen in stances and chosen != current:
            return chosen
        return next((s for s in stances if s != current), None)

    def set_other(self, stance: str) -> None:
        self.others[self.layer] = stance
        self.stance_changed.emit()

    # --- selection

    def select_clips(self, clips: tuple[str, ...]) -> None:
        """Select in the library; nothing is selected in the graph then."""
        self._select(clips=clips)

    def select_actions(self, actions: tuple[str, ...]) -> None:
        """Select in the graph; the library follows with the actions' clips by looking at `actions`."""
        self._select(actions=actions)

    def select_states(self, states: tuple[str, ...] = (), links: tuple[str, ...] = ()) -> None:
        """Select in the manual state machine."""
        self._select(states=states, links=links)

    def _select(
        self, clips: tuple[str, ...] = (), actions: tuple[str, ...] = (), states: tuple[str, ...] = (), links: tuple[str, ...] = ()
    ) -> None:
        if (clips, actions, states, links) != (self.clips, self.actions, self.states, self.links):
            self.clips, self.actions, self.states, self.links = clips, actions, states, links
            self.selection_changed.emit()

    def selected_actions(self) -> tuple[Action, ...]:
        """Return the selected actions that exist, in the order of selection."""
        found = (self.document.project.action(i) for i in self.actions)
        return tuple(a for a in found if a is not None)

    def jump(self, layer: Layer | None = None, stance: str | None = None, action: str | None = None, clip: str | None = None) -> None:
        """Go to a place of the project: what the problems panel and the timeline call."""
        project = self.document.project
        found = project.action(action) if action else None
        drawn = project.state(action) if action else None
        if drawn is not None:  # what the manual state machine plays is named by its states
            self.set_layer(drawn.layer)
            self.select_states((drawn.id,))
            return
        link = project.link(action) if action else None
        if link is not None and layer is not None:
            self.set_layer(layer)
            self.select_states((), (link.id,))
            return
        if found is not None:
            stance, layer = found.stance, found.layer
        if layer is not None:
            self.set_layer(layer)
        if stance is not None:
            self.set_stance(stance)
        if found is not None:
            self.select_actions((found.id,))
        elif clip is not None and clip in project.clips:
            self.select_clips((clip,))

    # --- performances

    def set_performance(self, ident: str | None) -> None:
        """Put a kept performance on stage, or none; a conversation leaves it for one."""
        if ident is not None:
            self.set_conversation(None)
        if ident != self.performance:
            self.performance, self.asks = ident, ()
            self.performance_changed.emit()

    def select_asks(self, asks: tuple[str, ...]) -> None:
        if asks != self.asks:
            self.asks = asks
            self.performance_changed.emit()

    def set_conversation(self, ident: str | None) -> None:
        """Put a conversation on stage, or none; a kept performance leaves it for one."""
        if ident is not None:
            self.set_performance(None)
        if ident != self.conversation:
            self.conversation = ident
            self.conversation_changed.emit()

    def set_side(self, side: int) -> None:
        """Let the timeline show the plan of one side of the conversation, 0 or 1."""
        if side != self.side:
            self.side = side
            self.conversation_changed.emit()

    # --- preview

    def show_plan(self) -> None:
        self._show("plan", None)

    def show_clip(self, clip: str) -> None:
        """Play a clip alone."""
        self._show("clip", clip)

    def show_context(self, ident: str, tried: str | None = None) -> None:
        """Play a clip or an action in context: stance, clip, back to the stance, the other layers on. tried: the stance, current from
        then on, that a clip is shown on as if it were placed there."""
        if tried is not None:
            self.set_stance(tried)
        self._show("context", ident, tried)

    def _show(self, show: Show, shown: str | None, tried: str | None = None) -> None:
        if (show, shown, tried) != (self.show, self.shown, self.tried):
            self.tried = tried
            if show == "plan":
                self.seconds = self._plan_seconds
            elif self.show == "plan":
                self._plan_seconds = self.seconds
            if show != "plan":
                self.seconds = 0.0
            self.show, self.shown = show, shown
            self.show_changed.emit()
        if show != "plan":
            self.seek(0.0)
            self.set_playing(True)

    _plan_seconds = 0.0

    def set_playing(self, playing: bool) -> None:
        if playing != self.playing:
            self.playing = playing
            self.playing_changed.emit()

    def seek(self, seconds: float) -> None:
        """Move the playhead; `moved` is emitted."""
        self.seconds = max(0.0, seconds)
        self.moved.emit(self.seconds)

    def set_theme(self, theme: Literal["dark", "light"]) -> None:
        if theme != self.theme:
            self.theme = theme
            self.theme_changed.emit()

    # --- following the document

    def _follow(self, before: Project, after: Project) -> None:
        actions = tuple(i for i in self.actions if after.action(i) is not None)
        clips = tuple(i for i in self.clips if i in after.clips)
        states = tuple(i for i in self.states if after.state(i) is not None)
        links = tuple(i for i in self.links if after.link(i) is not None)
        self._select(clips, actions, states, links)
        if self.performance is not None and self.performance not in after.performances:
            self.set_performance(None)
        elif self.performance is not None and before.performances is not after.performances:
            there = {ask.id for ask in after.performances[self.performance].asks}
            self.select_asks(tuple(i for i in self.asks if i in there))
        if self.conversation is not None and self.conversation not in after.conversations:
            self.set_conversation(None)
        if self.shown is not None and self.shown not in after.clips and not self._there(after, self.shown):
            self.show_plan()
        if any(before.graphs[layer].stances is not after.graphs[layer].stances for layer in LAYERS):
            self.stance_changed.emit()

    @staticmethod
    def _there(project: Project, ident: str) -> bool:
        return any(find(ident) is not None for find in (project.action, project.state, project.link))
