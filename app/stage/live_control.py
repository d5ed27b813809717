"""Go live and come back. In between, agents drive the character; what was played is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.stage.session import StageSession
from metagraph.graph.requests import Performance as KeptPerformance

if TYPE_CHECKING:
    from app.stage.live_stage import LiveStage
    from metagraph.live.server import Options


class LiveControl(QObject):
    """Controls live play. `changed` is emitted if it begins, ends, or its connection changes, `ticked` when
    the live plan advanced. `stage` exists while it is on.
    """

    changed = Signal()
    ticked = Signal()

    def __init__(self, document: Document, session: StageSession, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.stage: LiveStage | None = None
        self.following = True  # the playhead is at the present, not in the past
        self.last: KeptPerformance | None = None  # what was played live last, if there were requests

    def begin(self, options: Options | None = None) -> None:
        """Let agents drive the character from now on."""
        from app.stage.live_stage import LiveStage

        project = self.document.project
        if self.stage is not None or project.skeleton is None:
            return
        self.session.onstage.set_performance(None)
        self.session.transport.show_plan()
        self.stage, self.following = LiveStage(project, options, self, self.document.folder), True
        self.stage.ticked.connect(self.ticked)
        self.stage.told.connect(lambda _: self.changed.emit())
        self.session.transport.set_playing(True)
        self.stage.start()
        self.changed.emit()

    def end(self) -> None:
        """Disconnect, and keep what was played."""
        if self.stage is None:
            return
        stage, self.stage = self.stage, None
        stage.stop()
        self.last = stage.performance() if stage.tape.count else None
        if self.last is not None and (lacks := stage.session.kept_words()):
            self.document.failed.emit(lacks[0].upper() + lacks[1:])
        stage.deleteLater()
        self.changed.emit()

    def follow(self) -> None:
        """Go back to the present, after scrubbing through the past."""
        self.following = True
        self.session.transport.show_plan()
        self.session.transport.set_playing(True)
