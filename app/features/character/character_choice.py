"""Chooses the file the character is drawn from."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog

from app.shell.context import Shell
from app.translation import tr, tr_error
from metagraph.common.studio import find_start_folder


def choose_character(shell: Shell) -> None:
    """Ask which file the character is drawn from; it is read on a thread."""
    document = shell.document
    name, _ = QFileDialog.getOpenFileName(
        shell.widget,
        tr("Choose the character to draw"),
        str(find_start_folder(document.folder)),
        tr("Characters (*.glb *.gltf *.vrm)"),
    )
    if not name:
        return
    from metagraph.formats.characters import CharacterFile, look_at
    from metagraph.formats.project.paths import make_path_relative

    folder = document.folder
    path = make_path_relative(Path(name), folder) if folder is not None else Path(name).as_posix()
    left, skeleton = document.project.character, document.project.skeleton

    def done(found: CharacterFile) -> None:
        if document.folder != folder or document.project.character != left:
            return
        if found.why_not is not None:
            shell.tell(
                tr(
                    "{name} cannot be drawn as a character: its mesh {why}.",
                    name=Path(name).name,
                    why=found.why_not,
                )
            )
            return
        document.edit(tr("Choose character"), found.into)
        for note in found.notes:
            shell.tell(note)

    shell.jobs.start(
        tr("Reading {name}", name=Path(name).name),
        lambda _: look_at(path, folder, skeleton),
        done,
        lambda error: shell.tell(tr_error(error)),
    )
