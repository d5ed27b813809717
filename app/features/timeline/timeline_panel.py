"""The Performance panel: the performance on stage, its seed, and lanes of requests and actions."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import (
    QHBoxLayout,
    QInputDialog,
    QLabel,
    QMenu,
    QMessageBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.timeline.lane_view import Lanes
from app.features.timeline.stage_words import count_cues, describe_machine, describe_marks, describe_talk
from app.features.timeline.voices import Voices
from app.features.timeline.what_if import WhatIf
from app.look import icons
from app.look.theme import get_theme
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_error, tr_noop, tr_plural
from app.widgets.making import make_widget
from app.widgets.more_button import MoreButton
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from app.widgets.request_menu import MOOD_WORDS, make_request_menu
from app.widgets.sentence import Sentence
from metagraph.graph import edits
from metagraph.graph.conversation.edits import change_conversation
from metagraph.graph.conversation.model import get_side_name
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Performance as KeptPerformance
from metagraph.graph.words import FEELINGS

IMPROVISED = make_lazy_texts(
    lambda: {
        "talking": tr("Improvised, talking"),
        "listening": tr("Improvised, listening"),
        "idle": tr("Improvised, idle"),
    }
)
MAGNET = tr_noop(
    "Snap to markers, words, strokes, starts, ends and seconds while dragging (S; hold Shift to drag freely)"
)
GHOSTS = tr_noop("Show what other seeds would play, in rows under the lanes. Click one to use it (Shift+W)")
RIPPLE = tr_noop("Ripple: moving a request also moves everything after it (Shift+R)")


class TimelinePanel(QWidget):
    """The lanes, with what can be asked for, the seed and the zoom above them."""

    def __init__(
        self,
        document: Document,
        session: StageSession,
        performance: StagePerformance,
        jobs: Jobs,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.voices = Voices(document, jobs, performance, self)
        self.what_if = WhatIf(document, jobs, performance, self)
        self.lanes = Lanes(session, performance, self.voices, self.what_if, self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 4, 0, 0)
        layout.setSpacing(0)
        row = QHBoxLayout()
        row.setContentsMargins(12, 0, 12, 2)
        row.setSpacing(8)
        self._add_choice(row)
        self.magnet = self._switch(tr(MAGNET), tr("Snap"), self.lanes.magnet.on)
        self.ripple = self._switch(tr(RIPPLE), tr("Ripple"), performance.requests.ripple)
        for switch in (self.magnet, self.ripple):
            row.addWidget(switch)
        self._add_live(row)
        self._add_chance(row)
        layout.addLayout(row)
        layout.addWidget(self.lanes, 1)
        self.lanes.magnet.on = self.magnet.isChecked()
        self.magnet.toggled.connect(self.lanes.magnet.set_on)
        self.ripple.toggled.connect(lambda on: setattr(performance.requests, "ripple", on))
        self._restyle()
        self._spoken = QTimer(self, interval=500)  # the words about clients, while live
        self._spoken.timeout.connect(self._words)
        self._follow()
        self._live()
        self._restage()
        self._switched()

    def _add_choice(self, row: QHBoxLayout) -> None:
        """Add which performance is on stage, what can be done with it, and what is said of it."""
        self.stage = ComboBox(
            self,
            toolTip=tr(
                "The performance on stage. In an improvised one, the models choose all actions: gestures "
                "while the character talks, nods while it listens, fidgets while it idles."
            ),
        )
        self.stage.setAccessibleName(tr("Performance"))
        self.stage.setMinimumWidth(150)
        self.stage.activated.connect(self._put_on)
        row.addWidget(self.stage)
        self.more = MoreButton(
            self.session.look,
            tr("Performances"),
            tr("Create, rename and remove performances, set their length"),
            self,
        )
        self.more_menu = self.more.menu_of
        self.more_menu.aboutToShow.connect(self._fill)
        row.addWidget(self.more)
        self.title = Sentence(self)
        self.title.setMinimumHeight(2 * self.title.fontMetrics().height())
        row.addWidget(self.title, 1)

    def _add_live(self, row: QHBoxLayout) -> None:
        """Add what was not met, and what is done live."""
        self.lost = make_widget(
            QToolButton, self, toolTip=tr("Select the next request that cannot be met, and show why")
        )
        self.lost.clicked.connect(self.show_lost)
        row.addWidget(self.lost)
        self.now = make_widget(
            QToolButton, self, text=tr("Back to now"), toolTip=tr("Follow the live performance again")
        )
        self.now.clicked.connect(self.performance.live.follow)
        row.addWidget(self.now)
        self.live = make_widget(QToolButton, self, text=tr("Live"), checkable=True)
        self.live.setProperty("tight", True)
        self.live.setToolTip(
            tr("Let other programs on this computer control the character over WebSocket and OSC (Ctrl+L)")
        )
        self.live.clicked.connect(self.toggle_live)
        row.addWidget(self.live)
        self.ask = make_widget(
            QToolButton, self, text=tr("Ask for…"), toolTip=tr("Request an action, a look or a line now")
        )
        self.ask.setProperty("tight", True)
        self.ask.clicked.connect(self._ask)
        row.addWidget(self.ask)

    def _add_chance(self, row: QHBoxLayout) -> None:
        """Add the seed, and what others would bring."""
        row.addWidget(QLabel(tr("Seed"), self))
        # Whole numbers of 32 bits without a sign, which the other field does not hold.
        self.seed = DoubleSpinBox(
            self,
            toolTip=tr(
                "The number that decides all random choices. Another seed gives another performance of "
                "the same graph."
            ),
        )
        self.seed.setDecimals(0)
        self.seed.setFixedWidth(112)
        self.seed.setRange(0, 0xFFFFFFFF)
        self.seed.setAccessibleName(tr("Seed"))
        self.seed.valueChanged.connect(self._seeded)
        row.addWidget(self.seed)
        self.ghosts = self._switch(tr(GHOSTS), tr("What if"), False)
        self.ghosts.toggled.connect(self.what_if.set_on)
        self.what_if.changed.connect(lambda: self.ghosts.setChecked(self.what_if.on))
        row.addWidget(self.ghosts)

    def _follow(self) -> None:
        session, performance = self.session, self.performance
        session.look.changed.connect(self._restyle)
        performance.changed.connect(self._words)
        session.transport.show_changed.connect(self._words)
        performance.live.changed.connect(self._live)
        session.transport.moved.connect(self._moved)
        session.transport.playing_changed.connect(self._moved)
        session.onstage.performance_changed.connect(self._restage)
        session.onstage.performance_changed.connect(self._words)
        session.onstage.conversation_changed.connect(self._restage)
        session.onstage.mode_changed.connect(self._switched)
        self.document.changed.connect(lambda before, after: self._restage())

    def _switch(self, tip: str, name: str, on: bool) -> QToolButton:
        """Return a button that stays pressed while something is on."""
        out = make_widget(QToolButton, self, toolTip=tip, checkable=True, checked=on)
        out.setAccessibleName(name)
        out.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        out.setProperty("tight", True)
        return out

    def _restyle(self) -> None:
        color = get_theme(self.session.look.name).text
        self.magnet.setIcon(icons.make_icon("magnet", color))
        self.ghosts.setIcon(icons.make_icon("ghosts", color))
        self.ripple.setIcon(icons.make_icon("ripple", color))

    def _switched(self) -> None:
        """Requests and kept performances are the meta-graph's."""
        for part in (self.stage, self.more, self.ask, self.live):
            part.setEnabled(self.session.onstage.mode == "meta")
        self._words()

    def _put_on(self, _: int) -> None:
        """Put on stage what was chosen: a performance, improvising, or another of those who talk."""
        chosen = self.stage.currentData()
        if chosen in IMPROVISED:
            self.session.onstage.improvise(chosen)
        elif isinstance(chosen, int):
            self.session.onstage.set_side(chosen)
        else:
            self.session.onstage.set_conversation(None)
            self.session.onstage.set_performance(chosen)

    def _restage(self) -> None:
        """Show which performance is on stage, and its seed."""
        wanted: list[tuple[str, str | int]] = [(words, mode) for mode, words in IMPROVISED.items()]
        wanted += [(p.name, i) for i, p in self.document.project.performances.items()]
        talk = self.document.project.conversations.get(self.session.onstage.conversation or "")
        if talk is not None:  # then it is one of those who talk whose plan is seen
            wanted += [(f"{talk.name}: {get_side_name(talk, side)}", side) for side in range(len(talk.sides))]
        onstage = self.session.onstage
        shown = (onstage.performance or onstage.improvised) if talk is None else onstage.side
        if wanted != [(self.stage.itemText(n), self.stage.itemData(n)) for n in range(self.stage.count())]:
            self.stage.clear()
            for name, ident in wanted:
                self.stage.addItem(name, ident)
        self.stage.setCurrentIndex(next((n for n, (_, i) in enumerate(wanted) if i == shown), 0))
        self._show_seed()

    # --- performances

    def _fill(self) -> None:
        menu, kept = self.more_menu, self.performance.requests.kept
        menu.clear()
        menu.addAction(tr("New performance"), self.new)
        played = self.performance.live.last
        if played is not None:
            menu.addAction(tr("Keep the live session"), lambda: self._keep(tr("Keep live session"), played))
        if kept is None:
            return
        menu.addAction(tr("Rename…"), self.rename)
        menu.addAction(tr("Duplicate"), self.duplicate)
        menu.addAction(tr("Length…"), self.set_length)
        fill = menu.addAction(
            tr("Models fill the gaps"),
            lambda: self._change(tr("Change how gaps are filled"), idle=not kept.idle),
        )
        fill.setCheckable(True)
        fill.setChecked(kept.idle)
        gaps = menu.addMenu(tr("In the gaps"))
        gaps.setEnabled(kept.idle)
        for mode, words in IMPROVISED.items():
            choice = gaps.addAction(words, partial(self._change, tr("Change how gaps are filled"), mode=mode))
            choice.setCheckable(True)
            choice.setChecked(kept.mode == mode)
        self._fill_moods(menu.addMenu(tr("Mood")), kept)
        own = menu.addAction(tr("Use its own seed"), self._own_seed)
        own.setCheckable(True)
        own.setChecked(kept.seed is not None)
        menu.addSeparator()
        menu.addAction(tr("Remove…"), self.remove)

    def _fill_moods(self, menu: QMenu, kept: KeptPerformance) -> None:
        """Fill a menu with the moods a whole performance may be in, and how strongly."""
        moods: list[tuple[str, str | None]] = [(tr("As the character"), None)]
        moods += [(MOOD_WORDS[feeling], feeling) for feeling in FEELINGS]
        for words, mood in moods:
            choice = menu.addAction(
                words, partial(self._change, tr("Change the mood of a performance"), mood=mood)
            )
            choice.setCheckable(True)
            choice.setChecked(kept.mood == mood)
        menu.addSeparator()
        menu.addAction(tr("Intensity…"), self.set_intensity)

    def set_intensity(self) -> None:
        kept = self.performance.requests.kept
        if kept is not None:
            now = 1.0 if kept.intensity is None else kept.intensity
            words = tr("How large gestures play; 1 is as in the clips")
            value, ok = QInputDialog.getDouble(self, tr("Intensity"), words, now, 0.0, 2.0, 2)
            if ok:
                self._change(tr("Change the intensity of a performance"), intensity=value)

    def _keep(self, text: str, performance: KeptPerformance) -> None:
        made = ""

        def edit(project: Project) -> Project:
            nonlocal made
            project, made = performance_edits.add_performance(project, performance)
            return project

        self.document.edit(text, edit)
        self.session.onstage.set_performance(made)
        self.session.transport.show_plan()

    def new(self) -> None:
        self._keep(
            tr("New performance"),
            KeptPerformance(name=str(tr("Performance")), mode=self.session.onstage.improvised),
        )

    def duplicate(self) -> None:
        if self.performance.requests.kept is not None:
            self._keep(tr("Duplicate performance"), self.performance.requests.kept)

    def rename(self) -> None:
        kept = self.performance.requests.kept
        if kept is not None:
            name, ok = QInputDialog.getText(self, tr("Rename performance"), tr("Name"), text=kept.name)
            if ok and name.strip():
                self._change(tr("Rename performance"), name=name)

    def set_length(self) -> None:
        kept = self.performance.requests.kept
        if kept is not None:
            seconds, ok = QInputDialog.getDouble(
                self, tr("Length of the performance"), tr("Seconds"), kept.length, 0.1, 36000, 1
            )
            if ok:
                self._change(tr("Change length"), length=round(seconds, 3))

    def _own_seed(self) -> None:
        kept = self.performance.requests.kept
        if kept is not None:
            self._change(
                tr("Change seed"), seed=self.document.project.settings.seed if kept.seed is None else None
            )

    def remove(self) -> None:
        kept, ident = self.performance.requests.kept, self.session.onstage.performance
        if kept is None or ident is None:
            return
        if kept.asks:
            question = tr(
                "Remove '{name}' and its {requests}? You can undo this.",
                name=kept.name,
                requests=tr_plural("{count:,} request", "{count:,} requests", len(kept.asks)),
            )
            if (
                QMessageBox.question(self, tr("Remove performance"), question)
                != QMessageBox.StandardButton.Yes
            ):
                return
        self.document.edit(tr("Remove performance"), lambda p: performance_edits.remove_performance(p, ident))

    def _change(self, text: str, **changes: object) -> None:
        ident = self.session.onstage.performance
        if ident is not None:
            try:
                self.document.edit(
                    text, lambda p: performance_edits.change_performance(p, ident, **changes), merge=text
                )
            except EditError as error:
                self.document.failed.emit(tr_error(error))

    # --- live

    def toggle_live(self) -> None:
        if self.performance.live.stage is None:
            self.performance.live.begin()
        else:
            self.performance.live.end()
        self._live()

    def _live(self) -> None:
        on = self.performance.live.stage is not None
        self.live.setChecked(on)
        self.live.setText(f"● {tr('Live')}" if on else tr("Live"))
        self.stage.setEnabled(not on)
        self.more.setEnabled(not on)
        self.seed.setEnabled(not on)
        (self._spoken.start if on else self._spoken.stop)()
        self._moved()
        self._words()

    def _moved(self) -> None:
        here = self.performance.live.following and self.session.transport.playing
        self.now.setVisible(self.performance.live.stage is not None and not here)

    # --- asking, seed

    def _ask(self) -> None:
        make_request_menu(self, self.performance, None).exec(
            self.ask.mapToGlobal(self.ask.rect().bottomLeft())
        )

    def _seeded(self, value: float) -> None:
        seed = int(value)
        kept, talk = self.performance.requests.kept, self.performance.conversation
        if talk is not None:
            if seed != self.document.project.conversations[talk].seed:
                self.document.edit(
                    tr("Change seed"), lambda p: change_conversation(p, talk, seed=seed), merge="seed"
                )
        elif kept is not None and kept.seed is not None:
            if seed != kept.seed:
                self._change(tr("Change seed"), seed=seed)
        elif seed != self.document.project.settings.seed:
            self.document.edit(tr("Change seed"), lambda p: edits.set_settings(p, seed=seed), merge="seed")

    def _show_seed(self) -> None:
        kept, talk = self.performance.requests.kept, self.performance.conversation
        seed = (
            kept.seed if kept is not None and kept.seed is not None else self.document.project.settings.seed
        )
        if talk is not None:
            seed = self.document.project.conversations[talk].seed
        if self.seed.value() != seed:
            self.seed.blockSignals(True)
            self.seed.setValue(seed)
            self.seed.blockSignals(False)

    def show_lost(self) -> None:
        """Select the first request that does not play, or the one after the selected."""
        lost = [m.ask.id for m in sorted(self.lanes.marks(), key=lambda m: m.at) if m.lost]
        chosen = self.session.onstage.requests
        if lost:
            place = lost.index(chosen[0]) + 1 if chosen and chosen[0] in lost else 0
            self.lanes.reveal(lost[place % len(lost)])

    def _words(self) -> None:
        """Say what is selected, what plays live, or what is seen."""
        shown, plan = self.performance.shown, self.session.transport.show == "plan"
        answers = self.performance.answers() if plan else {}
        lost = sum(1 for a in answers.values() if a.state == "refused")
        self.lost.setVisible(lost > 0)
        self.lost.setText(tr("⚠ {lost:,} not met", lost=lost))
        self.lost.setAccessibleName(
            tr(
                "{requests} cannot be met",
                requests=tr_plural("{count:,} request", "{count:,} requests", lost),
            )
        )
        chosen = self.session.onstage.requests if plan else ()
        marks = [m for m in self.lanes.marks() if m.ask.id in chosen] if chosen else []
        if marks:
            self.title.say(describe_marks(marks), True)
        elif self.performance.live.stage is not None and plan:
            self.title.say(self.performance.live.stage.words())
        elif shown.clip is not None:
            self.title.say(
                tr(
                    "Only this clip plays. Click it again to play it in context, press Esc for the "
                    "performance."
                )
            )
        elif self.session.onstage.mode == "manual":
            self.title.say(describe_machine(shown, self.session))
        elif shown.others and plan:
            talk = self.document.project.conversations.get(self.session.onstage.conversation or "")
            self.title.say(describe_talk(shown, talk))
        elif self.session.transport.show == "context":
            self.title.say(
                tr("In context: stance, action, back to the stance. Press Esc for the performance.")
            )
        else:
            count = count_cues(shown)
            words = tr(
                "{actions} in {length:g} s",
                actions=tr_plural("{count:,} action", "{count:,} actions", count),
                length=shown.length,
            )
            empty = tr("Nothing plays yet")  # the lanes say what is missing
            self.title.say(
                (words if count else empty)
                + (
                    tr(
                        ", {requests} cannot be met",
                        requests=tr_plural("{count:,} request", "{count:,} requests", lost),
                    )
                    if lost
                    else ""
                )
            )
