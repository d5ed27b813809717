"""Mimicking a recording of keypoints: what was read, how it is to be mimicked, and the requests that become
of it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QMessageBox,
    QPushButton,
    QVBoxLayout,
)

from app.features.mimic.filmed_keypoints import film_person, read_video
from app.look.theme import strengthen
from app.project.jobs import WindowJob
from app.translation import format_number, tr, tr_error, tr_noop, tr_plural
from metagraph.common.studio import find_start_folder
from metagraph.formats.filmed.video import VIDEO_ENDINGS, is_video
from metagraph.formats.keypoints.reader import read_keypoints
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.requests import Performance
from metagraph.mimicry.keypoint_layouts import KeypointTrack
from metagraph.mimicry.performing import REST, Mimicry, mimic_performance, place_requests

if TYPE_CHECKING:
    from app.shell.context import Shell

FILTER = tr_noop(
    "Videos, keypoints, markers ({videos} *.json *.jsonl *.trc *.c3d);;Videos ({videos});;All files (*)"
)
SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "keypoints" / "conversation.openpose.json"
_NUMBERED = re.compile(r"_\d+_keypoints\.json$", re.I)


class MimicDialog(QDialog):
    """How a recording is mimicked; `accept` makes requests of it, in the performance on stage or a new
    one.
    """

    def __init__(self, shell: Shell, keypoints: KeypointTrack, name: str) -> None:
        super().__init__(shell.widget)
        self.shell, self.keypoints, self.name = shell, keypoints, name
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Mimic a person"))
        self.setMinimumWidth(480)
        layout = QVBoxLayout(self)
        flat = keypoints.judged.dims == 2
        deep = tr("without depth") if flat else tr("with depth")
        frames = tr_plural("{count:,} frame", "{count:,} frames", len(keypoints))
        facts = QLabel(f"{name}: {frames}, {format_number(keypoints.seconds, '.1f')} s, {deep}", self)
        facts.setWordWrap(True)
        layout.addWidget(facts)
        for note in keypoints.notes:
            layout.addWidget(self._dim(f"{note[:1].upper()}{note[1:]}."))
        form = QFormLayout()
        layout.addLayout(form)
        self.mirror = self._box(
            tr("Mirror"),
            tr(
                "The character moves its right side when the person moves the left, like somebody face "
                "to face"
            ),
            True,
        )
        form.addRow(tr("Sides"), self.mirror)
        row = QHBoxLayout()
        self.layers = {
            layer: self._box(
                tr(layer.capitalize()),
                tr("The {layer} layer follows the stances of the person", layer=tr(layer)),
                True,
            )
            for layer in LAYERS
        }
        project = shell.document.project
        for layer, box in self.layers.items():
            box.setEnabled(bool(project.graphs[layer].stances))
            box.setChecked(box.isEnabled())
            box.toggled.connect(lambda _: self._changed())
            row.addWidget(box)
        row.addStretch(1)
        form.addRow(tr("Layers"), row)
        self.gaze = self._box(
            tr("Look where the person looks"),
            tr("The character looks in the direction in which the person's head is turned"),
            False,
        )
        form.addRow(tr("Gaze"), self.gaze)
        kept = shell.stage.performance.requests.kept
        into = (
            tr(
                "The detected stances are added to '{name}'. Gestures and fidgets continue as before.",
                name=kept.name,
            )
            if kept is not None
            else tr("The detected stances become a new performance. Gestures and fidgets continue as before.")
        )
        layout.addWidget(self._dim(into))
        if flat:
            layout.addWidget(self._dim(tr("Without depth, leaning towards the camera cannot be detected.")))
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        buttons.button(QDialogButtonBox.StandardButton.Cancel).setIcon(QIcon())
        self.go = QPushButton(tr("Mimic"), self)
        strengthen(self.go)
        buttons.addButton(self.go, QDialogButtonBox.ButtonRole.AcceptRole)
        self.go.setDefault(True)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout.addWidget(buttons)

    def _dim(self, words: str) -> QLabel:
        label = QLabel(words, self, wordWrap=True)
        label.setProperty("dim", True)
        return label

    def _box(self, words: str, tip: str, on: bool) -> QCheckBox:
        box = QCheckBox(words, self)
        box.setToolTip(tip)
        box.setChecked(on)
        return box

    def _changed(self) -> None:
        self.go.setEnabled(any(box.isChecked() for box in self.layers.values()))

    def accept(self) -> None:
        """Look through the recording on a thread, then make requests of what was seen."""
        shell, keypoints, name = self.shell, self.keypoints, self.name
        project, stage = shell.document.project, shell.stage.session.onstage.performance
        kept = shell.stage.performance.requests.kept
        into = kept or Performance(name=Path(name).stem, length=round(keypoints.seconds + REST, 3))
        mirror, gaze = self.mirror.isChecked(), self.gaze.isChecked()
        layers = [layer for layer, box in self.layers.items() if box.isChecked()]

        def work(job: WindowJob) -> Mimicry:
            def tell(done: int, total: int) -> None:
                job.tell(done, total, name)
                if job.cancelled:
                    raise RuntimeError("stopped")

            return mimic_performance(project, keypoints, mirror, layers, gaze, into, tell)

        def failed(error: Exception) -> None:
            QMessageBox.warning(shell.widget, tr("Not mimicked"), tr_error(error))

        def done(found: Mimicry) -> None:
            if shell.document.project.skeleton is project.skeleton:
                _taken(shell, found, stage if kept is not None else None)
            else:
                shell.tell(
                    tr("The result was discarded because another project was opened. Mimic the file again.")
                )

        shell.jobs.start(tr("Mimicking {name}", name=name), work, done, failed)
        super().accept()


def _taken(shell: Shell, found: Mimicry, stage: str | None) -> None:
    """Add what was asked to the performance it was planned for, or keep it as a new one."""
    made = stage

    def edit(project: Project) -> Project:
        nonlocal made
        timed = place_requests(project, found.performance)
        if stage is not None and stage in project.performances:
            there = {ask.id for ask in project.performances[stage].asks}
            asks = (*project.performances[stage].asks, *(ask for ask in timed.asks if ask.id not in there))
            return performance_edits.change_performance(
                project, stage, asks=asks, length=max(timed.length, project.performances[stage].length)
            )
        project, made = performance_edits.add_performance(project, timed)
        return project

    if not found.sightings:
        shell.tell(tr("No stance of the project was recognised in the keypoints."))
        return
    shell.document.edit(tr("Mimic a person"), edit)
    shell.stage.session.onstage.set_performance(made)
    shell.stage.session.transport.show_plan()
    shell.tell(
        tr(
            "Recognised {stances}. The requests are in the performance below.",
            stances=tr_plural("{count:,} stance", "{count:,} stances", len(found.sightings)),
        )
    )


def pick_recording(file: Path) -> Path:
    """Return what to read for a file that was chosen: its folder where it is one of many frames."""
    if (
        _NUMBERED.search(file.name)
        and sum(1 for other in file.parent.iterdir() if _NUMBERED.search(other.name)) > 1
    ):
        return file.parent
    return file


def open_keypoints(shell: Shell, path: str | Path | None = None) -> None:
    """Ask for keypoints or a video (or take `path`), read them on a thread and open the dialog."""
    if not path:
        start = str(QSettings().value("mimic/folder") or find_start_folder(shell.document.folder))
        kinds = tr(FILTER, videos=" ".join(f"*{ending}" for ending in VIDEO_ENDINGS))
        path, _ = QFileDialog.getOpenFileName(shell.widget, tr("Mimic a person"), start, kinds)
        if not path:
            return
        QSettings().setValue("mimic/folder", str(Path(path).parent))
    file = pick_recording(Path(path))

    def show(keypoints: KeypointTrack) -> None:
        MimicDialog(shell, keypoints, file.name).open()

    if is_video(file):
        read_video(shell, file, show)
        return

    def failed(error: Exception) -> None:
        QMessageBox.warning(shell.widget, tr("Not read"), tr_error(error))

    shell.jobs.start(tr("Reading {name}", name=file.name), lambda _: read_keypoints(file), show, failed)


def open_camera(shell: Shell) -> None:
    """Film the person before a camera, then open the dialog."""
    film_person(shell, lambda keypoints: MimicDialog(shell, keypoints, tr("Camera")).open())
