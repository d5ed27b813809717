"""Somebody who moves as a model would by now, beside somebody who moved in the take it is heard with."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.features.generation.generation_jobs import Listing
from app.project.document import Document
from app.project.jobs import Job, Jobs
from app.widgets.stick_figures import StickFigures
from metagraph.motion.clip import Clip

SECONDS = 8.0  # of a take that are shown


class SamplePreview(QWidget):
    """The take on the left, the model on the right; nothing before a training began."""

    def __init__(self, document: Document, jobs: Jobs, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._take: Any = None
        self._clip: Clip | None = None
        self._busy = False
        self._next: Path | None = None
        self.shown: Clip | None = None  # what a model made last
        self.figures = StickFigures(self)
        self.figures.setMinimumSize(240, 150)
        self.figures.setAccessibleName("A take, and the model's own motion to its speech")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.figures)

    def begin(self, listing: Listing) -> None:
        """Show a take: the stretch of one in which most is said by turns."""
        batch = listing.batch
        if batch is None or not batch.takes:
            return
        take = max(batch.takes, key=lambda t: min(t.activity[:, 0].sum(), 250) + t.activity[:, 1].sum() / 10)
        self._take, self._clip = take, listing.clips.get(take.source.name)
        if self._clip is not None:
            count = max(1, round(SECONDS * self._clip.fps))
            first = round(self._first() / 25 * self._clip.fps)
            self._clip = self._clip.trimmed(first, min(self._clip.frames, first + count))
            self.figures.words = ("as recorded", "")
            self.figures.show_clips(self._clip, None)

    def _first(self) -> int:
        """Return the frame from which most is said oneself."""
        own = np.cumsum(self._take.activity[:, 0])
        size = min(len(own) - 1, round(SECONDS * 25))
        return int(np.argmax(own[size:] - own[: len(own) - size])) if size > 0 else 0

    def show_model(self, path: Path) -> None:
        """Let a model move to the take's speech; one at a time, the latest last."""
        if self._take is None:
            return
        if self._busy:
            self._next = path
            return
        self._busy = True
        first = self._first()
        heard = self._take.features[first : first + round(SECONDS * 25)]

        def work(_: Job) -> Clip:
            from metagraph.generation.performing import Chance, featured
            from metagraph.generation.stored import read_model

            return featured(read_model(path), heard, Chance(), "sample")

        job = self.jobs.start("Drawing a sample", work, self._made, lambda _: None, quick=True)
        job.ended.connect(self._free)

    def _made(self, clip: Clip) -> None:
        self.shown = clip
        self.figures.words = ("as recorded", "as the model moves")
        self.figures.show_clips(self._clip or clip, clip)

    def _free(self) -> None:
        self._busy = False
        path, self._next = self._next, None
        if path is not None:
            self.show_model(path)

    def still(self) -> None:
        self._next = None
