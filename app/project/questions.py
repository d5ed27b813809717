"""Ask about a project file: who has it open, what to do if another program has written it."""

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
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.writing import FileChangedError, FolderGoneError
from app.translation import tr, tr_error, tr_phrase
from metagraph.formats.locking import Holder
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.model import Project

Role = QMessageBox.ButtonRole
Held = Literal["read only", "copy", "take over"]
Gone = Literal["there", "save as"]
Changed = Literal["merge", "save as", "reload", "anyway"]


def describe_moment(seconds: float) -> str:
    """Return a time since 1970 in words: the time of day, and the date if it is not today."""
    then, now = time.localtime(seconds), time.localtime()
    return time.strftime("%H:%M" if then[:3] == now[:3] else tr("%H:%M on %d %B %Y"), then)


def describe_holder(holder: Holder) -> str:
    """Describe who has a file: user, computer, since when."""
    owner = holder.owner
    if owner is None:
        return tr("another window, whose user is unknown")
    return tr(
        "{user} on {host}, since {since}",
        user=owner.user,
        host=owner.host,
        since=describe_moment(owner.since),
    )


def ask_held(window: QWidget, path: Path, holder: Holder) -> Held | None:
    """Ask how to open a file that another window has."""
    box = QMessageBox(
        QMessageBox.Icon.Question,
        tr("Already open"),
        tr("{name} is open in another window.", name=path.name),
        parent=window,
    )
    words = tr("Opened by {holder}.", holder=describe_holder(holder)) + "\n\n"
    if holder.gone:
        words += tr(
            "That window has not responded for a while: it may be closed, or its computer asleep. "
            "Take over only if you know that it is closed."
        )
        words += "\n\n"
    words += tr(
        "In read-only mode you can look, play and try anything, and save under another name. A "
        "copy is a project of your own."
    )
    box.setInformativeText(words)
    first = box.addButton(tr("Open read-only"), Role.AcceptRole)
    answers: dict[object, Held] = {
        first: "read only",
        box.addButton(tr("Open a copy"), Role.AcceptRole): "copy",
    }
    if holder.gone:
        answers[box.addButton(tr("Take over"), Role.DestructiveRole)] = "take over"
    box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(first)
    box.exec()
    box.deleteLater()  # its parent would keep it
    return answers.get(box.clickedButton())


def ask_folder_gone(window: QWidget, error: FolderGoneError) -> Gone | None:
    """Ask where to save a project whose folder no longer exists."""
    box = QMessageBox(
        QMessageBox.Icon.Warning,
        tr("Not saved"),
        tr("The folder of {name} no longer exists.", name=error.path.name),
        parent=window,
    )
    box.setInformativeText(tr_error(error))
    there = (
        box.addButton(tr("Save in {name}", name=error.place.name), Role.AcceptRole) if error.place else None
    )
    elsewhere = box.addButton(tr("Save as…"), Role.AcceptRole)
    box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(there or elsewhere)
    box.exec()
    box.deleteLater()  # its parent would keep it
    answers: dict[object, Gone] = {elsewhere: "save as"}
    if there is not None:
        answers[there] = "there"
    return answers.get(box.clickedButton())


def ask_changed(
    window: QWidget, changed: FileChangedError, common: Project | None, mine: Project, dirty: bool
) -> Changed | None:
    """Ask what to do if the project file is not the one that was read; the differences can be shown first."""
    name = changed.path.name
    box = QMessageBox(
        QMessageBox.Icon.Question,
        tr("Changed on disk"),
        tr("{name} has changed on disk.", name=name),
        parent=window,
    )
    words = tr(
        "Another program, another window or a version control update has written it since you "
        "opened or saved it here."
    )
    if changed.theirs is None:
        words += "\n\n" + tr("It cannot be read: {why}", why=changed.why)
    if dirty:
        words += "\n\n" + tr(
            "Merge keeps the changes of both sides. Save anyway replaces the file on disk. You can "
            "undo Merge and Reload, and both keep your edits."
        )
    box.setInformativeText(words)
    ways: list[tuple[QPushButton, Changed]] = []
    if dirty and changed.theirs is not None and common is not None:
        ways.append((box.addButton(tr("Merge"), Role.AcceptRole), "merge"))
    if dirty:
        ways.append((box.addButton(tr("Save as…"), Role.AcceptRole), "save as"))
    if changed.theirs is not None:
        ways.append((box.addButton(tr("Reload"), Role.AcceptRole), "reload"))
    show = box.addButton(tr("Show differences"), Role.ActionRole)
    cancel = box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(ways[0][0] if ways else cancel)
    if dirty:
        ways.append((box.addButton(tr("Save anyway"), Role.DestructiveRole), "anyway"))
    answers: dict[object, Changed] = dict(ways)
    while True:
        box.exec()
        if box.clickedButton() is not show:
            box.deleteLater()  # its parent would keep it
            return answers.get(box.clickedButton())
        differences = DifferencesDialog(changed, common, mine, window)
        differences.exec()
        differences.deleteLater()


class DifferencesDialog(QDialog):
    """Shows how the file on disk and the project here have changed since they were the same."""

    def __init__(
        self, changed: FileChangedError, common: Project | None, mine: Project, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Differences"))
        self.resize(860, 460)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        headline = QLabel(tr("{name}, on disk and here", name=changed.path.name), self)
        headline.setProperty("heading", True)
        layout.addWidget(headline)
        row = QHBoxLayout()
        row.setSpacing(12)
        layout.addLayout(row, 1)
        theirs = changed.theirs
        if theirs is None:
            self._column(row, tr("On disk"), [tr("It cannot be read: {why}", why=changed.why)])
        elif common is not None:
            self._column(
                row,
                tr("Changed on disk"),
                describe_differences(common, theirs) or [tr("Only spacing or comments")],
            )
        if common is not None:
            self._column(row, tr("Changed here"), describe_differences(common, mine) or [tr("Nothing")])
        elif theirs is not None:
            self._column(
                row,
                tr("Changes from the file on disk to this window"),
                describe_differences(theirs, mine) or [tr("Nothing")],
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
        shown.addItems(list(map(tr_phrase, lines)))
        column.addWidget(shown)
        row.addLayout(column, 1)
