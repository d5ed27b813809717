"""Learning from takes: which there are and what is wrong with them, what is trained for how long, and how it
goes, with somebody who moves as the model would by now.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QProgressBar,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.features.generation.begun_row import BegunRow
from app.features.generation.generation_jobs import KINDS, TakeListing, as_sentence, list_takes
from app.features.generation.page import GenerationPage
from app.features.generation.sample_preview import SamplePreview
from app.features.generation.training_plots import RATIOS, TrainingPlots
from app.features.generation.training_run import (
    Begin,
    Hear,
    Process,
    TrainingRun,
    continue_training,
    describe_event,
    describe_goal,
    keep_checkpoint,
)
from app.look.theme import strengthen
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.shell.extras_dialog import ExtrasOffer
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_phrase, tr_plural
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, SpinBox
from metagraph.common.studio import find_start_folder
from metagraph.generation.standing import Standing, is_busy
from metagraph.generation.stored import SUFFIX
from metagraph.generation.train_plan import PLAN, find_training_folder, read_planned_takes

TIPS = make_lazy_texts(
    lambda: (
        ("matching", tr("Follows the speech best for its training time. Start with 15 minutes.")),
        (
            "flow-vae",
            tr("As in the paper: a learned code of poses with a flow model. Needs longer training."),
        ),
        ("moglow", tr("A comparison from the paper: a flow model on the poses themselves")),
        ("cvae", tr("Another comparison from the paper: moves only a little")),
    )
)
SIZES = make_lazy_texts(
    lambda: (("small", tr("small, for this computer")), ("paper", tr("as in the paper, for a graphics card")))
)
HEADS = make_lazy_texts(lambda: (tr("Take"), tr("Length"), tr("Speech"), tr("Notes")))


def describe_missing_training() -> str | None:
    """Return in words what must be installed for training, or None if nothing is missing."""
    from metagraph.generation import train_process

    return train_process.find_missing_tools()


class LearnPage(GenerationPage):
    """trained: a model's file is there. begin: starts a training's process; replaced in tests."""

    trained = Signal(object)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        jobs: Jobs,
        begin: Begin,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs, self.begin = document, session, jobs, begin
        self.folders: list[Path] = []
        self.listing = TakeListing()
        self.run: TrainingRun | None = None
        self._job: WindowJob | None = None
        columns = QHBoxLayout(self)
        columns.setContentsMargins(0, 8, 0, 0)
        columns.setSpacing(18)
        columns.addLayout(self._left(), 5)
        columns.addLayout(self._right(), 6)
        self._show_note()
        self.fill()

    # --- building

    def _left(self) -> QVBoxLayout:
        box = QVBoxLayout()
        box.setSpacing(6)
        self.title = self.heading(tr("Takes"))
        box.addWidget(self.title)
        row = QHBoxLayout()
        self.add = self.button(
            tr("Add folder…"),
            tr("Choose a folder of clips with a sound file for each: talk.bvh and talk.wav"),
            self.choose_folder,
        )
        self.clear = self.button(tr("Clear"), tr("Remove all folders from the list"), self.forget)
        row.addWidget(self.add)
        row.addWidget(self.clear)
        row.addStretch(1)
        box.addLayout(row)
        self.table = QTableWidget(0, len(HEADS), self)
        self.table.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.table.setHorizontalHeaderLabels(list(HEADS))
        self.table.setAccessibleName(tr("Takes to learn from"))
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setWordWrap(False)
        self.table.setSelectionBehavior(QTableWidget.SelectionBehavior.SelectRows)
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        header = self.table.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setHighlightSections(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(3, QHeaderView.ResizeMode.Stretch)
        self.table.itemSelectionChanged.connect(self._show_note)
        box.addWidget(self.table, 1)
        self.note = QLabel(self, wordWrap=True)
        self.note.setProperty("dim", True)
        self.note.setMinimumHeight(3 * self.note.fontMetrics().lineSpacing())
        self.note.setAlignment(Qt.AlignmentFlag.AlignTop)
        box.addWidget(self.note)
        return box

    def _right(self) -> QVBoxLayout:
        box = QVBoxLayout()
        box.setSpacing(6)
        box.addWidget(self.heading(tr("Model")))
        self.kind, self.how_large = ComboBox(self), ComboBox(self)
        self.kind.setAccessibleName(tr("Kind of model"))
        self.how_large.setAccessibleName(tr("Size"))
        for n, (kind, tip) in enumerate(TIPS):
            self.kind.addItem(KINDS[kind], kind)
            self.kind.setItemData(n, tip, Qt.ItemDataRole.ToolTipRole)
        for size, words in SIZES:
            self.how_large.addItem(words, size)
        self.minutes = SpinBox(self, minimum=1, maximum=10000, value=15)
        self.minutes.setSuffix(" min")
        self.minutes.setAccessibleName(tr("Minutes"))
        self.name = QLineEdit(tr("new model"), self)
        self.name.setAccessibleName(tr("Name of the model"))
        row = QHBoxLayout()
        for words, field in (
            (tr("Kind"), self.kind),
            (tr("Size"), self.how_large),
            (tr("for"), self.minutes),
        ):
            row.addWidget(QLabel(words, self))
            row.addWidget(field)
        row.addStretch(1)
        box.addLayout(row)
        row = QHBoxLayout()
        self.train = self.button(tr("Train"), tr("Train in the background, while you work"), self.start)
        strengthen(self.train)
        self.stop = self.button(
            tr("Stop and save"), tr("Stop now and save the model as trained so far"), self.end
        )
        row.addWidget(QLabel(tr("Name"), self))
        row.addWidget(self.name, 1)
        row.addWidget(self.train)
        row.addWidget(self.stop)
        box.addLayout(row)
        self.begun = BegunRow(self)
        self.begun.resumed.connect(lambda one: self._go_on(one, False))
        self.begun.kept.connect(lambda one: self._go_on(one, True))
        box.addWidget(self.begun)
        self.needs = QLabel(tr_phrase(describe_missing_training() or ""), self, wordWrap=True)
        self.needs.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.needs.setVisible(bool(self.needs.text()))
        box.addWidget(self.needs)
        self.extras = ExtrasOffer(self.jobs, self, self._look_for_tools)
        self.extras.follow(describe_missing_training())
        box.addWidget(self.extras, 0, Qt.AlignmentFlag.AlignLeft)
        self.plots = TrainingPlots(self.session, self)
        box.addWidget(self.plots, 2)
        self.preview = SamplePreview(self)
        box.addWidget(self.preview, 3)
        row = QHBoxLayout()
        self.progress = make_widget(QProgressBar, self, textVisible=False)
        self.progress.setRange(0, 1000)
        self.stands = QLabel(self)
        self.stands.setProperty("dim", True)
        row.addWidget(self.progress, 1)
        row.addWidget(self.stands)
        box.addLayout(row)
        self.progress.hide()
        return box

    def _look_for_tools(self) -> None:
        """Show whether training is possible now."""
        missing = describe_missing_training()
        self.needs.setText(tr_phrase(missing or ""))
        self.needs.setVisible(missing is not None)
        self.extras.follow(missing)
        self._enable()

    # --- takes

    def choose_folder(self) -> None:
        start = str(self.folders[-1] if self.folders else find_start_folder(self.document.folder))
        name = QFileDialog.getExistingDirectory(self, tr("A folder of takes"), start)
        if name:
            self.look_through([*self.folders, Path(name)])

    def forget(self) -> None:
        self.folders = []
        self._listed(TakeListing())

    def look_through(self, folders: list[Path]) -> None:
        """List the takes of folders; a second look waits for the first."""
        if self._job is not None or self.run is not None:
            return
        self.folders = list(dict.fromkeys(folders))
        project, chosen = self.document.project, list(self.folders)
        self.said.emit(tr("Reading takes…"))
        job = self.jobs.start(
            tr("Reading takes"),
            lambda job: list_takes(chosen, project, job.tell, lambda: job.cancelled),
            self._listed,
            self._failed,
        )
        self._job = job
        job.progress.connect(self._tell_reading)
        job.ended.connect(self._read)
        self._enable()

    def _tell_reading(self, done: int, total: int, _: str) -> None:
        self.said.emit(tr("Reading takes: {done} of {total}", done=done, total=total))

    def _read(self) -> None:
        self._job = None
        self._enable()

    def _listed(self, listing: TakeListing) -> None:
        self.listing = listing
        rows = sorted(listing.rows, key=lambda r: not r.bad)
        self.table.setRowCount(len(rows))
        for n, take in enumerate(rows):
            length = f"{take.seconds:.0f} s" if not take.bad else tr("skipped")
            for column, text in enumerate((take.name, length, take.heard, take.wrong)):
                item = QTableWidgetItem(text)
                item.setToolTip(text)
                self.table.setItem(n, column, item)
        self.table.setColumnWidth(0, min(220, self.table.columnWidth(0)))
        good, bad = sum(not r.bad for r in rows), sum(r.bad for r in rows)
        self.title.setText(
            tr("Takes · {good}, {minutes:.1f} min", good=good, minutes=listing.seconds / 60)
            if rows
            else tr("Takes")
        )
        left = (
            tr(
                " {bad} skipped: the first rows say why.",
                bad=tr_plural("{count:,} clip", "{count:,} clips", bad),
            )
            if bad
            else ""
        )
        short = (
            tr(" That is not much: use an hour or more for better results.")
            if good and listing.seconds < 1800
            else ""
        )
        self.said.emit(
            tr(
                "{good} can be used for training.{left}{short}",
                good=tr_plural("{count:,} take", "{count:,} takes", good),
                left=left,
                short=short,
            )
            if rows
            else ""
        )
        self._show_note()
        self._enable()

    def _show_note(self) -> None:
        """Say what there is to know of the selected take, as a whole."""
        rows = {i.row() for i in self.table.selectedItems()}
        item = self.table.item(min(rows), 3) if rows else None
        if item is None:
            empty = tr(
                "Each clip needs a sound file with the same name beside it: talk.bvh and talk.wav. Put "
                "the speaker's own voice in the first channel and the partner's in the second. "
                "Transcripts (ELAN, TextGrid …) help."
            )
            self.note.setText("" if self.table.rowCount() else empty)
            return
        self.note.setText(item.text() or tr("No problems found."))

    # --- training

    def fill(self) -> None:
        """List the trainings that were begun before, beside the project."""
        from metagraph.generation.offered import FOLDER
        from metagraph.generation.standing import find_begun_trainings

        folder = self.document.folder
        self.begun.show_begun(
            find_begun_trainings(folder / FOLDER) if folder is not None and self.run is None else ()
        )
        self._enable()

    @property
    def busy(self) -> bool:
        """Whether takes are looked through or a training is prepared."""
        return self._job is not None

    def _enable(self) -> None:
        busy, training = self.busy, self.run is not None
        ready = self.listing.batch is not None and describe_missing_training() is None
        for widget in (self.add, self.clear, self.kind, self.how_large, self.minutes, self.name):
            widget.setEnabled(not busy and not training)
        self.begun.setEnabled(not busy and not training and describe_missing_training() is None)
        self.train.setEnabled(ready and not busy and not training)
        self.train.setVisible(not training)
        self.stop.setVisible(training)
        self.stop.setEnabled(training and self.run is not None and not self.run.stopping)

    def start(self) -> None:
        """Begin to train, in a process of its own."""
        from metagraph.generation.offered import FOLDER

        folder = self.document.folder
        if folder is None:
            self.said.emit(tr("Save the project first. The model is saved as a file beside it."))
            return
        if self.listing.batch is None or self.run is not None or self._job is not None:
            return
        name = self.name.text().strip().strip(".") or tr("new model")
        if any(c in name for c in '/\\:*?"<>|'):
            self.said.emit(
                tr('The name of the model is a file name, so it cannot contain / \\ : * ? " < > |.')
            )
            return
        out = folder / FOLDER / f"{name}{SUFFIX}"
        if out.exists():
            self.said.emit(
                tr(
                    "A model '{name}' already exists. Choose another name, so that it is not overwritten.",
                    name=name,
                )
            )
            return
        if (find_training_folder(out) / PLAN).exists():
            self.said.emit(
                tr(
                    "There is an unfinished training of '{name}'. Continue it, or choose another name.",
                    name=name,
                )
            )
            return
        wish = {
            "kind": self.kind.currentData(),
            "size": self.how_large.currentData(),
            "minutes": float(self.minutes.value()),
        }
        batch, begin = self.listing.batch, self.begin

        def work(hear: Hear) -> tuple[Process, Any, Any]:
            out.parent.mkdir(parents=True, exist_ok=True)
            return begin(batch, wish, out, hear), batch.rig, batch.takes

        self._prepare(work)

    def _go_on(self, standing: Standing, as_it_is: bool) -> None:
        """Go on with a training that was begun, or make a model of what it has."""
        if self.run is not None or self._job is not None:
            return
        folder, minutes = find_training_folder(standing.out), float(self.minutes.value())
        if is_busy(folder):
            self.said.emit(
                tr(
                    "Another process is already training '{model}'. Wait until it has finished.",
                    model=standing.out.stem,
                )
            )
            return

        def work(hear: Hear) -> tuple[Process, Any, Any]:
            takes, _ = read_planned_takes(folder, standing.plan)
            process = (
                keep_checkpoint(standing, hear) if as_it_is else continue_training(standing, minutes, hear)
            )
            return process, standing.plan.skeleton.rig(), takes

        self._prepare(work)

    def _prepare(self, work: Callable[[Hear], tuple[Process, Any, Any]]) -> None:
        """Do what a training needs on a job's thread, and follow the process that comes of it."""
        said: deque[Any] = deque()
        self.said.emit(tr("Preparing…"))
        self.plots.clear()
        job = self.jobs.start(
            tr("Preparing the training"),
            lambda _: work(said.append),
            lambda made: self._started(said, *made),
            self._failed,
        )
        self._job = job
        job.ended.connect(self._read)
        self._enable()

    def _failed(self, error: Exception) -> None:
        self.said.emit(as_sentence(error))

    def _started(self, said: deque[Any], process: Process, rig: Any, takes: Sequence[Any]) -> None:
        self.run = TrainingRun(process, said, self)
        self.run.moved.connect(self._moved)
        self.run.ended.connect(self._ended)
        self.progress.setValue(0)
        self.stands.setText("")
        self.progress.show()
        self.said.emit(tr("Training in the background. You can continue working."))
        self.preview.begin(rig, takes)
        self.fill()

    def _moved(self, event: Any) -> None:
        """Show what a training's event says."""
        ratios = {words: event.statistics[name] for name, words in RATIOS.items() if name in event.statistics}
        words, value = describe_goal(event)
        if words or ratios:
            self.plots.add(event.minutes, {words: value} if words else {}, ratios)
        if event.minutes > 0:
            self.progress.setValue(round(1000 * event.share))
            self.stands.setText(describe_event(event))
        if event.landmarks:
            self.preview.show_sample(event.landmarks)
        if event.event == "finish":
            self.said.emit(tr("Measuring and saving the model…"))
        if event.event == "note" and event.text:
            self.said.emit(event.text)

    def end(self) -> None:
        """Stop soon, and keep the model as it is."""
        if self.run is not None:
            self.run.stop()
            self.said.emit(tr("Stopping and saving the model…"))
            self._enable()

    def _ended(self, model: Path | None, error: str) -> None:
        self.run = None
        self.progress.hide()
        if model is None:
            self.said.emit(error or tr("The training ended without a model."))
        else:
            self.said.emit(
                tr(
                    "The model '{model}' is saved in {folder}. Use it under Generate.",
                    model=model.stem,
                    folder=model.parent.name,
                )
            )
            self.trained.emit(model)
        self.fill()

    def close_down(self) -> None:
        """The window closes: nothing goes on unseen."""
        if self._job is not None:
            self._job.cancel()
        if self.run is not None:
            self.run.leave()
        self.preview.still()
