"""Messages between a process and one of ours that it starts: bytes, each with its length before it, through
the child's standard input and output.
"""

from __future__ import annotations

import os
import struct
import sys
from contextlib import suppress
from typing import IO

from metagraph.common.programs import make_python_command, start

_LENGTH = struct.Struct("<q")


class ChildChannel:
    """One end. Raises OSError if the other has ended. Sends and receives may be on threads of their own."""

    def __init__(self, incoming: IO[bytes], outgoing: IO[bytes]) -> None:
        self._in, self._out = incoming, outgoing

    def send(self, content: bytes) -> None:
        try:
            self._out.write(_LENGTH.pack(len(content)))
            self._out.write(content)
            self._out.flush()
        except ValueError as error:  # it is closed
            raise BrokenPipeError(str(error)) from None

    def receive(self) -> bytes:
        """Return the next message. Raises EOFError when there will be none."""
        head = self._read(_LENGTH.size)
        return self._read(_LENGTH.unpack(head)[0])

    def _read(self, size: int) -> bytes:
        try:
            content = self._in.read(size)
        except (OSError, ValueError):
            content = b""
        if len(content) < size:
            raise EOFError
        return content


class Child(ChildChannel):
    """A module of ours that runs as a process until it is closed; the end of its parent ends it, too."""

    def __init__(self, module: str, *words: str) -> None:
        import subprocess

        self.process = start(
            make_python_command(module, *words), stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        assert self.process.stdin is not None and self.process.stdout is not None
        super().__init__(self.process.stdout, self.process.stdin)

    def close(self, patience: float) -> None:
        """Signal the end of the messages, and wait until the child has ended, as `end` does."""
        self._shut(self._out)
        self.end(patience)

    def end(self, patience: float) -> None:
        """Wait until the child ends, and kill it after `patience` seconds."""
        import subprocess

        for ask in (self.process.terminate, self.process.kill):
            try:
                self.process.wait(patience)
                break
            except subprocess.TimeoutExpired:
                ask()
        self.process.wait()
        self._shut(self._out)
        self._shut(self._in)

    @staticmethod
    def _shut(pipe: IO[bytes]) -> None:
        with suppress(OSError):  # what was still to be written has no reader
            pipe.close()


def connect_to_parent() -> ChildChannel:
    """Return, in the child, the way to its parent; what is printed goes to standard error from now on."""
    outgoing = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print is no message
    return ChildChannel(sys.stdin.buffer, outgoing)
