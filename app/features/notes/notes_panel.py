"""A note to write: on the selected action, else on the project. It is kept in the project's file."""

from __future__ import annotations

from PySide6.QtGui import QFocusEvent
from PySide6.QtWidgets import QPlainTextEdit, QVBoxLayout, QWidget

from app.look.names import plain
from app.project.document import Document
from app.stage.session import Session
from app.widgets.sentence import OneLine
from metagraph.graph.model import Project
from metagraph.graph.notes import PROJECT, set_note


class _Text(QPlainTextEdit):
    """left: called when the keyboard goes elsewhere."""

    def __init__(self, parent: NotesPanel) -> None:
        super().__init__(parent)
        self._panel = parent
        self.setAccessibleName("Note")
        self.setTabChangesFocus(True)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._panel.finish()


class NotesPanel(QWidget):
    """What is typed is one step of undo, until the keyboard or the selection goes elsewhere. about: the id of
    the action whose note is shown, or `PROJECT`.
    """

    def __init__(self, document: Document, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.about = PROJECT
        self._filling = False
        self.title = OneLine(self)
        self.title.setProperty("title", True)
        self.text = _Text(self)
        self.text.textChanged.connect(self._typed)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.addWidget(self.title)
        layout.addWidget(self.text, 1)
        document.changed.connect(self._edited)
        session.selection.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the note of what is selected now."""
        project, chosen = self.document.project, self.session.selection.actions
        action = project.action(chosen[0]) if len(chosen) == 1 else None
        about = action.id if action is not None else PROJECT
        if about != self.about:
            self.finish()
            self.about = about
        self.title.say(f"On {plain(action.name)}" if action is not None else "On the project")
        self.text.setPlaceholderText(
            "What is to be done, or to be known, about this action"
            if action is not None
            else "What is to be done, or to be known, about this character"
        )
        note = project.notes.get(about, "")
        if note != self.text.toPlainText().rstrip():
            self._filling = True
            self.text.setPlainText(note)
            self._filling = False

    def finish(self) -> None:
        """What was typed is a step."""
        self.document.finish_merging()

    def _typed(self) -> None:
        if not self._filling:
            words, about = self.text.toPlainText(), self.about
            self.document.edit("Write a note", lambda p: set_note(p, about, words), merge=f"note {about}")

    def _edited(self, before: Project, after: Project) -> None:
        if before.notes is not after.notes or before.graphs is not after.graphs:
            self.refresh()
