"""Stances and actions from other projects: a whole project file, or what was copied in another window."""

from __future__ import annotations

from app.features.taking.taking_commands import COMMANDS, TakingFeature
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, Shell


def contribute(shell: Shell) -> Contribution:
    return Contribution(commands=bind_commands(COMMANDS, TakingFeature(shell)))
