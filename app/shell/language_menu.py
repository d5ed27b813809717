"""Define the menu that chooses the language of the window."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu

from app import translation
from app.shell.actions import Command
from app.shell.context import Shell
from app.translation import tr


def make_language_command(shell: Shell, chosen: Callable[[str], object]) -> Command:
    """Return the command whose menu lists the languages, each by its own name. `chosen` is called with the
    code of one.
    """

    def choose(code: str) -> None:
        shell.settings.setValue("language", code)
        chosen(code)

    def fill(menu: QMenu) -> None:
        group = QActionGroup(menu)
        for code, name in translation.NAMES.items():
            action = menu.addAction(name, partial(choose, code))
            action.setCheckable(True)
            action.setChecked(code == translation.get_language())
            group.addAction(action)

    return Command("language", "&View", "look", tr("Lan&guage"), fill=fill)
