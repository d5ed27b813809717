"""Libraries that a bare system lacks: the remedy is said instead of a traceback."""

from __future__ import annotations

import json
import sys

import pytest

from app.cli import parser, system_libraries
from app.shell import system_report

GLIB = "libglib-2.0.so.0: cannot open shared object file: No such file or directory"


@pytest.fixture
def bare(monkeypatch):
    """A Linux without the libraries of a desktop, on which Qt cannot be imported."""

    def refuse(name, *args, **options):
        if name.startswith("lib"):
            raise OSError(name)

    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(system_libraries.ctypes, "CDLL", refuse)


def test_a_missing_library_is_named_with_what_to_install(bare, monkeypatch, capsys):
    def fail(name):
        raise ImportError(GLIB)

    monkeypatch.setattr(parser, "_module", fail)
    assert parser.main(["window"]) == parser.ERROR
    said = capsys.readouterr().err
    assert "lacks the library libglib-2.0.so.0" in said and "apt install libglib2.0-0" in said
    assert parser.main(["doctor", "--json"]) == parser.ERROR
    assert "libegl1" in json.loads(capsys.readouterr().out)["error"]


def test_other_failed_imports_are_told_as_they_are(monkeypatch):
    def fail(name):
        raise ImportError("No module named 'x'")

    monkeypatch.setattr(parser, "_module", fail)
    with pytest.raises(ImportError, match="No module named"):
        parser.main(["window"])


def test_the_report_is_made_without_qt_and_says_what_to_install(bare, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "PySide6.QtCore", None)
    monkeypatch.setattr(system_report, "_describe_opengl", lambda: "There is no OpenGL 3.3")
    monkeypatch.setattr(system_report, "_describe_sound", lambda: "none")
    assert parser.main(["doctor", "--json"]) == 3
    report = json.loads(capsys.readouterr().out)
    assert report["Settings"].startswith("unknown: ") and report["Missing"].startswith("on Debian or Ubuntu")
