"""Writes down what is done in the window: edits, looks, dialogs, errors, and operators by their class
alone.
"""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, Any, Protocol

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QDialog

from app.features.study.operator_events import Hands
from app.features.study.screen_areas import list_screen_areas
from app.features.study.study_changes import describe_change
from app.project.importing import Importing
from app.stage.problem_watch import ProblemWatch
from app.translation import get_english
from metagraph.errors import FileError
from metagraph.formats.imports import Imported
from metagraph.formats.project.journal import find_changes
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from app.shell.context import Shell

IDLE = 10.0  # seconds without input that are reported
MOST = 50  # ids of what is selected that are reported
MERGING = 300  # milliseconds after which a run of merged edits, as a drag makes them, is taken to be over


class SittingLog(Protocol):
    def add(self, kind: str, **fields: Any) -> Any: ...


class Recorder(QObject):
    """Follows a window from its making until `stop`. What the log cannot take is shown to the user once."""

    def __init__(self, shell: Shell, log: SittingLog) -> None:
        super().__init__(shell.widget)
        self.shell, self.log = shell, log
        self._failed = False
        self._warned = self._grave()
        d, s = shell.document, shell.stage.session
        self._stack = d.undo_stack
        self._undone: object = None  # what a redo would do again
        self._edit: dict[str, Any] | None = None  # one that may still be merged with the next
        self._told = d.project  # as the events so far say it is
        self._areas: dict[str, list[int]] = {}
        self._importing = 0.0  # when the import began that comes next
        self._input_at = monotonic()
        self._sought = self._scroll = 0.0
        self._shown: set[int] = set()
        self._merging = QTimer(self, singleShot=True, interval=MERGING)
        self._merging.timeout.connect(self._tell_edit)
        self._second = QTimer(self, interval=1000)
        self._second.timeout.connect(self._tick)
        self._links = [
            (d.loaded, self._loaded),
            (d.saved, self._saved),
            (d.failed, self._document_failed),
            (self._stack.indexChanged, self._moved),
            (s.place.layer_changed, lambda: self._view("layer", layer=s.place.layer)),
            (s.place.stance_changed, self._stance),
            (s.selection.changed, self._selected),
            (s.look.changed, lambda: self._view("theme", theme=s.look.name)),
            (s.onstage.mode_changed, self._other_editor),
            (s.transport.show_changed, self._shows_else),
            (s.transport.playing_changed, self._plays),
            (s.transport.moved, self._seek),
            (shell.stage.refused, self._refused),
            (shell.stage.scrolled, self._scrolled),
            (shell.services[Importing].begun, self._import_begins),
            (shell.services[Importing].imported, self._imported),
        ]
        for signal, slot in self._links:
            signal.connect(slot)
        self.hands = Hands(self._input, self._dialog, self._scrolled, self)
        self._position()
        self._second.start()

    def stop(self) -> None:
        """Report what is left, and follow no more."""
        self._tell_edit()
        self._tell_operators()
        self._second.stop()
        self.hands.stop()
        for signal, slot in self._links:
            signal.disconnect(slot)
        self._links = []

    def tell(self, kind: str, **fields: Any) -> None:
        """Write an event, after what came before it."""
        self._tell_edit()
        self._write(kind, fields)

    def boundary(self) -> None:
        """Report what is still held back: a phase begins or ends."""
        self._tell_edit()
        self._tell_operators()

    def _write(self, kind: str, fields: dict[str, Any]) -> None:
        try:
            self.log.add(kind, **fields)
            self._failed = False
        except FileError as error:
            if not self._failed:
                self._failed = True
                self.shell.tell(str(error))

    # --- edits

    def _position(self) -> None:
        stack = self._stack
        self._index, self._count = stack.index(), stack.count()
        self._undone = stack.command(self._index) if self._index < self._count else None

    def _moved(self, index: int) -> None:
        """Report an edit, an undo or a redo from how the stack of steps has moved."""
        stack = self._stack
        last, count = self._index, stack.count()
        if index > last and self._undone is not None and stack.command(last) is self._undone:
            self._back_or_again("redo", stack.command(index - 1))
        elif index < last:
            if count == self._count:
                self._back_or_again("undo", stack.command(index))
            else:  # a drag that was cancelled leaves no step
                self._edit = None
                self._merging.stop()
        elif index > 0 and (index > last or count != self._count or self._edit is not None):
            self._edit_made(index)
        self._position()

    def _back_or_again(self, kind: str, command: Any) -> None:
        self._tell_edit()
        self._tell_operators()
        self._write(kind, {"words": command.english, **self._change(self.shell.document.project)})

    def _change(self, now: Project) -> dict[str, Any]:
        """Return what makes the project that was reported last what it is now, so that the work can be seen
        again.
        """
        before, self._told = self._told, now
        found = find_changes(before, now)
        return {"change": found} if found else {}

    def _edit_made(self, index: int) -> None:
        command: Any = self._stack.command(index - 1)
        if self._edit is not None and self._edit["command"] is not command:
            self._tell_edit()
        if self._edit is None:
            self._edit = {"command": command}
        if command.merge is None:
            self._tell_edit()
        else:
            self._merging.start()

    def _tell_edit(self) -> None:
        """Write the last edit, unless that is done; before it the operators it took."""
        self._merging.stop()
        if self._edit is None:
            return
        command, self._edit = self._edit["command"], None
        self._tell_operators()
        about = describe_change(command.before, command.after)
        self._write("edit", {**about, "words": command.english, **self._change(command.after)})

    def _loaded(self) -> None:
        self._edit = None
        self._told = self.shell.document.project
        self._position()

    # --- what is looked at

    def _other_editor(self) -> None:
        self._view("panel", mode=self.shell.stage.session.onstage.mode)

    def _view(self, what: str, **more: Any) -> None:
        self.tell("view", what=what, **more)

    def _stance(self) -> None:
        place = self.shell.stage.session.place
        self._view("stance", **{k: v for k, v in (("stance", place.stance()), ("other", place.other())) if v})

    def _selected(self) -> None:
        found = self.shell.stage.session.selection
        parts = {k: list(getattr(found, k)[:MOST]) for k in ("clips", "actions", "states", "links")}
        self._view("select", **{f"selected_{k}": ids for k, ids in parts.items() if ids})

    def _playback(self, what: str) -> None:
        transport = self.shell.stage.session.transport
        shown = {"shown": transport.shown} if transport.shown is not None else {}
        self.tell("playback", what=what, at=round(transport.seconds, 3), **shown)

    def _plays(self) -> None:
        self._playback("play" if self.shell.stage.session.transport.playing else "pause")

    def _shows_else(self) -> None:
        self._playback(self.shell.stage.session.transport.show)

    def _seek(self, seconds: float) -> None:
        now = monotonic()
        if not self.shell.stage.session.transport.playing and now - self._sought > 1.0:
            self._sought = now
            self._playback("seek")

    def _scrolled(self) -> None:
        now = monotonic()
        if now - self._scroll > 1.0:
            self._scroll = now
            self._view("scroll")

    def _dialog(self, dialog: QDialog, shown: bool) -> None:
        if shown is (id(dialog) in self._shown):
            return
        name = type(dialog).__name__
        if shown:
            self._shown.add(id(dialog))
            self.tell("dialog", name=name, state="open")
        else:
            self._shown.discard(id(dialog))
            self.tell("dialog", name=name, state="close", result=dialog.result())

    # --- the rest

    def _refused(self, words: str) -> None:
        self.tell("error", what="refused", words=get_english(words))

    def _document_failed(self, words: str) -> None:
        self.tell("error", what="failed", words=get_english(words))

    def _saved(self) -> None:
        path = self.shell.document.path
        self.tell("save", path=path.name if path is not None else "")

    def _import_begins(self) -> None:
        self._importing = monotonic()

    def _imported(self, result: Imported, drop: object) -> None:
        self.tell("import", clips=len(result.loaded), seconds=round(monotonic() - self._importing, 3))

    def _input(self, now: float) -> None:
        if now - self._input_at > IDLE:
            self.tell("idle", seconds=round(now - self._input_at, 3))
        self._input_at = now

    def _tick(self) -> None:
        areas = list_screen_areas(self.shell)
        if areas != self._areas:
            self._areas = areas
            self._view("layout", areas=areas)
        if self._edit is None:
            self._tell_operators()
        for words in self._grave() - self._warned:
            self.tell("error", what="warning", words=get_english(words))
        self._warned = self._grave()

    def _grave(self) -> frozenset[str]:
        return frozenset(
            p.message for p in self.shell.services[ProblemWatch].problems if p.severity != "hint"
        )

    def _tell_operators(self) -> None:
        found = self.hands.operators.take(monotonic())
        if not found.operators:
            return
        fields: dict[str, Any] = {name: found.operators[name] for name in "KPBDH"} | {
            "seconds": round(found.seconds, 3)
        }
        if found.drag_s:
            fields["drag_s"] = round(found.drag_s, 3)
        self._write("ops", fields)
