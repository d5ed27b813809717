"""What the menus offer to do with the conversation on stage; dialogs are imported when they are first
wanted.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QFileDialog, QInputDialog

from app.project.document import Edit
from app.project.files import Files
from app.project.speech_files import SOUNDS, TRANSCRIPTS, find_transcripts_beside, sort_speech_files
from app.translation import tr, tr_error, tr_phrase
from metagraph.common.studio import find_start_folder
from metagraph.errors import FileError
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import MOST_SPEAKERS, Conversation
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from app.shell.context import Shell


def _filter() -> str:
    return tr(
        "Sounds and transcripts ({names} *.TextGrid);;All files (*)",
        names=" ".join(f"*{s} *{s.upper()}" for s in (*SOUNDS, *TRANSCRIPTS)),
    )


def get_conversation(shell: Shell) -> tuple[str, Conversation] | None:
    """Return the conversation on stage with its id."""
    ident = shell.stage.session.onstage.conversation or ""
    found = shell.document.project.conversations.get(ident)
    return (ident, found) if found is not None else None


def ask_for_conversation(shell: Shell, paths: Sequence[Path] = ()) -> None:
    """Open the dialog on sounds and transcripts; without any they are asked for."""
    if shell.services[Files].refuse():
        return
    if not paths:
        start = str(find_start_folder(shell.document.folder))
        names, _ = QFileDialog.getOpenFileNames(
            shell.widget,
            tr("Conversation from sound: one file, or one file for each speaker"),
            start,
            _filter(),
        )
        paths = [Path(n) for n in names]
    sounds, transcripts = sort_speech_files(paths)
    if not sounds:
        if paths:
            shell.tell(
                tr("None of these files is a sound. Choose sounds ({names}).", names=", ".join(SOUNDS))
            )
        return
    from app.features.conversation.conversation_dialog import ImportDialog

    dialog = ImportDialog(
        shell.document,
        shell.stage.session,
        shell.jobs,
        sounds[:MOST_SPEAKERS],
        transcripts or find_transcripts_beside(sounds[:MOST_SPEAKERS]),
        shell.widget,
    )
    dialog.imported.connect(lambda: shell.show("conversation"))
    dialog.open()


def rename_conversation(shell: Shell) -> None:
    found = get_conversation(shell)
    if found is not None:
        name, ok = QInputDialog.getText(
            shell.widget, tr("Rename conversation"), tr("Name"), text=found[1].name
        )
        if ok and name.strip():
            _edit(
                shell,
                tr("Rename conversation"),
                lambda p: conversation_edits.change_conversation(p, found[0], name=name),
            )


def remove_shown_conversation(shell: Shell) -> None:
    found = get_conversation(shell)
    if found is not None:
        _edit(shell, tr("Remove conversation"), lambda p: conversation_edits.remove_conversation(p, found[0]))
        shell.tell(
            tr(
                "Removed '{name}'. Undo restores it. Its sound files were not deleted.",
                name=found[1].name,
            )
        )


def edit_rates(shell: Shell) -> None:
    found = get_conversation(shell)
    if found is not None:
        from app.features.conversation.conversation_settings import SideRatesDialog

        SideRatesDialog(shell.document, *found, shell.stage.performance, shell.widget).open()


def use_graph_again(shell: Shell) -> None:
    """Let the graph move all who talk again."""
    found = get_conversation(shell)
    if found is not None:

        def everyone(project: Project) -> Project:
            for side in range(len(found[1].sides)):
                project = conversation_edits.change_side(project, found[0], side, motion=None)
            return project

        _edit(shell, tr("Use the graph's motion"), everyone)


def edit_word_lists(shell: Shell) -> None:
    found = get_conversation(shell)
    if found is not None:
        from app.features.conversation.word_lists import WordsDialog

        WordsDialog(shell.document, *found, shell.widget).open()


def edit_side_sounds(shell: Shell) -> None:
    found = get_conversation(shell)
    if found is not None:
        from app.features.conversation.sides_dialog import SidesDialog

        SidesDialog(shell.document, *found, shell.widget).open()


def write_segments(shell: Shell) -> None:
    """Ask where to, and write the segments of the conversation on stage."""
    found = get_conversation(shell)
    if found is None:
        return
    from metagraph.formats.conversations.output_kinds import (
        CONVERSATION_OUTPUTS,
        find_conversation_output,
        write_conversation,
    )

    start = find_start_folder(shell.document.folder) / f"{found[1].name}.eaf"
    endings = {f"{tr_phrase(kind.name)} (*{kind.ending})": kind.ending for kind in CONVERSATION_OUTPUTS}
    name, chosen = QFileDialog.getSaveFileName(
        shell.widget, tr("Export conversation"), str(start), ";;".join(endings)
    )
    if not name:
        return
    path = Path(name)
    if find_conversation_output(path) is None:
        path = path.with_name(path.name + endings.get(chosen, ".eaf"))
    try:
        write_conversation(found[1], path, shell.document.folder)
    except (FileError, OSError) as error:
        shell.tell(tr_error(error))
        return
    shell.tell(tr("Wrote {name}", name=path.name))


def _edit(shell: Shell, text: str, function: Edit) -> None:
    try:
        shell.document.edit(text, function)
    except EditError as error:
        shell.tell(tr_error(error))
