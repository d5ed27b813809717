"""A folder shown to this machine's browser: what the exported web page needs instead of a file's address."""

from __future__ import annotations

import functools
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any


class _Quiet(SimpleHTTPRequestHandler):
    # Said here, since a system's own table may call scripts plain text, and browsers then refuse modules.
    extensions_map = {  # noqa: RUF012 - the base class has it so
        **SimpleHTTPRequestHandler.extensions_map,
        ".js": "text/javascript",
        ".mjs": "text/javascript",
        ".json": "application/json",
        ".glb": "model/gltf-binary",
        ".flac": "audio/flac",
    }

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: requests of one's own browser are not news."""

    def end_headers(self) -> None:
        self.send_header("Cache-Control", "no-cache")  # exporting again must show
        super().end_headers()


class Served:
    """A folder being served on the loopback, until `close` or the program's end. url: its address."""

    def __init__(self, folder: str | Path, port: int = 0) -> None:
        """port: 0 for any that is free. Raises OSError when it is taken."""
        self.folder = Path(folder).resolve()
        self._server = ThreadingHTTPServer(
            ("127.0.0.1", port), functools.partial(_Quiet, directory=str(self.folder))
        )
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/"
        self._thread = threading.Thread(
            target=self._server.serve_forever, args=(0.1,), name="web page", daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """Stop serving."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
