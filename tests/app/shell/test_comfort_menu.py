"""Help > Accessibility, in the window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSettings

from app.look.comfort import get_comfort, read_comfort
from app.look.theme import HIGH_DARK

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def menu(toys):
    found = toys.shell.actions["comfort"].menu()
    found.aboutToShow.emit()
    yield found
    QSettings().clear()
    read_comfort()
    toys.session.look.changed.emit()


def test_high_contrast_is_seen_at_once(toys, menu):
    toys.pick(menu, "High contrast")
    assert get_comfort().contrast
    color = toys.canvas.grab().toImage().pixelColor(2, 2).name()
    assert color == HIGH_DARK.ground


def test_with_reduced_motion_nothing_moves_by_itself(toys, menu):
    drive = toys
    drive.session.transport.set_playing(True)
    drive.pick(menu, "Reduced motion")
    assert not drive.session.transport.playing
    beat = drive.canvas._beat.count
    drive.session.transport.set_playing(True)  # asked for
    drive.pause(400)
    assert drive.canvas._beat.count == beat, "the stance on its card stands still"
    drive.session.transport.set_playing(False)


def test_the_size_of_text_is_told_to_hold_from_the_next_start(toys, menu):
    toys.pick(menu, "Text and controls at 125 %")
    assert get_comfort().size == 125
    assert "next start" in toys.window.statusBar().currentMessage()
