"""JSON lines on standard input and output, read and written by threads, since neither can be waited for
everywhere.
"""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable

from metagraph.live.hub import BACKLOG
from metagraph.live.messages import LONGEST_MESSAGE

AHEAD = 900  # lines read but not answered; more wait in the pipe


class StdioLine:
    """The one client that started the session. take: called with each line, and None at the end, on the event
    loop.
    """

    formats = ("json",)

    def __init__(
        self,
        call: Callable[..., object],
        take: Callable[[bytes | None], None],
        source: int = 0,
        target: int = 1,
    ) -> None:
        self._call, self._take, self._source, self._target = call, take, source, target
        self._room = threading.Semaphore(AHEAD)
        self._out: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._waiting = 0
        self._counting = threading.Condition()
        self._closed = False
        self._writer = threading.Thread(target=self._write, daemon=True)

    def start(self) -> None:
        """Begin to read and write."""
        self._writer.start()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        rest, skipping = b"", False
        while True:
            try:
                data = self.read_some()
            except OSError:
                data = b""
            if not data:
                break
            *whole, rest = (rest + data).split(b"\n")
            for line in whole:
                if skipping:
                    skipping = False
                elif line.strip():
                    self._pass(line)
            if len(rest) > LONGEST_MESSAGE:
                if not skipping:
                    self._pass(rest)  # too long: it is refused whole
                rest, skipping = b"", True
        if rest.strip() and not skipping:
            self._pass(rest)
        self._tell(None)

    def read_some(self) -> bytes:
        """Wait for bytes, and return them; none at the end. Raises OSError.

        Not through sys.stdin, whose lock a thread that waits for ever would hold at the interpreter's end.
        """
        return os.read(self._source, 65536)

    def write_some(self, data: memoryview) -> int:
        """Write bytes; return how many. Raises OSError."""
        return os.write(self._target, data)

    def _pass(self, line: bytes) -> None:
        self._room.acquire()
        with self._counting:  # who does not read its answers is not listened to
            self._counting.wait_for(lambda: self._waiting <= BACKLOG or self._closed)
        self._tell(line)

    def _tell(self, line: bytes | None) -> None:
        try:
            self._call(self._take, line)
        except RuntimeError:
            self._closed = True  # the loop has ended

    def _write(self) -> None:
        while (data := self._out.get()) is not None:
            try:
                view = memoryview(data)
                while view:
                    view = view[self.write_some(view) :]
            except OSError:
                self._closed = True
            with self._counting:
                self._waiting -= len(data)
                self._counting.notify_all()

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Write lines; never waits."""
        data = b"".join(line + b"\n" for line, _ in messages)
        if not self._closed:
            with self._counting:
                self._waiting += len(data)
            self._out.put(data)

    def answered(self, messages: int) -> None:
        """Read on."""
        self._room.release(messages)

    def backlog(self) -> int:
        """How many bytes are not yet written."""
        return self._waiting

    def close(self, code: int, reason: str) -> None:
        """Write nothing more."""
        self._closed = True
        self._out.put(None)
        with self._counting:
            self._counting.notify_all()

    def finish(self, seconds: float = 2.0) -> None:
        """Write what waits, but not for longer than some seconds."""
        self._out.put(None)
        self._writer.join(seconds)
