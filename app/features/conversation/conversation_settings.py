"""Small dialogs about a conversation: how often each who talks moves with what is said, whose sound is
whose.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QBoxLayout,
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFileDialog,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.document import Document
from app.project.speech_files import SOUNDS, channels_of
from app.stage.performance import Performance
from app.stage.playback_source import Shown
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.formats.store import SUFFIX, relative
from metagraph.graph import conversation_edits
from metagraph.graph.conversation import SPOKEN, Conversation, Rates, side_name
from metagraph.graph.edits import EditError
from metagraph.graph.model import Project
from metagraph.speech.duet import stands
from metagraph.speech.gaze_shares import together

RATES = {
    "clause": ("gestures with its own clauses", "How often the hands move with a clause"),
    "response": ("nods with its own responses", "How often the head nods with a “yeah” or “mm-hmm”"),
    "hesitation": ("nods when the other hesitates", "How often the head nods while the partner says “er”"),
    "mirror": (
        "mirrors the other's stance",
        "How often the partner's change of stance is taken up while listening",
    ),
}
BLINKS = {
    "life": ("As in Life, and on stresses", "The life layer's blinks, and one on many of the clauses' peaks"),
    "peaks": (
        "On stresses, and after 5 s without",
        "On a clause's peak if the last blink is a second ago, and once in each five seconds without: what "
        "Yang et al. keyed (section 7.3)",
    ),
}
ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")
ROWS = 7  # of the grid for each who talks
ACTORS = {"female": "the woman", "male": "the man"}


def asked(words: str) -> tuple[str, ...]:
    """Return the words of a list that was typed: one a line, or parted by commas."""
    return tuple(
        dict.fromkeys(x for part in words.replace(",", "\n").split("\n") if (x := " ".join(part.split())))
    )


def caption(words: str, parent: QWidget, dim: bool = False) -> QLabel:
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
        self.setWindowTitle(self.title)
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
            self.document.edit(self.text, self.change)
        except EditError as error:
            self.said.setText(f"{str(error)[:1].upper()}{str(error)[1:]}.")
            self.said.show()
            return
        super().accept()


def delivered_words(shown: Shown, conversation: Conversation) -> str:
    """Return what becomes of all sides' rates in what is shown, a line for each, and of three or more where
    they look; empty where nothing is.
    """
    rates = [
        f"{side_name(conversation, one.side)}: {told.words()}"
        for one in shown.everyone
        for told in one.told
        if told.count
    ]
    looks = together([share for one in shown.everyone for share in one.looks])
    return "\n".join((*rates, *(f"Whoever is {share.words()}" for share in looks)))


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


class RatesDialog(SettingDialog):
    """How often each who talks moves with what is said, and what becomes of it on stage."""

    title, text = "Rates", "Change rates"

    def __init__(
        self,
        document: Document,
        ident: str,
        conversation: Conversation,
        performance: Performance,
        parent: QWidget,
    ) -> None:
        self.performance = performance
        super().__init__(document, ident, conversation, parent)
        performance.changed.connect(self.refresh)
        self.refresh()

    def build(self, layout: QVBoxLayout) -> None:
        layout.addWidget(
            caption(
                "How often each moves with what is said. Beside: what actors did (Yang et al. 2020).",
                self,
                True,
            )
        )
        grid = QGridLayout()
        grid.setHorizontalSpacing(18)
        grid.setVerticalSpacing(8)
        count = len(self.conversation.sides)
        for side in range(count):
            whose = caption(side_name(self.conversation, side), self)
            whose.setWordWrap(True)
            grid.addWidget(whose, 0, 1 + side)
        for column, actor in enumerate(ACTORS.values()):
            told = caption(actor.capitalize(), self, True)
            told.setWordWrap(count == 2)  # of more the fields need the room
            grid.addWidget(told, 0, 1 + count + column)
        self.fields: list[dict[str, QDoubleSpinBox]] = [{} for _ in range(count)]
        for row, (name, (words, tip)) in enumerate(RATES.items(), 1):
            grid.addWidget(QLabel(words.capitalize(), self), row, 0)
            for side in range(count):
                field = DoubleSpinBox(self, toolTip=tip, suffix=" %", decimals=0)
                field.setRange(0, 100)
                field.setAccessibleName(f"{side_name(self.conversation, side)} {words}")
                field.setValue(100 * getattr(self.conversation.sides[side].rates, name))
                self.fields[side][name] = field
                grid.addWidget(field, row, 1 + side)
            for column, actor in enumerate(ACTORS):
                did = (
                    f"{100 * getattr(conversation_edits.PAPER[actor], name):.0f} %" if name in SPOKEN else "–"
                )
                told = caption(did, self, True)
                told.setWordWrap(count == 2)
                grid.addWidget(told, row, 1 + count + column)
        for side in range(count):
            row_of: QBoxLayout = QHBoxLayout() if count == 2 else QVBoxLayout()
            row_of.setSpacing(2)
            for actor, words in ACTORS.items():
                button = make_widget(
                    QToolButton, self, text=f"As {words}", toolTip=f"The rates of {words} in the paper"
                )
                button.clicked.connect(
                    lambda _=False, side=side, rates=conversation_edits.PAPER[actor]: self.take(side, rates)
                )
                row_of.addWidget(button)
            grid.addLayout(row_of, len(RATES) + 1, 1 + side)
        layout.addLayout(grid)
        row_of = QHBoxLayout()
        row_of.addWidget(QLabel("Blinks", self))
        self.blinks = ComboBox(self)
        self.blinks.setAccessibleName("Blinks")
        for value, (words, tip) in BLINKS.items():
            self.blinks.addItem(words, value)
            self.blinks.setItemData(self.blinks.count() - 1, tip, Qt.ItemDataRole.ToolTipRole)
        self.blinks.setCurrentIndex(list(BLINKS).index(self.conversation.blinks))
        row_of.addWidget(self.blinks)
        row_of.addStretch(1)
        layout.addLayout(row_of)
        self.delivered = caption("", self, True)
        if count == 2:
            layout.addWidget(self.delivered)
            layout.addStretch(1)
        else:
            self.delivered.setAlignment(Qt.AlignmentFlag.AlignTop)
            layout.addWidget(Tall(self.delivered, 260, self), 1)
            self.resize(max(800, 260 + 150 * count), 600)

    def refresh(self) -> None:
        """Say what becomes of the rates as they are."""
        self.delivered.setText(delivered_words(self.performance.shown, self.conversation))
        self.delivered.setVisible(bool(self.delivered.text()))

    def take(self, side: int, rates: Rates) -> None:
        for name in SPOKEN:
            self.fields[side][name].setValue(100 * getattr(rates, name))

    def change(self, project: Project) -> Project:
        for side in range(len(self.fields)):
            values = {name: round(field.value() / 100, 4) for name, field in self.fields[side].items()}
            project = conversation_edits.set_rates(project, self.ident, side, **values)
        return conversation_edits.change_conversation(project, self.ident, blinks=self.blinks.currentData())


class SidesDialog(SettingDialog):
    """Who talks, which sound is whose, whose graph moves each, and where they stand."""

    title, text = "Sounds and names", "Change sounds and names"

    def build(self, layout: QVBoxLayout) -> None:
        self.resize(720, 0 if len(self.conversation.sides) == 2 else 620)
        self.names: list[QLineEdit] = []
        self.sounds: list[QLineEdit] = []
        self.channels: list[QComboBox] = []
        self.movers: list[QLineEdit] = []
        self.places: list[tuple[QCheckBox, QDoubleSpinBox, QDoubleSpinBox]] = []
        count = len(self.conversation.sides)
        inside = QWidget(self)
        grid = QGridLayout(inside)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(10)
        grid.setVerticalSpacing(8)
        grid.setColumnStretch(1, 1)
        for side, of in enumerate(self.conversation.sides):
            top, ordinal = ROWS * side, ORDINALS[side]
            grid.addWidget(caption(f"{ordinal.capitalize()} speaker", inside), top, 0, 1, 3)
            name, sound, channel, mover = (
                QLineEdit(of.name, inside),
                QLineEdit(of.audio or "", inside),
                ComboBox(inside),
                QLineEdit(inside),
            )
            mover.setText(of.project or "")
            mover.setToolTip("The project whose graph and character move this one")
            mover.setClearButtonEnabled(True)
            for row, (words, widget, empty) in enumerate(
                (
                    ("Name", name, f"Speaker {side + 1}"),
                    ("Sound", sound, "No sound"),
                    ("Channel", channel, ""),
                    ("Moved by", mover, "This project"),
                ),
                top + 1,
            ):
                widget.setAccessibleName(f"{words} of the {ordinal} speaker")
                grid.addWidget(QLabel(words, inside), row, 0)
                grid.addWidget(widget, row, 1)
                if isinstance(widget, QLineEdit):
                    widget.setPlaceholderText(empty)
            for row, tip, choose in (
                (top + 2, "Choose a sound file", self.choose),
                (top + 4, "Choose a project", self.choose_project),
            ):
                button = make_widget(QToolButton, inside, text="Choose…", toolTip=tip)
                button.clicked.connect(lambda _=False, side=side, choose=choose: choose(side))
                grid.addWidget(button, row, 2)
            grid.addWidget(QLabel("Stands", inside), top + 5, 0)
            grid.addLayout(self._place_row(inside, side), top + 5, 1)
            grid.setRowMinimumHeight(top + 6, 6)
            self.names.append(name)
            self.sounds.append(sound)
            self.channels.append(channel)
            self.movers.append(mover)
            self._show_channels(side, of.channel)
            sound.editingFinished.connect(
                lambda side=side: self._show_channels(side, self.channels[side].currentData())
            )
        layout.addWidget(inside if count == 2 else Tall(inside, 520, self), 1)
        between = "the two" if count == 2 else "neighbours in the circle"
        self.distance = DoubleSpinBox(
            self, suffix=" m", decimals=2, singleStep=0.1, toolTip=f"How far apart {between} stand"
        )
        self.distance.setRange(0.2, 20)
        self.distance.setValue(self.conversation.distance)
        self.distance.setAccessibleName(f"Distance between {between}")
        row_of = QHBoxLayout()
        row_of.addWidget(QLabel("Distance", self))
        row_of.addWidget(self.distance)
        row_of.addStretch(1)
        layout.addLayout(row_of)

    def _place_row(self, parent: QWidget, side: int) -> QHBoxLayout:
        """A place of one's own: to the right, and towards the viewer."""
        of = self.conversation.sides[side]
        own = QCheckBox("at a place of its own", parent)
        own.setChecked(of.place is not None)
        own.setAccessibleName(f"The {ORDINALS[side]} speaker stands at a place of its own")
        row = QHBoxLayout()
        row.setSpacing(10)
        row.addWidget(own)
        fields = []
        here = stands(self.conversation)[side]
        for at, words, tip in (
            (here.x, "right", "Metres to the right of the middle; less than 0 to the left"),
            (here.z, "nearer", "Metres towards the viewer; less than 0 away"),
        ):
            field = DoubleSpinBox(parent, suffix=f" m {words}", decimals=2, singleStep=0.1, toolTip=tip)
            field.setRange(-50, 50)
            field.setValue(at)
            field.setAccessibleName(f"{words} of the {ORDINALS[side]} speaker")
            field.setEnabled(own.isChecked())
            own.toggled.connect(field.setEnabled)
            row.addWidget(field)
            fields.append(field)
        row.addStretch(1)
        self.places.append((own, fields[0], fields[1]))
        return row

    def _place(self, side: int) -> tuple[float, float] | None:
        """Return where a side stands, None in the circle; as it was, to what is shown of it."""
        own, right, nearer = self.places[side]
        if not own.isChecked():
            return None
        place, was = (round(right.value(), 3), round(nearer.value(), 3)), self.conversation.sides[side].place
        return was if was is not None and tuple(round(x, 2) for x in was) == place else place

    def _show_channels(self, side: int, chosen: int | None) -> None:
        """Offer the channels that the sound has, as far as that is known."""
        name = self.sounds[side].text().strip()
        count = channels_of((self.document.folder or Path()) / name) if name else 0
        box = self.channels[side]
        box.clear()
        box.addItem("All, mixed", None)
        for n in range(max(count, 0 if chosen is None else chosen + 1)):
            words = f"{n + 1}" + ((" (left)", " (right)")[n] if count == 2 and n < 2 else "")
            box.addItem(words, n)
        box.setCurrentIndex(max(0, box.findData(chosen)))

    def choose(self, side: int) -> None:
        """Ask for a sound."""
        if self._ask(self.sounds[side], "Choose a sound", f"Sounds ({' '.join(f'*{s}' for s in SOUNDS)})"):
            self._show_channels(side, self.channels[side].currentData())

    def choose_project(self, side: int) -> None:
        """Ask for the project whose graph moves a side."""
        self._ask(self.movers[side], "Choose a project", f"Projects (*{SUFFIX})")

    def _ask(self, field: QLineEdit, title: str, kinds: str) -> bool:
        folder = self.document.folder
        name, _ = QFileDialog.getOpenFileName(self, title, str(folder or Path.home()), kinds)
        if name:
            field.setText(relative(Path(name), folder) if folder is not None else Path(name).as_posix())
        return bool(name)

    def _mover(self, side: int) -> str | None:
        """Return the path of the project that moves a side, None for the one at hand. Raises EditError where
        there is none.
        """
        text = self.movers[side].text().strip()
        if not text or text == self.conversation.sides[side].project:
            return text or None
        whole = (self.document.folder or Path()) / text
        if not whole.is_file():
            raise EditError(
                f"there is no project at {whole}: choose another, or clear the field to let this project "
                "move the speaker"
            )
        own = self.document.path
        return None if own is not None and own.exists() and whole.samefile(own) else text

    def change(self, project: Project) -> Project:
        for side in range(len(self.names)):
            sound = self.sounds[side].text().strip() or None
            channel = self.channels[side].currentData() if sound is not None else None
            project = conversation_edits.change_side(
                project,
                self.ident,
                side,
                name=self.names[side].text(),
                audio=sound,
                channel=channel,
                project=self._mover(side),
                place=self._place(side),
            )
        distance = round(self.distance.value(), 3)
        if distance == round(self.conversation.distance, 2):  # as it was, to what is shown of it
            return project
        return conversation_edits.change_conversation(project, self.ident, distance=distance)
