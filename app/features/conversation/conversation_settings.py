"""Small dialogs about a conversation: how often each who talks moves with what is said, whose sound is
whose.
"""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QBoxLayout,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.document import Document
from app.stage.performance import StagePerformance
from app.stage.playback_source import ShownPlayback
from app.translation import make_lazy_texts, tr, tr_error, tr_noop, tr_phrase
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import SPOKEN, Conversation, Rates, get_side_name
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.speech.gaze_shares import join_shares

RATES = make_lazy_texts(
    lambda: {
        "clause": (tr("gestures on own clauses"), tr("How often the hands move with a clause")),
        "response": (
            tr("nods on own responses"),
            tr("How often the head nods with a “yeah” or “mm-hmm”"),
        ),
        "hesitation": (
            tr("nods when the partner hesitates"),
            tr("How often the head nods while the partner says “er”"),
        ),
        "mirror": (
            tr("mirrors the partner's stance"),
            tr("How often this speaker copies the partner's change of stance while listening"),
        ),
        "mood": (
            tr("takes on the partner's mood"),
            tr("How strongly the partner's mood shows in this speaker's face and posture a moment later"),
        ),
        "laugh": (
            tr("laughs along"),
            tr("How often this speaker answers another's laugh with a laughing face"),
        ),
    }
)
BLINKS = make_lazy_texts(
    lambda: {
        "life": (
            tr("As in Life, plus on stresses"),
            tr("The blinks of the life layer, plus a blink on many clause peaks"),
        ),
        "peaks": (
            tr("On stresses, and after 5 s without a blink"),
            tr(
                "On a clause's peak if the last blink is at least one second ago, and otherwise after "
                "five seconds without a blink, as keyed by Yang et al. (section 7.3)"
            ),
        ),
    }
)
ORDINALS = make_lazy_texts(
    lambda: (
        tr("first"),
        tr("second"),
        tr("third"),
        tr("fourth"),
        tr("fifth"),
        tr("sixth"),
        tr("seventh"),
        tr("eighth"),
    )
)
ACTORS = make_lazy_texts(lambda: {"female": tr("the woman"), "male": tr("the man")})


def parse_word_list(words: str) -> tuple[str, ...]:
    """Return the words of a list that was typed: one a line, or parted by commas."""
    return tuple(
        dict.fromkeys(x for part in words.replace(",", "\n").split("\n") if (x := " ".join(part.split())))
    )


def make_caption(words: str, parent: QWidget, dim: bool = False) -> QLabel:
    out = QLabel(words, parent, wordWrap=dim)
    out.setProperty("dim" if dim else "title", True)
    return out


class SettingDialog(QDialog):
    """One step of undo for all that is set in it; what cannot be is said, and the dialog stays."""

    title = text = ""

    def __init__(self, document: Document, ident: str, conversation: Conversation, parent: QWidget) -> None:
        super().__init__(parent)
        self.document, self.ident, self.conversation = document, ident, conversation
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr(self.title))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(18, 16, 18, 14)
        layout.setSpacing(12)
        self.build(layout)
        self.said = QLabel(self, wordWrap=True)
        self.said.hide()
        layout.addWidget(self.said)
        buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Cancel | QDialogButtonBox.StandardButton.Ok, self
        )
        self.go = buttons.button(QDialogButtonBox.StandardButton.Ok)
        strengthen(self.go)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        document.loaded.connect(self.reject)
        layout.addWidget(buttons)

    def build(self, layout: QVBoxLayout) -> None:
        raise NotImplementedError

    def change(self, project: Project) -> Project:
        raise NotImplementedError

    def accept(self) -> None:
        try:
            self.document.edit(tr(self.text), self.change)
        except EditError as error:
            self.said.setText(f"{tr_error(error)[:1].upper()}{tr_error(error)[1:]}.")
            self.said.show()
            return
        super().accept()


def describe_delivered(shown: ShownPlayback, conversation: Conversation) -> str:
    """Return how the performance on the stage meets the rates, with a line for each side and rate, and with
    three or more speakers where they look. Return "" if there is nothing to report.
    """
    rates = [
        f"{get_side_name(conversation, one.side)}: {tr_phrase(told.words())}"
        for one in shown.everyone
        for told in one.told
        if told.count
    ]
    looks = join_shares([share for one in shown.everyone for share in one.looks])
    return "\n".join(
        (*rates, *(tr("All speakers: {words}", words=tr_phrase(share.words())) for share in looks))
    )


class Tall(QScrollArea):
    """What three or more who talk need: as high as it likes, scrolled where the screen has less. most: pixels
    it is high at most before.
    """

    def __init__(self, inside: QWidget, most: int, parent: QWidget) -> None:
        super().__init__(parent)
        self.inside = inside
        self.setWidget(inside)
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.most = most

    def sizeHint(self) -> QSize:
        inside, bar = self.inside.sizeHint(), self.verticalScrollBar().sizeHint().width()
        return QSize(inside.width() + bar, min(self.most, inside.height() + 2))

    def minimumSizeHint(self) -> QSize:
        inside, bar = self.inside.minimumSizeHint(), self.verticalScrollBar().sizeHint().width()
        return QSize(inside.width() + bar, min(self.most, inside.height() + 2, 160))


