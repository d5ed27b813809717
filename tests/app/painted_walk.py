"""Goes through the five workspaces of a window and looks at their words, and at controls' names."""

from __future__ import annotations

from typing import Any

from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtTest import QTest

from app.shell.workspaces import WORKSPACES
from app.stage.gl_view import ImageView
from tests.app.accessible import nameless
from tests.app.painted_text import faults, without
from tests.app.shared_window import settle


def walk(drive: Any, width: int, height: int) -> dict[str, list[str]]:
    """Return what is wrong in each workspace at a size."""
    out = {}
    actions = (a for a in drive.document.project.actions() if a.kind == "gesture" and a.layer == "arms")
    action = next(actions, None)
    drive.window.resize(width, height)
    with without(QOpenGLWidget, ImageView):
        for workspace in WORKSPACES:
            drive.workspaces.choose(workspace.id)
            drive.session.onstage.set_conversation(
                next(iter(drive.document.project.conversations), None) if workspace.id == "talk" else None
            )
            if action is not None:
                drive.session.jump(action=action.id)
            drive.session.transport.set_playing(False)
            settle(drive.window)  # sounds are read, what was read is counted
            QTest.qWait(30)  # and laid out
            settle(drive.window)
            out[workspace.id] = faults(drive.window) + nameless(drive.window)
    return {k: v for k, v in out.items() if v}
