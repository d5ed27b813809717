"""Those who talk: lanes of sound, words and segments."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtWidgets import QMenu, QWidget

from app.project.files import Files
from app.project.importing import FileDrop
from app.project.speech_files import SOUNDS, converses, kinds_of
from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    session, performance = shell.stage.session, shell.stage.performance

    def run(name: str) -> Callable[[], None]:
        """Return what does one of the commands; they are imported when the first of them is wanted."""

        def call() -> None:
            from app.features.conversation import conversation_commands

            getattr(conversation_commands, name)(shell)

        return call

    def converse(paths: Sequence[Path] = ()) -> None:
        from app.features.conversation import conversation_commands

        conversation_commands.converse(shell, paths)

    def claim(paths: Sequence[Path]) -> Sequence[Path]:
        sounds, transcripts = kinds_of(paths)
        mine = (*sounds, *transcripts)
        return mine if sounds and converses(mine) else ()

    def take(paths: Sequence[Path]) -> None:
        if not shell.services[Files].refuse():
            converse(paths)

    def make() -> QWidget:
        from app.features.conversation.conversation_panel import ConversationPanel

        panel = ConversationPanel(shell.document, session, shell.jobs, shell.stage.performance, shell.widget)
        panel.files_dropped.connect(converse)
        panel.view.more = run("side_sounds")
        panel.add.clicked.connect(lambda: converse())
        panel.more_menu.addActions(shell.actions.of_menu("conversation"))
        panel.more_menu.aboutToShow.connect(shell.actions.refresh)
        return panel

    def partners(menu: QMenu) -> None:
        """Fill the menu of who is drawn, moved and heard how."""
        from app.features.conversation.partner_menu import fill_all

        ident = session.onstage.conversation
        if ident in shell.document.project.conversations:
            fill_all(menu, shell.document, str(ident), run("side_sounds"))

    def replaced() -> bool:
        """Whether somebody on stage moves with new motion instead of a graph."""
        talk = shell.document.project.conversations.get(session.onstage.conversation or "")
        return talk is not None and any(side.motion is not None for side in talk.sides)

    def next_side() -> None:
        """Show the plan of the next of those who talk."""
        talk = shell.document.project.conversations.get(session.onstage.conversation or "")
        session.onstage.set_side((session.onstage.side + 1) % (len(talk.sides) if talk is not None else 2))

    staged = lambda: session.onstage.conversation is not None  # noqa: E731
    menu, mine = "&Conversation", ("conversation",)
    return Contribution(
        panels=(
            Panel(
                "conversation",
                tr("Conversation"),
                "bottom",
                make,
                study=False,
                least=(400, 222),
                where={"talk": "below"},
                rank=1,
                imports=("app.features.conversation.conversation_panel",),
            ),
        ),
        commands=(
            Command(
                "converse",
                menu,
                "read",
                tr("Conversation from &sound…"),
                converse,
                menus=mine,
                tip=tr("Read what two or more say, and let a character each move with it"),
            ),
            Command(
                "rename_conversation",
                menu,
                "settings",
                tr("Re&name conversation…"),
                run("rename"),
                enabled=staged,
                menus=mine,
            ),
            Command(
                "rates",
                menu,
                "settings",
                tr("&Rates…"),
                run("rates"),
                enabled=staged,
                tip=tr("How often each gestures and nods"),
                menus=mine,
            ),
            Command(
                "word_lists",
                menu,
                "settings",
                tr("&Word lists…"),
                run("word_lists"),
                enabled=staged,
                tip=tr("Which words are responses, which hesitations"),
                menus=mine,
            ),
            Command(
                "side_sounds",
                menu,
                "settings",
                tr("S&ounds and names…"),
                run("side_sounds"),
                enabled=staged,
                tip=tr("Who talks, which sound is whose, and where each stands"),
                menus=mine,
            ),
            Command(
                "partners",
                menu,
                "settings",
                tr("C&haracters and voices"),
                enabled=staged,
                tip=tr("Another character, body or voice for each who talks"),
                fill=partners,
            ),
            Command(
                "other_side",
                menu,
                "stage",
                tr("The &other's plan"),
                next_side,
                enabled=staged,
                tip=tr("Whose plan the timeline shows: of several the next one's"),
            ),
            Command(
                "graph_again",
                menu,
                "stage",
                tr("Move with the &graph again"),
                run("graph_again"),
                enabled=replaced,
                tip=tr("Instead of new motion that was found for it"),
            ),
            Command(
                "keep_conversation",
                menu,
                "stage",
                tr("&Keep as performances"),
                performance.keep_conversation,
                enabled=staged,
                tip=tr("What all of them do, as requests that can be edited one by one, and exported"),
            ),
            Command(
                "write_segments",
                menu,
                "write",
                tr("&Export segments…"),
                run("write_segments"),
                enabled=staged,
                tip=tr("As ELAN or Praat TextGrid"),
                menus=mine,
            ),
            Command(
                "remove_conversation",
                menu,
                "remove",
                tr("Remove conversation"),
                run("remove"),
                enabled=staged,
                menus=mine,
            ),
        ),
        drops=(FileDrop(SOUNDS, claim, take),),
    )
