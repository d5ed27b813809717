"""The dialog with the report about this computer, to copy or save for a report of a fault."""

from __future__ import annotations

from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QFontDatabase, QFontInfo, QGuiApplication
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app import faults
from app.shell.report_saving import save_report
from app.shell.system_report import format_report, make_system_report
from app.stage.software_drawing import can_choose_software, choose_software, is_software_chosen
from app.translation import get_language, tr


def make_window_report() -> str:
    """Return what this computer has, how the window is drawn, and the last actions and faults, as text."""
    screen = QGuiApplication.primaryScreen()
    size = screen.size()
    facts = make_system_report() | {
        "Typeface": QFontInfo(QApplication.font()).family(),
        "Screen's size": f"{size.width()} x {size.height()}, scale {screen.devicePixelRatio():g}",
        "Language": get_language(),
    }
    return f"{format_report(facts)}\n\n{faults.format_happenings()}"


class SystemReportDialog(QDialog):
    """Shows the report; buttons copy and save it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("System report"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(760, 480)
        self.words = QLabel(
            tr("Send this when you report a problem. It contains nothing from your projects."),
            self,
            wordWrap=True,
        )
        self.report = QPlainTextEdit(make_window_report(), self)
        self.report.setReadOnly(True)
        self.report.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.report.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.report.setAccessibleName(tr("System report"))
        self.copy_button = QPushButton(tr("Copy"), self)
        self.copy_button.clicked.connect(self.copy)
        self.save_button = QPushButton(tr("Save report…"), self)
        self.save_button.clicked.connect(self.save)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        buttons.addButton(self.copy_button, QDialogButtonBox.ButtonRole.ActionRole)
        buttons.addButton(self.save_button, QDialogButtonBox.ButtonRole.ActionRole)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 16, 16, 12)
        layout.setSpacing(10)
        layout.addWidget(self.words)
        layout.addWidget(self.report, 1)
        if can_choose_software():
            layout.addWidget(self._make_software_box())
        layout.addWidget(buttons)

    def copy(self) -> None:
        """Put the report on the clipboard."""
        QGuiApplication.clipboard().setText(self.report.toPlainText())
        self.copy_button.setText(tr("Copied"))

    def save(self) -> None:
        """Ask where to save the report, and write it."""
        words = save_report(self, self.report.toPlainText())
        if words is not None:
            self.words.setText(words)

    def _make_software_box(self) -> QCheckBox:
        settings = QSettings()
        box = QCheckBox(tr("Draw without the graphics card from the next start on"), self)
        box.setToolTip(tr("Slower. It helps where the graphics card's driver is old or draws wrongly"))
        box.setChecked(is_software_chosen(settings))
        box.toggled.connect(lambda on: choose_software(settings, on))
        return box
