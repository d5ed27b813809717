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
from app.translation import make_lazy_texts, tr, tr_error, tr_noop
from app.widgets.lane_geometry import describe_outcome
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox, SpinBox
from app.widgets.request_menu import (
    LOOK_TARGETS,
    MODE_WORDS,
    MOOD_WORDS,
    describe_mood,
    describe_request,
)
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import LAYERS, LIMBS, MODES, Project
from metagraph.graph.timeline_edits import find_lane
from metagraph.graph.words import FEELINGS

SIDES = (tr_noop("left"), tr_noop("right"), tr_noop("both"))  # of an arm, or of two
UNSET = tr_noop("automatic")
LABELS = make_lazy_texts(
    lambda: {
        "at": tr("Start at"),
        "stroke": tr("Stroke at"),
        "duration": tr("Duration"),
        "hold": tr("Hold"),
        "late": tr("Maximum delay"),
        "priority": tr("Priority"),
        "tags": tr("Tags"),
        "limb": tr("Arm"),
        "prepare": tr("Preparation"),
        "resume": tr("Resume after an interruption"),
        "action": tr("Action"),
        "stance": tr("Stance"),
        "to": tr("Look at"),
        "amount": tr("Amount"),
        "strict": tr("Without looking away"),
        "line": tr("Line"),
        "text": tr("Words"),
        "gestures": tr("With gestures"),
        "mode": tr("Mode"),
        "mood": tr("Mood"),
        "intensity": tr("Intensity"),
        "name": tr("Point"),
        "stay": tr("Stay in the stance"),
    }
)
TIPS = make_lazy_texts(
    lambda: {
        "at": tr("Time in the performance. It can start later while another action plays."),
        "stroke": tr("When its stroke should come, instead of when it should start"),
        "late": tr(
            "How late its stroke, or its start if no stroke is set, may come. If it would be "
            "later, it does not play."
        ),
        "hold": tr("How long the hold lasts. The motion before and after it keeps its speed."),
        "prepare": tr("Off: it skips the preparation and starts shortly before its stroke"),
        "priority": tr(
            "The request with the higher priority plays. Every request overrides what the models play."
        ),
        "duration": tr("How long the activity lasts"),
        "tags": tr("Words separated by commas. The action must have all of these tags."),
        "resume": tr("If a more important request interrupts it, the remaining part plays afterwards"),
        "strict": tr("The gaze stays there and does not look away now and then"),
        "mood": tr(
            "Changes which actions are likely, how large and fast they play, the posture and the face"
        ),
        "intensity": tr("How large it plays; 1 is as in the clip"),
        "stay": tr("The models stay in this stance until a request asks for another"),
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
        self.remove = buttons.addButton(tr("Remove request"), QDialogButtonBox.ButtonRole.DestructiveRole)
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
            self.words.setText(tr("This request no longer exists."))
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
            items = [(tr("automatic"), None), *((MODE_WORDS[m], m) for m in MODES)]
        elif name == "mood":
            items = [(tr(UNSET), None), *((MOOD_WORDS[m], m) for m in FEELINGS)]
        elif name == "line":
            items = [(tr("none"), None), *((i, i) for i in project.lines)]
            value = None if value is None else str(value)
        elif name == "stance":
            lane = find_lane(ask, project)
            items = [
                (s.name, s.id)
                for layer in LAYERS
                if layer == lane
                for s in project.graphs[layer].stances.values()
            ]
        elif name == "action":
            lane = find_lane(ask, project)
            items = [(x.name, x.id) for x in project.actions() if x.layer == lane and x.kind != "stance"]
        elif name == "to":
            items = [(LOOK_TARGETS.get(n, n), n) for n in dict.fromkeys(("user", "ahead", *project.points))]
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
