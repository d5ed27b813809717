"""A second start while Metagraph runs: it opens its own window, or hands what it was given to the running
one, as the user chose.

The two talk through a local socket in a folder that nobody else of this computer can open.
"""

from __future__ import annotations

import hashlib
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
from PySide6.QtCore import QObject, QSettings, Signal

from metagraph.common.programs import make_own

if TYPE_CHECKING:
    from PySide6.QtNetwork import QLocalServer, QLocalSocket

SETTING = "second start"
RUNNING, BESIDE = "running", "beside"
PATIENCE = 1500  # ms that the running window may take to answer; then the second start opens its own
MOST = 1_000_000  # bytes of a request
TAKEN, BUSY = b"taken\n", b"busy\n"
LONGEST = 100  # bytes of a socket's path; systems allow 104 to 108


class StartRequest(msgspec.Struct, frozen=True):
    """What a start was given. paths: a project, or clips and folders of clips, absolute. token: the desktop's
    leave to come to the front (Wayland).
    """

    paths: tuple[str, ...] = ()
    sample: bool = False
    clip: str | None = None
    token: str = ""


def _settings() -> QSettings:
    """Return the window's settings, also before there is an application."""
    return QSettings(QSettings.defaultFormat(), QSettings.Scope.UserScope, "Metagraph", "Metagraph")


def is_handed_over() -> bool:
    """Return whether the user wants what is opened from outside in the running window."""
    return str(_settings().value(SETTING, BESIDE)) == RUNNING


def find_socket_name() -> str | None:
    """Return the name of the socket, one for each screen of this user; None if no safe place is known."""
    screen = os.environ.get("WAYLAND_DISPLAY") or os.environ.get("DISPLAY") or ""
    mark = hashlib.sha256(screen.encode()).hexdigest()[:8]
    if sys.platform == "win32":  # pipes have no folder; Qt guards them by the user's rights
        return f"metagraph-{os.environ.get('USERNAME', '')}-{mark}"
    from metagraph.common.disk_cache import cache_folder

    places = [Path(p) for p in (os.environ.get("XDG_RUNTIME_DIR"),) if p]
    for place in (*places, *(p for p in (cache_folder("start"),) if p is not None)):
        folder = place / "metagraph" if place in places else place
        name = str(folder / mark)
        if len(os.fsencode(name)) <= LONGEST and make_own(folder):
            return name
    return None


def send_start_request(request: StartRequest) -> bool:
    """Give a request to the running window; return whether it took it. A window that crashed, hangs or asks
    something takes nothing.
    """
    if not is_handed_over():
        return False
    name = find_socket_name()
    if name is None:
        return False
    from PySide6.QtNetwork import QLocalSocket

    socket = QLocalSocket()
    socket.connectToServer(name)
    if not socket.waitForConnected(PATIENCE):
        return False
    socket.write(msgspec.json.encode(request) + b"\n")
    while not socket.canReadLine():
        if not socket.waitForReadyRead(PATIENCE):
            return False
    return socket.readLine().data() == TAKEN


class SecondStarts(QObject):
    """Listens for second starts. asked: has the StartRequest of one."""

    asked = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._server: QLocalServer | None = None

    def choose(self, on: bool) -> None:
        """Remember whether second starts come here, and begin or end to listen."""
        _settings().setValue(SETTING, RUNNING if on else BESIDE)
        self.follow()

    def follow(self) -> None:
        """Listen if that is chosen, and no other window of this user does already."""
        if not is_handed_over():
            self.stop()
            return
        name = find_socket_name()
        if self._server is not None or name is None:
            return
        from PySide6.QtNetwork import QLocalServer, QLocalSocket

        other = QLocalSocket()
        other.connectToServer(name)
        if other.waitForConnected(200):
            other.abort()
            return
        QLocalServer.removeServer(name)  # what a crash left there
        self._server = server = QLocalServer(self)
        server.setSocketOptions(QLocalServer.SocketOption.UserAccessOption)
        server.newConnection.connect(self._accept)
        if not server.listen(name):
            self.stop()

    @property
    def listens(self) -> bool:
        return self._server is not None

    def stop(self) -> None:
        """Listen no more."""
        if self._server is not None:
            self._server.close()
            self._server.deleteLater()
            self._server = None

    def _accept(self) -> None:
        while self._server is not None and (socket := self._server.nextPendingConnection()) is not None:
            socket.disconnected.connect(socket.deleteLater)
            socket.readyRead.connect(lambda socket=socket: self._read(socket))
            if socket.canReadLine():
                self._read(socket)

    def _read(self, socket: QLocalSocket) -> None:
        if not socket.canReadLine():
            if socket.bytesAvailable() > MOST:
                socket.abort()
            return
        from PySide6.QtWidgets import QApplication

        request = None
        with suppress(msgspec.DecodeError):
            request = msgspec.json.decode(socket.readLine().data(), type=StartRequest)
        busy = request is None or QApplication.activeModalWidget() is not None
        socket.write(BUSY if busy else TAKEN)
        socket.flush()
        socket.disconnectFromServer()
        if request is not None and not busy:
            self.asked.emit(request)
