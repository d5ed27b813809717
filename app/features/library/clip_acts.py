"""What can be done with clips: a menu, and what its entries do."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QInputDialog, QMenu, QWidget

from app.project.document import Document
from app.stage.session import Session
from metagraph.graph import edits
from metagraph.graph.model import ClipEntry


class ClipActs:
    """widget: over which menus and questions appear. row_actions: the window's commands that go into a clip's
    menu.
    """

    def __init__(self, document: Document, session: Session, widget: QWidget) -> None:
        self.document, self.session, self.widget = document, session, widget
        self.row_actions: list[QAction] = []

    def menu(self, entry: ClipEntry) -> QMenu:
        """Return what can be done with a clip, and with all selected ones."""
        out = QMenu(self.widget)
        out.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        chosen = self.session.selection.clips if entry.id in self.session.selection.clips else (entry.id,)
        out.addAction("Play alone", lambda: self.session.transport.show_clip(entry.id))
        out.addAction("Play in context", lambda: self.session.show_context(entry.id))
        out.addSeparator()
        out.addAction("Use its first frame as base pose", lambda: self.use_as_base(entry.id, 0))
        if self.session.transport.show == "clip" and self.session.transport.shown == entry.id:
            frame = round(self.session.transport.seconds * entry.fps)
            out.addAction(f"Use this frame ({frame}) as base pose", lambda: self.use_as_base(entry.id, frame))
        out.addAction(
            "Use the rest pose as base pose",
            lambda: self.document.edit("Set base pose", lambda p: edits.set_base(p, None)),
        )
        out.addSeparator()
        out.addAction("Rename…\tF2", lambda: self.rename(entry.id))
        out.addActions(self.row_actions)
        out.addSeparator()
        noun = f"{len(chosen)} clips" if len(chosen) > 1 else "clip"
        out.addAction(f"Remove {noun} from the project\tDel", lambda: self.remove(chosen))
        return out

    def use_as_base(self, clip: str, frame: int) -> None:
        self.document.edit("Set base pose", lambda p: edits.set_base(p, clip, frame))

    def rename(self, clip: str) -> None:
        entry = self.document.project.clips[clip]
        name, accepted = QInputDialog.getText(self.widget, "Rename clip", "Name:", text=entry.name)
        if accepted and name.strip():
            self.document.edit("Rename clip", lambda p: edits.rename_clip(p, clip, name))

    def remove(self, clips: Iterable[str]) -> None:
        gone = tuple(clips)
        if gone:
            self.document.edit(
                f"Remove {len(gone)} clip{'s' if len(gone) > 1 else ''}",
                lambda p: edits.remove_clips(p, gone),
            )
