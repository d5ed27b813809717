"""The commands of the Conversation menu. The code behind them is imported when the first one runs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QMenu, QWidget

from app.project.files import Files
from app.project.importing import FileDrop
from app.project.speech_files import SOUNDS, is_conversation, sort_speech_files
from app.shell.actions import Command
from app.shell.command_table import Feature, is_conversation_staged
from app.translation import tr_noop
from metagraph.graph.conversation.model import Conversation

MENU = "&Conversation"
SHORT = "conversation"  # the panel's own menu


class ConversationFeature(Feature):
    """Makes the Conversation panel and runs the commands of this module."""

    def make_panel(self) -> QWidget:
        from app.features.conversation.conversation_panel import ConversationPanel

        shell = self.shell
        panel = ConversationPanel(self.document, self.session, shell.jobs, self.performance, shell.widget)
        panel.files_dropped.connect(self.converse)
        panel.view.more = self.edit_sounds
        panel.add.clicked.connect(lambda: self.converse())
        panel.more_menu.addActions(shell.actions.of_menu(SHORT))
        panel.more_menu.aboutToShow.connect(shell.actions.refresh)
        return panel

    def drop(self) -> FileDrop:
        """Return what happens when sounds are dropped on the window."""
        return FileDrop(SOUNDS, self._claim, self._take)

    def _claim(self, paths: Sequence[Path]) -> Sequence[Path]:
        sounds, transcripts = sort_speech_files(paths)
        mine = (*sounds, *transcripts)
        return mine if sounds and is_conversation(mine) else ()

    def _take(self, paths: Sequence[Path]) -> None:
        if not self.shell.services[Files].refuse():
            self.converse(paths)

    def talk(self) -> Conversation | None:
        """The conversation on stage."""
        return self.document.project.conversations.get(self.session.onstage.conversation or "")

    def do(self, name: str) -> None:
        """Run one of `conversation_commands`."""
        from app.features.conversation import conversation_commands

        getattr(conversation_commands, name)(self.shell)

    def converse(self, paths: Sequence[Path] = ()) -> None:
        from app.features.conversation import conversation_commands

        conversation_commands.ask_for_conversation(self.shell, paths)

    def edit_sounds(self) -> None:
        self.do("edit_side_sounds")

    def fill_partners(self, menu: QMenu) -> None:
        """Fill the menu of characters, body language and voices."""
        from app.features.conversation.partner_menu import fill_all

        if self.talk() is not None:
            fill_all(menu, self.document, str(self.session.onstage.conversation), self.edit_sounds)

    def show_next_side(self) -> None:
        """Show the plan of the next speaker."""
        talk, onstage = self.talk(), self.session.onstage
        onstage.set_side((onstage.side + 1) % (len(talk.sides) if talk is not None else 2))

    def keep_as_performances(self) -> None:
        self.performance.keep_conversation()

    def moves_without_graph(self) -> bool:
        """Whether a speaker on stage moves with generated motion instead of a graph."""
        talk = self.talk()
        return talk is not None and any(side.motion is not None for side in talk.sides)


COMMANDS = (
    Command(
        "converse",
        MENU,
        "read",
        tr_noop("Conversation from &sound…"),
        ConversationFeature.converse,
        menus=(SHORT,),
        tip=tr_noop("Read the speech of two or more people, and move one character for each"),
    ),
    Command(
        "rename_conversation",
        MENU,
        "settings",
        tr_noop("Re&name conversation…"),
        partial(ConversationFeature.do, name="rename_conversation"),
        enabled=is_conversation_staged,
        menus=(SHORT,),
    ),
    Command(
        "rates",
        MENU,
        "settings",
        tr_noop("&Rates…"),
        partial(ConversationFeature.do, name="edit_rates"),
        enabled=is_conversation_staged,
        tip=tr_noop("How often each speaker gestures and nods"),
        menus=(SHORT,),
    ),
    Command(
        "word_lists",
        MENU,
        "settings",
        tr_noop("&Word lists…"),
        partial(ConversationFeature.do, name="edit_word_lists"),
        enabled=is_conversation_staged,
        tip=tr_noop("Choose which words count as responses and which as hesitations"),
        menus=(SHORT,),
    ),
    Command(
        "side_sounds",
        MENU,
        "settings",
        tr_noop("S&ounds and names…"),
        ConversationFeature.edit_sounds,
        enabled=is_conversation_staged,
        tip=tr_noop("Set the speakers, their sounds and where they stand"),
        menus=(SHORT,),
    ),
    Command(
        "partners",
        MENU,
        "settings",
        tr_noop("C&haracters and voices"),
        fill=ConversationFeature.fill_partners,
        enabled=is_conversation_staged,
        tip=tr_noop("Change the character, body language or voice of each speaker"),
    ),
    Command(
        "other_side",
        MENU,
        "stage",
        tr_noop("&Next speaker's plan"),
        ConversationFeature.show_next_side,
        enabled=is_conversation_staged,
        tip=tr_noop("Show the plan of the next speaker in the timeline"),
    ),
    Command(
        "graph_again",
        MENU,
        "stage",
        tr_noop("Use the &graph's motion"),
        partial(ConversationFeature.do, name="use_graph_again"),
        enabled=ConversationFeature.moves_without_graph,
        tip=tr_noop("Stop using the new motion that was assembled for this conversation"),
    ),
    Command(
        "keep_conversation",
        MENU,
        "stage",
        tr_noop("&Keep as performances"),
        ConversationFeature.keep_as_performances,
        enabled=is_conversation_staged,
        tip=tr_noop(
            "Turn what each speaker does into a performance with requests that you can edit and export"
        ),
    ),
    Command(
        "write_segments",
        MENU,
        "write",
        tr_noop("&Export conversation…"),
        partial(ConversationFeature.do, name="write_segments"),
        enabled=is_conversation_staged,
        tip=tr_noop("Save the segments as ELAN or Praat TextGrid"),
        menus=(SHORT,),
    ),
    Command(
        "remove_conversation",
        MENU,
        "remove",
        tr_noop("Remove conversation"),
        partial(ConversationFeature.do, name="remove_shown_conversation"),
        enabled=is_conversation_staged,
        menus=(SHORT,),
    ),
)
