"""The report about this computer, in the window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest

from app.features.help.system_report_dialog import SystemReportDialog
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
