"""The page an empty window begins with."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.features.welcome.welcome_page import WelcomePage
from app.shell.workspace_keeper import FIELDS
from tests.app.painted_text import faults, painted

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def page(drive):
    drive.workspaces.choose("graph")
    drive.wait(lambda: bool(drive.window.findChildren(WelcomePage)))
    (found,) = drive.window.findChildren(WelcomePage)
    drive.wait(found.isVisible)
    return found


@pytest.mark.nightly
def test_it_goes_when_there_is_something_and_comes_with_nothing(drive, page, toy):
    from metagraph.graph.model import Project

    drive.document.load(toy.project(), None)
    assert page.isHidden()
    drive.document.load(Project(), None)
    assert page.isVisible()
    QTest.mouseClick(page.skip, Qt.MouseButton.LeftButton)
    assert page.isHidden()
    drive.workspaces.choose("label")
    drive.workspaces.choose("graph")
    assert page.isHidden(), "closed it stays closed"
    drive.document.load(Project(), None)
    assert page.isVisible()
    drive.session.set_mode("manual")
    assert page.isHidden()
    drive.session.set_mode("meta")


def test_no_field_takes_the_keys_when_it_goes(drive, page):
    page.cards[2].setFocus()
    drive.wait(page.cards[2].hasFocus)
    QTest.mouseClick(page.skip, Qt.MouseButton.LeftButton)
    assert page.isHidden() and not isinstance(QApplication.focusWidget(), FIELDS)


def test_a_first_edit_is_not_covered(drive, page):
    from metagraph.graph import edits

    drive.document.edit("New stance", lambda p: edits.add_stance(p, "arms", "rest"))
    assert page.isHidden()


def test_each_card_does_what_it_says(drive, page, monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr(type(drive.files), "open", lambda self, path, template=False: asked.append(path.name))
    for card in page.cards[1:3]:
        QTest.mouseClick(card, Qt.MouseButton.LeftButton)
    assert asked == ["practice.metagraph.yaml", "sample.metagraph.yaml"]
    assert not page.recent.isEnabled(), "nothing was saved yet"
    saved = tmp_path / "mine.metagraph.yaml"
    saved.write_text("")
    monkeypatch.setattr(type(drive.files), "recent", lambda self: [saved])
    page.hide()
    page.follow()
    assert page.recent.isEnabled() and "mine" in page.recent.toolTip()
    QTest.mouseClick(page.recent, Qt.MouseButton.LeftButton)
    assert asked[-1] == saved.name


@pytest.mark.parametrize("size", [(1280, 720), (2560, 1440)], ids=str)
def test_its_words_are_whole(drive, page, size):
    drive.window.resize(*size)
    drive.pause(30)
    assert page.isVisible() and page.size() == page.parentWidget().size()
    assert [f for f in faults(drive.window) if "Card" in f or "Welcome" in f or "Begin" in f] == []
    drive.window.resize(1680, 1020)


def test_where_the_graph_is_too_small_for_it_the_large_panel_has_it(drive, page):
    drive.workspaces.choose("time")
    drive.window.resize(1280, 720)
    drive.wait(page.isVisible)
    assert page.parentWidget() is drive.places.dock("character").widget()
    drive.workspaces.choose("graph")
    drive.window.resize(1680, 1020)
    drive.wait(lambda: page.parentWidget() is drive.places.dock("graph").widget())


@pytest.mark.parametrize("workspace", ["label", "graph", "time", "perform", "talk"])
def test_an_empty_project_has_it_in_every_workspace(drive, page, workspace):
    drive.workspaces.choose(workspace)
    drive.wait(page.isVisible)
    room = page.parentWidget()
    assert page.size() == room.size() and not page.visibleRegion().isEmpty()
    drive.workspaces.choose("graph")


@pytest.mark.parametrize("width", [420, 900])
def test_titles_beside_each_other_keep_to_a_line_and_no_button_is_cut(drive, page, width):
    page.resize(width, 420)
    drive.pause(20)
    tops = [painted(card)[0].rect.bottom() for card in page.cards]
    assert all(words == card.text() for card in page.cards for words in [painted(card)[0].text])
    assert abs(tops[0] - tops[1]) < 4 and abs(tops[2] - tops[3]) < 4, "letters reach below a line or not"
    for button in (page.guide, page.skip):
        assert button.width() >= button.sizeHint().width()
    page.follow()
