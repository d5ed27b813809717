"""Report unexpected errors: a plain sentence, and a report that can be saved."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QLabel,
    QPlainTextEdit,
    QVBoxLayout,
    QWidget,
)

from app import faults
from app.look.theme import strengthen
from app.project.autosave import state_folder
from app.project.document import Document
from app.shell.report_saving import save_report
from app.translation import tr

CHILDREN = 5000  # ms between two checks for what processes have written


def find_fault_folder() -> Path:
    """Return the folder for reports of crashes."""
    return state_folder() / "faults"


class FaultTeller(QObject):
    """Reports errors in the window, on its thread. First it makes sure that the journal is on the disk."""

    _arrived = Signal(object)

    def __init__(self, document: Document, window: QWidget, tell: Callable[[str], None]) -> None:
        super().__init__(window)
        self.document, self.window, self.words = document, window, tell
        self._arrived.connect(self._show, Qt.ConnectionType.QueuedConnection)
        self._listener = self._arrived.emit
        faults.listeners.append(self._listener)
        document.loaded.connect(lambda: faults.note("a project was opened"))
        document.saved.connect(lambda: faults.note("saved"))
        document.undo_stack.indexChanged.connect(self._note_step)
        self._timer = QTimer(self, interval=CHILDREN)
        self._timer.timeout.connect(lambda: faults.read_child_faults(find_fault_folder()))
        self._timer.start()

    def _note_step(self, index: int) -> None:
        """Remember the first word of what was done; the words after it may name something of the project."""
        step = self.document.undo_stack.command(index - 1) if index else None
        words = str(getattr(step, "english", "")).split()
        faults.note(f"step {index}: {words[0] if words else 'none'}")

    def stop(self) -> None:
        self._timer.stop()
        self.document.undo_stack.indexChanged.disconnect(self._note_step)  # it also reports its own end
        if self._listener in faults.listeners:
            faults.listeners.remove(self._listener)

    def _show(self, told: faults.UncaughtError | Exception) -> None:
        if isinstance(told, Exception):  # its message says what can be done
            self.words(str(told))
            return
        safe = self.document.secured() or not self.document.dirty
        dialog = self.window.findChild(FaultDialog)
        if dialog is None:
            dialog = FaultDialog(self.window)
        dialog.say(tr("Something went wrong"), _sentence(safe), faults.format_fault_report())
        dialog.show()

    def offer_left(self) -> None:
        """Offer the report of a crash that ended the program last time."""
        left = faults.read_crash_reports(find_fault_folder())
        if left:
            faults.note("started after it had ended by itself")
            dialog = FaultDialog(self.window)
            words = tr(
                "Metagraph quit unexpectedly last time. It offers to recover the edits that were "
                "finished. A report of where it stopped helps to fix the fault; it contains nothing from "
                "your projects."
            )
            dialog.say(tr("Metagraph quit unexpectedly"), words, f"{faults.format_fault_report()}\n{left}")
            dialog.show()


def _sentence(safe: bool) -> str:
    what = (
        tr(
            "Something in the window failed. Everything else still works, and every finished edit is "
            "in the journal."
        )
        if safe
        else tr(
            "Something in the window failed, and your last edits are not in any file. Save the "
            "project now, in another place if necessary."
        )
    )
    then = tr(
        "If the problem persists, save and restart Metagraph. The report below contains nothing "
        "from your project."
    )
    return f"{what} {then}"


class FaultDialog(QDialog):
    """A window beside the main one, which stays usable. There is only one; further faults are added to it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.resize(620, 400)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(10)
        self.heading = QLabel(self)
        self.heading.setProperty("heading", True)
        self.sentence = QLabel(self)
        self.sentence.setWordWrap(True)
        self.text = QPlainTextEdit(self)
        self.text.setReadOnly(True)
        self.text.setAccessibleName(tr("Contents of the report"))
        for widget in (self.heading, self.sentence):
            layout.addWidget(widget)
        layout.addWidget(self.text, 1)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.save = buttons.addButton(tr("Save report…"), QDialogButtonBox.ButtonRole.ActionRole)
        strengthen(buttons.button(QDialogButtonBox.StandardButton.Close))
        self.save.clicked.connect(self._save)
        buttons.rejected.connect(self.hide)
        layout.addWidget(buttons)

    def say(self, heading: str, sentence: str, report: str) -> None:
        self.setWindowTitle(heading)
        self.heading.setText(heading)
        self.sentence.setText(sentence)
        self.text.setPlainText(report)

    def _save(self) -> None:
        words = save_report(self, self.text.toPlainText())
        if words is not None:
            self.sentence.setText(words)
