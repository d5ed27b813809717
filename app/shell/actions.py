"""Every command of the window as data: one table makes the menus, the toolbar, the shortcuts and the shortcut list."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

Standard = QKeySequence.StandardKey


@dataclass(frozen=True)
class Command:
    """id: stable. menu: which menu, "-" before the text draws a line above. keys: shortcuts. enabled: when it can be used."""

    id: str
    menu: str
    text: str
    run: Callable[[], object]
    keys: tuple[str | QKeySequence.StandardKey, ...] = ()
    tip: str = ""
    icon: str = ""
    enabled: Callable[[], bool] | None = None
    checked: Callable[[], bool] | None = None
    line: bool = False


class Actions:
    """The window's QActions by command id. `refresh` enables and checks them as things are now. allowed: which may be used at all."""

    def __init__(self, parent: QWidget, commands: tuple[Command, ...]) -> None:
        self.commands = commands
        self.allowed: Callable[[str], bool] | None = None
        self.by_id: dict[str, QAction] = {}
        for command in commands:
            action = QAction(command.text, parent)
            action.setObjectName(command.id)
            if command.keys:
                # A platform's standard key may be the one that is given beside it; twice, it would be ambiguous.
                action.setShortcuts(list(dict.fromkeys(QKeySequence(k).toString() for k in command.keys)))
            keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
            tip = command.tip or command.text.replace("&", "").rstrip("…")
            action.setToolTip(f"{tip} ({keys})" if keys else tip)
            action.setStatusTip(command.tip)
            action.setCheckable(command.checked is not None)
            action.triggered.connect(lambda _=False, run=command.run: run())
            parent.addAction(action)
            self.by_id[command.id] = action

    def __getitem__(self, ident: str) -> QAction:
        return self.by_id[ident]

    def fill(self, bar: QMenuBar) -> dict[str, QMenu]:
        """Make the menus, in the order in which the table first names them."""
        menus: dict[str, QMenu] = {}
        for command in self.commands:
            if command.menu not in menus:
                menus[command.menu] = bar.addMenu(command.menu)
            if command.line:
                menus[command.menu].addSeparator()
            menus[command.menu].addAction(self.by_id[command.id])
        return menus

    def refresh(self) -> None:
        for command in self.commands:
            action = self.by_id[command.id]
            allowed = self.allowed is None or self.allowed(command.id)
            action.setEnabled(allowed and (command.enabled is None or command.enabled()))
            if command.checked is not None:
                action.setChecked(command.checked())
