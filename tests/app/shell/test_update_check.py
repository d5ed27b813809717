"""Updates are looked for only where a build has an address and the user allowed it, with one plain request."""

from __future__ import annotations

import json
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from PySide6.QtCore import QSettings

from app.shell import update_check
from app.shell.update_check import ALLOWED, UpdateError, find_update, is_due, note_version, read_notes

NEWER = {"version": "9.1.0", "notes": "Faster graphs", "url": "https://example.org/metagraph"}


class Server:
    """A server on this computer that keeps what it was asked."""

    def __init__(self):
        self.asked, self.answer, self.code, self.headers = [], json.dumps(NEWER).encode(), 200, {}
        outer = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                outer.asked.append((self.path, dict(self.headers)))
                self.send_response(outer.code)
                for name, value in outer.headers.items():
                    self.send_header(name, value)
                self.end_headers()
                self.wfile.write(outer.answer)

            def log_message(self, *words):
                pass

        self.http = HTTPServer(("127.0.0.1", 0), Handler)
        self.thread = threading.Thread(target=self.http.serve_forever, kwargs={"poll_interval": 0.02})
        self.thread.start()
        self.address = f"http://127.0.0.1:{self.http.server_port}/latest.json"

    def close(self):
        self.http.shutdown()
        self.thread.join()
        self.http.server_close()


@pytest.fixture
def server(tmp_path, monkeypatch):
    made = Server()
    monkeypatch.setattr(update_check, "ROOT", tmp_path)
    (tmp_path / update_check.ADDRESS).write_text(made.address + "\n")
    yield made
    made.close()


@pytest.fixture
def settings(tmp_path):
    return QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)


def test_nothing_is_asked_when_it_is_off(server, settings):
    assert not is_due(settings, 1e9), "off as it comes"
    with pytest.raises(UpdateError, match="does not look for updates"):
        find_update("0.1.0", settings)
    settings.setValue(ALLOWED, "false")
    assert not is_due(settings, 1e9)
    assert server.asked == []


def test_an_installation_from_source_has_no_address(tmp_path, settings):
    assert update_check.find_update_address() is None
    settings.setValue(ALLOWED, "true")
    assert not is_due(settings, 1e9)


def test_one_request_tells_nothing_of_the_user(server, settings):
    settings.setValue(ALLOWED, "true")
    assert is_due(settings, 1e9)
    assert find_update("0.1.0", settings).version == "9.1.0"
    ((path, headers),) = server.asked
    assert path == "/latest.json"
    assert set(headers) == {"Host", "User-Agent", "Accept", "Accept-Encoding", "Connection"}
    assert headers["User-Agent"] == "metagraph", "neither version nor system"


def test_it_is_asked_once_a_day(server, settings):
    settings.setValue(ALLOWED, "true")
    find_update("0.1.0", settings)
    import time

    assert not is_due(settings, time.time()) and is_due(settings, time.time() + 90000)
    settings.setValue(update_check.ASKED, "broken")
    assert is_due(settings, time.time())


@pytest.mark.parametrize(
    ("version", "newer"),
    [("9.1", False), ("9.1.0", False), ("9.0.9", True), ("10.0", False), ("9.1.1", False)],
)
def test_only_a_newer_version_counts(server, settings, version, newer):
    settings.setValue(ALLOWED, "true")
    assert (find_update(version, settings) is not None) is newer


@pytest.mark.parametrize(
    "answer",
    [b"", b"<html>", b"{}", b'{"version": "new"}', b'{"version": 5}', b'{"version": "9' + b" " * 200_000],
)
def test_an_answer_that_is_no_release_is_refused(server, settings, answer):
    settings.setValue(ALLOWED, "true")
    server.answer = answer
    with pytest.raises(UpdateError, match="does not describe a release"):
        find_update("0.1.0", settings)


def test_another_place_is_not_asked_and_its_page_not_offered(server, settings):
    settings.setValue(ALLOWED, "true")
    server.answer = json.dumps({**NEWER, "url": "file:///etc/passwd"}).encode()
    assert find_update("0.1.0", settings).url == ""
    server.code, server.headers = 302, {"Location": server.address}
    with pytest.raises(UpdateError, match="could not reach the server"):
        find_update("0.1.0", settings)
    assert len(server.asked) == 2


def test_a_server_that_is_not_there_is_reported(server, settings, monkeypatch):
    settings.setValue(ALLOWED, "true")
    (update_check.ROOT / update_check.ADDRESS).write_text("http://127.0.0.1:9/")
    with pytest.raises(UpdateError, match=r"could not reach the server .*Try again later"):
        find_update("0.1.0", settings)
    (update_check.ROOT / update_check.ADDRESS).write_text("http://example.org/")
    assert update_check.find_update_address() is None, "not in the clear"


def test_the_changelog_s_part_for_a_version_is_found(tmp_path):
    file = tmp_path / "CHANGELOG.md"
    file.write_text(
        "# Changelog\n\n## [Unreleased]\n\n- Soon\n\n## [0.2.0] - 2026-01-01\n\n- Now\n\n## [0.1.0]\n\n- Old\n"
    )
    assert read_notes("0.2.0", file) == "- Now"
    assert read_notes("0.3.0", file) == "- Soon"
    assert read_notes("0.2.0", tmp_path / "none") == ""


def test_an_update_is_noticed_once(settings):
    assert not note_version(settings, "0.1.0"), "the first start of all is no update"
    assert not note_version(settings, "0.1.0")
    assert note_version(settings, "0.2.0") and not note_version(settings, "0.2.0")
