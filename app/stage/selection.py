"""Keep the selection: clips in the library, actions in the graph, or states and links of the manual state
machine.
"""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from metagraph.graph.model import Action, Project


class Selection(QObject):
    """The selection. `changed` is emitted if something else is selected. Selecting in one place clears the
    others.
    """

    changed = Signal()

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.clips: tuple[str, ...] = ()  # in the library
        self.actions: tuple[str, ...] = ()  # in the graph
        self.states: tuple[str, ...] = ()  # and aliases, in the manual state machine
        self.links: tuple[str, ...] = ()
        self.copied: str | None = None  # the action whose properties can be pasted

    def select_clips(self, clips: tuple[str, ...]) -> None:
        """Select in the library; this clears the selection in the graph."""
        self._select(clips=clips)

    def select_actions(self, actions: tuple[str, ...]) -> None:
        """Select in the graph; the library shows the clips of `actions`."""
        self._select(actions=actions)

    def select_states(self, states: tuple[str, ...] = (), links: tuple[str, ...] = ()) -> None:
        """Select in the manual state machine."""
        self._select(states=states, links=links)

    def clear(self) -> None:
        """Select nothing."""
        self._select()

    def _select(
        self,
        clips: tuple[str, ...] = (),
        actions: tuple[str, ...] = (),
        states: tuple[str, ...] = (),
        links: tuple[str, ...] = (),
    ) -> None:
        if (clips, actions, states, links) != (self.clips, self.actions, self.states, self.links):
            self.clips, self.actions, self.states, self.links = clips, actions, states, links
            self.changed.emit()

    def selected_actions(self) -> tuple[Action, ...]:
        """Return the selected actions that exist, in the order of selection."""
        found = (self.document.project.action(i) for i in self.actions)
        return tuple(a for a in found if a is not None)

    def follow(self, after: Project) -> None:
        """Drop what an edit removed."""
        self._select(
            tuple(i for i in self.clips if i in after.clips),
            tuple(i for i in self.actions if after.action(i) is not None),
            tuple(i for i in self.states if after.state(i) is not None or after.alias(i) is not None),
            tuple(i for i in self.links if after.link(i) is not None),
        )
