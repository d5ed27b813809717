"""Which prop is chosen, on the floor plan, in the list and in the view of the character, and its changes."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.translation import tr_error
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.props import set_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop


class Placing(QObject):
    """The prop that the user chose, "" for none. `changed` is emitted when another is chosen."""

    changed = Signal()

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.ident = document, ""
        document.changed.connect(self._follow)

    @property
    def prop(self) -> Prop | None:
        """The chosen prop as it is now."""
        return self.document.project.props.get(self.ident)

    def choose(self, ident: str) -> None:
        """Choose a prop by its id; "" for none."""
        if ident != self.ident:
            self.ident = ident
            self.changed.emit()

    def _follow(self, before: Project, after: Project) -> None:
        if self.ident not in after.props:
            self.choose("")

    def edit(self, words: str, ident: str, prop: Prop, merge: str | None = None) -> None:
        """Change a prop as a step named `words`; steps that follow each other with one `merge` are one."""
        try:
            self.document.edit(words, lambda project: set_prop(project, ident, prop), merge=merge)
        except EditError as error:
            self.document.failed.emit(tr_error(error))

    def drag(self, words: str, ident: str, prop: Prop) -> None:
        """Show a prop as a drag has it, until `end` or `take_back`."""
        self.edit(words, ident, prop, f"prop {ident}")

    def end(self) -> None:
        """Keep what a drag did, as one step."""
        self.document.finish_merging()

    def take_back(self, ident: str) -> None:
        """Show a prop as it was before a drag."""
        self.document.cancel_merging(f"prop {ident}")
