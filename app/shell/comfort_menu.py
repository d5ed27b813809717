"""The menu of what makes the window easier to see and calmer."""

from __future__ import annotations

from functools import partial

from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu

from app.look.comfort import SIZES, get_comfort, set_comfort
from app.shell.actions import Command
from app.shell.context import Shell
from app.translation import tr


def make_comfort_command(shell: Shell) -> Command:
    """Return the command whose menu has high contrast, reduced motion and the sizes of text."""
    look = shell.stage.session.look

    def toggle(on: bool, name: str) -> None:
        set_comfort(**{name: on})
        if name == "still" and on:
            shell.stage.session.transport.set_playing(False)
        look.changed.emit()

    def resize(size: int) -> None:
        set_comfort(size=size)
        shell.tell(tr("This holds from the next start on."))

    def fill(menu: QMenu) -> None:
        now = get_comfort()
        white = tr("Black on white, or white on black in the dark theme")
        for name, words, tip, on in (
            ("contrast", tr("&High contrast"), white, now.contrast),
            ("still", tr("&Reduced motion"), tr("Nothing plays until you ask for it"), now.still),
        ):
            action = menu.addAction(words)
            action.setCheckable(True)
            action.setChecked(on)
            action.setToolTip(tip)
            action.toggled.connect(lambda on, name=name: toggle(on, name))
        menu.setToolTipsVisible(True)
        menu.addSeparator()
        group = QActionGroup(menu)
        for size in SIZES:
            action = menu.addAction(tr("Text and controls at {size} %", size=size), partial(resize, size))
            action.setCheckable(True)
            action.setChecked(size == now.size)
            group.addAction(action)

    return Command("comfort", "&Help", "", tr("&Accessibility"), fill=fill)
