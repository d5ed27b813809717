"""The Conversation panel: lanes of sound, words and segments."""

from __future__ import annotations

from app.features.conversation.conversation_menu import COMMANDS, ConversationFeature
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    conversation = ConversationFeature(shell)
    return Contribution(
        panels=(
            Panel(
                "conversation",
                tr("Conversation"),
                "bottom",
                conversation.make_panel,
                study=False,
                least=(400, 222),
                where={"talk": "below"},
                rank=1,
                imports=("app.features.conversation.conversation_panel",),
            ),
        ),
        commands=bind_commands(COMMANDS, conversation),
        drops=(conversation.drop(),),
    )
