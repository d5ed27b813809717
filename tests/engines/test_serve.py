"""Serving the web page: on the loopback alone, with the types browsers want, never from a cache."""

from __future__ import annotations

import gzip
import http.client
import os
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from metagraph.engines import serve
from metagraph.engines.serve import Served


@pytest.fixture
def shown(tmp_path: Path) -> Iterator[Served]:
    folder = tmp_path / "page"
    (folder / "inner").mkdir(parents=True)
    (folder / "index.html").write_text("<p>here")
    (folder / "inner" / "secret.txt").write_text("listed")
    (folder / ".env").write_text("hidden")
    (tmp_path / "secret").write_text("outside")
    served = Served(folder)
    yield served
    served.close()


def asked(served: Served, path: str, host: str | None = None, method: str = "GET") -> tuple[int, bytes]:
    port = int(served.url.rstrip("/").rpartition(":")[2])
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    try:
        line.request(method, path, headers={} if host is None else {"Host": host.format(port=port)})
        answer = line.getresponse()
        return answer.status, answer.read()
    finally:
        line.close()


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1.evil.example:{port}", "", "localhost:1"],
)
def test_who_asks_by_another_name_gets_nothing(shown: Served, host: str) -> None:
    status, body = asked(shown, "/", host)
    assert status == 403 and b"here" not in body


@pytest.mark.parametrize("host", [None, "127.0.0.1:{port}", "LOCALHOST:{port}"])
def test_this_machine_s_own_names_are_known(shown: Served, host: str | None) -> None:
    assert asked(shown, "/", host) == (200, b"<p>here")
    assert asked(shown, "/", host, "HEAD") == (200, b"")


def test_folders_are_not_listed_and_what_is_hidden_stays_so(shown: Served) -> None:
    for path in ("/inner/", "/inner", "/.env", "/./.env", "/inner/../.env", "/%2eenv", "//etc/passwd"):
        status, body = asked(shown, path)
        assert status == 404 and b"secret.txt" not in body and b"hidden" not in body, path
    assert asked(shown, "/inner/secret.txt") == (200, b"listed")
    assert asked(shown, "/", method="POST")[0] == 501


def test_links_that_lead_elsewhere_and_pipes_are_not_followed(shown: Served) -> None:
    try:
        (shown.folder / "link").symlink_to(shown.folder.parent / "secret")
        (shown.folder / "up").symlink_to(shown.folder.parent)
        (shown.folder / "fine").symlink_to(shown.folder / "index.html")
    except OSError:
        pytest.skip("links are not to be had here")
    assert asked(shown, "/link")[0] == 404 and asked(shown, "/up/secret")[0] == 404
    assert asked(shown, "/fine") == (200, b"<p>here")
    if hasattr(os, "mkfifo"):
        os.mkfifo(shown.folder / "pipe")
        assert asked(shown, "/pipe")[0] == 404


