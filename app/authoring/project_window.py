"""Work on the project that a window has open: each edit is one step of its history, seen at once."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from PySide6.QtCore import QObject, Qt, QThread, Signal

from app.authoring.tool import AuthorError
from app.project.document import Document
from metagraph.graph.model import Project

T = TypeVar("T")
LOOK = 0.2  # seconds between two looks at whether the window still lets anybody in
GONE = "a person has closed the project or switched agents off in the window; nothing was changed"


class AuthoredDocument(QObject):
    """A window's document for a call on another thread. What it does to the document happens on the window's
    thread, on which this object was made. `edited` has the name of each step that was made.

    roots: folders that may be used. look_only: whether nothing may be edited.
    """

    edited = Signal(str)
    _wanted = Signal(object)

    def __init__(self, document: Document, roots: Sequence[Path] = (), look_only: bool = False) -> None:
        super().__init__()
        assert document.path is not None
        self._document, self.path = document, document.path
        self.roots = (self.path.resolve().parent, *(root.resolve() for root in roots))
        self.project = document.project
        self._look_only = look_only
        self.closed = False
        self._wanted.connect(lambda serve: serve(), Qt.ConnectionType.QueuedConnection)

    @contextmanager
    def hold(self) -> Iterator[None]:
        """Look at the project as it is now. Nobody is kept from editing it; see `commit`."""
        self.project = self._in_window(lambda: self._document.project)
        yield

    def find_refusal(self) -> str:
        return "edits are forbidden: the program was started with --look-only" if self._look_only else ""

    def commit(self, title: str, after: Project) -> str:
        """Make the edit a step. Raises AuthorError if a person has edited the project meanwhile."""
        before = self.project

        def edit() -> str:
            document = self._document
            if document.project is not before:
                raise AuthorError("a person edited the project meanwhile; nothing was changed. Call again")
            document.finish_merging()
            document.edit(title, lambda _: after, agent=True)
            self.project = document.project
            return document.undo_stack.undoText()

        text = self._in_window(edit)
        self.edited.emit(text)
        return text

    def list_steps(self) -> tuple[Sequence[str], Sequence[str]]:
        return self._in_window(self._list_steps)

    def undo(self) -> None:
        self._in_window(self._document.undo)

    def redo(self) -> None:
        self._in_window(self._document.redo)

    def _list_steps(self) -> tuple[list[str], list[str]]:
        stack = self._document.undo_stack
        texts = [stack.text(n) for n in range(stack.count())]
        return texts[: stack.index()], texts[stack.index() :]

    def _in_window(self, does: Callable[[], T]) -> T:
        """Do something on the window's thread, and wait for it. Raises what it raises; AuthorError if the
        window lets nobody in any more.
        """
        done, out, failed = threading.Event(), list[Any](), list[BaseException]()

        def serve() -> None:
            try:
                if self.closed or self._document.path != self.path:
                    raise AuthorError(GONE)
                out.append(does())
            except BaseException as error:  # it belongs to the thread that waits
                failed.append(error)
            done.set()

        if QThread.currentThread() is self.thread():
            serve()
        else:
            self._wanted.emit(serve)
        while not done.wait(LOOK):
            if self.closed:
                raise AuthorError(GONE)
        if failed:
            raise failed[0]
        result: T = out[0]
        return result
