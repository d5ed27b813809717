"""The stage: what is looked at and what plays, with its pictures and its sound, as one value that features
are given.
"""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.figures import Figures
from app.stage.line_player import Sound
from app.stage.performance import StagePerformance
from app.stage.playhead import Playhead
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails


class Stage(QObject):
    """painted: the character was drawn. refused: what a hand tried and cannot be done, in words. scrolled: an
    editor shows another part.
    """

    painted = Signal()
    refused = Signal(str)
    scrolled = Signal()

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = StageSession(document, self)
        self.figures = Figures(document, jobs, self)
        self.performance = StagePerformance(document, self.session, jobs, self)
        self.playhead = Playhead(self.session, self.performance)
        self.thumbnails = Thumbnails(document, self.session, self.figures, self)
        self.sound = Sound(document, self.session, self.performance, jobs, self)

    def stop(self) -> None:
        """End what goes on by itself; at closing."""
        self.performance.live.end()
        self.sound.stop()
        self.thumbnails.stop()
