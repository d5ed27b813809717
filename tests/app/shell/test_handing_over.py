"""A language chosen in the menu shows at once, in a window that goes on with the work of the one before."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QLocale, QSettings
from PySide6.QtWidgets import QApplication, QDoubleSpinBox
from shiboken6 import isValid

from app import translation
from app.main import WindowKeeper, follow_language
from metagraph.graph import edits
from tests.app.shared_window import close, settle

pytestmark = pytest.mark.fresh_window


@pytest.fixture
def keeper(toys: Any) -> Iterator[WindowKeeper]:
    made = WindowKeeper(toys.window)
    yield made
    if made.window is not toys.window:
        close(made.window)
    translation.choose("en")
    follow_language(QApplication.instance())  # type: ignore[arg-type]


def choose(keeper: WindowKeeper, name: str) -> None:
    """Choose a language in the menu, as a click does."""
    menu = keeper.window.shell.actions["language"].menu()
    menu.aboutToShow.emit()
    next(a for a in menu.actions() if a.text() == name).trigger()
    QCoreApplication.processEvents()


@pytest.mark.nightly
def test_the_new_window_goes_on_where_the_old_one_was(toys: Any, keeper: WindowKeeper) -> None:
    document, chosen = toys.document, toys.id("rest beat lf")
    for number in (2.0, 3.0):
        document.edit(f"step {number}", lambda p, n=number: edits.update_actions(p, [chosen], likelihood=n))
    document.undo()
    toys.shell.stage.session.selection.select_actions((chosen,))
    project, journal, old = document.project, document.journal_place, toys.window
    assert journal.exists() and document.dirty

    choose(keeper, "Deutsch")

    new = keeper.window
    assert new is not old and new.isVisible() and QSettings().value("language") == "de"
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert not isValid(old)
    settle(new)
    there = new.shell.document
    assert there.project is project and there.dirty
    assert new.menuBar().actions()[0].text() == "&Datei"
    assert new.shell.stage.session.selection.actions == (chosen,)
    assert there.undo_stack.count() == 2
    assert all(f"→ {n + 2}, rest beat lf" in there.undo_stack.text(n) for n in range(2))
    assert there.journal_place == journal and journal.exists(), "what is in no file stays in the journal"
    there.redo()
    assert there.project.action(chosen).likelihood == 3.0
    there.undo()
    there.undo()
    assert there.project.action(chosen).likelihood == 1.0 and not there.dirty


@pytest.mark.nightly
def test_fields_and_texts_write_numbers_alike(keeper: WindowKeeper) -> None:
    choose(keeper, "Deutsch")
    field = QDoubleSpinBox()
    field.setValue(2.25)
    assert field.text() == translation.tr("{n:.2f}", n=2.25) == "2,25"
    choose(keeper, "English")
    field = QDoubleSpinBox()
    field.setValue(2.25)
    assert field.text() == translation.tr("{n:.2f}", n=2.25) == "2.25"
    assert QLocale().language() == QLocale.Language.English


@pytest.mark.nightly
def test_while_something_runs_the_window_stays_and_changes_once_it_has_ended(
    toys: Any, keeper: WindowKeeper
) -> None:
    go_on = threading.Event()
    toys.shell.jobs.start("Importing clips", lambda job: go_on.wait(20))
    choose(keeper, "Deutsch")
    assert keeper.window is toys.window and translation.get_language() == "en"
    assert "Importing clips" in toys.window.statusBar().currentMessage()
    go_on.set()
    toys.wait(lambda: translation.get_language() == "de")
    assert keeper.window is not toys.window


@pytest.mark.nightly
def test_while_a_live_session_runs_the_window_stays(toys: Any, keeper: WindowKeeper) -> None:
    live = toys.shell.stage.performance.live
    live.begin()
    choose(keeper, "Deutsch")
    assert keeper.window is toys.window and "live session" in toys.window.statusBar().currentMessage()
    live.end()
    toys.wait(lambda: translation.get_language() == "de")
