"""Going live and coming back: agents drive the character meanwhile; what was played is kept at hand."""

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
    """changed: live begins, ends, or is connected otherwise. ticked: the live plan went on. stage: while it
    is on.
    """

    changed = Signal()
    ticked = Signal()

    def __init__(self, document: Document, session: StageSession, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.stage: LiveStage | None = None
        self.following = True  # the playhead is now, not somewhere in the past
        self.last: KeptPerformance | None = None  # what was played live last, if anything was asked

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
        """Hang up, and keep at hand what was played."""
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
        """Back to now, after scrubbing through the past."""
        self.following = True
        self.session.transport.show_plan()
        self.session.transport.set_playing(True)
