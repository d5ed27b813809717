"""What new motion should have beside the constraints: how it is said, words, and another speed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QLineEdit, QWidget

from app.translation import tr
from app.widgets.making import make_widget
from app.widgets.quiet_fields import DoubleSpinBox
from metagraph.graph.conversation.model import Segment, Side

if TYPE_CHECKING:
    from metagraph.synthesis.prosody_costs import SpokenTake
    from metagraph.synthesis.soft_constraints import SoftWish

LONGEST = 7200.0  # seconds of a sound
KEPT = 16000  # samples a second that are kept of one


class SoftWishes(QWidget):
    """A row of fields, all of which ask for nothing at first. wanted: Enter was pressed."""

    wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        self.loudness = self._weight(
            tr("Loudness"),
            tr(
                "Prefers frames with a similar loudness, measured by the speaker's own standard "
                "deviation. Start with 0.25. Needs the sounds of the conversations"
            ),
        )
        self.rate = self._weight(
            tr("Speaking rate"),
            tr(
                "Prefers frames with a similar speaking rate. Start with 0.25. Uses the words if there "
                "are any, otherwise the sound"
            ),
        )
        self.words = QLineEdit(self, placeholderText=tr("big; round = circle, ball"))
        self.words.setAccessibleName(tr("Key words"))
        self.words.setToolTip(
            tr(
                "When one of these words is said, the motion comes from a take that says it or a "
                "similar word. Separate words with semicolons"
            )
        )
        self.words.setMinimumWidth(170)
        self.words.returnPressed.connect(self.wanted)
        self.must = make_widget(QCheckBox, tr("required"), self)
        self.must.setToolTip(tr("The search gives up other constraints before it misses one of these words"))
        self.speed = DoubleSpinBox(
            self, minimum=0, maximum=50, singleStep=5, decimals=0, value=0, prefix="± ", suffix=" %"
        )
        self.speed.setAccessibleName(tr("Change speed by up to"))
        self.speed.setToolTip(
            tr(
                "Plays parts faster or slower, except strokes, steps and transitions, so that starts, "
                "ends and stresses match the speech. Try 15 %."
            )
        )
        for words, field in (
            (tr("Also match: loudness"), self.loudness),
            (tr("speaking rate"), self.rate),
            (tr("key words"), self.words),
        ):
            row.addWidget(QLabel(words, self))
            row.addWidget(field, int(field is self.words))
            row.addSpacing(6)
        row.addWidget(self.must)
        row.addSpacing(6)
        row.addWidget(QLabel(tr("change speed"), self))
        row.addWidget(self.speed)
        row.addSpacing(12)

    def _weight(self, name: str, tip: str) -> DoubleSpinBox:
        out = DoubleSpinBox(self, minimum=0, maximum=20, singleStep=0.05, decimals=2, value=0)
        out.setAccessibleName(name)
        out.setToolTip(
            tr(
                "{tip}. The number is the cost of one second that differs by one standard deviation, as "
                "a share of what a transition can cost.",
                tip=tip,
            )
        )
        return out

    def wish(self) -> SoftWish:
        """Return what is requested now. Raises ValueError if a word is none."""
        from metagraph.synthesis.iconic_words import parse_word_wish
        from metagraph.synthesis.soft_constraints import SoftWish

        words = tuple(parse_word_wish(text) for text in self.words.text().split(";") if text.strip())
        return SoftWish(
            self.loudness.value(),
            self.rate.value(),
            words,
            hard=self.must.isChecked() and bool(words),
            retime=self.speed.value() / 100,
        )


def read_side_prosody(
    side: Side | None, segments: Sequence[Segment], folder: Path | None, wish: SoftWish
) -> SpokenTake:
    """Return what is known of the speech a side moves with, and of its sound where the wish needs that. side:
    None if nobody knows. folder: of the project. Raises FileError.
    """
    from metagraph.speech.prosody import measure_prosody
    from metagraph.speech.sound import read_sound
    from metagraph.synthesis.prosody_costs import SpokenTake

    if side is None:
        return SpokenTake(tuple(segments))
    samples, rate = None, 0
    silent = not side.words and not any(s.text for s in segments)
    if side.audio is not None and (wish.loudness or (wish.rate and silent)):
        samples, rate = read_sound((folder or Path()) / side.audio, side.channel, LONGEST, KEPT)
    return SpokenTake(tuple(segments), side.words, measure_prosody(segments, side.words, samples, rate))
