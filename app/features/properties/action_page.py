"""The properties of actions, one or many at once: every control writes through one edit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.properties.page_form import Edit, add_form
from app.features.properties.timing_plot import TimingPlot
from app.features.properties.variation_rows import ActionRows
from app.look.theme import KIND_MARKS, KIND_TITLES, get_theme
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_plural
from app.widgets.choice_row import LimbRow
from app.widgets.form_fields import MIXED, Field, Mixed, QuietChooser, Seconds, find_common_value
from app.widgets.halves import Halves
from app.widgets.making import make_widget
from app.widgets.restyling import set_sheet
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph import edits
from metagraph.graph.model import KINDS, LIMBS, Action
from metagraph.graph.repeating import cycle_of, times_played
from metagraph.playback.timing.handles import set_timing_field
from metagraph.suggest.jumps.soft_blends import repeat_actions


class ActionPage(Halves):
    """time_wanted: the timing is to be seen whole. timing_elsewhere: whether it is, beside this."""

    time_wanted = Signal()

    def __init__(self, document: Document, session: StageSession, edit: Edit, parent: QWidget) -> None:
        first, second = QWidget(parent), QWidget(parent)
        super().__init__(first, second, parent)
        self.document, self.session, self.edit = document, session, edit
        self.misfits: dict[str, str] = {}
        self.low = False  # there is no room for the curves
        self.timing_elsewhere: Callable[[], bool] = lambda: False
        page, box = second, QVBoxLayout(second)
        box.setContentsMargins(0, 0, 0, 0)
        upper = QVBoxLayout(first)
        upper.setContentsMargins(0, 0, 0, 0)
        upper.setSpacing(8)
        self._add_head(upper, page)
        self.plot = TimingPlot(document, session, page)
        self.plot.changed.connect(
            lambda fields: self._set(tr("Change timing"), merge="timing", timing=fields)
        )
        self.plot.finished.connect(document.finish_merging)
        upper.addWidget(self.plot)
        self.form = add_form(box)
        self._add_timing(page)
        self._add_choices(page)
        self.trouble = QLabel(page, wordWrap=True)
        box.addWidget(self.trouble)
        box.addStretch(1)
        self.turned.connect(self.plot.set_large)

    def _add_head(self, upper: QVBoxLayout, page: QWidget) -> None:
        """Add its name and kind."""
        head = QHBoxLayout()
        self.name = Field(page, tr("Name of the action"), tr("Name"))
        self.name.editingFinished.connect(self._rename)
        self.kind = QLabel(page)
        head.addWidget(self.name, 1)
        head.addWidget(self.kind)
        self.timing = make_widget(
            QToolButton, page, text=tr("Timing"), toolTip=tr("Open the timing editor for this action")
        )
        self.timing.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.timing.clicked.connect(self.time_wanted)
        head.addWidget(self.timing)
        upper.addLayout(head)

    def _add_pair(self, page: QWidget, title: str, *fields: QWidget) -> QWidget:
        """Add fields in one row; return it."""
        row = QWidget(page)
        line = QHBoxLayout(row)
        line.setContentsMargins(0, 0, 0, 0)
        for field in fields:
            line.addWidget(field, 1)
        self.form.addRow(title, row)
        return row

    def _add_timing(self, page: QWidget) -> None:
        """Add when it starts, blends, ends, and may be left."""
        self.start, self.end = Seconds(page, tr("Start in the clip")), Seconds(page, tr("End in the clip"))
        self.blend_in, self.blend_out = Seconds(page, tr("Blend in")), Seconds(page, tr("Blend out"))
        self._add_pair(page, tr("Start, end"), self.start, self.end)
        self.blend_row = self._add_pair(page, tr("Blend in, out"), self.blend_in, self.blend_out)
        self.start.valueChanged.connect(lambda v: self._timing("start", v))
        self.end.valueChanged.connect(lambda v: self._timing("end", v))
        self.blend_in.valueChanged.connect(lambda v: self._timing("blend_in", v))
        self.blend_out.valueChanged.connect(lambda v: self._timing("blend_out", v))
        self.leave = QCheckBox(tr("can exit from"), page)
        self.leave.setAccessibleName(tr("Can exit early"))
        self.leave.setToolTip(tr("The next action can start before this one ends"))
        self.leave.clicked.connect(self._leave)
        self.earliest = Seconds(page, tr("Earliest exit: from here on, the next action can start"))
        self.earliest.valueChanged.connect(lambda v: self._timing("earliest_exit", v))
        self.leave_row = self._add_pair(page, tr("Exit"), self.leave, self.earliest)
        self.repeats = QCheckBox(tr("for about"), page)
        self.repeats.setAccessibleName(tr("Repeats"))
        self.repeats.setToolTip(
            tr("Its part of the clip plays again and again. Use it for a clip that shows a movement once.")
        )
        self.repeats.clicked.connect(self._repeat)
        self.repeat = Seconds(page, tr("How long it repeats if a request does not say how long"))
        self.repeat.valueChanged.connect(self._repeat_for)
        self.repeat_row = self._add_pair(page, tr("Repeats"), self.repeats, self.repeat)

    def _add_choices(self, page: QWidget) -> None:
        """Add by what it is chosen, from where it leads where, and what it moves."""
        self.limb = LimbRow(page, "stance")
        self.limb.chosen.connect(lambda n: self._set(tr("Change limb"), limb=LIMBS[n]))
        self.form.addRow(tr("Limb"), self.limb)
        self.tags = Field(
            page,
            tr("Words separated by commas, such as positive, negative. Requests can ask for them."),
            tr("Tags"),
        )
        self.tags.editingFinished.connect(self._retag)
        self.form.addRow(tr("Tags"), self.tags)
        self.likelihood = Seconds(
            page,
            tr(
                "How often it plays compared with the other actions of its node; 1 is the default, 2 "
                "is twice as often"
            ),
            100,
            "",
            0.1,
        )
        self.likelihood.valueChanged.connect(self._likely)
        self.form.addRow(tr("Likelihood"), self.likelihood)
        self.variation = ActionRows(self.form, page)
        self.variation.changed.connect(lambda text, fields: self._set(text, **fields))
        self.chosen_kind = QuietChooser(page, toolTip=tr("What kind of action it is; its stance stays"))
        self.chosen_kind.activated.connect(self._rekind)
        self.form.addRow(tr("Kind"), self.chosen_kind)
        self.stance = QuietChooser(page, toolTip=tr("The stance it starts from"))
        self.stance.activated.connect(self._restance)
        self.form.addRow(tr("Stance"), self.stance)
        self.ends = QuietChooser(page, toolTip=tr("The stance it ends in"))
        self.ends.activated.connect(self._reend)
        self.form.addRow(tr("Ends in"), self.ends)
        self.joints = make_widget(QPushButton, page, toolTip=tr("Choose which joints it moves"))
        self.joints.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the space bar still plays
        self.joints.clicked.connect(self._mask)
        self.form.addRow(tr("Joints"), self.joints)

    def show_actions(self, actions: Sequence[Action]) -> None:
        """Show what actions have in common."""
        if not actions:
            return
        project, t = self.document.project, get_theme(self.session.look.name)
        one = len(actions) == 1
        kind, layer = (
            find_common_value([a.kind for a in actions]),
            find_common_value([a.layer for a in actions]),
        )
        self.name.setReadOnly(not one)
        of = tuple(a.id for a in actions)
        self.name.show_text(
            actions[0].name if one else tr_plural("{count:,} action", "{count:,} actions", len(actions)), of
        )
        title = f"{KIND_MARKS[kind]} {tr(KIND_TITLES[kind])}" if kind is not Mixed else tr("Mixed kinds")
        self.kind.setText(f"{title} · {get_vocabulary_title(layer) if layer is not Mixed else tr('layers')}")
        set_sheet(self.kind, f"color: {t.kinds[kind]}" if kind is not Mixed else "")
        self.plot.setVisible(one)
        self.set_first_low(not one)
        self.plot.set_curves(not self.low)
        self.timing.setVisible(one and self.low and not self.timing_elsewhere())
        if one:
            self.plot.show_action(actions[0])
        spans = [project.span(a) for a in actions]
        self.start.show_value(find_common_value([s for s, _ in spans]))
        self.end.show_value(find_common_value([e for _, e in spans]))
        self.blend_in.show_value(find_common_value([a.timing.blend_in for a in actions]))
        self.blend_out.show_value(find_common_value([a.timing.blend_out for a in actions]))
        stance = kind == "stance"
        blend_title = self.form.labelForField(self.blend_row)
        if isinstance(blend_title, QLabel):
            blend_title.setText(tr("Loop seam blend") if stance else tr("Blend in, out"))
        self.blend_out.setVisible(not stance)
        self.form.setRowVisible(self.leave_row, not stance)
        exits = find_common_value([a.timing.earliest_exit for a in actions])
        leaves = find_common_value([a.timing.earliest_exit is not None for a in actions])
        _check(self.leave, leaves)
        self.earliest.setEnabled(exits is not None)
        self.earliest.show_value(0.0 if exits is None else exits)
        self.form.setRowVisible(self.repeat_row, all(a.kind in ("gesture", "fidget") for a in actions))
        _check(self.repeats, find_common_value([a.timing.repeat > 0 for a in actions]))
        self.repeat.setEnabled(any(a.timing.repeat > 0 for a in actions))
        self.repeat.show_value(find_common_value([a.timing.repeat for a in actions]))
        self.repeats.setText(self._describe_repeats(actions))
        arms = layer == "arms" and not stance
        self.form.setRowVisible(self.limb, arms)
        self.limb.show_limb(find_common_value([a.limb for a in actions]))
        tags = find_common_value([a.tags for a in actions])
        self.tags.show_text("" if tags is Mixed else ", ".join(tags), of)
        self.tags.setPlaceholderText(tr(MIXED) if tags is Mixed else tr("positive, greeting, …"))
        self.likelihood.show_value(find_common_value([a.likelihood for a in actions]))
        self.variation.show_actions(project, actions)
        self.chosen_kind.show_entries(
            [(f"{KIND_MARKS[k]} {tr(KIND_TITLES[k])}", k) for k in KINDS], kind, tr(MIXED)
        )
        self._fill_stances(actions, kind)
        masks = find_common_value([(a.joints, a.joint_weights) for a in actions])
        self.joints.setText(tr(MIXED) if masks is Mixed else _moved(*masks))
        self.joints.setEnabled(project.skeleton is not None)
        self._show_trouble()

    def set_misfits(self, misfits: dict[str, str]) -> None:
        """Report what is wrong with actions; action id -> words."""
        self.misfits = misfits
        self._show_trouble()

    def _show_trouble(self) -> None:
        chosen = self.session.selection.actions
        wrong = self.misfits.get(chosen[0], "") if len(chosen) == 1 else ""
        self.trouble.setText(wrong)
        set_sheet(self.trouble, f"color: {get_theme(self.session.look.name).warning}")
        self.trouble.setVisible(bool(wrong))

    def _fill_stances(self, actions: Sequence[Action], kind: Any) -> None:
        project = self.document.project
        layer = find_common_value([a.layer for a in actions])
        stances = project.graphs[layer].stances.values() if layer is not Mixed else ()
        for box, values in (
            (self.stance, [a.stance for a in actions]),
            (self.ends, [a.end_stance for a in actions]),
        ):
            shared = find_common_value(values)
            box.show_entries(
                [(s.name, s.id) for s in stances],
                shared,
                tr(MIXED) if shared is Mixed else tr("choose a stance"),
            )
            box.setEnabled(bool(stances))
        self.form.setRowVisible(self.ends, kind == "transition")

    def _set(self, text: str, merge: str | None = None, **changes: Any) -> None:
        chosen = self.session.selection.actions
        self.edit(text, lambda p: edits.update_actions(p, chosen, **changes), merge)

    def _timing(self, field: str, value: float) -> None:
        if value < 0:  # "mixed" was typed over with nothing
            self.show_actions(self.session.selection.selected_actions())
            return
        chosen = self.session.selection.actions
        self.edit(tr("Change timing"), lambda p: set_timing_field(p, chosen, field, value))
        self.show_actions(self.session.selection.selected_actions())  # what was out of the clip was clamped

    def _leave(self) -> None:
        on, project = self.leave.checkState() != Qt.CheckState.Unchecked, self.document.project
        exits: dict[str, dict[str, Any]] = {}
        for action in self.session.selection.selected_actions():
            start, end = project.span(action)
            at = action.timing.earliest_exit
            exits[action.id] = {
                "timing": {
                    "earliest_exit": None
                    if not on
                    else round(start + 0.7 * (end - start), 3)
                    if at is None
                    else at
                }
            }
        self.edit(tr("Change earliest exit"), lambda p: edits.update_each(p, exits))

    def _describe_repeats(self, actions: Sequence[Action]) -> str:
        """Return how often actions play their part, if that is the same for all of them."""
        spans = [(a, *self.document.project.span(a)) for a in actions]
        cycles = [(cycle_of(a.kind, a.timing, start, end), a.timing.repeat) for a, start, end in spans]
        times = {round(times_played(cycle, seconds)) if cycle > 0 else 0 for cycle, seconds in cycles}
        if times == {0} or len(times) != 1:
            return tr("for about")
        return tr_plural("{count:,} time, for about", "{count:,} times, for about", times.pop())

    def _repeat(self) -> None:
        on, chosen = self.repeats.checkState() != Qt.CheckState.Unchecked, self.session.selection.actions
        self.edit(tr("Change repeats"), lambda p: repeat_actions(p, chosen, on))

    def _repeat_for(self, seconds: float) -> None:
        if seconds >= 0:
            spans = [self.document.project.span(a) for a in self.session.selection.selected_actions()]
            once = min((end - start for start, end in spans), default=0.0)
            self._set(tr("Change repeats"), timing={"repeat": round(max(seconds, once), 3)})
        self.show_actions(self.session.selection.selected_actions())

    def _rename(self) -> None:
        actions = self.session.selection.selected_actions()
        name = " ".join(self.name.text().split())
        if len(actions) == 1 and name and name != actions[0].name:
            self._set(tr("Rename action"), name=name)

    def _retag(self) -> None:
        actions = self.session.selection.selected_actions()
        tags = tuple(dict.fromkeys(w.strip().lower() for w in self.tags.text().split(",") if w.strip()))
        mixed = actions and find_common_value([a.tags for a in actions]) is Mixed
        if actions and not (mixed and not tags) and any(a.tags != tags for a in actions):
            self._set(tr("Change tags"), tags=tags)

    def _likely(self, value: float) -> None:
        if value > 0:
            self._set(tr("Change likelihood"), likelihood=round(value, 3))
        else:
            self.show_actions(self.session.selection.selected_actions())

    def _rekind(self, place: int) -> None:
        kind, chosen = self.chosen_kind.itemData(place), self.session.selection.actions
        end = self.session.place.other()
        self.edit(tr("Change kind"), lambda p: edits.set_kind(p, chosen, kind, end))
        self.show_actions(self.session.selection.selected_actions())  # as it was, if that is impossible

    def _restance(self, place: int) -> None:
        stance, chosen = self.stance.itemData(place), self.session.selection.actions
        if self.edit(tr("Move to another stance"), lambda p: edits.to_stance(p, chosen, stance)):
            self.session.place.set_stance(stance)

    def _reend(self, place: int) -> None:
        stance, chosen = self.ends.itemData(place), self.session.selection.actions
        self.edit(tr("Change end stance"), lambda p: edits.set_ends(p, chosen, stance))

    def _mask(self) -> None:
        from app.widgets.joint_mask import MaskDialog

        MaskDialog(self.document, self.session, self).open()


def _check(box: QCheckBox, value: Any) -> None:
    """Show in a box, without a signal, whether something is so: True, False or Mixed."""
    state = Qt.CheckState
    checked = state.PartiallyChecked if value is Mixed else state.Checked if value else state.Unchecked
    box.blockSignals(True)
    box.setTristate(value is Mixed)
    if box.checkState() != checked:
        box.setCheckState(checked)
    box.blockSignals(False)


def _moved(joints: tuple[str, ...], weights: tuple[tuple[str, float], ...]) -> str:
    """Say which joints an action moves, and how many in part."""
    words = tr("{count} joints only", count=len(joints)) if joints else tr("all joints of its layer")
    return f"{words}, {tr('{soft} partly', soft=len(weights))}" if weights else words
