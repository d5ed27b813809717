"""Going through proposals group by group: all gestures of a stance side by side, moving; what does not belong
is clicked away, the rest is accepted with one key.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app.features.labelling.clip_groups import ClipGroup, group_alike, is_doubtful
from app.features.labelling.group_sheet import GroupSheet, SheetCard
from app.features.labelling.review_session import Reviewing
from app.features.labelling.review_words import describe_placing
from app.look.names import drop_common_start, make_readable_name
from app.look.theme import KIND_MARKS, get_theme, strengthen
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import tr, tr_phrase, tr_plural
from app.widgets.quiet_fields import ComboBox
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import KINDS
from metagraph.suggest.review import Field

ROW = 26  # pixels: height of a group in the list


class GroupsDialog(QDialog):
    """`opened`: a clip is to be looked at by itself."""

    opened = Signal(str)

    def __init__(
        self, work: Reviewing, session: StageSession, thumbnails: Thumbnails, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.work, self.session = work, session
        self.groups: list[ClipGroup] = []
        self._unexpected = ""  # what was not placed, or was placed, too; until the next decision
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Review in groups"))
        if parent is not None:
            self.resize(parent.size() * 0.94)
        self.list = QListWidget(self)
        self.list.setMinimumWidth(230)
        self.list.setAccessibleName(tr("Groups"))
        self.list.currentRowChanged.connect(self._show)
        self.heading, self.told = QLabel(self), QLabel(self, wordWrap=True)
        self.heading.setProperty("heading", True)
        self.told.setProperty("dim", True)
        self.sheet = GroupSheet(session, thumbnails, self)
        self.sheet.changed.connect(self._count)
        self.sheet.opened.connect(self._open)
        self.kind = self._combo(tr("Change the kind of the clips shown"), "kind")
        self.stance = self._combo(tr("Change the stance of the clips shown"), "stance")
        self.go, self.shut = QPushButton(tr("Accept"), self), QPushButton(tr("Close"), self)
        strengthen(self.go)
        for button, run in ((self.go, self.accept_group), (self.shut, self.close)):
            button.setAutoDefault(False)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            button.clicked.connect(run)
        self._lay_out()
        work.changed.connect(self._regroup)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # all keys but Tab are the dialog's
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._regroup()
        self.setFocus()

    def _combo(self, words: str, name: Field) -> ComboBox:
        combo = ComboBox(self)
        combo.setAccessibleName(words)
        combo.setToolTip(words)
        combo.activated.connect(lambda row: self._correct(name, combo.itemData(row)))
        return combo

    def _lay_out(self) -> None:
        scroll = QScrollArea(self)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setWidget(self.sheet)
        above = QHBoxLayout()
        above.addWidget(self.heading, 1)
        above.addWidget(self.kind)
        above.addWidget(self.stance)
        below = QHBoxLayout()
        below.addWidget(self.told, 1)
        below.addWidget(self.shut)
        below.addWidget(self.go)
        right = QVBoxLayout()
        right.addLayout(above)
        right.addWidget(scroll, 1)
        right.addLayout(below)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.addWidget(self.list)
        layout.addLayout(right, 1)

    @property
    def group(self) -> ClipGroup | None:
        """Return the group that is shown."""
        row = self.list.currentRow()
        return self.groups[row] if 0 <= row < len(self.groups) else None

    # --- showing

    def _regroup(self) -> None:
        """List the groups of what waits, and stay with the one that is shown, or what is in its place."""
        before, row = self.group, self.list.currentRow()
        self.groups = group_alike(self.work.review, self.work.waiting())
        keys = [group.key for group in self.groups]
        at = keys.index(before.key) if before is not None and before.key in keys else max(0, row)
        look = get_theme(self.session.look.name)
        self.list.blockSignals(True)
        self.list.clear()
        for group in self.groups:
            odd = sum(is_doubtful(self.work.review.found.proposals[clip]) for clip in group.clips)
            words = f"{KIND_MARKS[group.kind]}  {group.title}  ({len(group.clips)})"
            item = QListWidgetItem(f"{words}  ⚠ {odd}" if odd else words, self.list)
            item.setForeground(look.kind(group.kind))
            item.setSizeHint(QSize(0, ROW))
            if odd:
                item.setToolTip(tr_plural("{count:,} clip needs a look", "{count:,} clips need a look", odd))
        self.list.setCurrentRow(min(at, len(self.groups) - 1))
        self.list.blockSignals(False)
        self._show()

    def _show(self) -> None:
        group, review, clips = self.group, self.work.review, self.work.document.project.clips
        if group is None:
            self.sheet.show_cards(())
            self.heading.setText(tr("All clips are placed."))
            self._fill(self.kind, [], None)
            self._fill(self.stance, [], None)
            self.told.clear()
            return
        self.heading.setText(f"{group.title}  ·  {group.count()}")
        there = [clip for clip in self.work.clips if clip in clips]
        names = dict(zip(there, drop_common_start([clips[c].name for c in there]), strict=True))
        cards = []
        for clip in group.clips:
            name = names.get(clip, clips[clip].name)
            p = review.found.proposals[clip]
            reasons = [tr_phrase(p.kind.reason), *([tr_phrase(p.stance.reason)] if p.stance else [])]
            words = "\n".join([clips[clip].name, *reasons, *map(tr_phrase, p.conflicts)])
            short = make_readable_name(name, group.stance)
            cards.append(SheetCard(clip, short, words, p.confidence, is_doubtful(p)))
        self.sheet.show_cards(cards)
        self._fill(self.kind, [(kind, get_vocabulary_title(kind)) for kind in KINDS], group.kind)
        first = group.clips[0]
        several = group.kind in ("stance", "transition")  # of several stances: none is the one of all
        choices = [] if several else review.choices(first, "stance")
        self._fill(self.stance, choices, review.value(first, "stance"))

    def _fill(self, combo: ComboBox, choices: list[tuple[Any, str]], now: object) -> None:
        combo.clear()
        for value, words in choices:
            combo.addItem(words, value)
        combo.setCurrentIndex(next((n for n, (value, _) in enumerate(choices) if value == now), -1))
        combo.setVisible(bool(choices))

    def _count(self) -> None:
        count = len(self.sheet.chosen)
        out = len(self.sheet.cards) - count
        self.go.setText(tr_plural("Accept {count:,} clip", "Accept {count:,} clips", count))
        self.go.setEnabled(count > 0)
        hint = tr("Click a clip that does not belong to leave it out. Double-click to look at it by itself.")
        stays = tr_plural("{count:,} clip stays in the review.", "{count:,} clips stay in the review.", out)
        self.told.setText(self._unexpected or (stays if out else hint))

    # --- deciding

    def accept_group(self) -> None:
        """Place the clips that were not left out, as one undo step."""
        clips = self.sheet.chosen
        if not clips:
            return
        row, key = self.list.currentRow(), self.groups[self.list.currentRow()].key
        taken = self.work.place(clips, tr("Label {clips} clips", clips=len(clips)), None)
        self._unexpected = describe_placing(taken, clips)
        self._regroup()
        others = [n for n, group in enumerate(self.groups) if group.key != key]
        self.list.setCurrentRow(next((n for n in others if n >= row), others[0] if others else row))

    def _correct(self, name: Field, value: object) -> None:
        """Take a value for a field of every clip that was not left out."""
        self._unexpected = ""
        self.work.tell_all(self.sheet.chosen, name, value)
        self.setFocus()

    def _open(self, clip: str) -> None:
        self.opened.emit(clip)
        self.close()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, sheet = event.key(), self.sheet
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.accept_group()
        elif key == Qt.Key.Key_Backspace or event.matches(QKeySequence.StandardKey.Undo):
            if self.work.can_undo:
                self.work.undo()
                self._regroup()
        elif key == Qt.Key.Key_Space and sheet.cards:
            sheet.toggle(sheet.cards[sheet.current].clip)
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            row = self.list.currentRow() + (1 if key == Qt.Key.Key_Down else -1)
            self.list.setCurrentRow(min(max(0, row), len(self.groups) - 1))
        elif Qt.Key.Key_1 <= key <= Qt.Key.Key_4 and sheet.cards:
            self._correct("kind", KINDS[key - Qt.Key.Key_1])
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            sheet.step(1 if key == Qt.Key.Key_Right else -1)
        else:
            super().keyPressEvent(event)  # Esc closes
