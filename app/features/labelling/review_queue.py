"""The clips of a review, what is done and what is left, and accepting all that are sure at once."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QProgressBar,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.features.labelling.clip_groups import is_doubtful
from app.features.labelling.review_words import describe_length
from app.look.names import drop_common_start
from app.look.theme import KIND_MARKS, get_theme
from app.stage.session import StageSession
from app.translation import tr, tr_noop, tr_phrase, tr_plural
from app.widgets.quiet_fields import SpinBox
from metagraph.graph.model import Project
from metagraph.suggest.propose import list_waiting_clips
from metagraph.suggest.review import Review, ReviewPace

CLIP = Qt.ItemDataRole.UserRole


class ReviewQueue(QWidget):
    """`clips`: all of the review, in the order they are gone through. `picked`: a clip was clicked.
    `sure_wanted`: accept the sure ones. `limit_changed`: how sure that is. `groups_wanted`: look at groups.
    `bridge_wanted`: join stances that no clip leads to.
    """

    picked = Signal(str)
    sure_wanted = Signal()
    limit_changed = Signal()
    groups_wanted = Signal()
    bridge_wanted = Signal()

    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.clips: tuple[str, ...] = ()
        self.aside: tuple[str, ...] = ()
        self._items: dict[str, QTreeWidgetItem] = {}
        self.bar = QProgressBar(self, textVisible=False)
        self.words = QLabel(tr("Analysing names and motion…"), self, wordWrap=True)
        self.words.setProperty("dim", True)
        self.list = QTreeWidget(self)
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        self.list.setHeaderHidden(True)
        self.list.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names of one set differ at their ends
        self.list.setColumnCount(2)
        self.list.setAccessibleName(tr("Clips to review"))
        header = self.list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.list.currentItemChanged.connect(
            lambda item, _: self.picked.emit(item.data(0, CLIP)) if item is not None else None
        )
        self.sure = QPushButton(tr("Accept certain proposals"), self)
        self.sure.setAutoDefault(False)
        self.sure.setToolTip(
            tr("Accept every proposal that is at least this certain and has no contradiction (A)")
        )
        self.sure.clicked.connect(self.sure_wanted)
        self.limit = SpinBox(self)
        self.limit.setRange(0, 100)
        self.limit.setValue(90)
        self.limit.setSuffix(" %")
        self.limit.setFixedWidth(78)
        self.limit.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.limit.setAccessibleName(tr("Minimum certainty"))
        self.limit.setToolTip(tr("Minimum certainty of the proposals to accept together"))
        self.limit.valueChanged.connect(self.limit_changed)
        self.groups = QPushButton(tr("Review in groups"), self)
        self.groups.setAutoDefault(False)
        self.groups.setToolTip(
            tr("See clips with the same proposal side by side, and accept them together (G)")
        )
        self.groups.clicked.connect(self.groups_wanted)
        self.parted = QLabel(self, wordWrap=True)
        self.bridge = QPushButton(tr("Bridge by blending"), self)
        self.bridge.setAutoDefault(False)
        self.bridge.setToolTip(tr("Add transitions that blend from pose to pose, as one undo step (B)"))
        self.bridge.clicked.connect(self.bridge_wanted)
        for widget in (self.list, self.sure, self.groups, self.bridge):
            widget.setFocusPolicy(
                Qt.FocusPolicy.NoFocus
            )  # keys are the review's, wherever the mouse has been
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 12, 4, 12)
        column.addWidget(self.bar)
        column.addWidget(self.words)
        column.addWidget(self.list, 1)
        row = QHBoxLayout()
        row.addWidget(self.sure, 1)
        row.addWidget(self.limit)
        column.addLayout(row)
        column.addWidget(self.groups)
        column.addWidget(self.parted)
        column.addWidget(self.bridge)
        self.part((), ())

    @property
    def least(self) -> float:
        """How sure a proposal must be to be accepted with the others, 0..1."""
        return self.limit.value() / 100

    def fill(self, clips: Sequence[str], aside: Sequence[str] = ()) -> None:
        """List other clips, and at the end those that were skipped."""
        self.list.blockSignals(True)
        self.list.clear()
        self.clips, self.aside, self._items = tuple(clips), tuple(aside), {}
        for clip in (*clips, *aside):
            if aside and clip == aside[0]:
                head = QTreeWidgetItem(self.list, [tr("Skipped ({count})", count=len(aside)), ""])
                head.setFlags(Qt.ItemFlag.NoItemFlags)
                head.setToolTip(
                    0, tr("These are none of the four kinds. To label one anyway, choose its kind.")
                )
            item = self._items[clip] = QTreeWidgetItem(self.list, ["", ""])
            item.setData(0, CLIP, clip)
            item.setTextAlignment(1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.list.blockSignals(False)

    def say_nothing_to_bridge(self) -> None:
        """Say that no stance waits to be joined to the others."""
        words = tr("Nothing to bridge: every placed stance has a way in and out.")
        if words not in self.parted.text():
            self.parted.setText("\n".join(text for text in (self.parted.text(), words) if text))
        self.parted.setVisible(True)

    def part(self, stances: Sequence[str], made: Sequence[str], unbridged: Sequence[str] = ()) -> None:
        """Report stances, by name, that no clip leads to or from, or else what was made of blends; and why
        others cannot be joined by blending.
        """
        names = ", ".join(stances[:4]) + (" …" if len(stances) > 4 else "")
        if stances:
            self.parted.setText(
                tr_plural(
                    "{count:,} stance has no clip that leads to it, or none that leads back: {names}.",
                    "{count:,} stances have no clip that leads to them, or none that leads back: {names}.",
                    len(stances),
                    names=names,
                )
            )
        else:
            self.parted.setText(
                tr_plural(
                    "Added {count:,} blended transition.",
                    "Added {count:,} blended transitions.",
                    len(made),
                )
                if made
                else ""
            )
        told = [text for text in (self.parted.text(), *(tr_phrase(words) for words in unbridged[:2])) if text]
        self.parted.setText("\n".join(told))
        self.parted.setToolTip("\n".join([*(stances if stances else made), *map(tr_phrase, unbridged)]))
        self.parted.setVisible(bool(told))
        self.bridge.setVisible(bool(stances))

    def go_to(self, clip: str) -> None:
        """Show a clip as the current one; `picked` is not emitted."""
        self.list.blockSignals(True)
        self.list.setCurrentItem(self._items[clip])
        self.list.blockSignals(False)

    def refresh(self, review: Review, project: Project) -> None:
        """Show what each clip is taken for now, and whether it is placed."""
        look, open_ = get_theme(self.session.look.name), set(list_waiting_clips(project))
        there = [clip for clip in self._items if clip in project.clips]
        short = drop_common_start([project.clips[clip].name for clip in there])
        names = dict(zip(there, short, strict=True))
        for clip, item in self._items.items():
            entry, p = project.clips.get(clip), review.found.proposals.get(clip)
            item.setHidden(entry is None)
            if entry is None:
                continue
            if p is None:
                item.setText(0, f"–  {names[clip]}")
                item.setToolTip(
                    0, tr("{name}: skipped, {why}", name=entry.name, why=review.found.aside.get(clip, ""))
                )
                for column in (0, 1):
                    item.setForeground(column, QColor(look.dim))
                continue
            placed, kind = clip not in open_, p.kind.value
            item.setText(0, f"{KIND_MARKS[kind]}  {names[clip]}")
            item.setToolTip(0, entry.name)
            item.setText(1, "✓" if placed else f"{100 * p.confidence:.0f} %")
            odd = not placed and is_doubtful(p)
            item.setForeground(0, QColor(look.dim) if placed else look.kind(kind))
            item.setForeground(1, QColor(look.warning if odd else look.dim))

    def count(self, left: int, sure: int, pace: ReviewPace) -> None:
        """Show how far it is. left: clips that are not placed. sure: those of them that can be accepted at
        once.
        """
        total = len(self.clips)
        self.bar.setMaximum(max(1, total))
        self.bar.setValue(total - left)
        if not total:
            what = tr("All remaining clips were skipped.") if self.aside else tr("All clips are placed.")
            self.words.setText(what)
        elif not left:
            self.words.setText(tr("All {total} clips are placed.", total=total))
        else:
            words = (
                tr_noop("{placed} of {total} placed, {time} left at your pace")
                if pace.known
                else tr_noop("{placed} of {total} placed, {time} left at a typical pace")
            )
            self.words.setText(
                tr(words, placed=total - left, total=total, time=describe_length(pace.left(left)))
            )
        self.sure.setText(
            tr_plural("Accept {count:,} proposal", "Accept {count:,} proposals", sure)
            if sure
            else tr("No certain proposals")
        )
        self.sure.setEnabled(sure > 0)
        self.groups.setEnabled(left > 0)
