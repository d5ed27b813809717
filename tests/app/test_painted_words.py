"""Every word that the five workspaces show: none cut, none left out untold, none over another; and every
control has a name, for who hears it instead.
"""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtOpenGLWidgets import QOpenGLWidget

from app.project.files import SAMPLE
from app.stage.gl_view import ImageView
from metagraph.graph import edits
from tests.app.accessible import nameless
from tests.app.every_dialog import DIALOGS, opened
from tests.app.painted_text import faults, without
from tests.app.painted_walk import walk
from tests.thorough import many

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.window, pytest.mark.gl]
SIZES = [(1280, 720), (2560, 1440)]
# A theme changes colours and not where words stand: each is walked through once at each size and once with
# each kind of names, not all eight times: long names on a small screen and short ones on a large one.
WALKS = [
    ((1280, 720), "light", "studio"),
    ((2560, 1440), "dark", "sample"),
    ((1280, 720), "dark", "sample"),
    ((2560, 1440), "light", "studio"),
][: many(2, 4)]


def studio(project):
    """The sample as another studio names things: everything long, and alike but in the middle."""
    for graph in project.graphs.values():
        for stance in list(graph.stances.values()):
            project = edits.rename_stance(project, stance.id, f"seated forward {stance.name} at the desk")
    clips = {
        i: replace(e, name=f"HeroMale01|seated_forward_{e.name.replace('__', '_at_the_desk_')}_final_v03")
        for i, e in project.clips.items()
    }
    project = replace(project, clips=clips)
    names = {
        a.id: {"name": f"explains_enthusiastically_{a.name}_with_feeling_{n % 2 + 1:02d}"}
        for n, a in enumerate(project.actions())
    }
    return edits.update_each(project, names)


@pytest.mark.nightly
@pytest.mark.parametrize(("size", "theme", "names"), WALKS, ids=str)
def test_every_word_is_whole_or_told_and_none_lies_on_another(drive, sample, size, theme, names):
    drive.session.look.choose(theme)
    drive.document.load(studio(sample) if names == "studio" else sample, None)
    drive.files.opened.emit()
    drive.wait(lambda: drive.performance.skeleton() is not None)
    found = walk(drive, *size)
    drive.window.resize(1680, 1020)
    drive.session.onstage.set_conversation(None)
    assert not found, told(found)


def told(found: dict[str, list[str]]) -> str:
    return "\n".join(f"{k}: {line}" for k, lines in found.items() for line in lines)


@pytest.mark.nightly
@pytest.mark.parametrize("size", SIZES[: many(1, 2)], ids=str)
def test_panels_that_are_opened_keep_to_it_too(drive, sample, size):
    drive.document.load(edits.update_each(sample, {}), None)
    drive.files.opened.emit()
    drive.wait(lambda: drive.performance.skeleton() is not None)
    drive.workspaces.choose("graph")
    drive.window.resize(*size)
    found = {}
    with without(QOpenGLWidget, ImageView):
        for panel in ("machine", "models", "problems", "lines", "life"):
            drive.show(panel)
            drive.settle()
            found[panel] = faults(drive.window) + nameless(drive.window)
    drive.show("machine", False)
    drive.window.resize(1680, 1020)
    assert not any(found.values()), told(found)


@pytest.mark.nightly
def test_every_dialog_keeps_to_it_too(drive, tmp_path):
    """In the theme in which they are opened least while they are made."""
    drive.session.look.choose("light")
    drive.files.open(SAMPLE, template=True)
    drive.wait(lambda: bool(drive.document.project.clips) and drive.performance.skeleton() is not None)
    drive.session.transport.set_playing(False)
    found = {}
    with without(QOpenGLWidget, ImageView):
        for name, open_it in DIALOGS.items():
            open_it(drive, tmp_path)
            drive.wait(lambda: bool(opened()))
            drive.pause(30)
            found[name] = [line for dialog in opened() for line in faults(dialog) + nameless(dialog)]
            while opened():
                opened()[-1].reject()
    drive.session.onstage.set_conversation(None)
    assert not any(found.values()), told(found)


@pytest.mark.nightly
@pytest.mark.parametrize(("scale", "language"), [("2", "de"), ("2", "en"), ("1", "de")][: many(1, 3)])
def test_on_a_screen_twice_as_fine_and_in_another_language_words_are_as_whole(scale, language):
    """Measures of letters differ by parts of a pixel on such a screen; Qt takes its scale, and the window its
    language, when it starts.
    """
    environment = {
        **os.environ,
        "QT_SCALE_FACTOR": scale,
        "METAGRAPH_LANGUAGE": language,
        "PYTHONPATH": str(ROOT),
    }
    done = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-m", "tests.app.painted_words_twice"],
        env=environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0 and not done.stdout.strip(), done.stdout + done.stderr
