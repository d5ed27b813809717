"""The panel in which the character plays, its transport, and which character it is."""

from __future__ import annotations

from app.features.character.character_commands import COMMANDS, CharacterFeature
from app.features.character.watch_commands import WATCH_COMMANDS, WatchFeature
from app.project.files import Files
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    character = CharacterFeature(shell)
    shell.services[Files].opened.connect(lambda: character.panel.frame_all())
    return Contribution(
        panels=(
            Panel(
                "character",
                tr("Character"),
                "right",
                character.make_panel,
                late=False,
                where={
                    "graph": "side",
                    "label": "side",
                    "time": "large",
                    "perform": "large",
                    "talk": "large",
                },
                least=(300, 230),
            ),
        ),
        commands=(*bind_commands(COMMANDS, character), *bind_commands(WATCH_COMMANDS, WatchFeature(shell))),
        close=character.close,
    )
