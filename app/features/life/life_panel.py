"""The life panel: how much the character breathes, looks about, blinks and speaks of itself; a slider and an
off for each amount.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QLabel,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.life.dial_words import put_in_sentence
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_error
from app.widgets.choice_row import ChoiceRow
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox, Slider
from app.widgets.request_menu import MODE_WORDS, MOOD_WORDS
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.life import DIALS, MANNER_DIALS, MANNERS, Dial, Life, get_manner, with_life
from metagraph.graph.model import MODES, Mode, Project
from metagraph.graph.words import FEELINGS
from metagraph.playback.planning.mood import MOODS


class DialSlider(Slider):
    """A slider that a double click puts back and that the wheel moves only once it has the keyboard."""

    def __init__(self, parent: QWidget, steps: int, put_back: Callable[[], None]) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setRange(0, steps)
        self.setPageStep(max(1, steps // 10))
        self._put_back = put_back

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._put_back()


class DialRow:
    """One dial: a tick for on and off, its name, its slider, its number with the unit."""

    def __init__(
        self,
        dial: Dial,
        grid: QGridLayout,
        row: int,
        parent: QWidget,
        set_value: Callable[[float, bool], None],
        default: float,
    ):
        self.dial, self.default, self._set = dial, default, set_value
        self._before = default  # what it was before it was turned off
        label, tip = tr(dial.label), tr(dial.tip)
        self.tick = QCheckBox(label, parent)
        self.tick.setToolTip(tr("{tip}\nUntick it to turn it off.", tip=tip) if dial.off is not None else tip)
        self.label = make_widget(QLabel, label, parent, toolTip=tip)
        self.slider = DialSlider(parent, round((dial.high - dial.low) / dial.step), self.put_back)
        self.slider.setToolTip(
            tr(
                "{tip}\nDouble-click to reset it to {default:g} {unit}",
                tip=tip,
                default=default,
                unit=tr(dial.unit),
            ).rstrip()
        )
        self.slider.setAccessibleName(label)
        self.slider.setFocusPolicy(Qt.FocusPolicy.ClickFocus)  # its number has the same keys
        decimals = 0 if dial.step >= 1 else 1 if dial.step >= 0.1 else 3 if dial.step < 0.01 else 2
        self.number = DoubleSpinBox(
            parent, minimum=dial.low, maximum=dial.high, singleStep=dial.step, decimals=decimals
        )
        self.number.setSuffix(f" {tr(dial.unit)}" if dial.unit else "")
        self.number.setAccessibleName(label)
        self.number.setKeyboardTracking(False)
        self.number.setFixedWidth(92)
        head = self.tick if dial.off is not None else self.label
        (self.label if head is self.tick else self.tick).hide()
        grid.addWidget(head, row, 0)
        grid.addWidget(self.slider, row, 1)
        grid.addWidget(self.number, row, 2)
        self.slider.valueChanged.connect(self._slid)
        self.slider.sliderReleased.connect(lambda: self._set(self.number.value(), True))
        self.number.valueChanged.connect(lambda v: self._set(v, True))
        self.tick.clicked.connect(self._toggle)

    def show_value(self, value: float) -> None:
        for widget in (self.slider, self.number):
            widget.blockSignals(True)
        self.slider.setValue(round((value - self.dial.low) / self.dial.step))
        self.number.setValue(value)
        self.tick.setChecked(value != self.dial.off)
        if value != self.dial.off:
            self._before = value
        for widget in (self.slider, self.number):
            widget.blockSignals(False)

    def set_enabled(self, on: bool) -> None:
        for widget in (self.tick, self.label, self.slider, self.number):
            widget.setEnabled(on)

    def _slid(self, place: int) -> None:
        self._set(min(self.dial.high, self.dial.low + place * self.dial.step), not self.slider.isSliderDown())

    def _toggle(self, on: bool) -> None:
        if self.dial.off is not None:
            self._set(
                self._before
                if on and self._before != self.dial.off
                else self.default
                if on
                else self.dial.off,
                True,
            )

    def put_back(self) -> None:
        self._set(self.default, True)


class LifePanel(QWidget):
    """Stillness over all; below it every amount, or what a mode makes of them."""

    def __init__(self, document: Document, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.mode: Mode | None = None  # whose factors are shown; None for the amounts themselves
        outer = QVBoxLayout(self)
        outer.setContentsMargins(12, 8, 12, 8)
        outer.setSpacing(8)
        self.on = QCheckBox(tr("Alive: breathing, gaze, blinks and lip sync"), self)
        self.on.clicked.connect(lambda on: self._change(tr("Turn life on or off"), on=on))
        outer.addWidget(self.on)
        top = QGridLayout()
        top.setHorizontalSpacing(10)
        outer.addLayout(top)
        self.rows: dict[str, DialRow] = {"stillness": self._row(DIALS[0], top, 0, None)}
        self.rows["stillness"].tick.setText(tr("Stillness"))
        factors = (
            (MODE_WORDS[m], tr("Factors that '{mode}' multiplies the amounts by", mode=tr(m))) for m in MODES
        )
        self.tabs = ChoiceRow(self, ((tr("Always"), tr("The amounts for all modes")), *factors), columns=3)
        self.tabs.show_choice(0)
        self.tabs.chosen.connect(lambda n: self.show_mode(None if n == 0 else MODES[n - 1]))
        outer.addWidget(self.tabs)
        area = QScrollArea(self, widgetResizable=True)
        area.setFrameShape(QScrollArea.Shape.NoFrame)
        area.setStyleSheet("QScrollArea { background: transparent; }")  # no box in the panel
        area.viewport().setAutoFillBackground(False)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        outer.addWidget(area, 1)
        self.area = area
        self.pages: dict[Mode | None, QWidget] = {}
        self.manner_rows: dict[Mode, dict[str, DialRow]] = {}
        self._fill(None)
        document.changed.connect(self._edited)
        self._show()

    def _row(self, dial: Dial, grid: QGridLayout, row: int, mode: Mode | None) -> DialRow:
        default = getattr(Life() if mode is None else MANNERS[mode], dial.name)
        return DialRow(dial, grid, row, self, partial(self._dial, dial, mode), default)

    def _fill(self, mode: Mode | None) -> None:
        """Make the page of the amounts, or of one mode, when it is first shown."""
        page = QWidget(self.area)
        page.setAutoFillBackground(False)
        grid = QGridLayout(page)
        grid.setContentsMargins(0, 0, 8, 0)
        grid.setHorizontalSpacing(10)
        grid.setVerticalSpacing(5)
        grid.setColumnStretch(1, 1)
        rows: dict[str, DialRow] = {}
        group, n = "", 0 if mode is not None else self._add_hands(page, grid)
        for dial in DIALS[1:] if mode is None else MANNER_DIALS:
            if dial.group != group:
                title = QLabel(tr(dial.group), page)
                title.setProperty("title", True)
                title.setContentsMargins(0, 8 if n else 0, 0, 0)
                grid.addWidget(title, n, 0, 1, 3)
                group, n = dial.group, n + 1
                if group == "Mood":
                    self._add_moods(page, grid, n)
                    n += 1
            rows[dial.name] = self._row(dial, grid, n, mode)
            n += 1
        if mode is not None:
            back = make_widget(QToolButton, page, text=tr("Reset to defaults"))
            back.clicked.connect(lambda: self._usual(mode))
            grid.addWidget(back, n, 0, 1, 2)
            n += 1
        grid.setRowStretch(n, 1)
        self.pages[mode] = page
        if mode is None:
            self.rows |= rows
        else:
            self.manner_rows[mode] = rows

    def _add_hands(self, page: QWidget, grid: QGridLayout) -> int:
        """Add whether hands stay out of the body and where they touch it; return the next row."""
        title = QLabel(tr("Hands"), page)
        title.setProperty("title", True)
        self.guard = QCheckBox(tr("Keep hands out of the body"), page)
        self.guard.setToolTip(
            tr("Hands and forearms slide along body, head and each other instead of entering")
        )
        self.guard.clicked.connect(lambda on: self._touch(tr("Turn the guard of hands on or off"), guard=on))
        self.contacts = QCheckBox(tr("Keep hand contacts"), page)
        self.contacts.setToolTip(
            tr("Hands stay where they touch the body. Find contacts with Motion > Find hand contacts")
        )
        self.contacts.clicked.connect(lambda on: self._touch(tr("Turn hand contacts on or off"), contacts=on))
        for n, widget in enumerate((title, self.guard, self.contacts)):
            grid.addWidget(widget, n, 0, 1, 3)
        return 3

    def _add_moods(self, page: QWidget, grid: QGridLayout, row: int) -> None:
        """Add the choice of a named mood above its dials."""
        self.moods = ComboBox(page)
        self.moods.setAccessibleName(tr("Mood"))
        self.moods.setToolTip(tr("The character's mood while no request sets another"))
        for feeling in FEELINGS:
            self.moods.addItem(MOOD_WORDS[feeling], feeling)
        self.moods.addItem(tr("Custom"), None)
        self.moods.activated.connect(self._take_mood)
        grid.addWidget(QLabel(tr("Mood amounts"), page), row, 0)
        grid.addWidget(self.moods, row, 1, 1, 2)

    def _take_mood(self, place: int) -> None:
        feeling = self.moods.itemData(place)
        if feeling is not None:
            valence, arousal = MOODS[feeling]
            self._change(tr("Change the mood"), None, None, valence=valence, arousal=arousal)

    def show_mode(self, mode: Mode | None) -> None:
        """Show the amounts, or what one mode makes of them."""
        if mode not in self.pages:
            self._fill(mode)
        self.mode = mode
        self._show()

    def _show(self) -> None:
        life = self.document.project.life
        if self.area.widget() is not self.pages[self.mode]:
            self.area.takeWidget()
            self.area.setWidget(self.pages[self.mode])
            self.pages[self.mode].setAutoFillBackground(False)  # which the area turns on
            self.pages[self.mode].show()
        self.on.setChecked(life.on)
        self.guard.setChecked(self.document.project.touch.guard)
        self.contacts.setChecked(self.document.project.touch.contacts)
        named = next((f for f, point in MOODS.items() if point == (life.valence, life.arousal)), None)
        self.moods.setCurrentIndex(self.moods.findData(named))
        for name, row in self.rows.items():
            row.show_value(getattr(life, name))
        for mode, rows in self.manner_rows.items():
            for name, row in rows.items():
                row.show_value(getattr(get_manner(life, mode), name))
        self.moods.setEnabled(life.on)
        for row in (
            *self.rows.values(),
            *(row for rows in self.manner_rows.values() for row in rows.values()),
        ):
            row.set_enabled(life.on or row is self.rows["stillness"])

    def _edited(self, before: Project, after: Project) -> None:
        if before.life is not after.life or before.touch is not after.touch:
            self._show()

    # --- changing

    def _touch(self, text: str, **changes: bool) -> None:
        def change(project: Project) -> Project:
            return replace(project, touch=msgspec.structs.replace(project.touch, **changes))

        self.document.edit(text, change)

    def _dial(self, dial: Dial, mode: Mode | None, value: float, done: bool) -> None:
        """Set a number; what is dragged is one step to undo."""
        value = round(value, 4)
        self._change(
            tr("Change {amount}", amount=put_in_sentence(dial)),
            f"life/{mode}/{dial.name}",
            mode,
            **{dial.name: value},
        )
        if done:
            self.document.finish_merging()

    def _change(
        self, text: str, merge: str | None = None, mode: Mode | None = None, **changes: float
    ) -> None:
        try:
            life = with_life(self.document.project.life, mode, **changes)
        except ValueError as error:
            self.document.failed.emit(tr_error(error))
            return
        self._set(text, life, merge)

    def _usual(self, mode: Mode) -> None:
        life = self.document.project.life
        modes = {m: x for m, x in life.modes.items() if m != mode}
        self._set(tr("Reset '{mode}'", mode=tr(mode)), None, None, modes=modes)

    def _set(self, text: str, life: Life | None, merge: str | None, **changes: object) -> None:
        fields = {f: getattr(life, f) for f in life.__struct_fields__} if life is not None else changes
        try:
            self.document.edit(text, lambda p: performance_edits.set_life(p, **fields), merge)
        except EditError as error:
            self.document.failed.emit(tr_error(error))
