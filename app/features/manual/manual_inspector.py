"""Properties in the editor: of states or links, one or many at once, or of the whole machine when nothing is
selected.
"""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from app.features.manual import manual_commands as commands
from app.features.manual import manual_many
from app.features.manual.alias_page import AliasPage
from app.features.manual.exit_row import ExitRow
from app.features.manual.manual_canvas import ManualCanvas
from app.features.manual.manual_mask import StateMask
from app.look.domain_words import LAYER_LONG_TITLES
from app.look.theme import get_theme
from app.stage.performance import StagePerformance
from app.translation import make_lazy_texts, tr, tr_plural
from app.widgets.choice_row import LimbRow
from app.widgets.form_fields import MIXED, Field, Mixed, QuietChooser, Seconds, find_common_value
from app.widgets.making import make_widget
from app.widgets.restyling import set_sheet
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import Link, State
from metagraph.graph.model import LIMBS, Project
from metagraph.playback.manual_playback import make_state_action

WHEN = make_lazy_texts(
    lambda: ((tr("when the source has finished"), "finished"), (tr("on request"), "request"))
)


class Inspector(QScrollArea):
    """Every control writes through one edit; what is shown is read back from the project."""

    def __init__(
        self, canvas: ManualCanvas, performance: StagePerformance, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.canvas, self.performance = canvas, performance
        self.document, self.session = canvas.document, canvas.session
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.pages = QStackedWidget(self)
        self.alias = AliasPage(canvas, self)
        for page in (self._machine_page(), self._state_page(), self._link_page(), self.alias):
            self.pages.addWidget(page)
        self.setWidget(self.pages)
        self.document.changed.connect(self._edited)
        for signal in (
            self.session.selection.changed,
            self.session.place.layer_changed,
            self.session.look.changed,
        ):
            signal.connect(self.show_selection)
        self.show_selection()

    # --- building

    def _page(self) -> tuple[QWidget, QVBoxLayout, QFormLayout]:
        page = QWidget(self)
        box = QVBoxLayout(page)
        box.setContentsMargins(14, 10, 14, 14)
        box.setSpacing(8)
        form = QFormLayout()
        form.setHorizontalSpacing(14)
        form.setVerticalSpacing(7)
        form.setLabelAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        return page, box, form

    def _machine_page(self) -> QWidget:
        page, box, form = self._page()
        self.title, self.words = QLabel(page), QLabel(page, wordWrap=True)
        self.title.setProperty("title", True)
        self.words.setProperty("dim", True)
        box.addWidget(self.title)
        box.addWidget(self.words)
        self.start = QuietChooser(page, toolTip=tr("The start state of this layer"))
        self.start.activated.connect(
            lambda n: self._try(
                tr("Start here"), lambda p: manual_edits.set_start_state(p, self.start.itemData(n))
            )
        )
        form.addRow(tr("Start state"), self.start)
        box.addLayout(form)
        self.triggers_title = QLabel(tr("Triggers: click one to fire it"), page)
        self.triggers_title.setProperty("dim", True)
        box.addWidget(self.triggers_title)
        self.triggers = QVBoxLayout()
        self.triggers.setSpacing(3)
        box.addLayout(self.triggers)
        self._shown_triggers: tuple[str, ...] = ()
        box.addStretch(1)
        return page

    def _state_page(self) -> QWidget:
        page, box, form = self._page()
        self.name = Field(page, tr("Name of the state"), tr("Name"))
        self.name.editingFinished.connect(self._rename)
        box.addWidget(self.name)
        self.clip = QLabel(page, wordWrap=True)
        self.clip.setProperty("dim", True)
        box.addWidget(self.clip)
        box.addLayout(form)
        self.loop = QCheckBox(tr("repeat"), page)
        self.loop.setToolTip(tr("If off, the state holds its last frame"))
        self.loop.clicked.connect(
            lambda: self._state(tr("Change loop"), loop=self.loop.checkState() != Qt.CheckState.Unchecked)
        )
        form.addRow(tr("Loop"), self.loop)
        self.first, self.last = Seconds(page, tr("Start in the clip")), Seconds(page, tr("End in the clip"))
        self.first.valueChanged.connect(lambda v: self._trim("start", v))
        self.last.valueChanged.connect(lambda v: self._trim("end", v))
        form.addRow(tr("Start, end"), _row(page, self.first, self.last))
        self.limb = LimbRow(page, tr("base pose"))
        self.limb.chosen.connect(lambda n: self._state(tr("Change limb"), limb=LIMBS[n]))
        form.addRow(tr("Limb"), self.limb)
        self.joints = make_widget(QPushButton, page, toolTip=tr("Choose which joints it moves"))
        self.joints.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.joints.clicked.connect(lambda: StateMask(self.document, self.session, self).open())
        form.addRow(tr("Joints"), self.joints)
        self.layer = QLabel(page)
        form.addRow(tr("Layer"), self.layer)
        self.begin = make_widget(
            QPushButton, tr("Start here"), page, toolTip=tr("Make this the start state of the layer")
        )
        self.begin.clicked.connect(lambda: commands.start_here(self.canvas, self.session.selection.states[0]))
        self.alone = QPushButton(tr("Play alone"), page)
        self.alone.clicked.connect(lambda: self.session.show_context(self.session.selection.states[0]))
        box.addWidget(_row(page, self.begin, self.alone))
        self.group = make_widget(
            QPushButton,
            tr("Make alias"),
            page,
            toolTip=tr("Make one node that stands for all selected states (Ctrl+G)"),
        )
        self.group.clicked.connect(lambda: manual_many.make_alias(self.canvas))
        box.addWidget(self.group)
        self.state_trouble = QLabel(page, wordWrap=True)
        box.addWidget(self.state_trouble)
        box.addStretch(1)
        return page

    def _link_page(self) -> QWidget:
        page, box, form = self._page()
        self.ends = QLabel(page, wordWrap=True)
        self.ends.setProperty("title", True)
        box.addWidget(self.ends)
        box.addLayout(form)
        self.when = QuietChooser(page, toolTip=tr("When the link is taken"))
        self.when.activated.connect(
            lambda n: self._link(tr("Change condition"), condition={"when": WHEN[n][1]})
        )
        form.addRow(tr("Taken"), self.when)
        self.trigger = Field(page, tr("The trigger that makes the link fire"), tr("Trigger"))
        self.trigger.editingFinished.connect(self._retrigger)
        form.addRow(tr("Trigger"), self.trigger)
        self.weight = Seconds(
            page,
            tr(
                "How often this link is taken compared with the other links when the source has "
                "finished; 1 is the default"
            ),
            1000,
            "",
            0.1,
        )
        self.weight.valueChanged.connect(self._weigh)
        form.addRow(tr("Weight"), self.weight)
        self.exit = ExitRow(page)
        self.exit.chosen.connect(self._leave)
        self.exit.timed.connect(lambda v: self._number(tr("Change exit time"), "exit_time", v))
        self.exit.shared.connect(lambda v: self._number(tr("Change exit time"), "exit_part", v))
        form.addRow(tr("Exit"), self.exit)
        self.blend = Seconds(page, tr("Duration of the blend into the target"))
        self.blend.valueChanged.connect(lambda v: self._number(tr("Change blend"), "blend", v))
        form.addRow(tr("Blend"), self.blend)
        self.form = form
        self.fire = make_widget(QPushButton, tr("Fire"), page, toolTip=tr("Fire its trigger now"))
        self.fire.clicked.connect(self._fire)
        self.play = make_widget(
            QPushButton,
            tr("Play link"),
            page,
            toolTip=tr("Play the end of the source, the blend and the start of the target"),
        )
        self.play.clicked.connect(lambda: self.session.show_context(self.session.selection.links[0]))
        box.addWidget(_row(page, self.fire, self.play))
        self.copy = make_widget(
            QPushButton,
            tr("Copy"),
            page,
            toolTip=tr(
                "Copy the links. You can paste their settings on other links, or the links on other states."
            ),
        )
        self.copy.clicked.connect(self._copy)
        self.paste = QPushButton(tr("Paste settings"), page)
        self.paste.clicked.connect(lambda: commands.paste_here(self.canvas))
        box.addWidget(_row(page, self.copy, self.paste))
        self.group.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        for button in (self.fire, self.play, self.copy, self.paste, self.begin, self.alone):
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the space bar still plays
        self.link_trouble = QLabel(page, wordWrap=True)
        box.addWidget(self.link_trouble)
        box.addStretch(1)
        return page

    # --- showing

    def _edited(self, before: Project, after: Project) -> None:
        if before.manual is not after.manual or before.clips is not after.clips:
            self.show_selection()

    def states(self) -> list[State]:
        return [s for i in self.session.selection.states if (s := self.document.project.state(i)) is not None]

    def links(self) -> list[Link]:
        return [x for i in self.session.selection.links if (x := self.document.project.link(i)) is not None]

    def show_selection(self) -> None:
        """Show what is selected as it is; links come before states, which are selected with them."""
        links, states = self.links(), self.states()
        aliases = [
            a for i in self.session.selection.states if (a := self.document.project.alias(i)) is not None
        ]
        lone = bool(aliases) and not states and not links
        self.pages.setCurrentIndex(3 if lone else 2 if links and not states else 1 if states else 0)
        if lone:
            self.alias.show_aliases(aliases)
            self._trouble(self.alias.trouble, [a.id for a in aliases])
            return
        if links and not states:
            self._show_links(links)
        elif states:
            self._show_states(states)
        else:
            self._show_machine()

    def _trouble(self, label: QLabel, idents: list[str]) -> None:
        words = [self.canvas.troubles[i] for i in idents if i in self.canvas.troubles]
        label.setText(words[0] if words else "")
        set_sheet(label, f"color: {get_theme(self.session.look.name).warning}")

    def _show_machine(self) -> None:
        manual = self.canvas.scene().manual
        self.title.setText(LAYER_LONG_TITLES[self.session.place.layer])
        self.words.setText(
            tr(
                "{states}, {links} for {ways}. Select one or more of them to edit them.",
                states=tr_plural("{count:,} state", "{count:,} states", len(manual.states)),
                links=tr_plural("{count:,} link", "{count:,} links", len(manual.links)),
                ways=tr_plural("{count:,} connection", "{count:,} connections", len(manual.ways)),
            )
        )
        self.start.show_entries(
            [(s.name, s.id) for s in manual.states.values()], manual.start, tr("no state yet")
        )
        self.start.setEnabled(bool(manual.states))
        self.triggers_title.setVisible(bool(manual.triggers))
        if manual.triggers != self._shown_triggers:
            self._shown_triggers = manual.triggers
            while (item := self.triggers.takeAt(0)) is not None:
                if (button := item.widget()) is not None:
                    button.deleteLater()
            for trigger in manual.triggers:
                button = QPushButton(trigger, self)
                button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
                button.clicked.connect(lambda _=False, t=trigger: self.performance.fire(t))
                self.triggers.addWidget(button)

    def _show_states(self, states: list[State]) -> None:
        project, one = self.document.project, len(states) == 1
        first = states[0]
        self.name.setEnabled(one)
        self.name.show_text(
            first.name if one else tr_plural("{count:,} state", "{count:,} states", len(states)),
            tuple(s.id for s in states),
        )
        clips = {
            project.clips[s.clip].name if s.clip in project.clips else tr("a missing clip") for s in states
        }
        self.clip.setText(
            tr("plays {clip}", clip=next(iter(clips)))
            if len(clips) == 1
            else tr("play {clips}", clips=tr_plural("{count:,} clip", "{count:,} clips", len(clips)))
        )
        loop = find_common_value([s.loop for s in states])
        self.loop.setTristate(loop is Mixed)
        self.loop.setCheckState(_check(loop))
        spans = [project.span(make_state_action(s)) for s in states]
        self.first.show_value(find_common_value([round(a, 4) for a, _ in spans]))
        self.last.show_value(find_common_value([round(b, 4) for _, b in spans]))
        self.limb.show_limb(find_common_value([s.limb for s in states]))
        masks = find_common_value([(s.joints, s.joint_weights) for s in states])
        self.joints.setText(tr(MIXED) if masks is Mixed else _moved(*masks))
        self.joints.setEnabled(project.skeleton is not None)
        self.layer.setText(tr(first.layer))
        start = self.canvas.scene().manual.start
        self.begin.setEnabled(one and start != first.id)
        self.begin.setText(tr("Starts here") if one and start == first.id else tr("Start here"))
        self.alone.setEnabled(one)
        self._trouble(self.state_trouble, [s.id for s in states])

    def _show_links(self, links: list[Link]) -> None:
        project, one = self.document.project, len(links) == 1
        source, target = (project.state(i) or project.alias(i) for i in (links[0].source, links[0].target))
        begins = escape(source.name) if source else tr("Any state")
        names = f"{begins} → {escape(target.name) if target else '?'}"
        self.ends.setText(names if one else tr_plural("{count:,} link", "{count:,} links", len(links)))
        when = find_common_value([x.condition.when for x in links])
        self.when.show_entries(WHEN, None if when is Mixed else when, tr(MIXED))
        trigger = find_common_value([x.condition.trigger for x in links])
        self.trigger.show_text(tr(MIXED) if trigger is Mixed else trigger, tuple(x.id for x in links))
        self.form.setRowVisible(self.trigger, when != "finished")
        self.form.setRowVisible(self.weight, when != "request")
        self.weight.show_value(find_common_value([x.condition.weight for x in links]))
        self.exit.show_links(links)
        self.blend.show_value(find_common_value([x.blend for x in links]))
        self.fire.setVisible(one and when == "request")
        self.play.setEnabled(one)
        self.paste.setEnabled(len(commands.kept.links) == 1)
        self._trouble(self.link_trouble, [x.id for x in links])

    # --- editing

    def _try(self, text: str, edit: Callable[[Project], Project]) -> None:
        if not self.canvas.do(text, edit):
            self.show_selection()

    def _state(self, text: str, **changes: Any) -> None:
        chosen = self.session.selection.states
        self._try(text, lambda p: manual_edits.update_states(p, chosen, **changes))

    def _link(self, text: str, **changes: Any) -> None:
        chosen = self.session.selection.links
        self._try(text, lambda p: manual_edits.update_links(p, chosen, **changes))

    def _number(self, text: str, field: str, value: float) -> None:
        if value < 0:  # "mixed" was typed over with nothing
            self.show_selection()
        else:
            self._link(text, **{field: round(value, 3)})

    def _rename(self) -> None:
        states = self.states()
        name = " ".join(self.name.text().split())
        if len(states) == 1 and name != states[0].name:
            self._state(tr("Rename state"), name=name)

    def _trim(self, field: str, value: float) -> None:
        chosen = self.session.selection.states

        def edit(project: Project) -> Project:
            for ident in chosen:
                state = project.state(ident)
                entry = project.clips.get(state.clip) if state is not None else None
                if state is None or entry is None:
                    continue
                start, end = project.span(make_state_action(state))
                shortest = 1 / entry.fps
                if field == "start":
                    at: float | None = round(min(max(0.0, value), max(0.0, end - shortest)), 3)
                else:
                    at = round(max(value, start + shortest), 3)
                    at = None if at >= entry.duration - shortest / 2 else at
                project = manual_edits.update_states(project, [ident], **{field: at})
            return project

        if value >= 0:
            self._try(tr("Trim"), edit)
        self.show_selection()  # what was out of the clip was clamped

    def _retrigger(self) -> None:
        links, words = self.links(), self.trigger.text()
        mixed = bool(links) and find_common_value([x.condition.trigger for x in links]) is Mixed
        if links and not (mixed and words == tr(MIXED)) and any(x.condition.trigger != words for x in links):
            self._link(tr("Change trigger"), condition={"trigger": words})

    def _weigh(self, value: float) -> None:
        if value > 0:
            self._link(tr("Change weight"), condition={"weight": round(value, 3)})
        else:
            self.show_selection()

    def _leave(self, way: str) -> None:
        """Let links leave otherwise; those that get a time or a share begin at the end of what plays."""
        chosen = self.session.selection.links

        def edit(project: Project) -> Project:
            if way in ("none", "end"):
                part = 1.0 if way == "end" else None
                return manual_edits.update_links(project, chosen, exit_time=None, exit_part=part)
            if way == "part":
                return manual_edits.update_links(project, chosen, exit_time=None, exit_part=0.9)
            for ident in chosen:
                link = project.link(ident)
                if link is None or link.exit_time is not None:
                    continue
                source = project.state(link.source)
                span = project.span(make_state_action(source)) if source is not None else (0.0, 1.0)
                at = round(max(span[0], span[1] - link.blend), 3)
                project = manual_edits.update_links(project, [ident], exit_time=at, exit_part=None)
            return project

        self._try(tr("Change exit time"), edit)
        self.show_selection()

    def _copy(self) -> None:
        commands.copy(self.canvas)
        self.show_selection()

    def _fire(self) -> None:
        links = self.links()
        if links and links[0].condition.trigger:
            self.performance.fire(links[0].condition.trigger)


def _row(parent: QWidget, *fields: QWidget) -> QWidget:
    row = QWidget(parent)
    line = QHBoxLayout(row)
    line.setContentsMargins(0, 0, 0, 0)
    for field in fields:
        line.addWidget(field, 0 if isinstance(field, QCheckBox) else 1)
    if any(isinstance(f, QCheckBox) for f in fields):
        line.addStretch(1)
    return row


def _check(value: Any) -> Qt.CheckState:
    if value is Mixed:
        return Qt.CheckState.PartiallyChecked
    return Qt.CheckState.Checked if value else Qt.CheckState.Unchecked


def _moved(joints: tuple[str, ...], weights: tuple[tuple[str, float], ...]) -> str:
    """Say how many joints a state moves, and how many in part."""
    words = tr_plural("{count:,} joint…", "{count:,} joints…", len(joints)) if joints else tr("All…")
    return f"{words} {tr('{soft} partly', soft=len(weights))}" if weights else words
