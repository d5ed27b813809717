# SPDX-License-Identifier: GPL-3.0-or-later
"""A WebSocket client that follows the poses of a live session (RFC 6455), of the standard library alone."""

from __future__ import annotations

import base64
import hashlib
import json
import os
import socket
import struct
import threading
from collections.abc import Mapping
from typing import Any
from urllib.parse import urlsplit

_SALT = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
_LARGEST = 1 << 24  # bytes of a message


class LinkError(Exception):
    """What went wrong, in words."""


class WebSocket:
    """A connection that sends and receives texts."""

    def __init__(self, address: str, seconds: float = 5.0) -> None:
        parts = urlsplit(address if "://" in address else f"ws://{address}")
        if parts.scheme != "ws" or not parts.hostname:
            raise LinkError(f"'{address}' is no address such as ws://127.0.0.1:8765")
        host, port = parts.hostname, parts.port or 80
        try:
            self._socket = socket.create_connection((host, port), seconds)
        except OSError as error:
            raise LinkError(f"nobody answers at {host}:{port} ({error}); start `metagraph live`") from None
        self._buffer = b""
        try:
            self._shake_hands(f"{host}:{port}", parts.path or "/")
        except OSError as error:
            self._socket.close()
            raise LinkError(f"{host}:{port} is no live session ({error})") from None
        self._socket.settimeout(None)

    def _shake_hands(self, host: str, path: str) -> None:
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(
            f"GET {path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        while b"\r\n\r\n" not in self._buffer:
            more = self._socket.recv(4096)
            if not more or len(self._buffer) > 65536:
                raise ConnectionError("it closed the connection")
            self._buffer += more
        head, _, self._buffer = self._buffer.partition(b"\r\n\r\n")
        answer = base64.b64encode(hashlib.sha1((key + _SALT).encode()).digest())
        lines = head.split(b"\r\n")
        fields = {k.strip().lower(): v.strip() for k, _, v in (x.partition(b":") for x in lines[1:])}
        if b" 101 " not in lines[0] + b" " or fields.get(b"sec-websocket-accept") != answer:
            raise ConnectionError("it speaks no WebSocket: " + lines[0].decode("latin-1"))

    def send(self, text: str) -> None:
        """Send a text."""
        self._frame(1, text.encode())

    def receive(self) -> str | None:
        """Return the next text; None when the other side has closed."""
        whole = b""
        while True:
            first, length = self._take(2)
            if length > 127:
                raise LinkError("the session sent what a server must not")
            if length == 126:
                length = struct.unpack(">H", self._take(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self._take(8))[0]
            if length + len(whole) > _LARGEST:
                raise LinkError("the session sent a message that is too long")
            content, code = self._take(length), first & 15
            if code == 8:
                return None
            if code == 9:
                self._frame(10, content)
            elif code in (0, 1, 2):
                whole += content
                if first & 128:
                    return whole.decode("utf-8", "replace")

    def close(self) -> None:
        """Say goodbye."""
        try:
            self._frame(8, struct.pack(">H", 1000))
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass
        self._socket.close()

    def _frame(self, code: int, content: bytes) -> None:
        mask, size = os.urandom(4), len(content)
        head = bytes([128 | code])
        if size < 126:
            head += bytes([128 | size])
        elif size < 65536:
            head += bytes([254]) + struct.pack(">H", size)
        else:
            head += bytes([255]) + struct.pack(">Q", size)
        masked = bytes(b ^ mask[n & 3] for n, b in enumerate(content))
        self._socket.sendall(head + mask + masked)

    def _take(self, count: int) -> bytes:
        while len(self._buffer) < count:
            more = self._socket.recv(65536)
            if not more:
                raise LinkError("the session has ended")
            self._buffer += more
        out, self._buffer = self._buffer[:count], self._buffer[count:]
        return out


class Poses:
    """The newest pose of a session, read in a thread of its own. joints, morphs: what its numbers are of."""

    def __init__(self, address: str, rate: float = 30.0, token: str = "") -> None:
        self._line = WebSocket(address)
        hello: dict[str, Any] = {"do": "hello", "name": "Blender", "poses": {"rate": rate}}
        self._line.send(json.dumps(hello | ({"token": token} if token else {})))
        reply = self._line.receive()
        said = json.loads(reply) if reply else {}
        if said.get("state") != "done" or not said.get("poses"):
            self._line.close()
            raise LinkError(f"the session sends no poses: {said.get('why') or said.get('state') or 'closed'}")
        self.joints: list[str] = said["poses"]["joints"]
        self.morphs: list[str] = said["poses"]["morphs"]
        self.count, self.ended = 0, ""
        self._newest: Mapping[str, Any] | None = None
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._follow, name="metagraph poses", daemon=True)
        self._thread.start()

    def _follow(self) -> None:
        try:
            while (text := self._line.receive()) is not None:
                said = json.loads(text)
                if isinstance(said, dict) and "rotations" in said:
                    with self._lock:
                        self._newest, self.count = said, self.count + 1
            self.ended = "the session has ended"
        except (OSError, ValueError, LinkError) as error:
            self.ended = str(error) or "the session has ended"

    def newest(self) -> Mapping[str, Any] | None:
        """Return the newest pose that was not taken yet: `root`, `rotations` and `weights`."""
        with self._lock:
            out, self._newest = self._newest, None
        return out

    def close(self) -> None:
        """End it."""
        self._line.close()
        self._thread.join(2)
