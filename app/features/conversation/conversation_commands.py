"""What the menus offer to do with the conversation on stage; dialogs are imported when they are first wanted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QFileDialog, QInputDialog

from app.project.speech_files import SOUNDS, TRANSCRIPTS, beside, kinds_of
from metagraph.errors import FileError
from metagraph.graph import conversing
from metagraph.graph.conversation import Conversation
from metagraph.graph.edits import EditError

if TYPE_CHECKING:
    from app.shell.window import Window

FILTER = f"Sounds and transcripts ({' '.join(f'*{s} *{s.upper()}' for s in (*SOUNDS, *TRANSCRIPTS))} *.TextGrid);;All files (*)"
ELAN, TEXTGRID = "ELAN annotation (*.eaf)", "Praat TextGrid (*.TextGrid)"


def on_stage(window: Window) -> tuple[str, Conversation] | None:
    """Return the conversation on stage with its id."""
    ident = window.session.conversation or ""
    found = window.document.project.conversations.get(ident)
    return (ident, found) if found is not None else None


def converse(window: Window, paths: Sequence[Path] = ()) -> None:
    """Open the dialog on sounds and transcripts; without any they are asked for."""
    if window.files.closed:
        window.tell(window.files.closed)
        return
    if not paths:
        start = str(window.document.folder or Path.home())
        names, _ = QFileDialog.getOpenFileNames(window, "Conversation from sound: one file, or one for each of the two", start, FILTER)
        paths = [Path(n) for n in names]
    sounds, transcripts = kinds_of(paths)
    if not sounds:
        if paths:
            window.tell(f"There is no sound among these files. Sounds are {', '.join(SOUNDS)}.")
        return
    from app.features.conversation.conversation_dialog import ImportDialog

    dialog = ImportDialog(window.document, window.session, window.jobs, sounds[:2], transcripts or beside(sounds[:2]), window)
    dialog.imported.connect(lambda: window.show_dock("conversation"))
    dialog.open()


def rename(window: Window) -> None:
    found = on_stage(window)
    if found is not None:
        name, ok = QInputDialog.getText(window, "Rename conversation", "Name", text=found[1].name)
        if ok and name.strip():
            _edit(window, "Rename conversation", lambda p: conversing.change_conversation(p, found[0], name=name))


def remove(window: Window) -> None:
    found = on_stage(window)
    if found is not None:
        _edit(window, "Remove conversation", lambda p: conversing.remove_conversation(p, found[0]))
        window.tell(f"Removed '{found[1].name}'. Undo brings it back; its sound files stay where they are.")


def rates(window: Window) -> None:
    found = on_stage(window)
    if found is not None:
        from app.features.conversation.conversation_settings import RatesDialog

        RatesDialog(window.document, *found, window).open()


def graph_again(window: Window) -> None:
    """Let the graph move both again."""
    found = on_stage(window)
    if found is not None:
        both = lambda p: conversing.change_side(conversing.change_side(p, found[0], 0, motion=None), found[0], 1, motion=None)  # noqa: E731
        _edit(window, "Move with the graph again", both)


def word_lists(window: Window) -> None:
    found = on_stage(window)
    if found is not None:
        from app.features.conversation.conversation_settings import WordsDialog

        WordsDialog(window.document, *found, window).open()


def side_sounds(window: Window) -> None:
    found = on_stage(window)
    if found is not None:
        from app.features.conversation.conversation_settings import SidesDialog

        SidesDialog(window.document, *found, window).open()


def write_segments(window: Window) -> None:
    """Ask where to, and write the segments of the conversation on stage."""
    found = on_stage(window)
    if found is None:
        return
    start = (window.document.folder or Path.home()) / f"{found[1].name}.eaf"
    name, kind = QFileDialog.getSaveFileName(window, "Export segments", str(start), f"{ELAN};;{TEXTGRID}")
    if not name:
        return
    path = Path(name)
    if path.suffix.lower() not in (".eaf", ".textgrid"):
        path = path.with_name(path.name + (".TextGrid" if kind == TEXTGRID else ".eaf"))
    from metagraph.formats.conversation_writers import write_elan, write_textgrid

    try:
        if path.suffix.lower() == ".textgrid":
            write_textgrid(found[1], path)
        else:
            write_elan(found[1], path, window.document.folder)
    except (FileError, OSError) as error:
        window.tell(str(error))
        return
    window.tell(f"Wrote {path.name}")


def _edit(window: Window, text: str, function: object) -> None:
    try:
        window.document.edit(text, function)  # type: ignore[arg-type]
    except EditError as error:
        window.tell(str(error))
