"""The report about this computer, in the window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QSettings, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QFileDialog

from app import faults
from app.features.help.system_report_dialog import SystemReportDialog
from app.stage.software_drawing import choose_software, is_software_chosen
from metagraph import __version__

pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_it_is_shown_copied_and_closed(drive):
    drive.do("system_report")
    dialog = drive.window.findChild(SystemReportDialog)
    assert f"{__version__}, " in dialog.report.toPlainText() and dialog.report.isReadOnly()
    QTest.mouseClick(dialog.copy_button, Qt.MouseButton.LeftButton)
    assert QGuiApplication.clipboard().text() == dialog.report.toPlainText()
    assert dialog.copy_button.text() == "Copied"
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    drive.wait(lambda: not dialog.isVisible())


def test_it_names_the_typeface_and_the_last_faults_and_is_saved(drive, tmp_path, monkeypatch):
    faults.note("step 1: Label")
    monkeypatch.setattr(
        QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "report.txt"), "Text (*.txt)")
    )
    drive.do("system_report")
    dialog = drive.window.findChild(SystemReportDialog)
    text = dialog.report.toPlainText()
    assert "Source Sans Pro" in text and "step 1: Label" in text and "Screen's size" in text
    QTest.mouseClick(dialog.save_button, Qt.MouseButton.LeftButton)
    assert (tmp_path / "report.txt").read_text(encoding="utf-8") == text
    assert dialog.words.text().startswith("Saved report.txt")
    dialog.close()


def test_drawing_without_the_graphics_card_is_chosen_there(drive):
    drive.do("system_report")
    dialog = drive.window.findChild(SystemReportDialog)
    (box,) = dialog.findChildren(QCheckBox)
    QTest.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(10, box.height() // 2))
    assert is_software_chosen(QSettings())
    choose_software(QSettings(), False)
    dialog.close()
