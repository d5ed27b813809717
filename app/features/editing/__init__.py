"""Remove, rename, copy, paste, select all: each means what is selected, wherever that is; several actions are
renamed at once. And the history of all that was done.
"""

from __future__ import annotations

from app.features.editing.editing_commands import COMMANDS, EditingFeature
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    editing = EditingFeature(shell)
    editing.offer_verbs()
    return Contribution(
        panels=(
            Panel(
                "history",
                tr("History"),
                "right below",
                editing.make_history,
                study=False,
                opens={"label": "below", "graph": "list", "time": "list", "perform": "side", "talk": "side"},
                rank=8,
            ),
        ),
        commands=bind_commands(COMMANDS, editing),
    )
