"""The panel of the timing editor: what it is about and what can be done with it on top, the rows below."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.timing_editor.kept_rows import find_kept_seconds, set_number
from app.features.timing_editor.subject import Subject
from app.features.timing_editor.view import TimingView
from app.look.names import describe_name_in_tooltip
from app.look.theme import KIND_MARKS, get_theme
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_plural
from app.widgets.form_fields import QuietChooser, Seconds, find_common_value
from app.widgets.making import make_widget
from app.widgets.more_button import MoreButton
from app.widgets.one_stop import OneStop
from app.widgets.restyling import set_sheet
from app.widgets.sentence import Sentence
from metagraph.graph.edit_error import EditError
from metagraph.motion.retime import SPEEDS
from metagraph.playback.timing.speed_curves import list_offered_joints

LONGEST = 30  # letters of an action's name before it is cut in its middle


class TimingPanel(QWidget):
    """Every control changes the project by one edit, or only what is shown."""

    def __init__(self, document: Document, session: StageSession, subject: Subject, parent: QWidget) -> None:
        super().__init__(parent)
        self.document, self.session, self.subject = document, session, subject
        self.name = QLabel(self)
        self.verdict = Sentence(self)
        self.use = make_widget(
            QPushButton,
            tr("Use proposed"),
            self,
            toolTip=tr("Start and end the action where its blends show no jump"),
        )
        self.use.clicked.connect(self._use)
        self.joint = QuietChooser(self, toolTip=tr("Which joint's speed the graph shows"))
        self.joint.setMinimumContentsLength(8)
        self.joint.activated.connect(lambda n: subject.show(joint=self.joint.itemData(n)))
        tip = tr(
            "Playback speed of the clip; 1 is the speed in the file. Every action that uses the "
            "clip changes too. The file is not changed."
        )
        self.speed = Seconds(self, tip, SPEEDS[1], " ×", 0.05)
        self.speed.valueChanged.connect(self._pace)
        self.hold = self._button(
            tr("Hold"), tr("Insert a hold at the playhead: the clip keeps that pose for a while")
        )
        self.hold.clicked.connect(lambda: self._try(subject.hold_here))
        self.onion = self._button(tr("Onion"), tr("Show ghosts of the start, stroke and end poses"), True)
        self.onion.clicked.connect(lambda on: subject.show(onion=on))
        self.compare = self._button(
            tr("A/B"),
            tr(
                'Show it as it was when you selected it, or chose "Compare from now on" in the menu (A shows '
                "it as it is again)"
            ),
            True,
        )
        self.compare.clicked.connect(subject.compare)
        self.compare.setText(tr("A: before"))  # nothing moves when it says so
        self.compare.setMinimumWidth(self.compare.sizeHint().width())
        self.compare.setText(tr("A/B"))
        self.loop = self._button(tr("Loop"), tr("Play only this action, in a loop"), True)
        self.loop.clicked.connect(subject.loop_action)
        self.more = MoreButton(session.look, tr("Display options"), tr("Display options"), self)
        self.menu = self.more.menu_of
        self.menu.aboutToShow.connect(self._fill)
        OneStop((self.hold, self.onion, self.compare, self.loop, self.more), self)
        self.view = TimingView(document, session, subject, self)
        self.view.typed.connect(self._type)
        self.area = QScrollArea(self)
        self.area.setWidgetResizable(True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.area.setWidget(self.view)
        self.number = Seconds(self.view, tr("New time of the handle"))
        self.number.hide()
        self.number.valueChanged.connect(self._typed)
        self.number.editingFinished.connect(self._done)
        self._typing: tuple[str, str] = ("", "")
        self._row = QHBoxLayout()
        self._row.setContentsMargins(10, 4, 8, 2)
        self._row.setSpacing(4)
        self._row.addWidget(self.name)
        self._row.addWidget(self.verdict, 1)
        for widget in (
            self.use, self.joint, self.speed, self.hold, self.onion, self.compare, self.loop, self.more,
        ):  # fmt: skip
            self._row.addWidget(widget)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(0)
        box.addLayout(self._row)
        box.addWidget(self.area, 1)
        subject.changed.connect(self.refresh)
        session.look.changed.connect(self.refresh)
        session.transport.part_changed.connect(self.refresh)
        self.refresh()
        self.view.refresh()

    def _button(self, text: str, tip: str, checkable: bool = False) -> QToolButton:
        out = make_widget(QToolButton, self, text=text, toolTip=tip, checkable=checkable)
        out.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the space bar still plays
        out.setProperty("tight", True)  # the verdict beside needs the room
        out.setAccessibleName(f"{text}: {tip}" if text else tip)
        return out

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.number.hide()

    # --- showing

    def refresh(self) -> None:
        """Show what the subject is now."""
        shown, t = self.subject.facts(), get_theme(self.session.look.name)
        first = next(iter(shown.values()), None)
        for widget in (self.use, self.joint, self.speed, self.hold, self.onion, self.compare, self.loop):
            widget.setEnabled(first is not None)
        joints = list_offered_joints(self.document.project)
        offered = [
            (tr("Moving parts"), ""),
            *((tr(words) if words != name else name, name) for name, words in joints),
        ]
        self.joint.show_entries(offered, self.subject.shows.joint)
        self.speed.show_value(
            find_common_value([f.entry.retime.speed for f in shown.values()]) if shown else 1.0
        )
        if first is None:
            self._done()
            self.name.setText("")
            self.verdict.say("")
            self.name.setToolTip("")
            set_sheet(self.name, "")
            set_sheet(self.verdict, "")
            self.use.setVisible(False)
            for button in (self.onion, self.compare, self.loop):
                button.setChecked(False)
            return
        name = (
            first.name if len(shown) == 1 else tr_plural("{count:,} action", "{count:,} actions", len(shown))
        )
        cut = name if len(name) <= LONGEST else f"{name[: LONGEST // 2]}…{name[-LONGEST // 2 + 1 :]}"
        self.name.setText(f"{KIND_MARKS[first.action.kind]} {cut}")
        self.name.setToolTip(describe_name_in_tooltip(name, first.action.name) if len(shown) == 1 else name)
        set_sheet(self.name, f"color: {t.kinds[first.action.kind]}")
        worse = next((f for f in shown.values() if not f.fine), first)
        words = worse.verdict if len(shown) == 1 or worse.fine else f"{worse.name}: {worse.verdict}"
        self.verdict.say(words, strong=not worse.fine)
        set_sheet(self.verdict, "" if worse.fine else f"color: {t.warning}")
        self.use.setVisible(first.seen is not None)
        self.onion.setChecked(self.subject.shows.onion)
        self.compare.setChecked(self.subject.before is not None)
        self.compare.setText(tr("A/B") if self.subject.before is None else tr("A: before"))
        part = self.session.transport.part
        self.loop.setChecked(part is not None and part[0] == first.action.clip)

    def _fill(self) -> None:
        """Offer what is shown, and which line is heard."""
        menu, subject = self.menu, self.subject
        menu.clear()
        for words, field in (
            (tr("Poses"), "poses"),
            (tr("Line"), "line"),
            (tr("Activity of body parts"), "dope"),
            (tr("Activity of each joint"), "whole"),
        ):
            action = menu.addAction(words)
            action.setCheckable(True)
            action.setChecked(getattr(subject.shows, field))
            action.setEnabled(field != "whole" or subject.shows.dope)
            action.triggered.connect(lambda on, f=field: subject.show(**{f: on}))
        lines = menu.addMenu(tr("Spoken line"))
        for words, ident in (
            (tr("The line from the performance"), ""),
            *((line.text or i, i) for i, line in list(self.document.project.lines.items())[:30]),
        ):
            action = lines.addAction(words[:60])
            action.setCheckable(True)
            action.setChecked(subject.shows.heard == ident)
            action.triggered.connect(lambda _, i=ident: subject.show(heard=i))
        menu.addSeparator()
        for side, words in (
            ("left", tr("Pin the left hand here")),
            ("right", tr("Pin the right hand here")),
        ):
            action = menu.addAction(words)
            action.setToolTip(
                tr(
                    "Keeps the hand in place during the loop range, or from the playhead to the end of the "
                    "hold"
                )
            )
            action.triggered.connect(lambda _, s=side: self._try(lambda: subject.keep_hand(s)))
        first = next(iter(subject.facts().values()), None)
        action = menu.addAction(tr("Release the hands"))
        action.setEnabled(first is not None and bool(first.kept))
        action.triggered.connect(lambda _: self._try(subject.let_go))
        menu.addSeparator()
        menu.addAction(tr("Compare from now on"), subject.mark)
        menu.addAction(tr("Zoom to the whole clip"), self.view.show_all)

    # --- editing

    def _use(self) -> None:
        self.subject.compatibility.use_proposed(self.subject.idents)

    def _pace(self, speed: float) -> None:
        if speed >= SPEEDS[0]:
            self._try(lambda: self.subject.set_speed(speed))
        self.refresh()

    def _try(self, edit: Callable[[], object]) -> None:
        try:
            edit()
        except EditError as error:
            self.document.failed.emit(tr_error(error))

    def _type(self, ident: str, handle: str, box: QRectF) -> None:
        """Let a number be typed where it stands."""
        facts = self.subject.facts().get(ident)
        found = facts.handle(handle) if facts is not None else None
        kept = find_kept_seconds(facts, handle) if facts is not None else None
        if found is None and kept is None:
            return
        self._typing = (ident, handle)
        self.number.show_value(found.number if found is not None else kept)
        wide = max(86, round(box.width()))
        left = min(max(0, round(box.center().x() - wide / 2)), self.view.width() - wide)
        self.number.setGeometry(left, round(box.top()) - 4, wide, 26)
        self.number.show()
        self.number.setFocus()
        self.number.selectAll()

    def _done(self) -> None:
        self._typing = ("", "")
        self.number.hide()

    def _typed(self, value: float) -> None:
        ident, handle = self._typing
        facts = self.subject.facts().get(ident)
        if facts is None or value < 0:
            return
        if find_kept_seconds(facts, handle) is not None:
            self._try(lambda: set_number(self.view, facts, handle, value))
            return
        start, end = facts.span
        at = {"in": start + value, "out": end - value}.get(handle, value)
        self.subject.set_number({ident: at}, handle)
