"""Keep what is on stage: the models that improvise, a kept performance or a conversation; and which of the
two editors' graphs plays.
"""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QObject, Signal

from metagraph.graph.model import Mode as Behaviour
from metagraph.graph.model import Project

Mode = Literal["meta", "manual"]


class OnStage(QObject):
    """What is on stage.

    `performance_changed` is emitted if another kept performance is on stage, or other requests of it are
    selected; `mode_changed` if the meta-graph or the manual state machine is edited and played instead;
    `conversation_changed` if another conversation is on stage, or another side of it is shown.
    """

    performance_changed = Signal()
    mode_changed = Signal()
    conversation_changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.mode: Mode = "meta"
        self.performance: str | None = None  # the kept performance on stage, None while the models improvise
        self.improvised: Behaviour = "talking"  # what the character does while the models improvise
        self.requests: tuple[str, ...] = ()  # selected in the timeline
        self.conversation: str | None = (
            None  # the conversation on stage, None for none; never together with a kept performance
        )
        self.side = 0  # the speaker whose plan the timeline shows

    def set_mode(self, mode: Mode) -> None:
        """Edit and play the meta-graph, or the manual state machine."""
        if mode != self.mode:
            self.mode = mode
            self.mode_changed.emit()

    def set_performance(self, ident: str | None) -> None:
        """Put a kept performance on stage, or none; it replaces a conversation."""
        if ident is not None:
            self.set_conversation(None)
        if ident != self.performance:
            self.performance, self.requests = ident, ()
            self.performance_changed.emit()

    def improvise(self, mode: Behaviour) -> None:
        """Let the models improvise while the character talks, listens or idles."""
        changes = mode != self.improvised
        self.improvised = mode
        self.set_conversation(None)
        if self.performance is not None:
            self.set_performance(None)
        elif changes:
            self.performance_changed.emit()

    def select_requests(self, requests: tuple[str, ...]) -> None:
        if requests != self.requests:
            self.requests = requests
            self.performance_changed.emit()

    def set_conversation(self, ident: str | None) -> None:
        """Put a conversation on stage, or none; it replaces a kept performance."""
        if ident is not None:
            self.set_performance(None)
        if ident != self.conversation:
            self.conversation, self.side = ident, min(self.side, 1)  # others may have no third side
            self.conversation_changed.emit()

    def set_side(self, side: int) -> None:
        """Make the timeline show the plan of one side of the conversation, from 0."""
        if side != self.side:
            self.side = side
            self.conversation_changed.emit()

    def follow(self, before: Project, after: Project) -> None:
        """Drop what an edit removed."""
        if self.performance is not None and self.performance not in after.performances:
            self.set_performance(None)
        elif self.performance is not None and before.performances is not after.performances:
            there = {ask.id for ask in after.performances[self.performance].asks}
            self.select_requests(tuple(i for i in self.requests if i in there))
        if self.conversation is not None and self.conversation not in after.conversations:
            self.set_conversation(None)
        elif self.conversation is not None and self.side >= len(after.conversations[self.conversation].sides):
            self.set_side(0)
