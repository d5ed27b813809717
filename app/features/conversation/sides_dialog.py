"""Who talks in a conversation, which sound is whose, whose graph moves each, and where they stand."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.conversation.conversation_settings import ORDINALS, SettingDialog, Tall, make_caption
from app.project.speech_files import SOUNDS, count_channels
from app.translation import tr, tr_noop
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.common.studio import find_start_folder
from metagraph.formats.project.paths import make_path_relative
from metagraph.formats.store import SUFFIX
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.speech.duet import place_sides

ROWS = 8  # of the grid for each who talks


class SidesDialog(SettingDialog):
    """Who talks, which sound is whose, whose graph moves each, and where they stand."""

    title, text = tr_noop("Sounds and names"), tr_noop("Change sounds and names")

    def build(self, layout: QVBoxLayout) -> None:
        self.resize(720, 0 if len(self.conversation.sides) == 2 else 620)
        self.names: list[QLineEdit] = []
        self.sounds: list[QLineEdit] = []
        self.channels: list[QComboBox] = []
        self.movers: list[QLineEdit] = []
        self.bodies: list[QLineEdit] = []
        self.places: list[tuple[QCheckBox, QDoubleSpinBox, QDoubleSpinBox]] = []
        count = len(self.conversation.sides)
        inside = QWidget(self)
        grid = QGridLayout(inside)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(10)
        grid.setVerticalSpacing(8)
        grid.setColumnStretch(1, 1)
        for side in range(count):
            self._add_side(grid, inside, side)
        layout.addWidget(inside if count == 2 else Tall(inside, 520, self), 1)
        between = tr("the two") if count == 2 else tr("neighbours in the circle")
        self.distance = DoubleSpinBox(
            self,
            suffix=" m",
            decimals=2,
            singleStep=0.1,
            toolTip=tr("How far apart {between} stand", between=between),
        )
        self.distance.setRange(0.2, 20)
        self.distance.setValue(self.conversation.distance)
        self.distance.setAccessibleName(tr("Distance between {between}", between=between))
        row_of = QHBoxLayout()
        row_of.addWidget(QLabel(tr("Distance"), self))
        row_of.addWidget(self.distance)
        row_of.addStretch(1)
        layout.addLayout(row_of)

    def _add_side(self, grid: QGridLayout, inside: QWidget, side: int) -> None:
        """Add the fields of one who talks."""
        of, top, ordinal = self.conversation.sides[side], ROWS * side, ORDINALS[side]
        grid.addWidget(
            make_caption(tr("{ordinal} speaker", ordinal=ordinal.capitalize()), inside), top, 0, 1, 3
        )
        name, sound, channel, mover, body = (
            QLineEdit(of.name, inside),
            QLineEdit(of.audio or "", inside),
            ComboBox(inside),
            QLineEdit(of.project or "", inside),
            QLineEdit(of.character or "", inside),
        )
        mover.setToolTip(tr("The project whose graph and character this speaker uses"))
        body.setToolTip(
            tr("The GLB with this speaker's mesh. Its joints must have the same names as the skeleton's.")
        )
        mover.setClearButtonEnabled(True)
        body.setClearButtonEnabled(True)
        for row, (words, widget, empty) in enumerate(
            (
                (tr("Name"), name, tr("Speaker {number}", number=side + 1)),
                (tr("Sound"), sound, tr("No sound")),
                (tr("Channel"), channel, ""),
                (tr("Moved by"), mover, tr("This project")),
                (tr("Character"), body, tr("From that project")),
            ),
            top + 1,
        ):
            widget.setAccessibleName(tr("{what} of the {ordinal} speaker", what=words, ordinal=ordinal))
            grid.addWidget(QLabel(words, inside), row, 0)
            grid.addWidget(widget, row, 1)
            if isinstance(widget, QLineEdit):
                widget.setPlaceholderText(empty)
        for row, tip, choose in (
            (top + 2, tr("Choose a sound file"), self.choose),
            (top + 4, tr("Choose a project"), self.choose_project),
            (top + 5, tr("Choose a character"), self.choose_character),
        ):
            button = make_widget(QToolButton, inside, text=tr("Choose…"), toolTip=tip)
            button.clicked.connect(lambda _=False, side=side, choose=choose: choose(side))
            grid.addWidget(button, row, 2)
        grid.addWidget(QLabel(tr("Position"), inside), top + 6, 0)
        grid.addLayout(self._place_row(inside, side), top + 6, 1)
        grid.setRowMinimumHeight(top + 7, 6)
        self.names.append(name)
        self.sounds.append(sound)
        self.channels.append(channel)
        self.movers.append(mover)
        self.bodies.append(body)
        self._show_channels(side, of.channel)
        sound.editingFinished.connect(
            lambda side=side: self._show_channels(side, self.channels[side].currentData())
        )

    def _place_row(self, parent: QWidget, side: int) -> QHBoxLayout:
        """A place of one's own: to the right, and towards the viewer."""
        of = self.conversation.sides[side]
        own = QCheckBox(tr("custom"), parent)
        own.setChecked(of.place is not None)
        own.setAccessibleName(tr("Custom position for the {ordinal} speaker", ordinal=ORDINALS[side]))
        row = QHBoxLayout()
        row.setSpacing(10)
        row.addWidget(own)
        fields = []
        here = place_sides(self.conversation)[side]
        for at, words, tip in (
            (here.x, tr("right"), tr("Metres to the right of the middle; negative is to the left")),
            (here.z, tr("nearer"), tr("Metres towards the viewer; negative is away from the viewer")),
        ):
            field = DoubleSpinBox(parent, suffix=f" m {words}", decimals=2, singleStep=0.1, toolTip=tip)
            field.setRange(-50, 50)
            field.setValue(at)
            field.setAccessibleName(tr("{what} of the {ordinal} speaker", what=words, ordinal=ORDINALS[side]))
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
        count = count_channels((self.document.folder or Path()) / name) if name else 0
        box = self.channels[side]
        box.clear()
        box.addItem(tr("All channels, mixed"), None)
        for n in range(max(count, 0 if chosen is None else chosen + 1)):
            words = f"{n + 1}" + ((tr(" (left)"), tr(" (right)"))[n] if count == 2 and n < 2 else "")
            box.addItem(words, n)
        box.setCurrentIndex(max(0, box.findData(chosen)))

    def choose(self, side: int) -> None:
        """Ask for a sound."""
        if self._ask(
            self.sounds[side],
            tr("Choose a sound"),
            tr("Sounds ({names})", names=" ".join(f"*{s}" for s in SOUNDS)),
        ):
            self._show_channels(side, self.channels[side].currentData())

    def choose_project(self, side: int) -> None:
        """Ask for the project whose graph moves a side."""
        self._ask(self.movers[side], tr("Choose a project"), tr("Projects (*{ends})", ends=SUFFIX))

    def choose_character(self, side: int) -> None:
        """Ask for the character a side is drawn with."""
        self._ask(self.bodies[side], tr("Choose a character"), tr("Characters (*.glb *.gltf)"))

    def _ask(self, field: QLineEdit, title: str, kinds: str) -> bool:
        folder = self.document.folder
        name, _ = QFileDialog.getOpenFileName(self, title, str(find_start_folder(folder)), kinds)
        if name:
            field.setText(
                make_path_relative(Path(name), folder) if folder is not None else Path(name).as_posix()
            )
        return bool(name)

    def _mover(self, side: int) -> str | None:
        """Return the path of the project that moves a side, None for the one at hand. Raises EditError if
        there is none.
        """
        text = self.movers[side].text().strip()
        if not text or text == self.conversation.sides[side].project:
            return text or None
        whole = (self.document.folder or Path()) / text
        if not whole.is_file():
            raise EditError(
                tr(
                    "there is no project at {whole}: choose another, or clear the field to move the "
                    "speaker with this project",
                    whole=whole,
                )
            )
        own = self.document.path
        return None if own is not None and own.exists() and whole.samefile(own) else text

    def _body(self, side: int) -> str | None:
        """Return the path of the character a side is drawn with, None for its project's. Raises EditError if
        there is no file.
        """
        text = self.bodies[side].text().strip()
        if text and text != self.conversation.sides[side].character:
            whole = (self.document.folder or Path()) / text
            if not whole.is_file():
                raise EditError(
                    tr(
                        "there is no character at {whole}: choose another, or clear the field to use the "
                        "character of the speaker's project",
                        whole=whole,
                    )
                )
        return text or None

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
                character=self._body(side),
                place=self._place(side),
            )
        distance = round(self.distance.value(), 3)
        if distance == round(self.conversation.distance, 2):  # as it was, to what is shown of it
            return project
        return conversation_edits.change_conversation(project, self.ident, distance=distance)
