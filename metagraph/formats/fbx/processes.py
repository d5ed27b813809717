"""Run the processes that read FBX files. Each reads one file after another, and a crash affects only its
current file.

Starting one takes about 0.3 s, reading a file a fiftieth of that. Within a `batch` they are kept for the next
file.
"""

from __future__ import annotations

import json
import struct
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from metagraph.common.programs import make_python_command, start
from metagraph.formats.fbx import child as fbx_child

HEAD = struct.Struct("<Bq")  # code, length
MOST = 50  # files that one process reads, because it keeps what it has read


class ReaderError(Exception):
    """Raised if a process could not read a file.

    `code` is its exit code, negative for a signal, None if it took too long; `fbx_child.REFUSED` if the file
    is at fault. `words` is the last line of its output.
    """

    def __init__(self, code: int | None, words: str = "") -> None:
        self.code, self.words = code, words
        super().__init__(f"{code}: {words}")


class _Reader:
    """One process. `count` is the number of files it has read."""

    def __init__(self) -> None:
        import subprocess
        import tempfile

        self.count = 0
        self.said = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the process)
        self.process = start(
            make_python_command(fbx_child.__name__),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.said,
            env={"OMP_NUM_THREADS": "1"},
        )

    def read(self, path: Path, timeout: float) -> bytes:
        """Return a file as binary glTF. Raises ReaderError if the file is refused or the process
        has ended.
        """
        late = threading.Event()

        def stop() -> None:
            late.set()
            self.process.kill()

        timer = threading.Timer(timeout, stop)
        timer.daemon = True
        timer.start()
        assert self.process.stdin is not None and self.process.stdout is not None
        try:
            self.process.stdin.write(json.dumps(str(path.resolve())).encode() + b"\n")
            self.process.stdin.flush()
            head = self.process.stdout.read(HEAD.size)
            code, length = HEAD.unpack(head) if len(head) == HEAD.size else (-1, 0)
            if code in (0, fbx_child.REFUSED) and 0 <= length < 1 << 40:
                body: bytes = self.process.stdout.read(length)
                if len(body) == length:
                    self.count += 1
                    if code:
                        raise ReaderError(code, body.decode("utf-8", "replace"))
                    return body
            elif len(head) == HEAD.size:
                self.process.kill()
                raise ReaderError(1, "its reader talks nonsense")
        except OSError:
            pass  # it ended before the request was written
        finally:
            timer.cancel()
        code = self.process.wait()
        self.said.seek(0)
        words = self.said.read().decode("utf-8", "replace").strip().splitlines()
        raise ReaderError(None if late.is_set() else code, words[-1] if words else "")

    def close(self) -> None:
        import subprocess

        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                try:
                    pipe.close()
                except OSError:
                    continue  # the rest of the output has no reader
        try:
            self.process.wait(1.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.said.close()


_lock = threading.Lock()
_idle: list[_Reader] = []
_batches = 0


@contextmanager
def batch() -> Iterator[None]:
    """Keep processes for the next file while this context lasts."""
    global _batches
    with _lock:
        _batches += 1
    try:
        yield
    finally:
        with _lock:
            _batches -= 1
            over = [] if _batches else [_idle.pop() for _ in range(len(_idle))]
        for reader in over:
            reader.close()


def convert(path: Path, timeout: float) -> bytes:
    """Return an FBX file as binary glTF. `timeout` is in seconds. Raises ReaderError, and OSError if no
    process starts.
    """
    while True:
        with _lock:
            reader = _idle.pop() if _idle else None
        reader = reader or _Reader()
        alive, before = False, reader.count
        try:
            data = reader.read(path, timeout)
            alive = True
            return data
        except ReaderError as error:
            alive = error.code == fbx_child.REFUSED and reader.process.poll() is None
            if alive or error.code is None or not before:
                raise
            # An earlier file may be the cause: try again with a process that has read none.
        finally:
            with _lock:
                keep = alive and _batches > 0 and reader.count < MOST
                if keep:
                    _idle.append(reader)
            if not keep:
                reader.close()
