"""Panels where they belong: those of a mode, beside the centre, alone, and put back."""

from __future__ import annotations

import pytest

pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_entering_another_mode_makes_the_window_no_wider(toys):
    drive = toys
    size = drive.window.size()
    for mode in ("manual", "meta", "manual", "meta"):
        drive.session.set_mode(mode)
        drive.pause(50)
        assert drive.window.size() == size
        assert drive.editor.isVisible() is (mode == "manual")
        assert drive.canvas.isVisible() is (mode == "meta")
        inspector = drive.shell.panel("inspector")
        assert inspector.isVisible() is (mode == "manual") and drive.properties.isVisible() is (
            mode == "meta"
        )


def test_what_stands_beside_the_graph_goes_with_it_and_comes_back(toys):
    drive = toys
    drive.show("machine")
    assert drive.machine.isVisible()
    drive.session.set_mode("manual")
    assert not drive.machine.isVisible() and drive.places.wanted("machine")
    drive.session.set_mode("meta")
    assert drive.machine.isVisible()
    drive.show("machine", False)
    assert not drive.machine.isVisible()


def test_a_panel_that_does_not_exist_is_said_so(toys):
    with pytest.raises(LookupError, match="no panel 'nonsense'"):
        toys.shell.panel("nonsense")
