"""Fields for how often actions play: cooldown and spacing, the phases of a gesture, and the numbers of the
planner.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QFormLayout, QHBoxLayout, QToolButton, QWidget

from app.translation import make_lazy_texts, tr
from app.widgets.form_fields import MIXED, Mixed, Seconds, find_common_value
from app.widgets.making import make_widget
from app.widgets.quiet_fields import SpinBox
from metagraph.graph import edits
from metagraph.graph.model import Action, Project, Settings
from metagraph.playback.planning.director import beat_interval, repeat_interval
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.timing.phases import find_phases

PHASE_FIELDS = ("ready", "stroke_end", "relax")
PHASE_WORDS = make_lazy_texts(
    lambda: {
        "ready": tr("End of the preparation"),
        "stroke_end": tr("Start of the hold"),
        "relax": tr("End of the hold and start of the retraction"),
    }
)
AS_THE_GRAPH = -1


class ActionRows(QWidget):
    """Rows of an action's form. changed: words for the undo step, and Action fields to set."""

    changed = Signal(str, object)

    def __init__(self, form: QFormLayout, parent: QWidget) -> None:
        super().__init__(parent)
        self.hide()  # it only holds its rows together
        self.form = form
        self.ready, self.stroke_end, self.relax = (Seconds(parent, PHASE_WORDS[f]) for f in PHASE_FIELDS)
        self.found = make_widget(
            QToolButton, parent, text=tr("Detect"), toolTip=tr("Detect the phases from the motion again")
        )
        self.found.setAccessibleName(tr("Detect phases"))
        self.phase_rows = (
            self._row(tr("Prepared"), self.ready, self.found),
            self._row(tr("Hold"), self.stroke_end, self.relax),
        )
        for field, box in zip(PHASE_FIELDS, (self.ready, self.stroke_end, self.relax), strict=True):
            box.valueChanged.connect(partial(self._phase, field))
        self.found.clicked.connect(
            lambda: self.changed.emit(tr("Detect phases"), {"timing": dict.fromkeys(PHASE_FIELDS)})
        )
        self.cooldown = Seconds(
            parent, tr("For how long after its end it cannot play again"), 3600, " s", 0.5, 1
        )
        self.cooldown.valueChanged.connect(self._cooled)
        self.spacing = SpinBox(
            parent,
            toolTip=tr("How many other actions of its kind and stance must play before it can play again"),
        )
        self.spacing.setAccessibleName(tr("Others in between"))
        self.spacing.setRange(-2, 31)
        self.spacing.setKeyboardTracking(False)
        self.spacing.valueChanged.connect(self._spaced)
        self.rest_row = self._row(tr("Cooldown"), self.cooldown, self.spacing)
        self.prominence = Seconds(parent, "", 100, " %", 5, 0)
        self.prominence.setAccessibleName(tr("How much it stands out"))
        self.prominence.valueChanged.connect(self._stood_out)
        self.measured = make_widget(
            QToolButton, parent, text=tr("Automatic"), toolTip=tr("Judge by its motion and its name again")
        )
        self.measured.setAccessibleName(tr("Judge how much it stands out"))
        self.measured.clicked.connect(
            lambda: self.changed.emit(tr("Judge how much it stands out"), {"prominence": None})
        )
        self.shown_row = self._row(tr("Stands out"), self.prominence, self.measured)

    def _row(self, title: str, *fields: QWidget) -> QWidget:
        row = QWidget(self.parentWidget())
        line = QHBoxLayout(row)
        line.setContentsMargins(0, 0, 0, 0)
        for field in fields:
            field.setMinimumWidth(60)  # long special words must not widen the whole panel
            line.addWidget(field, 0 if isinstance(field, QToolButton) else 1)
        self.form.addRow(title, row)
        return row

    def show_actions(self, project: Project, actions: Sequence[Action]) -> None:
        gestures = all(a.kind == "gesture" for a in actions)
        for row in self.phase_rows:
            self.form.setRowVisible(row, gestures)
        acts = all(a.kind in ("gesture", "fidget") for a in actions)
        self.form.setRowVisible(self.rest_row, acts)
        self.form.setRowVisible(self.shown_row, acts)
        if acts:
            self._show_prominence(project, actions)
        if gestures:
            found = [find_phases(project, a) for a in actions]
            self.ready.show_value(find_common_value([p.ready for p in found]))
            self.stroke_end.show_value(find_common_value([p.stroke_end for p in found]))
            self.relax.show_value(find_common_value([p.relax for p in found]))
            self.found.setEnabled(
                any(getattr(a.timing, f) is not None for a in actions for f in PHASE_FIELDS)
            )
        self.cooldown.show_value(find_common_value([a.cooldown for a in actions]))
        spacing = find_common_value([a.spacing for a in actions])
        self.spacing.blockSignals(True)
        least = -2 if spacing is Mixed else AS_THE_GRAPH
        if self.spacing.minimum() != least:  # which lays the form out again
            self.spacing.setMinimum(least)
        self.spacing.setSpecialValueText(tr(MIXED) if spacing is Mixed else tr("as the graph"))
        shown = least if spacing is Mixed or spacing is None else spacing
        if self.spacing.value() != shown or self.spacing.lineEdit().isModified():
            self.spacing.setValue(shown)
        self.spacing.blockSignals(False)

    def _show_prominence(self, project: Project, actions: Sequence[Action]) -> None:
        shares = [measure_prominence(project, a) for a in actions]
        self.prominence.show_value(find_common_value([100 * share for share in shares]))
        variety = project.settings.variety
        gestures = {
            layer: sum(len(of) for (_, kind), of in project.graphs[layer].index.items() if kind == "gesture")
            for layer in {a.layer for a in actions}
        }
        soonest = variety * min(
            repeat_interval(a.kind, x, beat_interval(a.layer, gestures[a.layer]))
            for a, x in zip(actions, shares, strict=True)
        )
        self.prominence.setToolTip(
            tr(
                "How much viewers notice it. The more it stands out, the longer the character waits before "
                "it does it again by itself: now {seconds:.0f} s or more.",
                seconds=soonest,
            )
        )
        self.measured.setEnabled(any(a.prominence is not None for a in actions))

    def _stood_out(self, percent: float) -> None:
        if percent >= 0:
            self.changed.emit(tr("Change how much it stands out"), {"prominence": round(percent / 100, 2)})

    def _phase(self, field: str, seconds: float) -> None:
        if seconds >= 0:
            self.changed.emit(tr("Change phases"), {"timing": {field: round(seconds, 3)}})

    def _cooled(self, seconds: float) -> None:
        if seconds >= 0:
            self.changed.emit(tr("Change cooldown"), {"cooldown": round(seconds, 2)})

    def _spaced(self, value: int) -> None:
        if value >= AS_THE_GRAPH:
            self.changed.emit(tr("Change spacing"), {"spacing": None if value == AS_THE_GRAPH else value})


