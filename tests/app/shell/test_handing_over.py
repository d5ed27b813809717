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


def test_the_new_window_goes_on_where_the_old_one_was(toys: Any, keeper: WindowKeeper) -> None:
    document = toys.document
    chosen = toys.id("rest beat lf")
    for number in (2.0, 3.0):
        document.edit(
            f"step {number}", lambda p, n=number: edits.update_actions(p, [chosen], likelihood=n)
        )
    document.undo()
