"""Hold the stage: what the user looks at and what plays, with its pictures and its sound, as one object for
features.
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
    """The stage. `painted` is emitted when the character was drawn, `refused` with words about something the
    user tried that cannot be done, `scrolled` when an editor shows another part.
    """

    painted = Signal()
    refused = Signal(str)
    scrolled = Signal()

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = StageSession(document, self)
        self.figures = Figures(document, jobs, self.session.watch, self)
        self.performance = StagePerformance(document, self.session, jobs, self, self.figures.props)
        self.playhead = Playhead(self.session, self.performance)
        self.thumbnails = Thumbnails(document, self.session, self.figures, self)
        self.sound = Sound(document, self.session, self.performance, jobs, self)

    def stop(self) -> None:
        """End everything that runs on its own, on closing."""
        self.performance.live.end()
        self.sound.stop()
        self.thumbnails.stop()
