"""A note to write: on the selected action or clip, else on the project. It is kept in the project's file."""

from __future__ import annotations

from PySide6.QtGui import QFocusEvent
from PySide6.QtWidgets import QPlainTextEdit, QVBoxLayout, QWidget

from app.look.names import make_readable_name
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.sentence import OneLine
from metagraph.graph.editing.marks import mark, mark_of
from metagraph.graph.model import Project
from metagraph.graph.notes import PROJECT, set_note


class _Text(QPlainTextEdit):
    """left: called when the keyboard goes elsewhere."""

    def __init__(self, parent: NotesPanel) -> None:
        super().__init__(parent)
        self._panel = parent
        self.setAccessibleName(tr("Note"))
        self.setTabChangesFocus(True)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._panel.finish()


class NotesPanel(QWidget):
    """What is typed is one step of undo, until the keyboard or the selection goes elsewhere. about: the id of
    the action or the clip whose note is shown, or `PROJECT`.
    """

    def __init__(self, document: Document, session: StageSession, parent: QWidget | None = None) -> None:
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
        project, selection = self.document.project, self.session.selection
        chosen = selection.actions or selection.clips
        ident = chosen[0] if len(chosen) == 1 else PROJECT
        found = project.action(ident) or project.clips.get(ident)
        about = found.id if found is not None else PROJECT
        if about != self.about:
            self.finish()
            self.about = about
        self.title.say(
            tr("On {name}", name=make_readable_name(found.name))
            if found is not None
            else tr("On the project")
        )
        self.text.setPlaceholderText(
            tr("Write down what to do or know about this character.")
            if found is None
            else tr("Write down what to do or know about this clip.")
            if about in project.clips
            else tr("Write down what to do or know about this action.")
        )
        note = mark_of(project, about).note if about in project.clips else project.notes.get(about, "")
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

            def write(project: Project) -> Project:
                if about in project.clips:
                    return mark(project, (about,), note=words.rstrip())
                return set_note(project, about, words)

            self.document.edit(tr("Write a note"), write, merge=tr("note {about}", about=about))

    def _edited(self, before: Project, after: Project) -> None:
        same = before.notes is after.notes and before.graphs is after.graphs
        if not same or before.marks is not after.marks or before.clips is not after.clips:
            self.refresh()
