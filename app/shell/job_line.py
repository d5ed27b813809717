"""Show the running job in the status bar: what it does, how far it is, how long it will still take, and a way
to stop it.
"""

from __future__ import annotations

import time

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QToolButton, QWidget

from app.project.jobs import Jobs
from app.translation import tr, tr_error
from app.widgets.making import make_widget

PAUSE = 40  # milliseconds between two updates of the bar
EARLY = 2.0  # seconds of work before what is left is estimated


class JobLine(QWidget):
    """The job in the status bar, hidden while nothing runs. `told` has words for the status bar."""

    told = Signal(str)

    def __init__(self, jobs: Jobs, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.jobs = jobs
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        self.label, self.bar = QLabel(self), QProgressBar(self)
        self.bar.setFixedWidth(180)
        self.cancel = make_widget(QToolButton, self, text=tr("Cancel"), toolTip=tr("Cancel this job"))
        self.cancel.clicked.connect(self._cancel)
        for widget in (self.label, self.bar, self.cancel):
            row.addWidget(widget)
        jobs.changed.connect(self._show)
        jobs.outlived.connect(self._tell_end)
        self._latest: tuple[int, int, str] | None = None  # reported, but not shown yet
        self._total, self._first, self._began = 0, 0, 0.0  # of the part of the work that is estimated
        self._pause = QTimer(self, singleShot=True, interval=PAUSE)
        self._pause.timeout.connect(self._show_progress)
        self.hide()

    def _show(self) -> None:
        job = self.jobs.running[-1] if self.jobs.running else None
        self.setVisible(job is not None)
        self._latest, self._total, self._first, self._began = None, 0, 0, 0.0
        if job is not None:
            self.label.setText(job.title)
            self.bar.setRange(0, 0)
            job.progress.connect(self._progress, Qt.ConnectionType.UniqueConnection)

    def _progress(self, done: int, total: int, words: str = "") -> None:
        self._latest = done, total, words
        if not self._pause.isActive():
            self._show_progress()

    def _show_progress(self) -> None:
        """Show the latest progress. A bar is painted at once whenever it moves, which takes longer than many
        steps of a job.
        """
        if self._latest is None:
            return
        (done, total, words), self._latest = self._latest, None
        self._pause.start()
        self.bar.setRange(0, max(1, total))
        self.bar.setValue(done)
        told = ", ".join(filter(None, (words, self._estimate(done, total))))
        if self.jobs.running and told:
            self.label.setText(f"{self.jobs.running[-1].title}: {told}")

    def _estimate(self, done: int, total: int) -> str:
        """Return how long the work will still take, in words; nothing at first, and at its end."""
        now = time.monotonic()
        if total != self._total or done < self._first:  # other work, counted by itself
            self._total, self._first, self._began = total, done, now
        if done <= self._first or done >= total or now - self._began < EARLY:
            return ""
        return describe_time_left((now - self._began) / (done - self._first) * (total - done))

    def _tell_end(self, title: str, error: Exception | None, stands: bool) -> None:
        """Report how a job ended whose dialog was closed."""
        if error is not None:
            self.told.emit(tr("{title}: {error}", title=title, error=tr_error(error)))
        elif stands:
            self.told.emit(tr("{title}: done.", title=title))
        else:
            self.told.emit(
                tr("{title}: the result was discarded because its dialog was closed.", title=title)
            )

    def _cancel(self) -> None:
        if self.jobs.running:
            self.jobs.running[-1].cancel()
            self.told.emit(tr("Cancelled."))


def describe_time_left(seconds: float) -> str:
    """Return how long something will still take, rounded as an estimate is."""
    if seconds < 90:
        return tr("about {seconds:,} s left", seconds=max(1, round(seconds)))
    return tr("about {minutes:,} min left", minutes=round(seconds / 60))
