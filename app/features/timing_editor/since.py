"""Keep the project as it was when the present selection was made."""

from __future__ import annotations

from app.project.document import Document
from app.stage.session import StageSession
from metagraph.graph.model import Project


class Since:
    """Follows the selection from the start: what is compared with it may be made when it is first seen.

    project: None before anything was selected.
    """

    def __init__(self, document: Document, session: StageSession) -> None:
        self.document, self.selection = document, session.selection
        self.project: Project | None = None
        self._of: tuple[str, ...] = ()
        document.loaded.connect(self._loaded)
        session.selection.changed.connect(self._selected)

    def _loaded(self) -> None:
        self.project, self._of = None, ()

    def _selected(self) -> None:
        if self.selection.actions != self._of:
            self.project, self._of = self.document.project, self.selection.actions
