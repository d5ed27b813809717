"""Keypoints of a video for the window: installs the estimator if the user agrees, looks at the pictures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QMessageBox

from app.project.jobs import WindowJob
from app.translation import tr, tr_error, tr_phrase
from metagraph.common.extra_steps import install_extra
from metagraph.common.extras import EXTRAS, is_installed
from metagraph.formats.filmed.estimator import EXTRA
from metagraph.formats.filmed.film import film_video
from metagraph.mimicry.keypoint_layouts import KeypointTrack

if TYPE_CHECKING:
    from app.shell.context import Shell


def read_video(shell: Shell, file: Path, show: Callable[[KeypointTrack], None]) -> None:
    """Find the person in a video on a thread, with MediaPipe, and call `show` with the keypoints. Asks before
    MediaPipe is installed.
    """
    _when_installed(shell, lambda: _start(shell, file, show))


def film_person(shell: Shell, show: Callable[[KeypointTrack], None]) -> None:
    """Open the dialog that films the person before a camera; `show` gets the keypoints. Asks before MediaPipe
    is installed.
    """
    from app.features.mimic.camera_dialog import CameraDialog

    _when_installed(shell, lambda: CameraDialog(shell, show).open())


def _when_installed(shell: Shell, begin: Callable[[], None]) -> None:
    """Call `begin` once MediaPipe is there; ask before it is installed."""
    if is_installed(EXTRA):
        begin()
        return
    box = QMessageBox(shell.widget)
    box.setIcon(QMessageBox.Icon.Question)
    box.setWindowTitle(tr("Install MediaPipe"))
    extra = EXTRAS[EXTRA]
    box.setText(tr("Finding a person in a picture needs MediaPipe, which is not installed."))
    box.setInformativeText(
        tr(
            "It takes {megabytes} MB on disk and is downloaded from PyPI. Licence: {licence}. "
            "Pictures stay on this computer.",
            megabytes=extra.megabytes,
            licence=extra.licence,
        )
    )
    install = box.addButton(tr("Install"), QMessageBox.ButtonRole.AcceptRole)
    box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(install)
    box.exec()
    if box.clickedButton() is not install:
        return

    def done(_: None) -> None:
        begin()

    def failed(error: Exception) -> None:
        QMessageBox.warning(shell.widget, tr("Not installed"), tr_error(error))

    def work(job: WindowJob) -> None:
        def tell(share: float, words: str) -> None:
            job.tell(round(100 * share), 100, tr_phrase(words))

        install_extra(EXTRA, tell, lambda: job.cancelled)

    shell.jobs.start(tr("Installing {name}", name=tr_phrase(extra.title)), work, done, failed, stands=True)


def _start(shell: Shell, file: Path, show: Callable[[KeypointTrack], None]) -> None:
    def work(job: WindowJob) -> KeypointTrack:
        return film_video(file, job.tell, lambda: job.cancelled).track

    def failed(error: Exception) -> None:
        QMessageBox.warning(shell.widget, tr("Not read"), tr_error(error))

    shell.jobs.start(tr("Looking for a person in {name}", name=file.name), work, show, failed)
