"""Pass a client's lines on to the window that has its project open, and the window's answers back."""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import msgspec

from app.authoring.door_key import DoorHello, find_key

PATIENCE = 5.0  # seconds in which a window has to answer


def connect_to_window(
    project: Path, folders: Sequence[Path], look_only: bool, source: int = 0, target: int = 1
) -> bool:
    """Let a client work in the window that has a project open, until either ends; return whether one let it
    in.
    """
    key = find_key(project)
    if key is None:
        return False
    try:
        line = socket.create_connection(("127.0.0.1", key.port), PATIENCE)
    except OSError:
        return False  # its window is gone
    with line:
        hello = DoorHello(key.token, tuple(str(folder.resolve()) for folder in folders), look_only)
        line.sendall(msgspec.json.encode(hello) + b"\n")
        line.settimeout(None)
        threading.Thread(target=_send_all, args=(line, source), daemon=True).start()
        with suppress(OSError):
            while data := line.recv(65536):
                view = memoryview(data)
                while view:
                    view = view[os.write(target, view) :]
    return True


def _send_all(line: socket.socket, source: int) -> None:
    with suppress(OSError):
        while data := os.read(source, 65536):
            line.sendall(data)
        line.shutdown(socket.SHUT_WR)
