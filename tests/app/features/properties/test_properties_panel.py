"""The page of actions is made when its modules are there; until then nothing waits for them."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType

import pytest

from app.features.properties.properties_panel import PLOTS, PropertiesPanel
from app.project.document import Document
from app.stage.session import StageSession
from metagraph.graph import edits


@pytest.fixture
def document(qapp, toy):
    document = Document()
    document.load(toy.project(), None)
    yield document
    document.deleteLater()  # or it would keep its journal where the next test keeps its own


def test_an_edit_while_the_plots_are_imported_does_not_wait_for_them(qtbot, monkeypatch, toy, document):
    asked = []
    session = StageSession(document)
    monkeypatch.delitem(sys.modules, PLOTS, raising=False)
    panel = PropertiesPanel(document, session, lambda modules, go_on: asked.append(go_on), lambda page: None)
    qtbot.addWidget(panel)
    action = toy.id(document.project, "rest long")
    session.selection.select_actions((action,))
    assert len(asked) == 1 and panel.pages.currentIndex() == 0
    # From here on the module is listed, but another thread holds its lock until it has been imported.
    monkeypatch.setitem(sys.modules, PLOTS, ModuleType(PLOTS))
    document.edit("Change timing", lambda p: edits.update_actions(p, (action,), timing={"blend_in": 0.31}))
    assert len(asked) == 1 and panel.pages.currentIndex() == 0
    monkeypatch.delitem(sys.modules, PLOTS)
    asked[0]()
    assert len(asked) == 2, "it is asked for again, since it is not there"


def test_the_page_of_actions_is_there_before_one_is_selected(qtbot, toy, document):
    session = StageSession(document)
    made = []

    def fetch(modules, go_on):
        for module in modules:
            import_module(module)
        go_on()

    panel = PropertiesPanel(document, session, fetch, made.append)
    qtbot.addWidget(panel)
    qtbot.waitUntil(lambda: len(made) == 1)
    assert panel.pages.currentIndex() == 0, "the layer is shown still"
    session.selection.select_actions((toy.id(document.project, "rest long"),))
    assert panel.pages.currentWidget() is made[0]


def test_fields_of_several_actions_stand_below_their_head_however_wide_the_panel_is(qtbot, toy, document):
    session = StageSession(document)
    import_module(PLOTS)
    panel = PropertiesPanel(document, session, lambda modules, go_on: go_on(), lambda page: None)
    qtbot.addWidget(panel)
    panel.resize(900, 300)
    panel.show()
    one, other = (toy.id(document.project, name) for name in ("rest long", "rest short"))
    session.selection.select_actions((one,))
    assert panel.action.beside, "beside the curves of one action"
    session.selection.select_actions((one, other))
    assert not panel.action.beside
    session.selection.select_actions((one,))
    assert panel.action.beside
