"""The live control of a parameter: a slider, a tick, a choice, some of many, three numbers, or a button."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QHBoxLayout,
    QMenu,
    QPushButton,
    QSlider,
    QToolButton,
    QWidget,
)

from app.translation import tr
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox, Scrub
from metagraph.graph.parameter import CharacterParameter, get_first_value

STEPS = 100  # of a slider
FAR = 100.0  # metres to which points are offered

Send = Callable[[Any], None]


def make_control(name: str, parameter: CharacterParameter, send: Send, parent: QWidget) -> QWidget:
    """Return the control of a parameter with its first value. send: called with each value that it is set to,
    None for a trigger.
    """
    made = _MAKERS[parameter.type](parameter, send, parent)
    for part in (made, *made.findChildren(QSlider), *made.findChildren(QAbstractSpinBox)):
        if not part.accessibleName():
            part.setAccessibleName(name)
    made.setAccessibleDescription(parameter.about)
    return made


class NumberControl(QWidget):
    """A slider, and the number beside it."""

    def __init__(self, parameter: CharacterParameter, send: Send, parent: QWidget) -> None:
        super().__init__(parent)
        self._least, self._span = parameter.least, parameter.most - parameter.least
        self.slider = Scrub(Qt.Orientation.Horizontal, self)
        self.slider.setRange(0, STEPS)
        self.slider.setPageStep(STEPS // 10)
        self.slider.setFocusPolicy(Qt.FocusPolicy.ClickFocus)  # its number has the same keys
        self.number = DoubleSpinBox(
            self, minimum=parameter.least, maximum=parameter.most, singleStep=self._span / 20, decimals=2
        )
        self.number.setKeyboardTracking(False)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.slider, 1)
        layout.addWidget(self.number)
        self._show(get_first_value(parameter))
        self.slider.valueChanged.connect(lambda at: self._set(self._least + self._span * at / STEPS, send))
        self.number.valueChanged.connect(lambda value: self._set(value, send))

    def _set(self, value: float, send: Send) -> None:
        self._show(value)
        send(round(value, 4))

    def _show(self, value: float) -> None:
        for widget in (self.slider, self.number):
            widget.blockSignals(True)
        self.slider.setValue(round(STEPS * (value - self._least) / self._span))
        self.number.setValue(value)
        for widget in (self.slider, self.number):
            widget.blockSignals(False)


def _make_switch(parameter: CharacterParameter, send: Send, parent: QWidget) -> QWidget:
    box = QCheckBox(tr("On"), parent)
    box.setChecked(bool(get_first_value(parameter)))
    box.toggled.connect(send)
    return box


def _make_choice(parameter: CharacterParameter, send: Send, parent: QWidget) -> QWidget:
    box = ComboBox(parent)
    for choice in parameter.choices:
        box.addItem(choice.name, choice.name)
    box.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(10)
    box.choose(get_first_value(parameter))
    box.activated.connect(lambda _: send(box.currentData()))
    return box


class ListControl(QToolButton):
    """Some of many: a menu that is ticked, and taken when it closes."""

    def __init__(self, parameter: CharacterParameter, send: Send, parent: QWidget) -> None:
        super().__init__(parent)
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.ticked = QMenu(self)
        self.setMenu(self.ticked)
        self._before: list[str] = get_first_value(parameter)
        for choice in parameter.choices:
            action = self.ticked.addAction(choice.name)
            action.setCheckable(True)
            action.setChecked(choice.name in self._before)
        self.ticked.triggered.connect(lambda _: self._take(send))
        self._tell()

    @property
    def chosen(self) -> list[str]:
        return [action.text() for action in self.ticked.actions() if action.isChecked()]

    def _tell(self) -> None:
        self.setText(", ".join(self.chosen) or tr("Choose…"))

    def _take(self, send: Send) -> None:
        self._tell()
        if self.chosen:
            send(self.chosen)


class PointControl(QWidget):
    """Three numbers, metres."""

    def __init__(self, parameter: CharacterParameter, send: Send, parent: QWidget) -> None:
        super().__init__(parent)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        names = tr("Left"), tr("Up"), tr("Front")
        self.numbers = [
            DoubleSpinBox(self, minimum=-FAR, maximum=FAR, singleStep=0.1, decimals=2, value=value)
            for value in get_first_value(parameter)
        ]
        for box, name in zip(self.numbers, names, strict=True):
            box.setKeyboardTracking(False)
            box.setSuffix(" m")
            box.setToolTip(name)
            box.setAccessibleName(name)
            box.valueChanged.connect(lambda _: send([x.value() for x in self.numbers]))
            layout.addWidget(box, 1)


def _make_trigger(parameter: CharacterParameter, send: Send, parent: QWidget) -> QWidget:
    button = QPushButton(tr("Play"), parent)
    button.clicked.connect(lambda: send(None))
    return button


_MAKERS: dict[str, Callable[[CharacterParameter, Send, QWidget], QWidget]] = {
    "number": NumberControl,
    "boolean": _make_switch,
    "enum": _make_choice,
    "list": ListControl,
    "point": PointControl,
    "trigger": _make_trigger,
}
