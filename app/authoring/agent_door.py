"""Let programs of this user work on the project that a window has open, while a person allows it.

Only this computer can connect, and only with the token in a file that the user alone can read.
"""

from __future__ import annotations

import hmac
import secrets
import socket
import threading
from contextlib import suppress
from pathlib import Path

import msgspec
from PySide6.QtCore import QObject, Qt, Signal

from app.authoring.author_line import AuthorLine
from app.authoring.desk import AuthorDesk
from app.authoring.door_key import DoorHello, leave_key, remove_key
from app.authoring.project_window import AuthoredDocument
from app.project.document import Document
from metagraph.errors import FileError

PATIENCE = 5.0  # seconds in which a program has to say who it is
LONGEST = 65536  # bytes of what it says
MOST = 8  # programs at a time


class SocketAuthorLine(AuthorLine):
    """A program that is connected to the window."""

    def __init__(self, desk: AuthorDesk, line: socket.socket) -> None:
        super().__init__(desk)
        self._line = line

    def tell_edited(self) -> None:
        """Say nothing: the door reports every edit, also those that a person makes."""

    def read_some(self) -> bytes:
        return self._line.recv(65536)

    def write_some(self, data: memoryview) -> int:
        return self._line.send(data)


class AgentDoor(QObject):
    """Open while programs may edit. `changed` is emitted when it opens or closes, or a program comes or goes;
    `edited` has the name of each step that one made.
    """

    changed = Signal()
    edited = Signal(str)
    _came = Signal(object, object)  # a connection, and what it said first
    _gone = Signal(object)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._listening: socket.socket | None = None
        self._key: Path | None = None
        self._guests: dict[socket.socket, AuthoredDocument] = {}
        self._lines: dict[socket.socket, SocketAuthorLine] = {}
        self._came.connect(self._let_in, Qt.ConnectionType.QueuedConnection)
        self._gone.connect(self._let_go, Qt.ConnectionType.QueuedConnection)
        document.loaded.connect(self.close)
        document.changed.connect(self._tell_changed)

    @property
    def is_open(self) -> bool:
        return self._listening is not None

    @property
    def count(self) -> int:
        """How many programs are connected."""
        return len(self._guests)

    def open(self) -> None:
        """Let programs in. Raises FileError or OSError if that cannot be."""
        path = self._document.path
        if self.is_open or path is None:
            return
        listening = socket.create_server(("127.0.0.1", 0), backlog=MOST)
        token = secrets.token_urlsafe(24)
        try:
            self._key = leave_key(path, listening.getsockname()[1], token)
        except (FileError, OSError):
            listening.close()
            raise
        self._listening = listening
        threading.Thread(target=self._listen, args=(listening, token), daemon=True).start()
        self.changed.emit()

    def close(self) -> None:
        """Let nobody in any more, and hang up; what a program has not finished changes nothing."""
        if self._listening is None:
            return
        if self._key is not None:
            remove_key(self._key)
        with suppress(OSError):
            self._listening.shutdown(socket.SHUT_RDWR)  # else the thread would wait on
        self._listening.close()
        self._listening = self._key = None
        for line, authored in self._guests.items():
            authored.closed = True
            with suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)
        self._guests.clear()
        self._lines.clear()
        self.changed.emit()

    def _tell_changed(self) -> None:
        for author in self._lines.values():
            author.tell_changed(*author.list_watched())

    def _listen(self, listening: socket.socket, token: str) -> None:
        """Wait for programs, on a thread."""
        while True:
            try:
                line, _ = listening.accept()
            except OSError:
                return  # closed
            threading.Thread(target=self._greet, args=(line, token), daemon=True).start()

    def _greet(self, line: socket.socket, token: str) -> None:
        """Hear who it is, on a thread."""
        try:
            line.settimeout(PATIENCE)
            data = b""
            while not data.endswith(b"\n") and len(data) < LONGEST:
                some = line.recv(1)  # no more than the line: what follows is the protocol's
                if not some:
                    break
                data += some
            hello = msgspec.json.decode(data, type=DoorHello)
            if not hmac.compare_digest(hello.token.encode(), token.encode()):
                raise ValueError("a wrong token")
            line.settimeout(None)
        except (OSError, ValueError):
            line.close()
            return
        self._came.emit(line, hello)

    def _let_in(self, line: socket.socket, hello: DoorHello) -> None:
        if not self.is_open or self._document.path is None or len(self._guests) >= MOST:
            line.close()
            return
        folders = [Path(folder) for folder in hello.folders]
        authored = AuthoredDocument(self._document, folders, hello.look_only)
        authored.edited.connect(self.edited)
        self._guests[line] = authored
        author = self._lines[line] = SocketAuthorLine(AuthorDesk(authored), line)
        author.start()
        threading.Thread(target=self._work, args=(author, line), daemon=True).start()
        self.changed.emit()

    def _work(self, author: SocketAuthorLine, line: socket.socket) -> None:
        """Do what a program asks, on a thread."""
        author.work()
        author.finish()
        line.close()
        with suppress(RuntimeError):  # the window is gone
            self._gone.emit(line)

    def _let_go(self, line: socket.socket) -> None:
        self._lines.pop(line, None)
        if self._guests.pop(line, None) is not None:
            self.changed.emit()