@pytest.mark.nightly
def test_who_says_nothing_takes_no_room_from_others_for_long(
    shown: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(serve.Quiet, "timeout", 0.2)
    port = int(shown.url.rstrip("/").rpartition(":")[2])
    silent = [socket.create_connection(("127.0.0.1", port)) for _ in range(serve.AT_ONCE)]
    for line in silent:
        line.settimeout(10)
        assert line.recv(100) == b""  # hung up on
        line.close()
    assert asked(shown, "/")[0] == 200


def test_a_folder_is_served_with_the_types_browsers_want(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("<p>here")
    (tmp_path / "main.js").write_text("1")
    (tmp_path / "x.glb").write_bytes(b"glTF")
    served = Served(tmp_path)
    try:
        assert served.url.startswith("http://127.0.0.1:")
        for name, kind in (("", "text/html"), ("main.js", "text/javascript"), ("x.glb", "model/gltf-binary")):
            with urllib.request.urlopen(served.url + name, timeout=10) as answer:
                assert answer.headers["content-type"] == kind
                assert answer.headers["cache-control"] == "no-cache"
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(served.url + "nothing", timeout=10)
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(served.url + "%2e%2e/%2e%2e/etc/passwd", timeout=10)
    finally:
        served.close()
    with pytest.raises(OSError):
        urllib.request.urlopen(served.url, timeout=2)


def test_who_takes_gzip_gets_less_and_the_same_and_what_changed_anew(shown: Served) -> None:
    def got(path: str, **headers: str) -> tuple[dict[str, str], bytes]:
        request = urllib.request.Request(
            shown.url + path, headers={k.replace("_", "-"): v for k, v in headers.items()}
        )
        with urllib.request.urlopen(request, timeout=10) as answer:
            return dict(answer.headers), answer.read()

    for text in (b"metagraph " * 1000, b"character " * 2000):
        (shown.folder / "large.js").write_bytes(text)
        told, body = got("large.js", Accept_Encoding="br, gzip;q=0.5")
        assert told["Content-Encoding"] == "gzip" and told["Content-Type"] == "text/javascript"
        assert len(body) == int(told["Content-Length"]) < len(text) / 20 and gzip.decompress(body) == text
        assert got("large.js")[1] == text and "Content-Encoding" not in got("large.js")[0]
        assert got("large.js", Accept_Encoding="gzip", Range="bytes=0-3")[1] == text[:4]
    assert got("index.html", Accept_Encoding="gzip")[1] == b"<p>here"  # so little is sent as it is
    (shown.folder / "large.wav").write_bytes(bytes(5000))
    assert got("large.wav", Accept_Encoding="gzip")[1] == bytes(5000)


def test_what_is_kept_small_has_its_bounds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serve, "_small", {})
    monkeypatch.setattr(serve, "KEPT", 100)
    for name in "abc":
        (tmp_path / name).write_bytes(os.urandom(2000))
        assert serve._shrunk(tmp_path / name)
    assert [path.name for path in serve._small] == ["c"]
    assert serve._shrunk(tmp_path / "none") is None


def test_a_port_that_is_taken_is_an_error(tmp_path: Path) -> None:
    served = Served(tmp_path)
    try:
        with pytest.raises(OSError):
            Served(tmp_path, int(served.url.rstrip("/").rpartition(":")[2]))
    finally:
        served.close()


@pytest.mark.parametrize(
    ("asked_for", "status", "body", "told"),
    [
        ("bytes=0-1", 206, b"<p", "bytes 0-1/7"),
        ("bytes=3-", 206, b"here", "bytes 3-6/7"),
        ("bytes=-2", 206, b"re", "bytes 5-6/7"),
        ("bytes=5-900", 206, b"re", "bytes 5-6/7"),
        ("bytes=7-", 416, b"", "bytes */7"),
        ("bytes=5-2", 416, b"", "bytes */7"),
        ("bytes=-", 200, b"<p>here", None),
        ("bytes=0-1,3-4", 200, b"<p>here", None),
        ("bytes=x-1", 200, b"<p>here", None),
        ("lines=1-2", 200, b"<p>here", None),
    ],
)
def test_parts_of_files_are_sent_as_asked(
    shown: Served, asked_for: str, status: int, body: bytes, told: str | None
) -> None:
    request = urllib.request.Request(shown.url, headers={"Range": asked_for})
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            found = answer.status, answer.read(), answer.headers["Content-Range"]
    except urllib.error.HTTPError as error:
        with error:
            found = error.code, error.read(), error.headers["Content-Range"]
    assert found == (status, body, told)


def test_a_part_of_what_is_hidden_is_not_sent(shown: Served) -> None:
    request = urllib.request.Request(shown.url + ".env", headers={"Range": "bytes=0-3"})
    with pytest.raises(urllib.error.HTTPError, match="404") as told:
        urllib.request.urlopen(request, timeout=10)
    told.value.close()
