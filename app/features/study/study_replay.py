"""A sitting played again in the window from its log: every edit, look and pause, at any speed."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QToolBar, QWidget

from app.features.study.reserved_window import ReservedWindow
from app.features.study.study_screen import format_minutes
from app.project.files import Files
from app.project.opening import with_motion_of
from app.translation import format_number, tr, tr_error
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, Slider
from metagraph.errors import FileError
from metagraph.graph.model import LAYERS, Project
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.logs.replay import Again, SittingPart, list_sitting_parts, load_first_project
from metagraph.research.study.study_plan import CONDITION_TITLES, Study

if TYPE_CHECKING:
    from app.shell.context import Shell

SPEEDS = (0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0)
TICK = 50  # milliseconds


class ReplayBar(QToolBar):
    """Which part, where in it, how fast, and what happens."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(tr("Replay"), parent)
        self.setObjectName("replay")
        self.setMovable(False)
        inner = QWidget(self)
        row = QHBoxLayout(inner)
        row.setContentsMargins(6, 2, 6, 2)
        row.setSpacing(8)
        self.part = ComboBox(inner)
        self.part.setAccessibleName(tr("Part of the sitting"))
        self.play = make_widget(QPushButton, inner, text=tr("Play"), checkable=True)
        self.speed = ComboBox(inner)
        self.speed.setAccessibleName(tr("Speed"))
        for value in SPEEDS:
            self.speed.addItem(f"{format_number(value, 'g')} ×", value)
        self.slider = Slider(Qt.Orientation.Horizontal, inner)
        self.slider.setAccessibleName(tr("Moment"))
        self.slider.setMinimumWidth(160)
        self.time = QLabel(inner)
        self.time.setMinimumWidth(110)
        self.told = QLabel(inner)
        self.told.setMinimumWidth(260)
        self.leave = QPushButton(tr("Close"), inner)
        for widget in (self.part, self.play, self.speed):
            row.addWidget(widget)
        row.addWidget(self.slider, 2)
        row.addWidget(self.time)
        row.addWidget(self.told, 3)
        row.addWidget(self.leave)
        self.addWidget(inner)

    def set_speed(self, speed: float) -> None:
        """Choose a speed, times as fast as it was; one of another size is added."""
        if self.speed.findData(speed) < 0:
            self.speed.addItem(f"{format_number(speed, 'g')} ×", speed)
        self.speed.setCurrentIndex(self.speed.findData(speed))


