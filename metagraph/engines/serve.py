"""A folder shown to this machine's browser: what the exported web page needs instead of a file's address.

Any page of the web may send requests to this machine, and a name of its own may lead here: who does not ask
for this machine by its own name gets nothing. Nor does anybody get a list of what there is, what is hidden,
or what a link leads to elsewhere.
"""

from __future__ import annotations

import functools
import gzip
import os
import re
import socket
import threading
from collections.abc import Callable
from http import HTTPStatus
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from metagraph.common.files import is_file, is_inside

WAIT = 10.0  # seconds for a request to be sent
AT_ONCE = 64  # requests
MOST_AT_ONCE = 8 << 20  # bytes of a part of a file
SHRUNK = (".html", ".js", ".mjs", ".css", ".json", ".glb", ".svg", ".txt", ".csv")  # what gzip makes smaller
SHRUNK_FROM, SHRUNK_TO = 1 << 10, 64 << 20  # bytes
KEPT = 64 << 20  # bytes of files made smaller that are kept for the next time
_RANGE = re.compile(r"bytes=([0-9]{0,15})-([0-9]{0,15})")


class Quiet(SimpleHTTPRequestHandler):
    # Said here, since a system's own table may call scripts plain text, and browsers then refuse modules.
    extensions_map = {  # noqa: RUF012 - the base class has it so
        **SimpleHTTPRequestHandler.extensions_map,
        ".js": "text/javascript",
        ".mjs": "text/javascript",
        ".json": "application/json",
        ".glb": "model/gltf-binary",
        ".flac": "audio/flac",
    }
    timeout = WAIT

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: requests of one's own browser are not news."""

    def end_headers(self) -> None:
        self.send_header("Accept-Ranges", "bytes")
        self.send_header("Cache-Control", "no-cache")  # exporting again must show
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Cross-Origin-Resource-Policy", "same-origin")
        super().end_headers()

    def is_asked_by_name(self) -> bool:
        """Return whether a request is to the address that is listened on, by its own name."""
        address, port = self.connection.getsockname()[:2]
        names = dict.fromkeys(
            (address, "127.0.0.1", "localhost") if address.startswith("127.") else (address,)
        )
        hosts = self.headers.get_all("Host") or []
        return [h.strip().lower() for h in hosts] in [[f"{name}:{port}"] for name in names]

    def send_head(self) -> BytesIO | BinaryIO | None:
        """Send what comes before a file, or why there is none."""
        if not self.is_asked_by_name():
            self.send_error(HTTPStatus.FORBIDDEN, "This page is for this machine alone")
            return None
        path, root = Path(self.translate_path(self.path)), Path(self.directory)
        path = path / "index.html" if path.is_dir() else path
        inside = path.is_relative_to(root) and is_inside(path, root)
        if not inside or any(p.startswith(".") for p in path.relative_to(root).parts) or not is_file(path):
            self.send_error(HTTPStatus.NOT_FOUND)
            return None
        wanted = _RANGE.fullmatch(self.headers.get("Range", ""))
        if wanted is not None and wanted[0] != "bytes=-":
            return self._part(path, *wanted.groups())
        coded = {
            word.partition(";")[0].strip() for word in self.headers.get("Accept-Encoding", "").split(",")
        }
        if "gzip" in coded and path.suffix.lower() in SHRUNK and "Range" not in self.headers:
            content = _shrunk(path)
            if content is not None:
                return self._whole(path, content)
        return super().send_head()

    def _whole(self, path: Path, content: bytes) -> BytesIO:
        """Send what comes before a file that was made smaller."""
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", self.guess_type(str(path)))
        self.send_header("Content-Encoding", "gzip")
        self.send_header("Vary", "Accept-Encoding")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        return BytesIO(content)

    def _part(self, path: Path, first: str, last: str) -> BytesIO | None:
        """Send what comes before a part of a file, which browsers ask for to play a video again."""
        try:
            with path.open("rb") as file:
                size = os.fstat(file.fileno()).st_size
                begin = int(first) if first else max(0, size - int(last))
                end = min(int(last) if first and last else size - 1, size - 1, begin + MOST_AT_ONCE - 1)
                file.seek(begin)
                content = file.read(max(0, end - begin + 1))
        except OSError:
            self.send_error(HTTPStatus.NOT_FOUND)
            return None
        if not content:
            self.send_response(HTTPStatus.REQUESTED_RANGE_NOT_SATISFIABLE)
            self.send_header("Content-Range", f"bytes */{size}")
            self.send_header("Content-Length", "0")
            self.end_headers()
            return None
        self.send_response(HTTPStatus.PARTIAL_CONTENT)
        self.send_header("Content-Type", self.guess_type(str(path)))
        self.send_header("Content-Range", f"bytes {begin}-{begin + len(content) - 1}/{size}")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        return BytesIO(content)

    def list_directory(self, path: Any) -> None:
        """Show nobody what lies in a folder."""
        self.send_error(HTTPStatus.NOT_FOUND)


_small: dict[Path, tuple[tuple[int, int], bytes]] = {}  # by file: its time and size, and what it became
_one = threading.Lock()


def _shrunk(path: Path) -> bytes | None:
    """Return a file made smaller, kept until it changes; None if that does not pay or cannot be."""
    with _one:
        try:
            told = path.stat()
            state = (told.st_mtime_ns, told.st_size)
            if not SHRUNK_FROM <= told.st_size <= SHRUNK_TO:
                return None
            known = _small.pop(path, None)
            if known is None or known[0] != state:
                known = (state, gzip.compress(path.read_bytes(), 5, mtime=0))
        except OSError:
            return None
        _small[path] = known
        while len(_small) > 1 and sum(len(content) for _, content in _small.values()) > KEPT:
            del _small[next(iter(_small))]
        return known[1]


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, address: tuple[str, int], handler: Callable[..., Any]) -> None:
        self._room = threading.Semaphore(AT_ONCE)
        super().__init__(address, handler)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer on a thread, while there is room for one."""
        if self._room.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._room.release()

    def handle_error(self, request: socket.socket | tuple[bytes, socket.socket], client_address: Any) -> None:
        """Say nothing: who hangs up in the middle is no news either."""


class Served:
    """A folder being served on the loopback, until `close` or the program's end. url: its address."""

    def __init__(
        self,
        folder: str | Path,
        port: int = 0,
        address: str = "127.0.0.1",
        handler: type[Quiet] = Quiet,
    ) -> None:
        """port: 0 for any that is free. address: of the interface that is listened on, IPv4. handler: what
        answers requests. Raises OSError when the port is taken or there is no such address.
        """
        self.folder = Path(folder).resolve()
        self._server = _Server((address, port), functools.partial(handler, directory=str(self.folder)))
        self.url = f"http://{address}:{self._server.server_address[1]}/"
        self._thread = threading.Thread(
            target=self._server.serve_forever, args=(0.1,), name="web page", daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """Stop serving."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
