"""The page of a perceptual study served, and what it sends kept. Everything that holds for exported web pages
holds here (`engines.serve`): this machine's own names alone unless told, no lists, no links out of the
folder.
"""

from __future__ import annotations

import json
from http import HTTPStatus
from pathlib import Path
from typing import Any

from metagraph.engines.serve import Quiet, Served
from metagraph.errors import FileError
from metagraph.research.study.perceive.answers import SheetError, decode_sheet, keep_sheet
from metagraph.research.study.perceive.folder import Perceived

MOST_POSTED = 512 << 10  # bytes of one request


def serve_page(study: Perceived, port: int = 0, address: str = "127.0.0.1") -> Served:
    """Serve a study's page until closed. address: of the interface that is listened on. Raises OSError if the
    port is taken or there is no such address.
    """

    class Handler(_Answering):
        kept_for = study

    return Served(study.show, port, address, Handler)


class _Answering(Quiet):
    """Also takes answers, at `answers` alone."""

    kept_for: Perceived

    def end_headers(self) -> None:
        self.send_header(
            "Content-Security-Policy",
            "default-src 'self'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; "
            "frame-ancestors 'none'",
        )
        self.send_header("Referrer-Policy", "no-referrer")
        super().end_headers()

    def do_POST(self) -> None:
        """Keep what was sent: 200 with how many events are kept, 409 where the code was begun elsewhere."""
        self.close_connection = True  # a body that is not read must not become the next request
        if not self.is_asked_by_name():
            return self._say(HTTPStatus.FORBIDDEN, "this page is for others")
        if self.path.partition("?")[0] != "/answers":
            return self._say(HTTPStatus.NOT_FOUND, "answers go to /answers")
        if self.headers.get_content_type() != "application/json":  # what other pages cannot send unasked
            return self._say(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "answers are application/json")
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdecimal()) or self.headers.get("Transfer-Encoding"):
            return self._say(HTTPStatus.LENGTH_REQUIRED, "how long it is should be said")
        if len(length) > 9 or int(length) > MOST_POSTED:
            return self._say(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {MOST_POSTED >> 10} KiB at once")
        try:
            content = self.rfile.read(int(length))
        except OSError:
            return None
        if len(content) < int(length):
            return self._say(HTTPStatus.BAD_REQUEST, "it ended too early")
        try:
            kept = keep_sheet(self.kept_for, decode_sheet(content))
        except SheetError as error:
            return self._say(HTTPStatus.CONFLICT if error.taken else HTTPStatus.BAD_REQUEST, str(error))
        except FileError as error:
            return self._say(HTTPStatus.INSUFFICIENT_STORAGE, error.cause)
        return self._say(HTTPStatus.OK, "", kept=kept.kept, new=kept.new)

    def _say(self, status: HTTPStatus, error: str, **more: Any) -> None:
        content = json.dumps({**({"error": error} if error else {}), **more}).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)


def find_page(study: Perceived) -> Path:
    """Return the page. Raises FileError if it is not there, or a video is not."""
    page = study.show / "index.html"
    missing = [n for n in study.key.stimuli if not study.video(n).is_file()]
    if not page.is_file() or missing:
        what = "its page is not there" if not page.is_file() else f"{len(missing)} videos are not there"
        raise FileError(study.show, what, "", "Make the study anew, or take it from a copy.")
    return page
