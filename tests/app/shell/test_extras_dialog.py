"""The extras in the window: listed, installed with progress and Stop, removed, and how without a network."""

from __future__ import annotations

import time

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QMessageBox, QPushButton

from app.shell import extras_dialog
from app.shell.extras_dialog import ExtrasDialog, ExtrasOffer
from metagraph.common.extra_steps import ExtraError
from metagraph.common.extras import EXTRAS, describe_missing_extra
from metagraph.common.wording import phrase
from metagraph.errors import FileError

pytestmark = [pytest.mark.window, pytest.mark.gl]


class Steps:
    """Stands in for what installs and removes."""

    def __init__(self):
        self.there, self.asked, self.wait, self.error = {"fbx"}, [], False, None

    def install(self, name, tell, stopped, folder):
        self.asked.append((name, folder))
        tell(0.4, phrase("Downloading {package}…", package="numba"))
        while self.wait and not stopped():
            time.sleep(0.01)
            tell(0.4, phrase("Downloading {package}…", package="numba"))
        if self.error is not None:
            raise self.error
        if not stopped():
            self.there.add(name)

    def remove(self, name):
        self.there.discard(name)
        return 210_000_000


@pytest.fixture
def steps(monkeypatch):
    made = Steps()
    for name, stand_in in (
        ("install_extra", made.install),
        ("remove_extra", made.remove),
        ("is_installed", lambda name: name in made.there),
        ("is_removable", lambda name: name in made.there and name != "fbx"),
        ("can_install", lambda _: True),
    ):
        monkeypatch.setattr(extras_dialog, name, stand_in)
    return made


def open_dialog(drive) -> ExtrasDialog:
    drive.do("extras")
    return drive.window.findChild(ExtrasDialog)


def press(button: QPushButton) -> None:
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def close(drive, dialog) -> None:
    drive.wait(dialog.isActiveWindow)
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    drive.wait(lambda: not dialog.isVisible())
    QCoreApplication.sendPostedEvents(dialog, QEvent.Type.DeferredDelete.value)
    assert drive.window.findChild(ExtrasDialog) is None


def test_every_extra_is_listed_with_size_licence_and_state(drive, steps):
    dialog = open_dialog(drive)
    rows = [dialog.table.topLevelItem(n) for n in range(dialog.table.topLevelItemCount())]
    assert len(rows) == len(EXTRAS)
    texts = [rows[0].text(column) for column in range(6)]
    assert texts[0] == "Fast motion graphs (numba)" and texts[1].startswith("Building and searching")
    assert texts[2:] == ["60 MB", "210 MB", "BSD-2-Clause", "Not installed"]
    assert rows[1].text(5) == "Comes with Metagraph"
    close(drive, dialog)


def test_an_extra_is_installed_and_removed_with_the_space_it_frees(drive, steps):
    dialog = open_dialog(drive)
    assert dialog.install.isEnabled() and not dialog.remove.isEnabled()
    press(dialog.install)
    drive.wait(lambda: "is installed and works" in dialog.said.text())
    assert steps.asked == [("compiled", None)] and dialog.table.currentItem().text(5) == "Installed"
    assert not dialog.install.isEnabled() and not dialog.progress.isVisible()
    press(dialog.remove)
    drive.wait(lambda: "210 MB are free again" in dialog.said.text())
    assert dialog.table.currentItem().text(5) == "Not installed"
    close(drive, dialog)


def test_stop_ends_an_installation(drive, steps):
    steps.wait = True
    dialog = open_dialog(drive)
    press(dialog.install)
    drive.wait(lambda: dialog.said.text() == "Downloading numba…")
    assert dialog.progress.value() == 400 and dialog.stop.isVisible() and not dialog.install.isEnabled()
    press(dialog.stop)
    drive.wait(lambda: "Nothing was changed" in dialog.said.text())
    assert dialog.install.isEnabled() and not dialog.stop.isVisible() and "compiled" not in steps.there
    close(drive, dialog)


def test_a_failure_is_said_where_it_was_asked_for(drive, steps):
    steps.error = ExtraError("The network could not be reached.")
    dialog = open_dialog(drive)
    press(dialog.install)
    drive.wait(lambda: dialog.said.text() == "The network could not be reached.")
    assert dialog.install.isEnabled()
    close(drive, dialog)


def test_without_a_network_it_says_what_to_load_and_takes_it_from_a_folder(
    drive, steps, tmp_path, monkeypatch
):
    dialog = open_dialog(drive)
    steps_words = dialog.steps.toPlainText()
    assert "pip download --dest metagraph-compiled" in steps_words and '"numba>=0.60"' in steps_words
    press(dialog.copy_steps)
    assert QGuiApplication.clipboard().text() == steps_words
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(tmp_path))
    press(dialog.from_folder)
    drive.wait(lambda: "is installed" in dialog.said.text())
    assert steps.asked == [("compiled", tmp_path)]
    close(drive, dialog)


def test_in_somebody_elses_python_the_command_is_shown_and_copied(drive, steps, monkeypatch):
    monkeypatch.setattr(extras_dialog, "can_install", lambda _: False)
    dialog = open_dialog(drive)
    assert not dialog.install.isVisible() and '"numba>=0.60"' in dialog.line.text()
    press(dialog.copy_line)
    assert QGuiApplication.clipboard().text() == dialog.line.text()
    assert "--no-index --find-links metagraph-compiled" in dialog.steps.toPlainText()
    dialog.choose("fbx")
    assert "uninstall" in dialog.line.text() and "remove" in dialog.heading.text()
    close(drive, dialog)


def test_a_button_is_offered_while_a_text_says_that_an_extra_is_missing(drive, steps):
    again = []
    offer = ExtrasOffer(drive.shell.jobs, drive.window, lambda: again.append(True))
    offer.follow("all is well")
    assert offer.isHidden()
    offer.follow(describe_missing_extra("train", phrase("Training")))
    assert not offer.isHidden()
    press(offer)
    dialog = drive.window.findChild(ExtrasDialog)
    assert dialog.get_chosen() == "train"
    press(dialog.install)
    drive.wait(lambda: bool(again))
    close(drive, dialog)
    offer.deleteLater()


def test_a_warning_about_a_missing_extra_opens_the_extras(drive, steps, monkeypatch):
    def press_extras(box):
        next(b for b in box.buttons() if b.text() == "Extras…").click()

    monkeypatch.setattr(QMessageBox, "exec", press_extras)
    words = describe_missing_extra("fbx", phrase("Reading FBX"))
    drive.shell.files.show_failure(FileError("walk.fbx", "it is an FBX file", "on opening it", words))
    dialog = drive.window.findChild(ExtrasDialog)
    assert dialog.get_chosen() == "fbx"
    close(drive, dialog)
