"""What reading clips repaired: seen clip by clip, and left out one by one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import PurePath

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QLabel,
    QPlainTextEdit,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.translation import make_lazy_texts, tr, tr_error, tr_phrase, tr_plural
from app.widgets.making import make_widget
from app.widgets.tree_items import list_items_below, list_top_items
from metagraph.formats.repairs import Repaired, Reread, list_repairs, reread
from metagraph.formats.takes import BIND_POSE, FRAME_TIME, FROM_OFFSET, LONE_FRAME, NAME, ONE_FRAME, UNIT, UP
from metagraph.graph.edit_error import EditError

PLACE = Qt.ItemDataRole.UserRole
TITLES = make_lazy_texts(
    lambda: {
        BIND_POSE: tr("Remove bind poses at the ends"),
        LONE_FRAME: tr("Smooth single stray frames"),
        UNIT: tr("Detect the unit of length"),
        UP: tr("Rotate from Z up to Y up"),
        FROM_OFFSET: tr("Add a joint's OFFSET to its positions"),
        FRAME_TIME: tr("Correct the frame time"),
        ONE_FRAME: tr("Skip one-frame bind poses"),
        NAME: tr("Clean names"),
    }
)
TICKED, OPEN = Qt.CheckState.Checked, Qt.CheckState.Unchecked


class RepairsDialog(QDialog):
    """title: what happened. clips: whose repairs are shown. lines: what else there is to read."""

    def __init__(
        self,
        document: Document,
        jobs: Jobs,
        title: str,
        clips: Iterable[str],
        lines: Sequence[str] = (),
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.clips = document, jobs, tuple(clips)
        self.found: list[Repaired] = []
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Repairs"))
        self.resize(760, 520)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        self.headline = QLabel(title, self, wordWrap=True)
        self.headline.setProperty("heading", True)
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        self.tree = make_widget(QTreeWidget, self, uniformRowHeights=True)
        self.tree.setHeaderLabels([tr("Clip"), tr("Repair")])
        self.tree.setColumnWidth(0, 320)
        self.tree.setAccessibleName(tr("Repairs"))
        self.tree.itemChanged.connect(self._count)
        self.lines = QPlainTextEdit("\n".join(lines), self, readOnly=True)
        self.lines.setAccessibleName(tr("Other notes"))
        self.lines.setMaximumHeight(110)
        self.lines.setVisible(bool(lines))
        self.trouble = QLabel(self, wordWrap=True)
        self.trouble.hide()
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.go = self.buttons.addButton(tr("Apply"), QDialogButtonBox.ButtonRole.ApplyRole)
        self.go.clicked.connect(self.apply)
        strengthen(self.go)
        self.buttons.rejected.connect(self.reject)
        for part in (self.headline, self.words, self.tree, self.lines, self.trouble):
            layout.addWidget(part, 1 if part is self.tree else 0)
        layout.addStretch(0)  # where there is no tree, the words stay at the top
        layout.addWidget(self.buttons)
        document.changed.connect(self._fill)
        document.loaded.connect(self.reject)
        self._fill()

    def _fill(self, *_: object) -> None:
        project = self.document.project
        found = list_repairs(project, self.clips)
        if found == self.found and self.tree.topLevelItemCount():
            return
        self.found = found
        self.tree.blockSignals(True)
        self.tree.clear()
        for name, title in TITLES.items():
            mine = [n for n, r in enumerate(found) if r.repair.name == name]
            if not mine:
                continue
            top = QTreeWidgetItem(self.tree, [f"{title} ({len(mine)})"])
            top.setFlags(top.flags() | Qt.ItemFlag.ItemIsAutoTristate | Qt.ItemFlag.ItemIsUserCheckable)
            font = top.font(0)
            font.setBold(True)
            top.setFont(0, font)
            for n in mine:
                entry, repair = project.clips[found[n].clip], found[n].repair
                # A skipped take is none of the clips; its words name it, its file is what it has.
                whose = entry.name if repair.take is None else PurePath(entry.path).name
                item = QTreeWidgetItem(top, [whose, tr_phrase(repair.words)])
                item.setData(0, PLACE, n)
                item.setToolTip(0, entry.path)
                item.setToolTip(1, item.text(1))
                item.setCheckState(0, TICKED if found[n].repair.made else OPEN)
            top.setExpanded(len(mine) <= 12)
        self.tree.blockSignals(False)
        self.tree.setVisible(bool(found))
        self.words.setText(
            tr(
                "These repairs were made on import. Untick a repair to leave the file as "
                "it is; you can tick it again at any time."
            )
            if found
            else tr("These clips needed no repairs.")
        )
        self._count()

    def _items(self) -> list[QTreeWidgetItem]:
        return [item for top in list_top_items(self.tree) for item in list_items_below(top)]

    def changes(self) -> list[tuple[Repaired, bool]]:
        """Return the repairs whose tick was changed, with whether they are to be made."""
        now = [(self.found[item.data(0, PLACE)], item.checkState(0) == TICKED) for item in self._items()]
        return [(found, made) for found, made in now if found.repair.made != made]

    def _count(self, *_: object) -> None:
        count = len(self.changes())
        self.go.setEnabled(count > 0)
        self.go.setText(
            tr_plural("Apply {count:,} change", "Apply {count:,} changes", count) if count else tr("Apply")
        )

    def apply(self) -> None:
        """Read the clips again with and without those repairs, on a thread; one undo step."""
        changes = self.changes()
        project, folder = self.document.project, self.document.folder
        self.go.setEnabled(False)
        self.trouble.hide()

        def work(job: WindowJob) -> Reread:
            return reread(project, folder, changes, job.go_on)

        document, failures = self.document, list[str]()

        def done(result: Reread) -> None:
            """Put it into the project, whether the dialog is still there or not."""
            if document.project is not project:
                failures.append(tr("The project has changed in the meantime. Apply again."))
                return
            failures.extend(result.failures)
            try:
                if result.count:
                    left, repairs = (
                        sum(not made for _, made in changes),
                        tr_plural("{count:,} repair", "{count:,} repairs", len(changes)),
                    )
                    words = (
                        tr("Revert {repairs}", repairs=repairs)
                        if left == len(changes)
                        else tr("Make {repairs}", repairs=repairs)
                        if not left
                        else tr("Change {repairs}", repairs=repairs)
                    )
                    document.edit(words, result.into)
            except EditError as error:
                failures.append(tr_error(error))

        self._failures = failures
        job = self.jobs.start(
            tr("Reading clips again"), work, done, lambda error: self._fail(tr_error(error)), stands=True
        )
        job.done.connect(self._applied)

    def _applied(self) -> None:
        """Show what is left to repair."""
        self.found = []
        self._fill()
        if self._failures:
            self._fail("\n".join(self._failures[:4]))

    def _fail(self, words: str) -> None:
        self.trouble.setText(words)
        self.trouble.show()
        self._count()
