"""Every word that the five workspaces show: none cut, none left out untold, none over another."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtOpenGLWidgets import QOpenGLWidget

from app.shell.workspaces import WORKSPACES
from app.stage.gl_view import ImageView
from metagraph.graph import edits
from tests.app.painted_text import faults, without

pytestmark = [pytest.mark.window, pytest.mark.gl]
SIZES = [(1280, 720), (2560, 1440)]


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


def walk(drive, width: int, height: int) -> dict[str, list[str]]:
    """Return what is wrong in each workspace at a size."""
    out = {}
    action = next(a for a in drive.document.project.actions() if a.kind == "gesture" and a.layer == "arms")
    drive.window.resize(width, height)
    with without(QOpenGLWidget, ImageView):
        for workspace in WORKSPACES:
            drive.workspaces.choose(workspace.id)
            drive.session.onstage.set_conversation(
                next(iter(drive.document.project.conversations), None) if workspace.id == "talk" else None
            )
            drive.session.jump(action=action.id)
            drive.session.transport.set_playing(False)
            drive.pause(60)
            out[workspace.id] = faults(drive.window)
    return {k: v for k, v in out.items() if v}


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("dress", [lambda p: p, studio], ids=["sample", "studio"])
def test_every_word_is_whole_or_told_and_none_lies_on_another(drive, sample, size, dress):
    drive.document.load(dress(sample), None)
    drive.files.opened.emit()
    drive.wait(lambda: drive.performance.skeleton() is not None)
    found = walk(drive, *size)
    drive.window.resize(1680, 1020)
    drive.session.onstage.set_conversation(None)
    assert not found, "\n".join(f"{k}: {line}" for k, lines in found.items() for line in lines)


@pytest.mark.parametrize("size", SIZES, ids=str)
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
            found[panel] = faults(drive.window)
    drive.show("machine", False)
    drive.window.resize(1680, 1020)
    assert not any(found.values()), "\n".join(f"{k}: {line}" for k, v in found.items() for line in v)
