"""File > Compare versions: what is new, gone and changed since another version of the project, each with a
moving picture of both.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSplitter,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.project.jobs import Jobs, WindowJob
from app.project.questions import describe_moment
from app.stage.comparing import VersionComparison, compare_projects, count_fates, film_difference
from app.translation import tr, tr_phrase
from app.widgets.quiet_fields import ComboBox
from app.widgets.stick_figures import StickFigures
from app.widgets.tree_items import list_items_below, list_top_items
from metagraph.errors import describe_error
from metagraph.formats.project.git_history import list_commits, read_commit
from metagraph.formats.project.versions import list_earlier_versions
from metagraph.formats.store import SUFFIX, read_project
from metagraph.graph.editing.differences import Difference
from metagraph.graph.model import Project

ROLE = Qt.ItemDataRole.UserRole
LINES = 500  # things of one fate that are listed


@dataclass(frozen=True)
class OtherVersion:
    """A version to compare with. words: what it is called. read: reads it, without motion. folder: what its
    paths are relative to.
    """

    words: str
    read: Callable[[], Project]
    folder: Path


def list_other_versions(path: Path) -> tuple[OtherVersion, ...]:
    """Return what a project file can be compared with: its earlier versions, then Git's commits; for a
    thread.
    """
    out = []
    for version in list_earlier_versions(path):
        words = tr("Version {n}, {when}", n=version.number, when=describe_moment(version.saved))
        out.append(OtherVersion(words, partial(read_project, version.path, []), path.parent))
    for commit in list_commits(path):
        words = tr(
            "Git, {when}: {subject} ({author})",
            when=describe_moment(commit.saved),
            subject=commit.subject,
            author=commit.author,
        )
        out.append(OtherVersion(words, partial(read_commit, path, commit), path.parent))
    return tuple(out)


class CompareDialog(QDialog):
    """The differences on the left, by whether they are new, gone or changed; the chosen one on the right, as
    it was and as it is. compared: another version was read and compared.
    """

    compared = Signal()

    def __init__(
        self, now: Project, others: Sequence[OtherVersion], jobs: Jobs, folder: Path, parent: QWidget
    ) -> None:
        super().__init__(parent)
        self.now, self.jobs, self.folder = now, jobs, folder
        self.others = list(others)
        self.found: VersionComparison | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Compare versions"))
        self.resize(980, 600)
        self.choice = ComboBox(self)
        self.choice.setAccessibleName(tr("Compare with"))
        self.choice.setMinimumContentsLength(40)
        self.choice.addItems([one.words for one in self.others])
        self.choice.currentIndexChanged.connect(self.compare)
        self.file = QPushButton(tr("Another file…"), self)
        self.file.setToolTip(tr("Compare with a project file, such as a colleague's copy"))
        self.file.clicked.connect(self.ask_file)
        self.summary = QLabel(self)
        self.summary.setProperty("dim", True)
        self.summary.setWordWrap(True)
        self.tree = QTreeWidget(self)
        self.tree.setHeaderHidden(True)
        self.tree.setWordWrap(True)
        self.tree.setAccessibleName(tr("Differences"))
        self.tree.currentItemChanged.connect(lambda item, _: self._show(item))
        self.figures = StickFigures(self)
        self.figures.words = (tr("Then"), tr("Now"))
        self.figures.setAccessibleName(tr("What was chosen, then and now"))
        self.words = QLabel(self)
        self.words.setWordWrap(True)
        self.words.setMinimumHeight(48)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        buttons.rejected.connect(self.reject)
        self._lay_out(buttons)
        if self.others:
            self.compare(0)
        else:
            self.summary.setText(tr("No earlier versions, no commits. Choose another file to compare with."))

    def _lay_out(self, buttons: QDialogButtonBox) -> None:
        first = QHBoxLayout()
        label = QLabel(tr("&Compare with"), self)
        label.setBuddy(self.choice)
        first.addWidget(label)
        first.addWidget(self.choice, 1)
        first.addWidget(self.file)
        halves = QSplitter(self)
        halves.setChildrenCollapsible(False)
        halves.addWidget(self.tree)
        shown = QWidget(halves)
        column = QVBoxLayout(shown)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.figures, 1)
        column.addWidget(self.words)
        halves.setSizes([430, 530])
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        layout.addLayout(first)
        layout.addWidget(self.summary)
        layout.addWidget(halves, 1)
        layout.addWidget(buttons)

    def ask_file(self) -> None:
        """Ask for another project file, and compare with it."""
        kinds = tr("Metagraph projects (*{suffix})", suffix=SUFFIX)
        name, _ = QFileDialog.getOpenFileName(self, tr("Compare with"), str(self.folder), kinds)
        if name:
            self.add_file(Path(name))

    def add_file(self, path: Path) -> None:
        """Compare with another project file."""
        self.others.append(OtherVersion(path.name, partial(read_project, path, []), path.parent))
        self.choice.addItem(path.name)
        self.choice.setCurrentIndex(len(self.others) - 1)
        if len(self.others) == 1:
            self.compare(0)

    def compare(self, place: int) -> None:
        """Compare with the version at a place in the list, on a thread."""
        if not 0 <= place < len(self.others):
            return
        other, now = self.others[place], self.now
        self.found = None
        self.tree.clear()
        self._show(None)
        self.summary.setText(tr("Comparing…"))

        def done(found: VersionComparison) -> None:
            if self.choice.currentIndex() == place:
                self.found = found
                self._fill(found.differences)
                self.compared.emit()

        def failed(error: Exception) -> None:
            if self.choice.currentIndex() == place:
                self.summary.setText(tr_phrase(describe_error(error)))

        def work(_: WindowJob) -> VersionComparison:
            return compare_projects(other.read(), now, other.folder)

        self.jobs.start(tr("Comparing versions"), work, done, failed)

    def _fill(self, differences: Sequence[Difference]) -> None:
        added, removed, changed = count_fates(differences)
        if not differences:
            self.summary.setText(tr("The two versions are the same."))
            return
        counts = {"added": added, "removed": removed, "changed": changed}
        words = tr("{added:,} new, {removed:,} gone, {changed:,} changed", **counts)
        self.summary.setText(words)
        titles = (
            ("added", tr("New: {count:,}", count=added)),
            ("removed", tr("Gone: {count:,}", count=removed)),
            ("changed", tr("Changed: {count:,}", count=changed)),
        )
        for fate, title in titles:
            some = [one for one in differences if one.fate == fate]
            if not some:
                continue
            top = QTreeWidgetItem(self.tree, [title])
            top.setFlags(Qt.ItemFlag.ItemIsEnabled)
            for one in some[:LINES]:
                item = QTreeWidgetItem(top, [tr_phrase(one.words)])
                item.setToolTip(0, tr_phrase(one.words))
                item.setData(0, ROLE, one)
            if len(some) > LINES:
                QTreeWidgetItem(top, [tr("and {count} more", count=len(some) - LINES)])
            top.setExpanded(True)
        self.tree.setCurrentItem(list_items_below(list_top_items(self.tree)[0])[0])
        self.tree.setFocus()

    def _show(self, item: QTreeWidgetItem | None) -> None:
        """Show a difference as it was and as it is."""
        one = item.data(0, ROLE) if item is not None else None
        found = self.found
        if one is None or found is None:
            self.words.clear()
            self.figures.show_clips(None, None)
            return
        self.words.setText(tr_phrase(one.words))
        then, now = (film_difference(found, one, side) for side in ("before", "after"))
        self.figures.words = (
            tr("Then") if then is not None else tr("Not there then"),
            tr("Now") if now is not None else tr("Not there now"),
        )
        self.figures.show_clips(then, now)
