"""Leads a participant through a sitting in the window: screens, work, time, and what the window offers
meanwhile.
"""

from __future__ import annotations

import platform
from time import monotonic
from typing import TYPE_CHECKING, Any, Literal

from PySide6.QtCore import QEvent, QLockFile, QObject, QTimer, Signal
from PySide6.QtWidgets import QApplication

from app.features.study.operator_counting import OperatorCounting
from app.features.study.reserved_window import ReservedWindow
from app.features.study.study_bar import StudyBar
from app.features.study.study_recorder import Recorder
from app.features.study.study_screen import (
    BreakPage,
    ClapPage,
    ConsentPage,
    QuestionsPage,
    Screen,
    StudyPage,
    make_question_page,
    make_text_page,
)
from app.project.files import Files
from app.project.jobs import WindowJob
from app.translation import tr, tr_error, tr_noop
from metagraph import __version__
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.research.study.plan.freeze import study_manifest
from metagraph.research.study.plan.hidden_names import copy_numbered
from metagraph.research.study.plan.task_projects import make_task_project, reopen, write_task_project
from metagraph.research.study.sitting import Phase, Sitting
from metagraph.research.study.study_plan import CONDITION_TITLES, Study

if TYPE_CHECKING:
    from app.shell.context import Shell


EDITORS = (tr_noop("Meta-graph"), tr_noop("State machine"))  # of `CONDITION_TITLES`
CLAP = 600  # milliseconds of a flash


