"""Panels where they belong: those of a mode, beside the centre, alone, and put back."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt

from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.mark.nightly
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


@pytest.mark.nightly
def test_the_character_alone_has_the_whole_window_and_gives_it_back(toys):
    drive = toys
    drive.workspaces.choose("graph")
    bars = [drive.window.menuBar(), drive.window.statusBar(), drive.window.header]
    drive.do("big")
    drive.pause(20)
    assert not any(b.isVisible() for b in bars) and not drive.preview.play_button.isVisible()
    assert drive.preview.view.size() == drive.window.size()
    drive.key(Qt.Key.Key_F11)
    drive.pause(20)
    assert all(b.isVisible() for b in bars) and drive.preview.play_button.isVisible()
    assert not drive.docks["graph"].isHidden() and drive.docks["character"].titleBarWidget() is None
    drive.do("big")
    drive.workspaces.choose("label")
    assert all(b.isVisible() for b in bars) and drive.preview.play_button.isVisible()


def test_the_history_goes_back_to_where_it_is_clicked(toys):
    drive = toys
    drive.workspaces.choose("graph")
    before = drive.document.project
    for name in ("one", "two"):
        drive.document.edit(f"New stance {name}", lambda p, n=name: edits.add_stance(p, "arms", n))
    drive.do("history")
    view = drive.shell.panel("history")
    assert drive.docks["history"].isVisible()
    texts = [view.model().index(n, 0).data() for n in range(view.model().rowCount())]
    assert texts == ["Before these steps", "New stance one", "New stance two"]
    view.setCurrentIndex(view.model().index(0, 0))
    assert drive.document.project == before
    drive.docks["history"].close()