class Replayer(QObject):
    """ready: a part is loaded. over: the window is as before. Raises FileError if there is nothing to see."""

    ready = Signal()
    over = Signal()

    def __init__(self, shell: Shell, study: Study, participant: str) -> None:
        super().__init__(shell.widget)
        self.shell, self.study, self.participant = shell, study, participant
        study.plan.known(participant)
        self.parts = list_sitting_parts(study, read_log(study.log(participant)).events)
        if not self.parts:
            raise FileError(
                study.log(participant),
                tr("it contains no work"),
                participant,
                tr("Choose another sitting."),
            )
        self.part: SittingPart = self.parts[0]
        self.again: Again | None = None
        self.at = 0.0
        self._left = False
        self.bar = ReplayBar(shell.widget)
        self.reserved = ReservedWindow(shell, self.bar, False)
        for part in self.parts:
            title = CONDITION_TITLES.get(part.condition, part.condition)
            self.bar.part.addItem(f"{part.title}: {title} ({format_minutes(part.seconds)})")
        self._timer = QTimer(self, interval=TICK)
        self._timer.timeout.connect(self._tick)
        self._last = monotonic()
        self.bar.part.currentIndexChanged.connect(self.choose)
        self.bar.play.toggled.connect(self.set_playing)
        self.bar.slider.valueChanged.connect(self._slid)
        self.bar.leave.clicked.connect(self.leave)
        shell.stage.session.transport.set_playing(False)
        self.reserved.enter()
        shell.widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Close:
            self.leave()
        return False

    def choose(self, number: int) -> None:
        """Load a part, on a thread; it stands at its begin then."""
        self.bar.play.setChecked(False)
        self.part, self.again = self.parts[number], None
        part = self.part
        self.bar.told.setText(tr("Loading the clips…"))
        self.shell.jobs.start(
            tr("Loading the clips"),
            lambda job: load_first_project(self.study, part),
            lambda project: self._loaded(part, project),
            lambda error: self.bar.told.setText(tr_error(error)),
        )

    def _loaded(self, part: SittingPart, first: Project) -> None:
        if self._left or part is not self.part:
            return
        self.again = Again(first, self.study.data(self.participant))
        self.bar.slider.setRange(0, max(1, round(part.seconds * 10)))
        self._show_first()
        if part.silent:
            self.bar.told.setText(
                tr("{silent} edits in this log do not record what they changed", silent=part.silent)
            )
        self.ready.emit()

    def _show_first(self) -> None:
        assert self.again is not None
        self.again.rewind()
        self.at = 0.0
        self.shell.document.load(self.again.first, None)
        self.shell.stage.session.set_mode("manual" if self.part.condition == "manual" else "meta")
        self.shell.services[Files].opened.emit()
        self._tell()

    # --- time

    def set_playing(self, on: bool) -> None:
        """Go on from here, or stand still."""
        self.bar.play.setChecked(on)
        self.bar.play.setText(tr("Pause") if on else tr("Play"))
        self._last = monotonic()
        if on and self.again is not None and self.at >= self.part.seconds:
            self._show_first()
        (self._timer.start if on else self._timer.stop)()

    def _tick(self) -> None:
        now = monotonic()
        passed, self._last = now - self._last, now
        self.advance(passed * float(self.bar.speed.currentData()))
        if self.at >= self.part.seconds:
            self.set_playing(False)

    def _slid(self, value: int) -> None:
        if abs(value / 10 - self.at) > 0.11:
            self.seek(value / 10)

    def advance(self, seconds: float) -> None:
        """Go on by seconds of the sitting."""
        if self.again is not None:
            self.seek(self.at + seconds)

    def seek(self, seconds: float) -> None:
        """Show a moment of the part; seconds from its begin."""
        if self.again is None:
            return
        seconds = min(max(0.0, seconds), self.part.seconds)
        if seconds < self.at:
            self._show_first()
        until, changed, words = self.part.until(seconds), False, ""
        for event in self.part.events[self.again.done : until]:
            changed = self.again.step(event) or changed
            words = str(event.get("words") or "") or words
            if event["type"] in ("view", "playback"):
                if changed:
                    self._edit(words)
                    changed = False
                self._look(event)
        if changed:
            self._edit(words)
        self.at = seconds
        self._tell()

    def _edit(self, words: str) -> None:
        assert self.again is not None
        try:
            project = with_motion_of(self.again.project(), self.again.first)
        except ValueError as error:
            self.bar.told.setText(tr_error(error))
            return
        self.shell.document.edit(words or tr("Replay"), lambda _: project)

    # --- what was looked at

    def _look(self, event: dict[str, Any]) -> None:
        session, what = self.shell.stage.session, event.get("what")
        if event["type"] == "playback":
            transport, shown = session.transport, event.get("shown")
            if what in ("play", "pause"):
                transport.set_playing(what == "play")
            elif what == "plan":
                transport.show_plan()
            elif what in ("clip", "context") and self._there(shown):
                (transport.show_clip if what == "clip" else transport.show_context)(str(shown))
            if isinstance(event.get("at"), int | float) and what in ("seek", "pause"):
                transport.seek(float(event["at"]))
        elif what == "layer" and event.get("layer") in LAYERS:
            session.place.set_layer(event["layer"])
        elif what == "stance" and isinstance(event.get("stance"), str):
            session.place.set_stance(event["stance"])
        elif what == "select":
            self._select(event)

    def _there(self, ident: object) -> bool:
        project = self.shell.document.project
        return isinstance(ident, str) and (
            ident in project.clips
            or any(find(ident) is not None for find in (project.action, project.state, project.link))
        )

    def _select(self, event: dict[str, Any]) -> None:
        selection, project = self.shell.stage.session.selection, self.shell.document.project
        found = {
            k: tuple(i for i in event.get(f"selected_{k}", ()) if isinstance(i, str))
            for k in ("clips", "actions", "states", "links")
        }
        if found["clips"]:
            selection.select_clips(tuple(i for i in found["clips"] if i in project.clips))
        elif found["actions"]:
            selection.select_actions(tuple(i for i in found["actions"] if project.action(i) is not None))
        else:
            selection.select_states(
                tuple(i for i in found["states"] if project.state(i) is not None),
                tuple(i for i in found["links"] if project.link(i) is not None),
            )

    def _tell(self) -> None:
        """Show where it stands, and what happened last."""
        self.bar.time.setText(
            tr("{at} of {whole}", at=format_minutes(self.at), whole=format_minutes(self.part.seconds))
        )
        if not self.bar.slider.isSliderDown():
            self.bar.slider.setValue(round(self.at * 10))
        done = self.part.events[: self.part.until(self.at)]
        last = next((said for e in reversed(done[-200:]) if (said := _said(e))), "")
        self.bar.told.setText(last)

    def leave(self) -> None:
        """Give the window back, with nothing in it."""
        if self._left:
            return
        self._left = True
        self._timer.stop()
        self.shell.widget.removeEventFilter(self)
        self.shell.document.undo_stack.setClean()
        self.reserved.leave()
        self.shell.document.load(Project(), None)
        self.shell.services[Files].opened.emit()
        self.over.emit()


def _said(event: dict[str, Any]) -> str:
    """Return an event in words; nothing of those that are not worth any."""
    kind = event["type"]
    if kind == "pause":
        return tr("Paused") if event.get("state") == "begin" else tr("Resumes")
    if kind == "idle":
        return tr("No activity for {seconds:.0f} s", seconds=event.get("seconds", 0))
    if kind in ("undo", "redo"):
        return f"{tr('Undo') if kind == 'undo' else tr('Redo')}: {event.get('words', '')}"
    if kind in ("edit", "error", "note"):
        return str(event.get("words", ""))
    if kind in ("view", "playback"):
        return f"{tr('Looks') if kind == 'view' else tr('Preview')}: {event.get('what', '')}"
    return ""
