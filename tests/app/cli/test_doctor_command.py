"""The report of what this computer has."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings

from app.cli.parser import main
from app.main import prepare_application
from app.shell import system_report
from metagraph import __version__
from metagraph.common.extras import EXTRAS
from preview.offscreen import OpenGLError


@pytest.mark.gl
def test_the_report_names_versions_drawing_and_folders(capsys):
    assert main(["doctor", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["Metagraph"].startswith(__version__)
    assert report["OpenGL"].startswith("3.3 or later") and report["numpy"] != "missing"


def test_the_settings_are_where_the_window_keeps_them(qapp):
    application = prepare_application()  # gives both names
    names = application.organizationName(), application.applicationName()
    assert system_report.make_system_report()["Settings"] == QSettings(*names).fileName()


def test_the_folder_of_caches_is_metagraphs_own_and_not_everybodys():
    assert Path(system_report.make_system_report()["Caches"]).name == "metagraph"


def test_without_opengl_it_says_what_to_install_and_ends_with_3(monkeypatch, capsys):
    def refuse():
        raise OpenGLError("There is no OpenGL 3.3 (x). Install Mesa's software renderer.")

    monkeypatch.setattr("preview.offscreen.make_standalone_context", refuse)
    assert main(["doctor"]) == 3
    assert "Install Mesa" in capsys.readouterr().out


def test_without_sound_it_says_why(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "sounddevice", None)
    assert system_report.make_system_report()["Sound"].startswith("none: ")


def test_extras_are_listed_and_one_without_a_name_is_refused(capsys):
    assert main(["extras", "--json"]) == 0
    assert json.loads(capsys.readouterr().out).keys() == EXTRAS.keys()
    assert main(["extras", "add"]) == 1
    assert "name the extra" in capsys.readouterr().err
    assert main(["extras", "remove", "lab"]) == 1
    assert "was not installed by Metagraph" in capsys.readouterr().err
