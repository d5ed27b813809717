"""The state machine drawn by hand: an editor in the meta-graph's place, and an inspector in that of the
properties.
"""

from __future__ import annotations

from app.features.manual.manual_feature import COMMANDS, ManualFeature
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    manual = ManualFeature(shell)
    manual.offer_verbs()
    return Contribution(
        panels=(
            Panel(
                "manual",
                tr("Manual state machine"),
                "centre",
                manual.make_editor,
                when="manual",
                instead_of="graph",
            ),
            Panel(
                "inspector",
                tr("Properties"),
                "right below",
                lambda: manual.editor.inspector,
                when="manual",
                instead_of="properties",
            ),
        ),
        commands=bind_commands(COMMANDS, manual),
    )
