"""File > Earlier versions: what each save has kept of a project, with what has changed since, opened as a
copy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QSplitter,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.leftovers import find_telling_pose
from app.project.questions import describe_moment
from app.project.recovering import PICTURE, SittingPicture
from app.project.version_count import count_kept_versions, set_version_count
from app.translation import tr, tr_phrase, tr_plural
from app.widgets.quiet_fields import SpinBox
from metagraph.errors import FileError, describe_error
from metagraph.formats.project.versions import MOST, Version, list_earlier_versions
from metagraph.formats.store import read_project
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip

LINES = 500  # changes of a version that are listed


@dataclass(frozen=True)
class Found:
    """An earlier version. project: None if it cannot be read, and then why. changes: what was done since, in
    words. pose: for its picture, a clip of it where one could be read.
    """

    version: Version
    project: Project | None
    changes: tuple[str, ...] = ()
    why: str = ""
    pose: Clip | None = None


def find_versions(path: Path, now: Project) -> tuple[Found, ...]:
    """Return a project file's earlier versions, the most recent first, compared with what it is now; for a
    thread.
    """
    out = []
    for version in list_earlier_versions(path):
        try:
            project = read_project(version.path, [])
        except FileError as error:
            out.append(Found(version, None, why=describe_error(error)))
            continue
        pose = find_telling_pose(project, version.path.parent)
        out.append(Found(version, project, tuple(describe_differences(project, now)), pose=pose))
    return tuple(out)


class VersionsDialog(QDialog):
    """The versions on the left, what has changed since the chosen one on the right. chosen: is called with
    the one to open.
    """

    def __init__(
        self,
        name: str,
        found: Sequence[Found],
        chosen: Callable[[Found], object],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.found, self.chosen = tuple(found), chosen
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Earlier versions"))
        self.resize(880, 480)
        heading = QLabel(tr("Earlier versions of {name}", name=name), self)
        heading.setProperty("heading", True)
        words = QLabel(
            tr("Each save keeps the previous version. A version opens as a copy and replaces nothing.")
            if found
            else tr("No earlier versions yet. Each save keeps the previous version."),
            self,
        )
        words.setProperty("dim", True)
        self.versions = QListWidget(self)
        self.versions.setWordWrap(True)
        self.versions.setAccessibleName(tr("Earlier versions"))
        self.versions.setIconSize(PICTURE)
        self.versions.setSpacing(3)
        for one in self.found:
            self.versions.addItem(self._item(one))
        self.title = QLabel(self)
        self.title.setProperty("title", True)
        self.changes = QListWidget(self)
        self.changes.setWordWrap(True)
        self.changes.setAccessibleName(tr("Changed since then"))
        self.changes.setSelectionMode(QListWidget.SelectionMode.NoSelection)
        self.count = SpinBox(self)
        self.count.setRange(0, MOST)
        self.count.setValue(count_kept_versions())
        self.count.setSpecialValueText(tr("none"))
        self.count.setAccessibleName(tr("Versions kept"))
        self.count.valueChanged.connect(set_version_count)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.go = self.buttons.addButton(tr("Open as a copy"), QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.go)
        self.go.setDefault(True)
        self.buttons.accepted.connect(self.open_chosen)
        self.buttons.rejected.connect(self.reject)
        self.versions.itemActivated.connect(lambda _: self.open_chosen())
        self.versions.currentRowChanged.connect(self._show)
        self._lay_out(heading, words)
        self.versions.setCurrentRow(0)
        self._show(self.versions.currentRow())
        self.versions.setFocus()

    def _lay_out(self, heading: QLabel, words: QLabel) -> None:
        saved = QLabel(tr("Saved"), self)
        saved.setProperty("title", True)
        halves = QSplitter(self)
        halves.setChildrenCollapsible(False)
        for title, rows in ((saved, self.versions), (self.title, self.changes)):
            half = QWidget(halves)
            column = QVBoxLayout(half)
            column.setContentsMargins(0, 0, 0, 0)
            column.addWidget(title)
            column.addWidget(rows, 1)
        halves.setSizes([440, 410])
        last = QHBoxLayout()
        label = QLabel(tr("&Versions to keep"), self)
        label.setBuddy(self.count)
        last.addWidget(label)
        last.addWidget(self.count)
        last.addStretch(1)
        last.addWidget(self.buttons)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        layout.addWidget(heading)
        layout.addWidget(words)
        layout.addWidget(halves, 1)
        layout.addLayout(last)
        halves.setVisible(bool(self.found))
        if not self.found:
            layout.addStretch(1)
            self.resize(560, 160)

    def _item(self, one: Found) -> QListWidgetItem:
        when = tr("Version {n}, {when}", n=one.version.number, when=describe_moment(one.version.saved))
        if one.project is None:
            words = tr("Cannot be read")
        elif not one.changes:
            words = tr("Same as now")
        else:
            words = tr_plural("{count:,} change since then", "{count:,} changes since then", len(one.changes))
        item = QListWidgetItem(f"{when}\n{words}")
        if one.project is not None:
            clips = tr_plural("{count:,} clip", "{count:,} clips", len(one.project.clips))
            count = sum(1 for _ in one.project.actions())
            actions = tr_plural("{count:,} action", "{count:,} actions", count)
            item.setText(f"{when}\n{clips}, {actions}\n{words}")
            picture = SittingPicture(one.project, one.pose).grab()
            icon = QIcon(picture)
            icon.addPixmap(picture, QIcon.Mode.Selected)  # Qt would dim it
            item.setIcon(icon)
        item.setToolTip(one.version.path.name)
        item.setSizeHint(QSize(PICTURE.width() + 120, PICTURE.height() + 12))
        return item

    @property
    def current(self) -> Found | None:
        row = self.versions.currentRow()
        return self.found[row] if 0 <= row < len(self.found) else None

    def _show(self, _: int) -> None:
        one = self.current
        self.changes.clear()
        self.go.setEnabled(one is not None and one.project is not None)
        if one is None:
            self.title.clear()
            return
        self.title.setText(tr("Changed since {when}", when=describe_moment(one.version.saved)))
        if one.project is None:
            self.changes.addItem(tr_phrase(one.why))
            return
        self.changes.addItems(list(map(tr_phrase, one.changes[:LINES])) or [tr("Nothing")])
        if len(one.changes) > LINES:
            self.changes.addItem(tr("and {count} more", count=len(one.changes) - LINES))

    def open_chosen(self) -> None:
        """Open the chosen version as a copy, and close."""
        one = self.current
        if one is None or one.project is None:
            return
        self.accept()
        self.chosen(one)
