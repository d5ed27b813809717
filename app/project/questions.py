"""What is asked about a project file: who has it open, what a crash left, what to do when another program has
written it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QMessageBox,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.writing import FileChangedError
from metagraph.formats.locking import Holder
from metagraph.formats.recovery import Left
from metagraph.graph.differences import differences
from metagraph.graph.model import Project

Role = QMessageBox.ButtonRole
Held = Literal["read only", "copy", "take over"]
Changed = Literal["save as", "reload", "anyway"]


def moment_words(seconds: float) -> str:
    """Return a time since 1970 as people say it: the hour, and the day where it is another than today."""
    then, now = time.localtime(seconds), time.localtime()
    return time.strftime("%H:%M" if then[:3] == now[:3] else "%H:%M on %d %B %Y", then)


def holder_words(holder: Holder) -> str:
    """Say who has a file: user, computer, since when."""
    owner = holder.owner
    if owner is None:
        return "another window, which does not say whose it is"
    return f"{owner.user} on {owner.host}, since {moment_words(owner.since)}"


def ask_held(window: QWidget, path: Path, holder: Holder) -> Held | None:
    """Ask how to open a file that another window has."""
    box = QMessageBox(
        QMessageBox.Icon.Question, "Already open", f"{path.name} is open in another window.", parent=window
    )
    words = f"By {holder_words(holder)}.\n\n"
    if holder.gone:
        words += "That window has not been heard of for a while: it may be gone, or its computer asleep. "
        words += "Take over if you know that it is gone.\n\n"
    words += (
        "Read-only, you can look, play and try anything, and save it elsewhere. A copy is a project of "
        "your own."
    )
    box.setInformativeText(words)
    first = box.addButton("Open read-only", Role.AcceptRole)
    answers: dict[object, Held] = {first: "read only", box.addButton("Open a copy", Role.AcceptRole): "copy"}
    if holder.gone:
        answers[box.addButton("Take over", Role.DestructiveRole)] = "take over"
    box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(first)
    box.exec()
    box.deleteLater()  # its parent would keep it
    return answers.get(box.clickedButton())


def ask_recover(window: QWidget, left: Left, saved: Path | None, more: int = 0) -> bool:
    """Ask whether to take over a journal's edits. more: how many other journals there are."""
    name = saved.name if saved is not None else "A project that was never saved"
    edits = f"{left.edits} edit{'s' if left.edits != 1 else ''}"
    words = (
        f"{name} was not closed properly. {edits.capitalize()} since the last save can be recovered; "
        "the "
        "last is of"
    )
    words += f" {moment_words(left.written)}."
    if left.behind:
        words += "\n\nThe file has been saved by somebody else since. Saving will show what differs."
    if more:
        words += f"\n\nEdits of {more} more window{'s' if more > 1 else ''} are offered next."
    return _yes(window, words)


def ask_keep(window: QWidget, left: Left, saved: Path) -> bool:
    """Ask whether to save another window's edits as a copy, since those of one are taken over already."""
    edits = f"{left.edits} edit{'s' if left.edits != 1 else ''}"
    words = (
        f"Another window on {saved.name} was not closed properly either. {edits.capitalize()} of it, "
        "the "
        "last of"
    )
    return _yes(window, f"{words} {moment_words(left.written)}, can be saved as a copy beside it.")


def _yes(window: QWidget, words: str) -> bool:
    box = QMessageBox.StandardButton
    return QMessageBox.question(window, "Recover edits?", words, box.Yes | box.Discard, box.Yes) == box.Yes


def ask_changed(
    window: QWidget, changed: FileChangedError, common: Project | None, mine: Project, dirty: bool
) -> Changed | None:
    """Ask what to do when the project file is not the one that was read; the differences can be looked at
    first.
    """
    name = changed.path.name
    box = QMessageBox(
        QMessageBox.Icon.Question, "Changed on disk", f"{name} has changed on disk.", parent=window
    )
    words = (
        "Another program, another window or a version control update has written it since it was opened "
        "or saved here."
    )
    if changed.theirs is None:
        words += f"\n\nIt cannot be read: {changed.why}"
    if dirty:
        words += (
            "\n\nSaving anyway replaces what is there. Reloading is a step that can be undone; your "
            "edits are kept in it."
        )
    box.setInformativeText(words)
    answers: dict[object, Changed] = {}
    if dirty:
        first = box.addButton("Save as…", Role.AcceptRole)
        answers[first] = "save as"
    if changed.theirs is not None:
        reload = box.addButton("Reload", Role.AcceptRole)
        answers[reload] = "reload"
        first = first if dirty else reload
    show = box.addButton("Show differences", Role.ActionRole)
    if dirty:
        answers[box.addButton("Save anyway", Role.DestructiveRole)] = "anyway"
    cancel = box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(first if answers else cancel)
    while True:
        box.exec()
        if box.clickedButton() is not show:
            box.deleteLater()  # its parent would keep it
            return answers.get(box.clickedButton())
        differences = DifferencesDialog(changed, common, mine, window)
        differences.exec()
        differences.deleteLater()


class DifferencesDialog(QDialog):
    """What the file on disk and the project here have become since they were the same."""

    def __init__(
        self, changed: FileChangedError, common: Project | None, mine: Project, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Differences")
        self.resize(860, 460)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        headline = QLabel(f"{changed.path.name}, on disk and here", self)
        headline.setProperty("heading", True)
        layout.addWidget(headline)
        row = QHBoxLayout()
        row.setSpacing(12)
        layout.addLayout(row, 1)
        theirs = changed.theirs
        if theirs is None:
            self._column(row, "On disk", [f"It cannot be read: {changed.why}"])
        elif common is not None:
            self._column(
                row, "Done on disk", differences(common, theirs) or ["Nothing but spacing or comments"]
            )
        if common is not None:
            self._column(row, "Done here", differences(common, mine) or ["Nothing"])
        elif theirs is not None:
            self._column(
                row, "From the file on disk to what is here", differences(theirs, mine) or ["Nothing"]
            )
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        strengthen(buttons.button(QDialogButtonBox.StandardButton.Close))
        buttons.rejected.connect(self.reject)
        layout.addWidget(buttons)

    def _column(self, row: QHBoxLayout, title: str, lines: Sequence[str]) -> None:
        column = QVBoxLayout()
        label = QLabel(title, self)
        label.setProperty("title", True)
        column.addWidget(label)
        shown = QListWidget(self)
        shown.setWordWrap(True)
        shown.setAccessibleName(title)
        shown.addItems(list(lines))
        column.addWidget(shown)
        row.addLayout(column, 1)
