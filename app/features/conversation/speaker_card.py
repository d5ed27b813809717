"""What was read of those who talk, on cards."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QToolButton,
    QWidget,
)

from app.features.conversation.conversation_settings import ORDINALS, Tall, make_caption
from app.features.conversation.segment_lanes import KINDS, PLURALS
from app.features.conversation.word_lists import name_language
from app.look.theme import SOUND_MARKS
from app.translation import group_thousands, tr, tr_plural
from app.widgets.making import make_widget
from metagraph.graph.conversation.model import SPOKEN, Side


class SpeakerCard(QFrame):
    """One who talks: name, sound, words, and how many segments. taken: whether it is in the conversation; of
    two both are. ordinal: "first", "second". earlier: lets it stand before the one on its left.
    """

    def __init__(self, ordinal: str, parent: QWidget, first: bool = True) -> None:
        super().__init__(parent)
        title = tr("{ordinal} speaker", ordinal=ordinal.capitalize())
        self.setObjectName("card")
        grid = QGridLayout(self)
        grid.setContentsMargins(14, 10, 14, 12)
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(6)
        grid.setColumnStretch(1, 1)
        row_of = QHBoxLayout()
        row_of.addWidget(make_caption(title, self), 1)
        self.taken = QCheckBox(tr("Include"), self)
        self.taken.setChecked(True)
        self.taken.setToolTip(tr("Includes this speaker in the conversation, with their own character"))
        self.taken.setAccessibleName(tr("Include the {ordinal} speaker", ordinal=ordinal))
        self.earlier = make_widget(
            QToolButton, self, text="←", toolTip=tr("Move this speaker one place to the left")
        )
        self.earlier.setAccessibleName(
            tr("Move the {ordinal} speaker one place to the left", ordinal=ordinal)
        )
        self.earlier.setEnabled(not first)
        for choice in (self.taken, self.earlier):
            choice.hide()
            row_of.addWidget(choice)
        grid.addLayout(row_of, 0, 0, 1, 2)
        self.name = QLineEdit(self)
        self.name.setPlaceholderText(title)
        self.name.setAccessibleName(tr("Name of the {ordinal} speaker", ordinal=ordinal))
        self.sound, self.words, self.segments = QLabel(self), QLabel(self), QLabel(self)
        for row, (words, widget) in enumerate(
            (
                (tr("Name"), self.name),
                (tr("Sound"), self.sound),
                (tr("Words"), self.words),
                (tr("Segments"), self.segments),
            ),
            1,
        ):
            grid.addWidget(make_caption(words, self, True), row, 0)
            grid.addWidget(widget, row, 1)
            if isinstance(widget, QLabel):
                widget.setTextFormat(Qt.TextFormat.PlainText)

    def show_side(self, side: Side | None) -> None:
        """Show what was read of it; None while that is not known."""
        if side is None:
            for label in (self.sound, self.words, self.segments):
                label.setText("…")
            return
        sound = Path(side.audio).name if side.audio else tr("none")
        self.sound.setText(
            tr("{sound}, channel {number}", sound=sound, number=side.channel + 1)
            if side.channel is not None
            else sound
        )
        spoken = f", {name_language(side.language)}" if side.language else ""
        self.words.setText(
            tr_plural("{count:,} word", "{count:,} words", len(side.words)) + spoken
            if side.words
            else tr("none: detected from loudness")
        )
        counts = {k: sum(s.kind == k for s in side.segments) for k in SPOKEN}
        self.segments.setText(
            "   ".join(
                f"{SOUND_MARKS[k]} {group_thousands(n)} {KINDS[k] if n == 1 else PLURALS[k]}"
                for k, n in counts.items()
            )
        )


class Cards(Tall):
    """A card for each who was read: two beside each other with a button to swap them, more in rows of two.
    moved: one is to stand before the one before it; its number. chosen: somebody takes part, or no longer.
    """

    moved = Signal(int)
    chosen = Signal()

    def __init__(self, parent: QWidget) -> None:
        inside = QWidget(parent)
        super().__init__(inside, 330, parent)  # two rows; more are scrolled
        self.setAccessibleName(tr("Detected speakers"))
        self.cards: list[SpeakerCard] = []
        self.grid = QGridLayout(inside)
        self.grid.setContentsMargins(0, 0, 0, 0)
        self.grid.setSpacing(10)
        self.grid.setColumnStretch(0, 1)
        self.grid.setColumnStretch(2, 1)
        self.swap = make_widget(
            QToolButton,
            inside,
            text="⇄",
            toolTip=tr("Swap the two speakers. The left one is moved by this project's graph."),
        )
        self.swap.setAccessibleName(tr("Swap speakers"))
        self.swap.clicked.connect(lambda: self.moved.emit(1))
        self.grid.addWidget(self.swap, 0, 1)
        self.deal(2)

    def deal(self, count: int) -> None:
        """Have so many cards."""
        if len(self.cards) == count:
            return
        for card in self.cards[count:]:
            card.deleteLater()
        del self.cards[count:]
        for n in range(len(self.cards), count):
            card = SpeakerCard(ORDINALS[n], self.inside, n == 0)
            card.earlier.clicked.connect(lambda _=False, n=n: self.moved.emit(n))
            card.taken.toggled.connect(lambda _: self.chosen.emit())
            self.cards.append(card)
            self.grid.addWidget(card, n // 2, 2 * (n % 2))
            card.show()  # at once: how high the cards are is asked for below
        self.swap.setVisible(count == 2)
        for card in self.cards:
            for choice in (card.taken, card.earlier):
                choice.setVisible(count > 2)
        self.grid.activate()
        self.setFixedHeight(self.sizeHint().height())