class PlannerRows(QWidget):
    """Rows of the planner's numbers, the same for every layer. edit: as `Document.edit` takes them."""

    def __init__(
        self, form: QFormLayout, parent: QWidget, edit: Callable[[str, Callable[[Project], Project]], object]
    ) -> None:
        super().__init__(parent)
        self.hide()
        self._edit = edit
        self.never_twice = QCheckBox(tr("Never twice in a row"), parent)
        self.never_twice.setToolTip(
            tr('Applies when the node has another action. An action\'s own "Others in between" overrides it.')
        )
        self.never_twice.clicked.connect(lambda on: self._set(tr("Change repetition"), never_twice=on))
        form.addRow(tr("Repetition"), self.never_twice)
        self.fields: dict[str, Seconds] = {}
        for name, title, edit_words, tip, most, suffix, step in (
            (
                "alpha",
                tr("Avoid repeats"),
                tr("Change repeat avoidance"),
                tr("How strongly an action that has just played is avoided; the published method uses 4"),
                100,
                "",
                0.5,
            ),
            (
                "variety",
                tr("Variety"),
                tr("Change variety"),
                tr(
                    "How rarely the character repeats actions and changes stances by itself: 1 is natural, 0 "
                    "lets it repeat at once, as in the published method"
                ),
                4,
                "",
                0.25,
            ),
            (
                "memory",
                tr("Remember for"),
                tr("Change memory"),
                tr("How long the planner remembers that an action has played; 0 means always"),
                600,
                " s",
                5,
            ),
            (
                "rest",
                tr("Minimum pause"),
                tr("Change minimum pause"),
                tr("Shortest time in the stance between two actions"),
                60,
                " s",
                0.1,
            ),
            (
                "wait",
                tr("Maximum wait"),
                tr("Change maximum wait"),
                tr("How late a requested action may start"),
                60,
                " s",
                0.5,
            ),
            (
                "lookahead",
                tr("Look ahead"),
                tr("Change look-ahead"),
                tr("In a live performance, actions that start within this time are no longer changed"),
                10,
                " s",
                0.05,
            ),
        ):
            field = Seconds(parent, tip, most, suffix, step)
            field.valueChanged.connect(partial(self._number, name, edit_words))
            self.fields[name] = field
            form.addRow(title, field)

    def show_settings(self, settings: Settings) -> None:
        self.never_twice.setChecked(settings.never_twice)
        for name, field in self.fields.items():
            field.show_value(getattr(settings, name))

    def _number(self, name: str, text: str, value: float) -> None:
        if value >= 0:
            self._set(text, **{name: round(value, 3)})

    def _set(self, text: str, **changes: Any) -> None:
        self._edit(text, lambda p: edits.set_settings(p, **changes))
