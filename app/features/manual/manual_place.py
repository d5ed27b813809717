"""Where the editor is in the window, and which of the window's commands are its own while it is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QStackedWidget

from app.project.load import Load
from metagraph.graph.manual import Manual
from metagraph.graph.model import LAYERS, Project

if TYPE_CHECKING:
    from app.features.manual.manual_editor import ManualEditor
    from app.shell.window import Window

# Commands of the meta-graph, which must not change it unseen.
META_ONLY = frozenset((
    "annotate", "render", "twins", "new_stance", "propose", "use_times", "patterns", "live", "mimic", "machine", "compatibility",
    "replace_clip", *(f"label_{kind}" for kind in ("stance", "gesture", "fidget", "transition")), *(f"stance_{n}" for n in range(1, 10)),
))  # fmt: skip


class Place:
    """Shows the editor in the meta-graph's place while the session's mode is manual, and its inspector in the dock of properties.

    It is made when it is first wanted, so that nobody waits for it at the start.
    """

    def __init__(self, window: Window) -> None:
        self.window = window
        self.editor: ManualEditor | None = None
        self.session = window.session
        self.session.mode_changed.connect(self.show)

    def show(self) -> None:
        """Show what the mode says."""
        w, manual = self.window, self.session.mode == "manual"
        if manual and self.editor is None:
            self._make()
        if self.editor is None:
            return
        w.canvas.setVisible(not manual)
        self.editor.setVisible(manual)
        w.header.machine_button.setEnabled(not manual)
        if w.ready:
            w.machine.setVisible(not manual and w._machine_wanted)
            self.stack().setCurrentWidget(self.editor.inspector if manual else w.properties)
        w.refresh()
        if manual:
            self.editor.canvas.setFocus()

    def stack(self) -> QStackedWidget:
        """Return what the dock of properties holds: the panel of actions, and the inspector."""
        assert self.editor is not None
        dock = self.window.docks["properties"]
        found = dock.widget()
        if not isinstance(found, QStackedWidget):
            stack = QStackedWidget(dock)
            dock.setWidget(stack)
            stack.addWidget(found)
            stack.addWidget(self.editor.inspector)
            found = stack
        return found

    def _make(self) -> None:
        from app.features.manual.manual_canvas import ManualCanvas
        from app.features.manual.manual_editor import ManualEditor

        w = self.window
        if not w.ready:
            w.make_late_panels()
        canvas = ManualCanvas(w.document, self.session, w.performance, w.thumbnails, w)
        canvas.refused.connect(w.tell)
        canvas.files_dropped.connect(lambda paths, at: w.files.import_paths(list(paths), at))
        self.editor = ManualEditor(canvas, w)
        w.centre.insertWidget(1, self.editor)
        self.editor.show_problems(w.problems)

    def opened(self, project: Project) -> None:
        """Show what a project that was opened is made of; one with nothing in it leaves the mode as it is."""
        drawn = [layer for layer in LAYERS if project.manual.get(layer, Manual(layer)).states]
        if any(True for _ in project.actions()):
            self.session.set_mode("meta")
        elif drawn:
            self.session.set_mode("manual")
            if self.session.layer not in drawn:
                self.session.set_layer(drawn[0])

    def imported(self, load: Load, at: QPointF) -> None:
        """Place clips of files that were dropped on the editor."""
        if self.editor is not None and load.clips:
            self.editor.canvas.place(load.clips, at)

    def takes(self, command: str) -> bool:
        """Let the editor do one of the window's commands, "remove", "copy", "paste" or "select_all"; return whether it was its own.

        What is selected in the library stays the window's to remove.
        """
        if self.session.mode != "manual" or self.editor is None or (command == "remove" and self.session.clips):
            return False
        from app.features.manual import manual_commands as commands

        getattr(commands, command)(self.editor.canvas)
        return True
