"""Properties of what is selected: one action or many at once, clips, or the layer when nothing is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from html import escape
from typing import Any

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.properties.timing_plot import ANY, TimingPlot
from app.features.properties.variation_rows import ActionRows, PlannerRows
from app.look.theme import KIND_MARKS, KIND_TITLES, theme
from app.project.document import Document
from app.stage.performance import Performance
from app.stage.session import Session
from app.widgets.choice_row import LimbRow
from app.widgets.form_fields import MIXED, Chooser, Field, Mixed, Seconds, common
from app.widgets.halves import Halves
from app.widgets.making import make_widget
from metagraph.graph import edits
from metagraph.graph.model import LIMBS, PARTS, REACH, Action, Project
from metagraph.graph.words import Part
from metagraph.playback.timing import retimed

LOW = 240  # pixels of height below which the curves of a timing leave no room for anything else


class PropertiesPanel(QScrollArea):
    """Every control writes through one edit; what is shown is read back from the project. time_wanted: its
    timing is to be seen whole. timing_elsewhere: whether it is, beside this panel.
    """

    time_wanted = Signal()

    def __init__(
        self, document: Document, session: Session, performance: Performance, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.timing_elsewhere: Callable[[], bool] = lambda: False
        self.misfits: dict[str, str] = {}
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.pages = QStackedWidget(self)
        self.pages.addWidget(self._layer_page())
        self.pages.addWidget(self._action_page())
        self.pages.addWidget(self._clip_page())
        self.setWidget(self.pages)
        document.changed.connect(self._edited)
        for signal in (
            session.selection.changed,
            session.place.layer_changed,
            session.look.changed,
            session.place.stance_changed,
        ):
            signal.connect(self.show_selection)
        self.show_selection()

    # --- building

    def _page(self) -> tuple[QWidget, QVBoxLayout]:
        page = QWidget(self)
        box = QVBoxLayout(page)
        box.setContentsMargins(14, 10, 14, 14)
        box.setSpacing(8)
        return page, box

    def _form(self, box: QVBoxLayout) -> QFormLayout:
        form = QFormLayout()
        form.setHorizontalSpacing(14)
        form.setVerticalSpacing(7)
        form.setLabelAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        box.addLayout(form)
        return form

    def _action_page(self) -> QWidget:
        first, second = QWidget(self), QWidget(self)
        page, box = second, QVBoxLayout(second)
        box.setContentsMargins(0, 0, 0, 0)
        upper = QVBoxLayout(first)
        upper.setContentsMargins(0, 0, 0, 0)
        upper.setSpacing(8)
        head = QHBoxLayout()
        self.name = Field(page, "Name of the action", "Name")
        self.name.editingFinished.connect(self._rename)
        self.kind = QLabel(page)
        head.addWidget(self.name, 1)
        head.addWidget(self.kind)
        self.timing = make_widget(QToolButton, page, text="Timing", toolTip="Show its timing whole")
        self.timing.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.timing.clicked.connect(self.time_wanted)
        head.addWidget(self.timing)
        upper.addLayout(head)
        self.plot = TimingPlot(self.document, self.session, page)
        self.plot.changed.connect(lambda fields: self._set("Change timing", merge="timing", timing=fields))
        self.plot.finished.connect(self.document.finish_merging)
        upper.addWidget(self.plot)
        form = self._form(box)

        def pair(title: str, *fields: QWidget) -> QWidget:
            row = QWidget(page)
            line = QHBoxLayout(row)
            line.setContentsMargins(0, 0, 0, 0)
            for field in fields:
                line.addWidget(field, 1)
            form.addRow(title, row)
            return row

        self.start, self.end = Seconds(page, "Start in the clip"), Seconds(page, "End in the clip")
        self.blend_in, self.blend_out = Seconds(page, "Blend in"), Seconds(page, "Blend out")
        pair("Start, end", self.start, self.end)
        self.blend_row = pair("Blend in, out", self.blend_in, self.blend_out)
        self.start.valueChanged.connect(lambda v: self._timing("start", v))
        self.end.valueChanged.connect(lambda v: self._timing("end", v))
        self.blend_in.valueChanged.connect(lambda v: self._timing("blend_in", v))
        self.blend_out.valueChanged.connect(lambda v: self._timing("blend_out", v))
        self.leave = QCheckBox("early, from", page)
        self.leave.setAccessibleName("May be left early")
        self.leave.setToolTip("Whether what comes next may begin before its end")
        self.leave.clicked.connect(self._leave)
        self.earliest = Seconds(page, "Earliest exit: from here on the action may be left")
        self.earliest.valueChanged.connect(lambda v: self._timing("earliest_exit", v))
        self.leave_row = pair("Exit", self.leave, self.earliest)
        self.limb = LimbRow(page, "stance")
        self.limb.chosen.connect(lambda n: self._set("Change limb", limb=LIMBS[n]))
        form.addRow("Limb", self.limb)
        self.tags = Field(
            page, "Words apart by commas; requests can ask for them: positive, negative, ...", "Tags"
        )
        self.tags.editingFinished.connect(self._retag)
        form.addRow("Tags", self.tags)
        self.likelihood = Seconds(page, "Likelihood against the others of its node; 1 is usual", 100, "", 0.1)
        self.likelihood.valueChanged.connect(self._likely)
        form.addRow("Likelihood", self.likelihood)
        self.variation = ActionRows(form, page)
        self.variation.changed.connect(lambda text, fields: self._set(text, **fields))
        self.stance = Chooser(page, toolTip="The stance it starts from")
        self.stance.activated.connect(self._restance)
        form.addRow("Stance", self.stance)
        self.ends = Chooser(page, toolTip="The stance it ends in")
        self.ends.activated.connect(self._reend)
        form.addRow("Ends in", self.ends)
        self.form = form
        self.joints = make_widget(QPushButton, page, toolTip="Let it move only some joints")
        self.joints.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the space bar still plays
        self.joints.clicked.connect(self._mask)
        form.addRow("Joints", self.joints)
        self.trouble = QLabel(page, wordWrap=True)
        box.addWidget(self.trouble)
        box.addStretch(1)
        self.halves = Halves(first, second, self)
        self.halves.turned.connect(self.plot.set_large)
        return self.halves

    def resizeEvent(self, event: QResizeEvent) -> None:
        self.halves.fit(event.size())
        self._fit_height(event.size().height())
        super().resizeEvent(event)
        self._bound()

    def _fit_height(self, height: int) -> None:
        """Where it is low and not wide, the curves give way: what can be typed is in sight."""
        low = self.timing_elsewhere() or (height < LOW and not self.halves.beside)
        if low == self.low:
            return
        self.low = low
        self.show_selection()

    low = False

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.pages and event.type() == QEvent.Type.LayoutRequest:
            self._bound()
        return super().eventFilter(watched, event)

    def _bound(self) -> None:
        """Side by side, the halves are as high as what is seen of them: the second scrolls alone."""
        beside = self.halves.beside and self.pages.currentIndex() == 1
        self.pages.setMaximumHeight(
            max(self.halves.minimumSizeHint().height(), self.viewport().height()) if beside else ANY
        )

    def _layer_page(self) -> QWidget:
        page, box = self._page()
        self.layer_title = QLabel(page)
        self.layer_title.setProperty("title", True)
        box.addWidget(self.layer_title)
        words = QLabel(
            "Select an action to see its timing. The layer moves these body parts, added to the base pose:",
            page,
            wordWrap=True,
        )
        words.setProperty("dim", True)
        box.addWidget(words)
        form = self._form(box)
        self.weights: dict[str, Seconds] = {}
        for part in PARTS:
            field = Seconds(
                page, f"Weight on the {part}: 0 not at all, 1 as in the clip, 2 twice as much", 2, "", 0.1
            )
            field.valueChanged.connect(lambda v, p=part: self._weigh(p, v))
            self.weights[part] = field
            form.addRow(part.capitalize(), field)
        line = QFrame(page, frameShape=QFrame.Shape.HLine)
        line.setStyleSheet("color: palette(mid)")
        box.addWidget(line)
        form = self._form(box)
        self.gap = Seconds(
            page, "Mean seconds of rest between two actions when nobody asks for any", 60, " s", 0.2
        )
        self.gap.valueChanged.connect(self._set_gap)
        form.addRow("Rest between", self.gap)
        self.base = Chooser(
            page, toolTip="The pose all layers are added to; a neutral one, hands at the sides"
        )
        self.base.activated.connect(self._set_base)
        form.addRow("Base pose", self.base)
        self.base_frame = Seconds(page, "Frame of that clip", 1e6, "", 1, 0)
        self.base_frame.valueChanged.connect(self._set_base_frame)
        form.addRow("At frame", self.base_frame)
        line = QFrame(page, frameShape=QFrame.Shape.HLine)
        line.setStyleSheet("color: palette(mid)")
        box.addWidget(line)
        words = QLabel("All layers, when something is chosen:", page, wordWrap=True)
        words.setProperty("dim", True)
        box.addWidget(words)
        self.planner = PlannerRows(self._form(box), page, self._try)
        box.addStretch(1)
        return page

    def _clip_page(self) -> QWidget:
        page, box = self._page()
        self.clip_title = QLabel(page, wordWrap=True)
        self.clip_title.setProperty("title", True)
        self.clip_words = QLabel(page, wordWrap=True)
        self.clip_words.setProperty("dim", True)
        self.clip_words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        box.addWidget(self.clip_title)
        box.addWidget(self.clip_words)
        self.clip_uses = QLabel(page, wordWrap=True)
        self.clip_uses.setTextFormat(Qt.TextFormat.RichText)
        self.clip_uses.linkActivated.connect(lambda ident: self.session.jump(action=ident))
        box.addWidget(self.clip_uses)
        box.addStretch(1)
        return page

    # --- showing

    def _edited(self, before: Project, after: Project) -> None:
        if (
            before.graphs is not after.graphs
            or before.clips is not after.clips
            or before.base != after.base
            or before.markov is not after.markov
            or before.settings != after.settings
        ):
            self.show_selection()

    def show_selection(self) -> None:
        actions = self.session.selection.selected_actions()
        clips = self.session.selection.clips
        self._turn_to(1 if actions else 2 if clips else 0)
        if actions:
            self._show_actions(actions)
        elif clips:
            self._show_clips(clips)
        else:
            self._show_layer()

    def _turn_to(self, place: int) -> None:
        """Show a page; the panel is as large as that one needs to be, and not as the largest."""
        policy = QSizePolicy.Policy
        for n in range(self.pages.count()):
            page = self.pages.widget(n)
            if page is not None:
                page.setSizePolicy(policy.Preferred, policy.Preferred if n == place else policy.Ignored)
        self.pages.setCurrentIndex(place)
        self._bound()

    def _show_actions(self, actions: Sequence[Action]) -> None:
        project, t = self.document.project, theme(self.session.look.name)
        one = len(actions) == 1
        kind, layer = common([a.kind for a in actions]), common([a.layer for a in actions])
        self.name.setReadOnly(not one)
        of = tuple(a.id for a in actions)
        self.name.show_text(actions[0].name if one else f"{len(actions)} actions", of)
        title = f"{KIND_MARKS[kind]} {KIND_TITLES[kind]}" if kind is not Mixed else "Mixed kinds"
        self.kind.setText(f"{title} · {layer.capitalize() if layer is not Mixed else 'layers'}")
        self.kind.setStyleSheet(f"color: {t.kinds[kind]}" if kind is not Mixed else "")
        self.plot.setVisible(one)
        self.plot.set_curves(not self.low)
        self.timing.setVisible(one and self.low and not self.timing_elsewhere())
        if one:
            self.plot.show_action(actions[0])
        spans = [project.span(a) for a in actions]
        self.start.show_value(common([s for s, _ in spans]))
        self.end.show_value(common([e for _, e in spans]))
        self.blend_in.show_value(common([a.timing.blend_in for a in actions]))
        self.blend_out.show_value(common([a.timing.blend_out for a in actions]))
        stance = kind == "stance"
        blend_title = self.form.labelForField(self.blend_row)
        if isinstance(blend_title, QLabel):
            blend_title.setText("Blend at seam" if stance else "Blend in, out")
        self.blend_out.setVisible(not stance)
        self.form.setRowVisible(self.leave_row, not stance)
        exits = common([a.timing.earliest_exit for a in actions])
        leaves = common([a.timing.earliest_exit is not None for a in actions])
        self.leave.blockSignals(True)
        self.leave.setTristate(leaves is Mixed)
        state = Qt.CheckState
        self.leave.setCheckState(
            state.PartiallyChecked if leaves is Mixed else state.Checked if leaves else state.Unchecked
        )
        self.leave.blockSignals(False)
        self.earliest.setEnabled(exits is not None)
        self.earliest.show_value(0.0 if exits is None else exits)
        arms = layer == "arms" and not stance
        self.form.setRowVisible(self.limb, arms)
        self.limb.show_limb(common([a.limb for a in actions]))
        tags = common([a.tags for a in actions])
        self.tags.show_text("" if tags is Mixed else ", ".join(tags), of)
        self.tags.setPlaceholderText(MIXED if tags is Mixed else "positive, greeting, …")
        self.likelihood.show_value(common([a.likelihood for a in actions]))
        self.variation.show_actions(project, actions)
        self._fill_stances(actions, kind)
        masks = common([a.joints for a in actions])
        self.joints.setText(
            MIXED if masks is Mixed else f"{len(masks)} joints only" if masks else "all its layer reaches"
        )
        self.joints.setEnabled(project.skeleton is not None)
        self._show_trouble()

    def set_misfits(self, misfits: dict[str, str]) -> None:
        """Tell what is wrong with actions; action id -> words."""
        self.misfits = misfits
        self._show_trouble()

    def _show_trouble(self) -> None:
        chosen = self.session.selection.actions
        wrong = self.misfits.get(chosen[0], "") if len(chosen) == 1 else ""
        self.trouble.setText(wrong)
        self.trouble.setStyleSheet(f"color: {theme(self.session.look.name).warning}")
        self.trouble.setVisible(bool(wrong))

    def _fill_stances(self, actions: Sequence[Action], kind: Any) -> None:
        project = self.document.project
        layer = common([a.layer for a in actions])
        stances = project.graphs[layer].stances.values() if layer is not Mixed else ()
        for box, values in (
            (self.stance, [a.stance for a in actions]),
            (self.ends, [a.end_stance for a in actions]),
        ):
            shared = common(values)
            box.show_entries(
                [(s.name, s.id) for s in stances], shared, MIXED if shared is Mixed else "choose one"
            )
            box.setEnabled(bool(stances))
        self.form.setRowVisible(self.ends, kind == "transition")

    def _show_clips(self, clips: Sequence[str]) -> None:
        project, t = self.document.project, theme(self.session.look.name)
        entries = [project.clips[c] for c in clips]
        total = sum(e.duration for e in entries)
        if len(entries) == 1:
            e = entries[0]
            self.clip_title.setText(e.name)
            notes = "".join(
                f"\n\n{note}"
                for note in (e.motion.notes if e.motion is not None else ("The file is missing.",))
            )
            self.clip_words.setText(
                f"{e.duration:.2f} s, {e.frames} frames at {e.fps:g} fps\n{e.path}{notes}"
            )
        else:
            self.clip_title.setText(f"{len(entries)} clips")
            self.clip_words.setText(f"{total:.1f} s together")
        lines = []
        for action in [a for c in clips for a in project.uses.get(c, ())][:20]:
            stance = project.stance(action.stance)
            color = t.kinds[action.kind]
            where = escape(f"{action.kind} of {stance.name if stance else '?'}, {action.layer}")
            lines.append(
                f"<p style='margin:2px'><span style='color:{color}'>{KIND_MARKS[action.kind]}</span> "
                f"<a style='color:{t.text}' href='{action.id}'>{where}</a></p>"
            )
        keys = (
            "<p>Drag onto a node, or press <b>1</b> stance, <b>2</b> gesture, <b>3</b> fidget, <b>4</b> "
            "transition.</p>"
        )
        self.clip_uses.setText("".join(lines) + keys)

    def _show_layer(self) -> None:
        project, layer = self.document.project, self.session.place.layer
        graph = project.graphs[layer]
        self.layer_title.setText(f"{layer.capitalize()} layer")
        for part in PARTS:
            self.weights[part].show_value(graph.weights.get(part, REACH[layer][part]))
        from metagraph.playback.markov import model

        self.gap.show_value(model(project, layer).gap)
        clips = [("Rest pose of the skeleton", None), *((e.name, e.id) for e in project.clips.values())]
        self.base.show_entries(clips, project.base.clip, "a clip that is gone")
        self.base.setEnabled(bool(project.clips))
        self.base_frame.setEnabled(project.base.clip is not None)
        self.base_frame.show_value(project.base.frame)
        self.planner.show_settings(project.settings)

    # --- editing

    def _try(self, text: str, function: Callable[[Project], Project], merge: str | None = None) -> bool:
        try:
            self.document.edit(text, function, merge)
        except edits.EditError as error:
            self.document.failed.emit(str(error))
            self.show_selection()
            return False
        return True

    def _set(self, text: str, merge: str | None = None, **changes: Any) -> None:
        chosen = self.session.selection.actions
        self._try(text, lambda p: edits.update_actions(p, chosen, **changes), merge)

    def _timing(self, field: str, value: float) -> None:
        if value < 0:  # "mixed" was typed over with nothing
            self.show_selection()
            return
        chosen = self.session.selection.actions
        self._try("Change timing", lambda p: retimed(p, chosen, field, value))
        self.show_selection()  # what was out of the clip was clamped

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
        self._try("Change earliest exit", lambda p: edits.update_each(p, exits))

    def _rename(self) -> None:
        actions = self.session.selection.selected_actions()
        name = " ".join(self.name.text().split())
        if len(actions) == 1 and name and name != actions[0].name:
            self._set("Rename action", name=name)

    def _retag(self) -> None:
        actions = self.session.selection.selected_actions()
        tags = tuple(dict.fromkeys(w.strip().lower() for w in self.tags.text().split(",") if w.strip()))
        mixed = actions and common([a.tags for a in actions]) is Mixed
        if actions and not (mixed and not tags) and any(a.tags != tags for a in actions):
            self._set("Change tags", tags=tags)

    def _likely(self, value: float) -> None:
        if value > 0:
            self._set("Change likelihood", likelihood=round(value, 3))
        else:
            self.show_selection()

    def _restance(self, place: int) -> None:
        stance, chosen = self.stance.itemData(place), self.session.selection.actions
        if self._try("Move to another stance", lambda p: edits.to_stance(p, chosen, stance)):
            self.session.place.set_stance(stance)

    def _reend(self, place: int) -> None:
        stance, chosen = self.ends.itemData(place), self.session.selection.actions
        self._try("Change end stance", lambda p: edits.set_ends(p, chosen, stance))

    def _mask(self) -> None:
        from app.widgets.joint_mask import MaskDialog

        MaskDialog(self.document, self.session, self).open()

    def _weigh(self, part: Part, value: float) -> None:
        if value < 0:
            self.show_selection()
        else:
            layer = self.session.place.layer
            self._try("Change layer weight", lambda p: edits.set_weight(p, layer, part, round(value, 2)))

    def _set_gap(self, value: float) -> None:
        from dataclasses import replace

        from metagraph.playback.markov import model

        layer = self.session.place.layer
        if value <= 0:
            self.show_selection()
        else:
            self._try(
                "Change rest between actions",
                lambda p: edits.set_markov(p, replace(model(p, layer), gap=round(value, 2))),
            )

    def _set_base(self, place: int) -> None:
        clip = self.base.itemData(place)
        self._try("Set base pose", lambda p: edits.set_base(p, clip, 0))

    def _set_base_frame(self, value: float) -> None:
        clip = self.document.project.base.clip
        if clip is not None and value >= 0:
            self._try("Set base pose", lambda p: edits.set_base(p, clip, int(value)))
