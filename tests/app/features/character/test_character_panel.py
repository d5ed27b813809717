"""The character in the real window: what is paused costs nothing, and goes on where it was."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QTimer

pytestmark = [pytest.mark.window, pytest.mark.gl]


def ticking(widget) -> list[QTimer]:
    return [timer for timer in widget.findChildren(QTimer) if timer.isActive() and not timer.isSingleShot()]


@pytest.mark.nightly
def test_a_paused_window_rests_and_playing_goes_on_without_a_leap(toys):
    drive = toys
    panel, transport = drive.shell.panel("character"), drive.shell.stage.session.transport
    transport.set_playing(True)
    drive.wait(lambda: transport.seconds > 0.1)
    assert ticking(panel) and ticking(drive.canvas)
    transport.set_playing(False)
    assert not ticking(panel) and not ticking(drive.canvas)
    here, frames = transport.seconds, panel.frames
    drive.pause(600)
    assert transport.seconds == here
    assert panel.frames <= frames + 6, "what was asked for before; 36 if it played on"
    transport.set_playing(True)
    drive.wait(lambda: transport.seconds != here)
    assert transport.seconds - here < 0.3, "the time it rested is not made up for"
