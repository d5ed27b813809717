"""The fields of one request, in a small dialog; every change is an edit that can be undone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.stage.performance import StagePerformance
from app.translation import lazy_texts, tr, tr_error, tr_noop
from app.widgets.lane_geometry import describe_outcome
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox, SpinBox
from app.widgets.request_menu import MODE_WORDS, MOOD_WORDS, describe_mood, describe_request
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import LAYERS, LIMBS, MODES, Project
from metagraph.graph.timeline_edits import lane_of
from metagraph.graph.words import FEELINGS

SIDES = (tr_noop("left"), tr_noop("right"), tr_noop("both"))  # of an arm, or of two
UNSET = tr_noop("as it comes")
LABELS = lazy_texts(
    lambda: {
        "at": tr("At"),
        "stroke": tr("Stroke at"),
        "duration": tr("Wanted for"),
        "hold": tr("Hold"),
        "late": tr("Late by at most"),
        "priority": tr("Priority"),
        "tags": tr("Tags"),
        "limb": tr("Arm"),
        "prepare": tr("Prepare"),
        "resume": tr("Go on after a cut"),
        "action": tr("Action"),
        "stance": tr("Stance"),
        "to": tr("Look at"),
        "amount": tr("How far"),
        "strict": tr("Without averting"),
        "line": tr("Line"),
        "text": tr("Words"),
        "gestures": tr("With its gestures"),
        "mode": tr("Mode"),
        "mood": tr("Mood"),
        "intensity": tr("Intensity"),
        "name": tr("Point"),
        "stay": tr("Stay there"),
    }
)
TIPS = lazy_texts(
    lambda: {
        "at": tr("Seconds of the performance; it may come later when something else plays"),
        "stroke": tr("When its most telling moment should come, instead of when it begins"),
        "late": tr("Seconds by which its stroke, or else its start, may come late, or it does not play"),
        "hold": tr("How long the hold lasts; the motion before and after keeps its speed"),
        "prepare": tr("Off: the preparation is skipped, and it begins shortly before its stroke"),
        "priority": tr("Higher wins over lower; what the models play gives way to all"),
        "duration": tr("How long the activity is wanted"),
        "tags": tr("Words apart by commas; all must be among the action's tags"),
        "resume": tr("When something more important cuts it, its rest plays afterwards"),
        "strict": tr("The gaze stays there without looking away now and then"),
        "mood": tr("Which actions are likely, how large and fast they are played, posture and face"),
        "intensity": tr("How large it is played; 1 as it was made"),
        "stay": tr("The models do not leave the stance, until another one is asked for"),
    }
)
ORDER = tuple(LABELS)


class RequestEditor(QDialog):
    def __init__(self, performance: StagePerformance, ident: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.performance, self.ident = performance, ident
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setMinimumWidth(340)
        ask = self._ask()
        self.setWindowTitle(
            tr("Request: {what}", what=describe_request(ask, performance.document.project))
            if ask is not None
            else tr("Request")
        )
        layout = QVBoxLayout(self)
        form = QFormLayout()
        layout.addLayout(form)
        self.fields: dict[str, QWidget] = {}
        for name in ORDER:
            if ask is not None and name in ask.__struct_fields__:
                field = self._field(name, getattr(ask, name), performance.document.project)
                if field is not None:
                    field.setToolTip(TIPS.get(name, ""))
                    field.setAccessibleName(LABELS[name])
                    self.fields[name] = field
                    form.addRow("" if isinstance(field, QCheckBox) else LABELS[name], field)
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        layout.addWidget(self.words)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.remove = buttons.addButton(tr("Take it back"), QDialogButtonBox.ButtonRole.DestructiveRole)
        self.remove.clicked.connect(self._remove)
        buttons.rejected.connect(self.accept)
        for button in buttons.findChildren(QPushButton):  # Enter takes over what was typed, it does not close
            button.setAutoDefault(False)
        layout.addWidget(buttons)
        performance.changed.connect(self._told)
        self._told()

    def _ask(self) -> Any:
        return next((x for x in self.performance.asks if x.id == self.ident), None)

    def _told(self) -> None:
        ask = self._ask()
        if ask is None:
            self.words.setText(tr("This request is not there any more."))
        else:
            self.words.setText(describe_outcome(ask, self.performance.answers().get(self.ident)))
        self.remove.setEnabled(ask is not None)
        for field in self.fields.values():
            field.setEnabled(ask is not None)

    def _set(self, name: str, value: Any) -> None:
        if self._ask() is None:
            return
        try:
            self.performance.requests.change(self.ident, **{name: value})
        except EditError as error:
            self.words.setText(tr_error(error))

    def _remove(self) -> None:
        self.performance.requests.withdraw(self.ident)
        self.accept()

    # --- one widget a field

    def _field(self, name: str, value: Any, project: Project) -> QWidget | None:
        if name in ("at", "stroke", "duration", "hold", "late"):
            return self._seconds(name, value)
        if name == "priority":
            spin = SpinBox(self)
            spin.setRange(-1000, 1000)
            spin.setValue(value)
            spin.setKeyboardTracking(False)
            spin.valueChanged.connect(lambda v: self._set(name, v))
            return spin
        if name == "amount":
            amount = DoubleSpinBox(self, minimum=0.0, maximum=1.0, singleStep=0.1)
            amount.setValue(value)
            amount.setKeyboardTracking(False)
            amount.valueChanged.connect(lambda v: self._set(name, round(v, 3)))
            return amount
        if name == "intensity":
            return self._intensity(value)
        if isinstance(value, bool):
            box = QCheckBox(LABELS[name], self)
            box.setChecked(value)
            box.toggled.connect(lambda on: self._set(name, on))
            return box
        if name == "tags":
            return self._text(
                ", ".join(value),
                lambda text: tuple(dict.fromkeys(w.strip() for w in text.split(",") if w.strip())),
                name,
            )
        if name == "text":
            return self._text(value, str.strip, name)
        return self._choice(name, value, project)

    def _seconds(self, name: str, value: float | None) -> QDoubleSpinBox:
        """Return a number of seconds; at its lowest it is left open."""
        spin = DoubleSpinBox(self, decimals=2, singleStep=0.1, suffix=" s")
        spin.setRange(-0.01, 600.0 if name in ("hold", "late") else 1e6)
        spin.setSpecialValueText(tr(UNSET))
        spin.setValue(-0.01 if value is None else value)
        spin.setKeyboardTracking(False)
        spin.valueChanged.connect(lambda v: self._set(name, None if v < 0 else round(v, 3)))
        return spin

    def _intensity(self, value: float | None) -> QDoubleSpinBox:
        """Return a number from 0 to 2; at its lowest it is left open."""
        spin = DoubleSpinBox(self, decimals=2, singleStep=0.1, minimum=-0.01, maximum=2.0, prefix="× ")
        spin.setSpecialValueText(tr(UNSET))
        spin.setValue(-0.01 if value is None else value)
        spin.setKeyboardTracking(False)
        spin.valueChanged.connect(lambda v: self._set("intensity", None if v < 0 else round(v, 3)))
        return spin

    def _text(self, value: str, read: Callable[[str], Any], name: str) -> QLineEdit:
        edit = QLineEdit(value, self)

        def take() -> None:
            if edit.isModified():
                edit.setModified(False)
                self._set(name, read(edit.text()))

        edit.editingFinished.connect(take)
        return edit

    def _choice(self, name: str, value: Any, project: Project) -> QComboBox | None:
        ask = self._ask()
        items: list[tuple[str, Any]]
        if name == "limb":
            items = [(tr("any"), None), *((tr(x), x) for x in LIMBS)]
        elif name == "mode":
            items = [(tr("as it comes"), None), *((MODE_WORDS[m], m) for m in MODES)]
        elif name == "mood":
            items = [(tr(UNSET), None), *((MOOD_WORDS[m], m) for m in FEELINGS)]
        elif name == "line":
            items = [(tr("none"), None), *((i, i) for i in project.lines)]
            value = None if value is None else str(value)
        elif name == "stance":
            lane = lane_of(ask, project)
            items = [
                (s.name, s.id)
                for layer in LAYERS
                if layer == lane
                for s in project.graphs[layer].stances.values()
            ]
        elif name == "action":
            lane = lane_of(ask, project)
            items = [(x.name, x.id) for x in project.actions() if x.layer == lane and x.kind != "stance"]
        elif name == "to":
            items = [(n, n) for n in dict.fromkeys(("user", "ahead", *project.points))]
        else:
            return None
        box = ComboBox(self)
        if value not in [v for _, v in items]:
            point = describe_mood(value, None) if name == "mood" else tr("a point")
            items.append((value if isinstance(value, str) else point, value))
        for words, data in items:
            box.addItem(words, data)
        box.setCurrentIndex([v for _, v in items].index(value))
        box.activated.connect(lambda place: self._set(name, items[place][1]))
        return box