class Guide(QObject):
    """over: the sitting has ended or was left; the window is as before. Raises FileError and SittingError
    when it cannot begin.
    """

    over = Signal()

    def __init__(self, shell: Shell, study: Study, participant: str, experimenter: bool = False) -> None:
        super().__init__(shell.widget)
        self.shell, self.study, self.participant, self.experimenter = shell, study, participant, experimenter
        folder = study.data(participant)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(
                folder,
                tr("cannot be created ({why})", why=error.strerror or error),
                tr("at the start"),
                tr("Check that you can write to that folder."),
            ) from None
        self._lock = QLockFile(str(folder / "sitting.lock"))
        self._lock.setStaleLockTime(0)
        if not self._lock.tryLock(0):
            raise FileError(
                folder,
                tr("another window has this sitting open"),
                participant,
                tr("Continue there, or close that window."),
            )
        try:
            self.sitting = Sitting(study, participant, describe_computer(), __version__)
        except (FileError, ValueError):
            self._lock.unlock()
            raise
        self.recorder = Recorder(shell, self.sitting.writer)
        self.screen = Screen(shell.widget, shell.stage.session)
        self.bar = StudyBar(shell.stage.session, shell.widget)
        self.bar.hide()
        self.reserved = ReservedWindow(shell, self.bar, "labels" in study.plan.allow)
        self._resumed = self.sitting.resumed
        self._working = False  # a task is on and not paused
        self._claps = 0
        self.over_already = False
        self._elapsed, self._from = 0.0, 0.0  # seconds before the last start of the clock; when that was
        self._second = QTimer(self, interval=500)
        self._second.timeout.connect(self._tick)
        self.bar.done.clicked.connect(self.ask_done)
        self.bar.pause.clicked.connect(lambda: self.pause())
        self.bar.note.clicked.connect(self.write_note)
        self._enter()
        shell.jobs.start(
            tr("Recording the study's files"),
            lambda job: study_manifest(study),
            self.sitting.freeze,
            quick=True,
        )

    # --- the window

    def _enter(self) -> None:
        counting = self.shell.services[OperatorCounting]
        self.shell.stage.session.transport.set_playing(False)
        if counting.on:
            counting.toggle()
        self.reserved.enter()
        self.shell.widget.installEventFilter(self)

    def _leave(self) -> None:
        """Give the window back."""
        self.over_already = True
        self._second.stop()
        self.shell.widget.removeEventFilter(self)
        self.recorder.stop()
        self.sitting.close()
        self._lock.unlock()
        self.reserved.leave()
        self.over.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Close:
            self.leave()
        return False

    def leave(self) -> None:
        """Break the sitting off where it is; it goes on there next time."""
        phase = self.sitting.phase
        try:
            if (
                phase is not None
                and phase.works
                and self.sitting.now.begun
                and self.shell.document.path == self.sitting.file
            ):
                self.shell.document.finish_merging()
                self.recorder.boundary()
                self.shell.document.save()
        except FileError as error:  # the window asks what is to become of the edits
            self.shell.tell(tr_error(error))
        self._leave()

    # --- going through

    def show(self) -> None:
        """Show where the sitting stands."""
        phase = self.sitting.phase
        if phase is None:
            self._show(
                make_text_page(
                    tr("This sitting is finished"),
                    tr("All parts of it are already done."),
                    tr("Close"),
                    self._finish,
                )
            )
        elif phase.works:
            self._load(phase)
        else:
            self.sitting.begin()
            self._show(self._page(phase))
            self._resumed = False

    def _page(self, phase: Phase) -> StudyPage:
        if phase.name == "consent":
            return ConsentPage(phase.title, phase.text, self.go_on, self.decline)
        if phase.name == "break":
            return BreakPage(phase.minutes or 0, self.go_on)
        if phase.questionnaire is not None:
            return QuestionsPage(
                phase.questionnaire,
                self._about(phase),
                self.sitting.now.answers,
                self.sitting.answer,
                self.go_on,
            )
        if phase.name == "end":
            return make_text_page(
                phase.title,
                phase.text or tr("That was the last part. Thank you for your help."),
                tr("Close"),
                self.go_on,
            )
        limit = tr("\n\nYou have {minutes:g} minutes.", minutes=phase.minutes) if phase.minutes else ""
        return make_text_page(
            phase.title,
            phase.text + (limit if phase.condition else ""),
            tr("Start") if phase.condition else tr("Continue"),
            self.go_on,
        )

    def _about(self, phase: Phase) -> str:
        names = [self.study.plan.task(phase.task).name] if phase.task is not None else []
        names += (
            [tr("the editor “{title}”", title=tr(CONDITION_TITLES[phase.condition]))]
            if phase.condition is not None
            else []
        )
        return tr("About {names}", names=tr(", with ").join(names)) if names else ""

    def _show(self, page: StudyPage) -> None:
        """Lay a page over the window, whose commands rest."""
        phase = self.sitting.phase
        self.reserved.allow_page()
        self.shell.stage.session.transport.set_playing(False)
        self.reserved.reach(False)
        step = (
            tr("   {number} of {count}", number=phase.index + 1, count=len(self.sitting.course))
            if phase is not None
            else ""
        )
        self.screen.show_page(page, f"{self.study.plan.title}   {self.participant}{step}")

    def go_on(self) -> None:
        """End what is shown, and show what comes next."""
        self.recorder.boundary()
        self.sitting.end()
        if self.sitting.phase is None:
            self._finish()
        else:
            self.show()

    def _finish(self) -> None:
        self.screen.hide()
        self._leave()
        self.shell.document.load(Project(), None)
        self.shell.services[Files].opened.emit()

    def decline(self) -> None:
        """Note that nobody agreed, and end here."""
        self.sitting.decline()
        self.shell.widget.close()

    # --- work

    def _load(self, phase: Phase) -> None:
        """Make or open the project of a task on a thread; its time begins when it is there."""
        self._show(StudyPage(phase.title, tr("One moment. The clips are loading.")).finish())
        study, path, again = self.study, self.sitting.file, self.sitting.now.begun
        name = study.plan.task(phase.task).name if phase.task is not None else tr("Practice")
        reference = study.reference(phase.task) if phase.task is not None else None

        def work(job: WindowJob) -> Project:
            if again:
                return reopen(path, job.tell)[0].project
            numbered = None
            if phase.names == "hidden":
                found = study.make_clip_numbers(self.participant, phase.condition or "", phase.task or "")
                copies = copy_numbered(found, path.parent / f"{phase.index:02d}-clips")
                numbered = dict(zip(copies, found.values(), strict=True))
            return write_task_project(make_task_project(study, phase.clips, name, reference, numbered), path)

        self.shell.jobs.start(
            tr("Loading the clips"), work, lambda project: self._begin(phase, project), self._cannot
        )

    def _cannot(self, error: Exception) -> None:
        self.recorder.tell("error", what="failed", words=str(error))
        self._show(
            make_question_page(
                tr("The study cannot continue"),
                tr_error(error),
                tr("Try again"),
                self.show,
                tr("Close the window"),
                self.shell.widget.close,
            )
        )

    def _begin(self, phase: Phase, project: Project) -> None:
        document = self.shell.document
        if self.sitting.phase is not phase:
            return  # it was left meanwhile
        again = self.sitting.now.begun
        document.load(project, self.sitting.file)
        self.shell.stage.session.set_mode("manual" if phase.condition == "manual" else "meta")
        self.shell.services[Files].opened.emit()
        self._elapsed = self.sitting.now.elapsed if again else 0.0
        self.bar.begin(phase.title, phase.text)
        self.bar.show()
        if again and self._resumed:
            self._resumed = False
            self.sitting.writer.add("pause", state="begin", why="resumed")
            page = make_text_page(
                tr("Welcome back"),
                tr("Your work is as you left it. The clock starts again when you continue."),
                tr("Continue"),
                self.unpause,
            )
            self._show(page)
            return
        self._resumed = False
        self.sitting.begin()
        if self.study.plan.claps:
            self._clap()
        else:
            self._start()

    def _clap(self) -> None:
        """Flash and sound, and tell when; the task begins after it."""
        self._claps += 1
        self._show(ClapPage(self._claps))
        self.screen.repaint()
        QApplication.beep()
        self.recorder.tell("marker", name="clap", number=self._claps)
        QTimer.singleShot(CLAP, self, lambda: None if self.over_already else self._start())

    def _start(self) -> None:
        """Let the work be seen, and the clock run."""
        phase = self.sitting.phase
        assert phase is not None
        self.screen.hide()
        self.reserved.reach(True)
        self.reserved.allow_task()
        self._working, self._from = True, monotonic()
        self._second.start()
        self._tick()
        self.shell.stage.session.transport.set_playing(True)

    def _stop(self) -> None:
        self._elapsed, self._working = self.elapsed, False
        self._second.stop()

    @property
    def elapsed(self) -> float:
        """Return how long the task has been on, without pauses; seconds."""
        return self._elapsed + (monotonic() - self._from if self._working else 0.0)

    def _tick(self) -> None:
        phase = self.sitting.phase
        if phase is None or not self._working:
            return
        self.bar.show_time(self.elapsed, phase.minutes)
        if phase.minutes is not None and self.elapsed >= 60 * phase.minutes:
            self.finish_task("time")

    def pause(self) -> None:
        """Stop the clock and hide the work."""
        if self._working:
            self._stop()
            self.recorder.tell("pause", state="begin")
            self._show(
                make_text_page(tr("Paused"), tr("The clock is stopped."), tr("Continue"), self.unpause)
            )

    def unpause(self) -> None:
        self.sitting.writer.add("pause", state="end")
        self._start()

    def ask_done(self) -> None:
        """Ask whether the task is done; the clock runs on meanwhile."""
        self._show(
            make_question_page(
                tr("Are you done?"),
                tr("You cannot come back to this part."),
                tr("Yes, done"),
                lambda: self.finish_task("done"),
                tr("No, continue"),
                self._back_to_work,
            )
        )

    def _back_to_work(self) -> None:
        self._elapsed = self.elapsed
        self._start()

    def finish_task(self, why: Literal["done", "time"]) -> None:
        """Keep what was made, and go on."""
        document = self.shell.document
        self._stop()
        try:
            document.finish_merging()
            self.recorder.boundary()
            document.save()
            self.sitting.keep(why)
        except FileError as error:
            self._show(
                make_question_page(
                    tr("Your work could not be saved"),
                    tr_error(error),
                    tr("Try again"),
                    lambda: self.finish_task(why),
                    tr("Close the window"),
                    self.shell.widget.close,
                )
            )
            return
        self.bar.hide()
        if why == "time":
            self._show(make_text_page(tr("Time is up"), tr("Your work is saved."), tr("Continue"), self.show))
        else:
            self.show()

    def write_note(self) -> None:
        """Let something be written down."""
        from app.features.study.study_note import NoteDialog

        dialog = NoteDialog(self.experimenter, self.shell.widget)
        dialog.noted.connect(lambda words, by: self.recorder.tell("note", words=words, by=by))
        dialog.open()


def describe_computer() -> dict[str, Any]:
    """Return what the log says about the computer; nothing that names it or its user."""
    screen = QApplication.primaryScreen()
    size, ratio = screen.size(), screen.devicePixelRatio()
    return {
        "os": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
        "screen": {"width": size.width(), "height": size.height(), "ratio": ratio},
    }