class SideRatesDialog(SettingDialog):
    """How often each who talks moves with what is said, and what becomes of it on stage."""

    title, text = tr_noop("Rates"), tr_noop("Change rates")

    def __init__(
        self,
        document: Document,
        ident: str,
        conversation: Conversation,
        performance: StagePerformance,
        parent: QWidget,
    ) -> None:
        self.performance = performance
        super().__init__(document, ident, conversation, parent)
        performance.changed.connect(self.refresh)
        self.refresh()

    def build(self, layout: QVBoxLayout) -> None:
        layout.addWidget(
            make_caption(
                tr(
                    "How often each speaker moves with the speech. The right columns show what actors did "
                    "(Yang et al. 2020)."
                ),
                self,
                True,
            )
        )
        grid = QGridLayout()
        grid.setHorizontalSpacing(18)
        grid.setVerticalSpacing(8)
        count = len(self.conversation.sides)
        for side in range(count):
            whose = make_caption(get_side_name(self.conversation, side), self)
            whose.setWordWrap(True)
            grid.addWidget(whose, 0, 1 + side)
        for column, actor in enumerate(ACTORS.values()):
            told = make_caption(actor[:1].upper() + actor[1:], self, True)
            told.setWordWrap(count == 2)  # of more the fields need the room
            grid.addWidget(told, 0, 1 + count + column)
        self.fields: list[dict[str, QDoubleSpinBox]] = [{} for _ in range(count)]
        for row, (name, (words, tip)) in enumerate(RATES.items(), 1):
            grid.addWidget(QLabel(words[:1].upper() + words[1:], self), row, 0)
            for side in range(count):
                field = DoubleSpinBox(self, toolTip=tip, suffix=" %", decimals=0)
                field.setRange(0, 100)
                field.setAccessibleName(f"{get_side_name(self.conversation, side)} {words}")
                field.setValue(100 * getattr(self.conversation.sides[side].rates, name))
                self.fields[side][name] = field
                grid.addWidget(field, row, 1 + side)
            for column, actor in enumerate(ACTORS):
                did = (
                    f"{100 * getattr(conversation_edits.PAPER[actor], name):.0f} %" if name in SPOKEN else "–"
                )
                told = make_caption(did, self, True)
                told.setWordWrap(count == 2)
                grid.addWidget(told, row, 1 + count + column)
        for side in range(count):
            row_of: QBoxLayout = QHBoxLayout() if count == 2 else QVBoxLayout()
            row_of.setSpacing(2)
            for actor, words in ACTORS.items():
                button = make_widget(
                    QToolButton,
                    self,
                    text=tr("As {actor}", actor=words),
                    toolTip=tr("Use the rates of {actor} in the paper", actor=words),
                )
                button.clicked.connect(
                    lambda _=False, side=side, rates=conversation_edits.PAPER[actor]: self.take(side, rates)
                )
                row_of.addWidget(button)
            grid.addLayout(row_of, len(RATES) + 1, 1 + side)
        layout.addLayout(grid)
        row_of = QHBoxLayout()
        row_of.addWidget(QLabel(tr("Blinks"), self))
        self.blinks = ComboBox(self)
        self.blinks.setAccessibleName(tr("Blinks"))
        for value, (words, tip) in BLINKS.items():
            self.blinks.addItem(words, value)
            self.blinks.setItemData(self.blinks.count() - 1, tip, Qt.ItemDataRole.ToolTipRole)
        self.blinks.setCurrentIndex(list(BLINKS).index(self.conversation.blinks))
        row_of.addWidget(self.blinks)
        row_of.addStretch(1)
        layout.addLayout(row_of)
        self.delivered = make_caption("", self, True)
        if count == 2:
            layout.addWidget(self.delivered)
            layout.addStretch(1)
        else:
            self.delivered.setAlignment(Qt.AlignmentFlag.AlignTop)
            layout.addWidget(Tall(self.delivered, 260, self), 1)
            self.resize(max(800, 260 + 150 * count), 600)

    def refresh(self) -> None:
        """Say what becomes of the rates as they are."""
        self.delivered.setText(describe_delivered(self.performance.shown, self.conversation))
        self.delivered.setVisible(bool(self.delivered.text()))

    def take(self, side: int, rates: Rates) -> None:
        for name in SPOKEN:
            self.fields[side][name].setValue(100 * getattr(rates, name))

    def change(self, project: Project) -> Project:
        for side in range(len(self.fields)):
            values = {name: round(field.value() / 100, 4) for name, field in self.fields[side].items()}
            project = conversation_edits.set_rates(project, self.ident, side, **values)
        return conversation_edits.change_conversation(project, self.ident, blinks=self.blinks.currentData())
