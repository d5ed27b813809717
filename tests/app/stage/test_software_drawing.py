"""Drawing in software is offered where OpenGL fails, tried first, and takes effect at the next start."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import moderngl
import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton

from app.stage import gl_view, software_drawing
from app.stage.gl_view import ImageView
from app.stage.software_drawing import (
    VARIABLES,
    apply_drawing_choice,
    choose_software,
    has_software_opengl,
    is_software_chosen,
)
from preview.scene import Scene

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Mesa's variables are Linux's")


def without_opengl(*_: object, **__: object) -> Any:
    raise RuntimeError("libGL is not there")


@pytest.fixture
def settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> QSettings:
    kept = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    monkeypatch.setattr(gl_view, "QSettings", lambda: kept)
    return kept


@pytest.fixture
def view(qapp: Any, settings: QSettings, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr(moderngl, "create_context", without_opengl)
    out = ImageView(lambda: Scene(()))
    out.resize(500, 400)
    out.show()
    out.grab()
    qapp.processEvents()
    yield out
    out.close()


def press(view: ImageView) -> str:
    (button,) = view.findChildren(QPushButton)
    assert button.text() == "Draw without the graphics card"
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    assert not button.isVisible()
    (label,) = view.findChildren(QLabel)
    return label.text()


@linux
def test_where_software_works_it_is_chosen_for_the_next_start(
    view: ImageView, settings: QSettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gl_view, "has_software_opengl", lambda: True)
    assert "open it again" in press(view)
    assert is_software_chosen(settings)
    monkeypatch.delenv("LIBGL_ALWAYS_SOFTWARE", raising=False)
    monkeypatch.delenv("GALLIUM_DRIVER", raising=False)
    apply_drawing_choice(settings)
    assert {name: os.environ[name] for name in VARIABLES} == VARIABLES


@linux
def test_where_software_fails_too_the_remedy_stays_and_nothing_is_chosen(
    view: ImageView, settings: QSettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gl_view, "has_software_opengl", lambda: False)
    words = press(view)
    assert words.startswith("OpenGL 3.3 does not work in software either.") and "apt install" in words
    assert not is_software_chosen(settings)


def test_unless_it_is_chosen_no_variable_is_set(settings: QSettings, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("LIBGL_ALWAYS_SOFTWARE", raising=False)
    apply_drawing_choice(settings)
    choose_software(settings, True)
    choose_software(settings, False)
    apply_drawing_choice(settings)
    assert "LIBGL_ALWAYS_SOFTWARE" not in os.environ


@linux
@pytest.mark.gl
def test_the_try_runs_in_a_process_of_its_own_and_says_what_that_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert has_software_opengl()
    monkeypatch.setattr(software_drawing, "run_program", lambda *_, **__: (3, "no OpenGL"))
    assert not has_software_opengl()


def test_a_try_that_cannot_start_or_never_ends_is_a_no(monkeypatch: pytest.MonkeyPatch) -> None:
    for error in (OSError("no such program"), TimeoutError()):

        def fail(*_: object, error: Exception = error, **__: object) -> Any:
            raise error

        monkeypatch.setattr(software_drawing, "run_program", fail)
        assert not has_software_opengl()
