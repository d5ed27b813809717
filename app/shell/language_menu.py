"""Chooses the language of the window, from the next time it is opened on."""

from __future__ import annotations

from functools import partial

from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu

from app import translation
from app.shell.actions import Command
from app.shell.context import Shell
from app.translation import tr, tr_noop


def language_command(shell: Shell) -> Command:
    """Return the command whose menu lists the languages there are, each by what it calls itself."""

    def choose(code: str) -> None:
        shell.settings.setValue("language", code)
        words = translation.words_of(code)  # said in the language that was chosen
        told = tr_noop("The window speaks {language} the next time it is opened.")
        shell.tell(words.get(told, told).format(language=translation.NAMES[code]))

    def fill(menu: QMenu) -> None:
        chosen = str(shell.settings.value("language", translation.language()))
        group = QActionGroup(menu)
        for code, name in translation.NAMES.items():
            action = menu.addAction(name, partial(choose, code))
            action.setCheckable(True)
            action.setChecked(code == chosen)
            group.addAction(action)

    return Command("language", "&View", "look", tr("Lan&guage"), fill=fill, study=True)
