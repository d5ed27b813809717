"""Serving the web page: on the loopback alone, with the types browsers want, never from a cache."""

from __future__ import annotations

import urllib.error
import urllib.request
from pathlib import Path

import pytest

from metagraph.engines.serve import Served


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


def test_a_port_that_is_taken_is_an_error(tmp_path: Path) -> None:
    served = Served(tmp_path)
    try:
        with pytest.raises(OSError):
            Served(tmp_path, int(served.url.rstrip("/").rpartition(":")[2]))
    finally:
        served.close()
