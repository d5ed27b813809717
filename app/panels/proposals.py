"""Proposals for all clips that are not placed yet: seen, heard why, played, and placed together; the least certain first."""

from __future__ import annotations

from html import escape

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QSlider,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.document import Document
from app.jobs import Job, Jobs
from app.session import Session
from app.theme import KIND_MARKS, strengthen, theme
from metagraph.suggest.propose import Proposal, Proposals, accept, propose

CLIP = Qt.ItemDataRole.UserRole
COLUMNS = ("Clip", "Is a", "Layer", "Stance", "Sure")


class ProposalsDialog(QDialog):
    """placed: how many clips were placed last."""

    def __init__(self, document: Document, session: Session, jobs: Jobs, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.found = Proposals({}, {})
        self.placed = 0
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Label clips")
        self.resize(860, 620)
        self.words = QLabel("Looking at names and motion…", self, wordWrap=True)
        self.list = QTreeWidget(self, rootIsDecorated=False, uniformRowHeights=True)
        self.list.setHeaderLabels(list(COLUMNS))
        self.list.setAccessibleName("Proposals")
        for column, width in enumerate((280, 120, 70, 250)):
            self.list.setColumnWidth(column, width)
        self.list.currentItemChanged.connect(self._show)
        self.list.itemChanged.connect(lambda *_: self._count())
        self.why = QLabel(self, wordWrap=True)
        self.why.setTextFormat(Qt.TextFormat.RichText)
        self.why.setMinimumHeight(96)
        self.why.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.limit = QSlider(Qt.Orientation.Horizontal, self)
        self.limit.setRange(0, 99)
        self.limit.setValue(50)
        self.limit.setAccessibleName("At least so sure")
        self.limit.valueChanged.connect(self._check)
        self.limit_words = QLabel(self)
        row = QHBoxLayout()
        row.addWidget(QLabel("Place what is at least", self))
        row.addWidget(self.limit, 1)
        row.addWidget(self.limit_words)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.go = self.buttons.addButton("Place", QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.go)
        self.buttons.accepted.connect(self._place)
        self.buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        for part in (self.words, self.list, self.why):
            layout.addWidget(part, 1 if part is self.list else 0)
        layout.addLayout(row)
        layout.addWidget(self.buttons)
        self._count()
        self._look()

    def _look(self) -> None:
        project = self.document.project

        def work(job: Job) -> Proposals:
            return propose(project, cancelled=lambda: job.cancelled, progress=job.tell)

        self.jobs.start("Proposing labels", work, self._fill, lambda error: self.words.setText(str(error)))

    def _fill(self, found: Proposals) -> None:
        self.found = found
        self.list.blockSignals(True)
        self.list.clear()
        look = theme(self.session.theme)
        for p in found.doubtful:
            clip = self.document.project.clips.get(p.clip)
            if clip is None:
                continue  # it was removed meanwhile
            kind = p.kind.value
            item = QTreeWidgetItem(
                self.list, [clip.name, f"{KIND_MARKS[kind]} {kind}", p.layer.value, self._where(p), f"{p.confidence:.0%}"]
            )
            item.setData(0, CLIP, p.clip)
            item.setForeground(1, QColor(look.kinds[kind]))
            if p.conflicts or p.good is False:
                item.setForeground(4, QColor(look.warning))
        self.list.blockSignals(False)
        count = self.list.topLevelItemCount()
        unsure = sum(1 for p in found.proposals.values() if p.confidence < 0.9 or p.conflicts)
        self.words.setText(
            f"{count} clips are not placed yet; {unsure} of them are worth a look, the least certain stand first."
            if count
            else "Every clip is placed."
        )
        self._check()

    def _where(self, p: Proposal) -> str:
        stance = self.found.places[p.stance.value].name if p.stance is not None else "?"
        return f"{stance} ➜ {self.found.places[p.end_stance.value].name}" if p.end_stance is not None else stance

    def _items(self) -> list[QTreeWidgetItem]:
        return [item for n in range(self.list.topLevelItemCount()) if (item := self.list.topLevelItem(n)) is not None]

    def _check(self) -> None:
        """Tick what is as sure as the slider says."""
        limit = self.limit.value() / 100
        self.limit_words.setText(f"{limit:.0%} sure")
        self.list.blockSignals(True)
        for item in self._items():
            sure = self.found.proposals[item.data(0, CLIP)].confidence >= limit
            item.setCheckState(0, Qt.CheckState.Checked if sure else Qt.CheckState.Unchecked)
        self.list.blockSignals(False)
        self._count()

    def chosen(self) -> list[str]:
        """Return the clips that are ticked."""
        return [item.data(0, CLIP) for item in self._items() if item.checkState(0) == Qt.CheckState.Checked]

    def _count(self) -> None:
        count = len(self.chosen())
        self.go.setText(f"Place {count} clip{'s' if count != 1 else ''}" if count else "Place")
        self.go.setEnabled(count > 0)

    def _show(self) -> None:
        """Play the clip of the current row, and say why it is taken for what it is."""
        item = self.list.currentItem()
        if item is None:
            return
        p = self.found.proposals[item.data(0, CLIP)]
        self.session.show_clip(p.clip)
        rows = [f"<b>{escape(words)}</b>" for words in (*p.conflicts, *([p.timing_reason] if p.good is False else []))]
        parts = (("kind", p.kind), ("layer", p.layer), ("stance", p.stance), ("end", p.end_stance))
        rows += [f"{name} {b.confidence:.0%}: {escape(b.reason)}" for name, b in parts if b is not None]
        self.why.setText("<br>".join(rows))

    def _place(self) -> None:
        clips = self.chosen()
        taken = accept(self.document.project, self.found, clips=clips)
        self.placed = len(taken.placed)
        self.document.edit(f"Label {self.placed} clips", lambda p: accept(p, self.found, clips=clips).project)
        if not taken.left:
            self.accept()
            return
        why = {self.document.project.clips[c].name: words for c, words in taken.left.items()}
        first = next(iter(why))
        self.words.setText(f"{self.placed} clips were placed; {len(why)} were not: {first}: {why[first]}.")
        self._look_again(set(taken.placed))

    def _look_again(self, gone: set[str]) -> None:
        """Take what was placed off the list."""
        self.found = Proposals({c: p for c, p in self.found.proposals.items() if c not in gone}, self.found.places)
        words = self.words.text()
        self._fill(self.found)
        self.words.setText(words)
