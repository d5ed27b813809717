"""Programs, such as language models, that edit the open project while a person watches and allows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QWidget

from app.look import icons
from app.look.theme import get_theme
from app.shell.actions import Command
from app.shell.command_table import Feature, bind_commands
from app.shell.context import Contribution, HeaderItem, Shell
from app.translation import tr, tr_error, tr_noop, tr_plural
from app.typed_command import list_program_words, quote_command

if TYPE_CHECKING:
    from app.authoring.agent_door import AgentDoor


class AgentsFeature(Feature):
    """Opens and closes the door for programs."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.door: AgentDoor | None = None
        self.button: AgentsButton | None = None

    def is_open(self) -> bool:
        return self.door is not None and self.door.is_open

    def can_open(self) -> bool:
        return self.document.path is not None and not self.document.read_only

    def switch(self) -> None:
        """Let programs edit, or no longer."""
        if self.is_open():
            self.close()
            return
        door = self._make_door()
        try:
            door.open()
        except (OSError, ValueError) as error:
            self._show()
            self.document.failed.emit(tr("Agents cannot edit: {error}", error=tr_error(error)))
            return
        self.shell.tell(tr("Agents may edit this project: {command}", command=self._command()))

    def close(self) -> None:
        """Let no program edit any more."""
        if self.door is not None:
            self.door.close()

    def make_button(self, parent: QWidget) -> QWidget:
        room = QWidget(parent)  # a bar would not show again what was hidden in it
        layout = QHBoxLayout(room)
        layout.setContentsMargins(0, 0, 0, 0)
        self.button = AgentsButton(self, room)
        layout.addWidget(self.button)
        self.button.refresh()
        return room

    def _command(self) -> str:
        """Return what a program is started by that works on the open project."""
        name = self.document.path.name if self.document.path is not None else ""
        return quote_command([*list_program_words(), "author", name])

    def _make_door(self) -> AgentDoor:
        from app.authoring.agent_door import AgentDoor

        self.door = AgentDoor(self.document, self.shell.widget)
        self.door.changed.connect(self._show)
        self.door.edited.connect(self.shell.tell)
        return self.door

    def _show(self) -> None:
        if self.door is not None and not self.door.is_open:
            self.door.deleteLater()
            self.door = None
        if self.button is not None:
            self.button.refresh()
        self.shell.actions.refresh_soon()


class AgentsButton(QToolButton):
    """Shows that programs may edit, and how many are connected; pressing it forbids it."""

    def __init__(self, feature: AgentsFeature, parent: QWidget) -> None:
        super().__init__(parent)
        self._feature = feature
        self.setToolTip(tr("Programs on this computer may edit the project. Click to forbid it."))
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.clicked.connect(feature.close)

    def refresh(self) -> None:
        """Show how many programs there are now."""
        door = self._feature.door
        count = door.count if door is not None else 0
        some = tr_plural("{count:,} agent edits", "{count:,} agents edit", count)
        self.setText(some if count else tr("Agents may edit"))
        look = get_theme(self._feature.session.look.name)
        self.setIcon(icons.make_icon("warning" if count else "done", look.warning if count else look.dim))
        self.setVisible(self._feature.is_open())


COMMANDS = (
    Command(
        "agents",
        "&File",
        "kept",
        tr_noop("Let a&gents edit"),
        AgentsFeature.switch,
        tip=tr_noop("Let programs on this computer edit this project, step by step, while you watch"),
        enabled=AgentsFeature.can_open,
        checked=AgentsFeature.is_open,
    ),
)


def contribute(shell: Shell) -> Contribution:
    feature = AgentsFeature(shell)
    return Contribution(
        commands=bind_commands(COMMANDS, feature),
        header=(HeaderItem("right", feature.make_button),),
        close=feature.close,
    )
