"""Filming the person before a camera, until the user stops it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSettings, Qt, Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QVBoxLayout,
)

from app.look.theme import strengthen
from app.project.jobs import WindowJob
from app.translation import format_number, tr, tr_error
from metagraph.formats.filmed.film import film_camera
from metagraph.mimicry.keypoint_layouts import KeypointTrack

if TYPE_CHECKING:
    from app.shell.context import Shell

USUAL = "0"


class CameraDialog(QDialog):
    """Names the camera, films and stops; `show` gets the keypoints of the person who was filmed."""

    filmed = Signal(float)  # seconds, from the thread that films

    def __init__(self, shell: Shell, show: Callable[[KeypointTrack], None]) -> None:
        super().__init__(shell.widget)
        self.shell, self._show = shell, show
        self._filming = self._stopped = False
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Mimic from camera"))
        self.setMinimumWidth(420)
        layout = QVBoxLayout(self)
        form = QFormLayout()
        layout.addLayout(form)
        self.device = QLineEdit(str(QSettings().value("mimic/camera") or USUAL), self)
        self.device.setToolTip(tr("A number from 0, or the name that the system has for the camera"))
        form.addRow(tr("Camera"), self.device)
        told = tr("Stand back until your hips are in the picture. Nothing is stored or sent.")
        self.words = QLabel(told, self, wordWrap=True)
        self.words.setProperty("dim", True)
        layout.addWidget(self.words)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        buttons.button(QDialogButtonBox.StandardButton.Cancel).setIcon(QIcon())
        self.go = QPushButton(tr("Film"), self)
        strengthen(self.go)
        buttons.addButton(self.go, QDialogButtonBox.ButtonRole.ActionRole)
        self.go.setDefault(True)
        self.go.clicked.connect(self._go)
        buttons.rejected.connect(self.reject)
        layout.addWidget(buttons)
        self.filmed.connect(self._tell)

    def _go(self) -> None:
        """Begin to film, or stop."""
        if self._filming:
            self._stopped = True
            self.go.setEnabled(False)
            return
        self._filming, device = True, self.device.text().strip() or USUAL
        QSettings().setValue("mimic/camera", device)
        self.device.setEnabled(False)
        self.go.setText(tr("Stop filming"))

        def work(job: WindowJob) -> KeypointTrack:
            def is_stopped() -> bool:
                return self._stopped or job.cancelled

            return film_camera(device, None, self.filmed.emit, is_stopped).track

        self._job = self.shell.jobs.start(tr("Filming"), work, self._done, self._failed)

    def _tell(self, seconds: float) -> None:
        self.words.setText(tr("{seconds} s filmed", seconds=format_number(seconds, ".1f")))

    def _done(self, keypoints: KeypointTrack) -> None:
        super().accept()
        self._show(keypoints)

    def _failed(self, error: Exception) -> None:
        self.reject()
        QMessageBox.warning(self.shell.widget, tr("Not read"), tr_error(error))

    def reject(self) -> None:
        """Let go of the camera; what was filmed is dropped."""
        if self._filming:
            self._stopped = True
            self._job.cancel()
        super().reject()
