"""The dialog that writes a performance: as a video with sound, a contact sheet, or plain motion."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSettings, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.jobs import Jobs, WindowJob
from app.project.reveal import open_folder
from app.stage.performance import StagePerformance
from app.stage.render_process import SUFFIXES, RenderOrder, write_rendering
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_noop
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.common.studio import find_start_folder
from metagraph.graph import requests
from metagraph.graph.conversation.model import Conversation
from preview.looks import BACKDROPS, LIGHTS, look_name

LOOKS = (  # what the preview calls its lights and backgrounds
    tr_noop("Studio"),
    tr_noop("Day"),
    tr_noop("Evening, from the side"),
    tr_noop("Rim light, from behind"),
    tr_noop("Flat"),
    tr_noop("Stage, as in the window"),
    tr_noop("Sky"),
    tr_noop("Dusk"),
    tr_noop("Warm paper"),
    tr_noop("Neutral grey, for recording"),
    tr_noop("White"),
    tr_noop("Black"),
    tr_noop("Green, for keying"),
)
TRANSPARENT = "transparent"  # instead of a background
VIDEOS = (".mp4", ".mov", ".webm")
SIZES = ((640, 360), (960, 540), (1280, 720), (1920, 1080))


class RenderDialog(QDialog):
    """written: the file is there."""

    written = Signal(str)

    def __init__(
        self, performance: StagePerformance, session: StageSession, jobs: Jobs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.performance, self.session, self.jobs = performance, session, jobs
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)  # what runs goes on; the status bar shows it
        kept: requests.Performance | Conversation | None = performance.requests.kept
        if performance.conversation is not None:
            kept = performance.document.project.conversations[performance.conversation]
        self.setWindowTitle(
            tr("Write '{name}'", name=kept.name) if kept is not None else tr("Write the performance")
        )
        self.setMinimumWidth(520)
        layout = QVBoxLayout(self)
        self.form = QFormLayout()
        layout.addLayout(self.form)
        self._add_file(kept.name if kept is not None else performance.document.project.name)
        self._add_part(kept.length if kept is not None else min(30.0, performance.length))
        self._add_pictures()
        self._add_looks()
        self._add_end(layout)
        self._suffixed()

    def _add_file(self, name: str) -> None:
        """Add what kind of file is written, and where. name: of the file."""
        self.kind = ComboBox(self)
        for suffix, words in SUFFIXES.items():
            self.kind.addItem(words, suffix)
        self.kind.activated.connect(lambda _: self._suffixed())
        self.form.addRow(tr("Format"), self.kind)
        row = QHBoxLayout()
        folder = find_start_folder(self.performance.document.folder)
        self.file = QLineEdit(str(folder / f"{name}.mp4"), self)
        self.file.setAccessibleName(tr("File"))
        browse = QPushButton(tr("Choose…"), self, autoDefault=False)
        browse.clicked.connect(self._browse)
        row.addWidget(self.file, 1)
        row.addWidget(browse)
        self.form.addRow(tr("File"), row)

    def _add_part(self, length: float) -> None:
        """Add how much is written. length: in seconds."""
        self.seconds = DoubleSpinBox(self, minimum=0.1, maximum=3600, decimals=1, suffix=" s")
        self.seconds.setValue(length)
        self.part = ComboBox(self, toolTip=tr("Where it begins, or the loop range of the timeline"))
        self.part.addItem(tr("From the start"), 0.0)
        transport = self.session.transport
        if transport.show == "plan" and transport.seconds >= 0.1:
            now = round(transport.seconds, 2)
            self.part.addItem(tr("From the playhead, {start:.2f} s", start=now), now)
        self.range = self.performance.timeline.range
        if self.range is not None:
            self.part.addItem(
                tr("Loop range, {start:.2f} to {end:.2f} s", start=self.range[0], end=self.range[1]),
                self.range,
            )
            self.part.setCurrentIndex(self.part.count() - 1)
        self.part.activated.connect(lambda _: self._suffixed())
        self.form.addRow(tr("Range"), self.part)
        self.form.addRow(tr("Length"), self.seconds)

    def _add_pictures(self) -> None:
        """Add how large and how many they are."""
        self.size_box = ComboBox(self)
        for width, height in SIZES:
            self.size_box.addItem(f"{width} × {height}", (width, height))
        self.size_box.setCurrentIndex(int(str(QSettings().value("render/size", 2))))
        self.form.addRow(tr("Size"), self.size_box)
        self.fps = ComboBox(self)
        for fps in (24.0, 25.0, 30.0, 60.0):
            self.fps.addItem(tr("{fps:g} fps", fps=fps), fps)
        self.fps.setCurrentIndex(2)
        self.form.addRow(tr("Frame rate"), self.fps)

    def _add_looks(self) -> None:
        """Add what is seen beside the character."""
        watched = self.session.watch.now
        self.light, self.background = ComboBox(self), ComboBox(self)
        for box, choices, now in (
            (self.light, LIGHTS, watched.light),
            (self.background, BACKDROPS, watched.background),
        ):
            for name in choices:
                box.addItem(tr(look_name(name)), name)
            box.setCurrentIndex(box.findData(now))
        self.background.addItem(tr("Transparent"), TRANSPARENT)
        if self.performance.document.project.backdrop.kind:
            self.background.insertItem(0, tr("The project's"), None)
            self.background.setCurrentIndex(0)
        self._opaque = self.background.currentIndex()  # what is chosen where nothing can be transparent
        self.form.addRow(tr("Light"), self.light)
        self.form.addRow(tr("Background"), self.background)
        self.blurred = QCheckBox(tr("Blur what is nearer or farther than the face"), self)
        self.form.addRow(tr("Depth of field"), self.blurred)
        self.background.currentIndexChanged.connect(self._offer_blur)
        self.captions = QCheckBox(tr("Show the spoken words at the bottom of the picture"), self)
        self.captions.setChecked(self.performance.timeline.now.captions)
        self.form.addRow(tr("Captions"), self.captions)
        self.cuts = QCheckBox(tr("Use the cuts of the camera lane"), self)
        self.cuts.setChecked(True)
        self.form.addRow(tr("Camera"), self.cuts)

    def _add_end(self, layout: QVBoxLayout) -> None:
        """Add what is said of it, and the buttons."""
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        layout.addWidget(self.words)
        self.progress = QProgressBar(self)
        self.progress.hide()
        layout.addWidget(self.progress)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.show_button = self.buttons.addButton(tr("Open folder"), QDialogButtonBox.ButtonRole.ActionRole)
        self.show_button.setEnabled(False)
        self.show_button.clicked.connect(self._show_folder)
        self.go = self.buttons.addButton(tr("Write"), QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.go)
        self.buttons.accepted.connect(self._write)
        self.buttons.rejected.connect(self.reject)
        layout.addWidget(self.buttons)

    def _show_folder(self) -> None:
        folder = Path(self.file.text()).parent
        if not open_folder(folder):
            self.words.setText(tr("No program opened. The folder is {folder}.").format(folder=folder))

    def _suffixed(self) -> None:
        """Show what belongs to the chosen kind of file."""
        suffix = self.kind.currentData()
        self.file.setText(str(Path(self.file.text()).with_suffix(suffix)))
        drawn = suffix in (*VIDEOS, ".png")
        self._offer_transparency(suffix)
        for row in (self.size_box, self.light, self.background, self.blurred):
            self.form.setRowVisible(row, drawn)
        self.form.setRowVisible(self.seconds, isinstance(self.part.currentData(), float))
        self.form.setRowVisible(self.fps, suffix != ".png")
        self.form.setRowVisible(self.captions, drawn)
        self.form.setRowVisible(self.cuts, drawn and bool(self.performance.timeline.now.cuts))
        self.words.setText({
            ".mp4": tr("H.264 video with the sound of the lines."),
            ".mov": tr("For editing programs: large, with the sound of the lines."),
            ".webm": tr("For web pages: small, with the sound of the lines."),
            ".png": tr("24 pictures of the performance on one sheet."),
            ".glb": tr("The motion of every joint, with the character mesh, for any 3D program."),
            ".bvh": tr("The motion of every joint, without a mesh."),
        }[suffix])  # fmt: skip

    def _offer_transparency(self, suffix: str) -> None:
        """Choose a transparent background with files that are for that; MP4 has none."""
        place = self.background.findData(TRANSPARENT)
        held = self.background.currentData() == TRANSPARENT
        self.background.setItemData(place, suffix != ".mp4", Qt.ItemDataRole.UserRole - 1)
        if suffix in (".mov", ".webm") and not held:
            self._opaque = self.background.currentIndex()
            self.background.setCurrentIndex(place)
        elif suffix == ".mp4" and held:
            self.background.setCurrentIndex(self._opaque)

    def _offer_blur(self) -> None:
        """Offer to blur where there is something behind the character."""
        self.blurred.setEnabled(self.background.currentData() != TRANSPARENT)

    def _browse(self) -> None:
        suffix = self.kind.currentData()
        name, _ = QFileDialog.getSaveFileName(
            self, tr("Write the performance"), self.file.text(), f"{SUFFIXES[suffix]} (*{suffix})"
        )
        if name:
            self.file.setText(str(Path(name).with_suffix(suffix)))

    def _write(self) -> None:
        document = self.performance.document
        clear = self.background.currentData() == TRANSPARENT
        part = self.part.currentData()
        start, end = (part, part + self.seconds.value()) if isinstance(part, float) else part
        wanted = RenderOrder(
            Path(self.file.text()),
            self.session.onstage.performance,
            end - start,
            self.size_box.currentData(),
            self.fps.currentData(),
            self.session.look.name,
            self.performance.conversation,
            self.light.currentData(),
            None if clear else self.background.currentData(),
            start,
            self.captions.isChecked(),
            self.cuts.isChecked(),
            self.session.watch.now.sticks,
            self.session.onstage.improvised,
            self.session.watch.now.seat,
            clear,
            self.blurred.isChecked() and not clear,
        )
        QSettings().setValue("render/size", self.size_box.currentIndex())
        project, folder = document.project, document.folder or Path()
        self.go.setEnabled(False)
        self.progress.setRange(0, 0)
        self.progress.show()

        def work(job: WindowJob) -> Path:
            return write_rendering(project, folder, wanted, job)

        job = self.jobs.start(tr("Writing the performance"), work, self._done, self._failed, stands=True)
        job.progress.connect(self._tell)
        job.ended.connect(self._ended)

    def _tell(self, done: int, total: int, words: str) -> None:
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def _ended(self) -> None:
        self.progress.hide()
        self.go.setEnabled(True)

    def _done(self, path: Path) -> None:
        self.show_button.setEnabled(True)
        self.words.setText(
            tr("Written: {name} ({size:.1f} MB).", name=path.name, size=path.stat().st_size / 1e6)
        )
        self.written.emit(str(path))

    def _failed(self, error: Exception) -> None:
        self.words.setText(tr_error(error))
