"""What was read of one who talks, on a card."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
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

from app.features.conversation.conversation_panel import PLURALS
from app.features.conversation.conversation_settings import caption
from app.features.conversation.word_lists import language_name
from app.look.plural import many
from app.look.theme import SOUND_MARKS
from app.widgets.making import make_widget
from metagraph.graph.conversation import SPOKEN, Side


class Card(QFrame):
    """One who talks: name, sound, words, and how many segments. taken: whether it is in the conversation; of
    two both are. earlier: lets it stand before the one on its left.
    """

    def __init__(self, title: str, parent: QWidget, first: bool = True) -> None:
        super().__init__(parent)
        self.setObjectName("card")
        grid = QGridLayout(self)
        grid.setContentsMargins(14, 10, 14, 12)
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(6)
        grid.setColumnStretch(1, 1)
        row_of = QHBoxLayout()
        row_of.addWidget(caption(title, self), 1)
        self.taken = QCheckBox("Takes part", self)
        self.taken.setChecked(True)
        self.taken.setToolTip("Whether this speaker is in the conversation, with a character of its own")
        self.taken.setAccessibleName(f"The {title.lower()} takes part")
        self.earlier = make_widget(
            QToolButton, self, text="←", toolTip="Before the one on the left: who stands where"
        )
        self.earlier.setAccessibleName(f"Move the {title.lower()} one place forward")
        self.earlier.setEnabled(not first)
        for choice in (self.taken, self.earlier):
            choice.hide()
            row_of.addWidget(choice)
        grid.addLayout(row_of, 0, 0, 1, 2)
        self.name = QLineEdit(self)
        self.name.setPlaceholderText(title)
        self.name.setAccessibleName(f"Name of the {title.lower()}")
        self.sound, self.words, self.segments = QLabel(self), QLabel(self), QLabel(self)
        for row, (words, widget) in enumerate(
            (("Name", self.name), ("Sound", self.sound), ("Words", self.words), ("Segments", self.segments)),
            1,
        ):
            grid.addWidget(caption(words, self, True), row, 0)
            grid.addWidget(widget, row, 1)
            if isinstance(widget, QLabel):
                widget.setTextFormat(Qt.TextFormat.PlainText)

    def show_side(self, side: Side | None) -> None:
        """Show what was read of it; None while that is not known."""
        if side is None:
            for label in (self.sound, self.words, self.segments):
                label.setText("…")
            return
        sound = Path(side.audio).name if side.audio else "none"
        self.sound.setText(f"{sound}, channel {side.channel + 1}" if side.channel is not None else sound)
        spoken = f", {language_name(side.language)}" if side.language else ""
        self.words.setText(
            many(len(side.words), "word") + spoken if side.words else "none: told by its loudness"
        )
        counts = {k: sum(s.kind == k for s in side.segments) for k in SPOKEN}
        self.segments.setText(
            "   ".join(f"{SOUND_MARKS[k]} {n:,} {PLURALS[k] if n != 1 else k}" for k, n in counts.items())
        )
