"""The graphics driver is loaded on a thread, while Python imports."""

from __future__ import annotations

import ctypes
import subprocess
import sys
import threading

import pytest

from preview import early_driver
from tests.processes import ROOT


@pytest.mark.gl
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere nothing is loaded early")
def test_a_context_can_be_made_while_the_driver_loads_and_after():
    code = (
        "from preview.early_driver import load_soon; load_soon(); load_soon()\n"
        "from preview.offscreen import Offscreen\n"
        "for _ in range(2):\n"
        "    with Offscreen(8, 8) as picture: print(bool(picture.description))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stdout.split() == ["True", "True"], done.stderr


@pytest.mark.parametrize("missing", [OSError("no such library"), AttributeError("no such symbol")])
def test_where_there_is_no_egl_nothing_happens(monkeypatch, missing):
    def refuse(name: str) -> None:
        raise missing

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    early_driver._load()


def test_elsewhere_no_thread_is_started(monkeypatch):
    monkeypatch.setattr(sys, "platform", "darwin")
    before = threading.active_count()
    early_driver.load_soon()
    assert threading.active_count() == before
