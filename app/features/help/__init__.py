"""The manual, what can be done and by which keys, and what this program is."""

from __future__ import annotations

from app.features.help.help_commands import HELP_COMMANDS, HelpFeature
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, Shell


def contribute(shell: Shell) -> Contribution:
    return Contribution(commands=bind_commands(HELP_COMMANDS, HelpFeature(shell)))
