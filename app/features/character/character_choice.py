"""Chooses the file the character is drawn from."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QFileDialog, QWidget

from app.project.files import SAMPLE
from app.project.jobs import Jobs
from app.shell.context import Shell
from app.translation import tr, tr_error
from metagraph.common.studio import find_start_folder
from metagraph.graph import edits

OURS = {"Ada": SAMPLE.parent / "ada.glb", "Ben": SAMPLE.parent / "ben.glb"}
RECENT = "character/recent"  # the setting
MOST = 5  # files that are remembered


def ask_character_file(parent: QWidget | None, folder: Path | None) -> Path | None:
    """Ask for a file with a character; None if none is chosen."""
    name, _ = QFileDialog.getOpenFileName(
        parent,
        tr("Choose the character to draw"),
        str(find_start_folder(folder)),
        tr("Characters (*.glb *.gltf *.vrm)"),
    )
    return Path(name) if name else None


def list_recent() -> list[Path]:
    """Return the files that were chosen lately and are still there, the latest first."""
    kept = QSettings().value(RECENT, [])
    names = kept if isinstance(kept, list) else [kept]
    return [Path(name) for name in names if isinstance(name, str) and Path(name).is_file()]


def remember_character(path: Path) -> None:
    """Put a file first among those that were chosen lately."""
    rest = [other for other in list_recent() if other != path]
    QSettings().setValue(RECENT, [str(one) for one in [path, *rest][:MOST]])


def draw_default_body(shell: Shell) -> None:
    """Draw the project with no character of its own."""
    if shell.document.project.character is not None:
        shell.document.edit(tr("Draw the default body"), lambda p: edits.set_character(p, None))


def take_character(shell: Shell, path: Path) -> None:
    """Draw the project with the character of a file, which is read on a thread."""
    from metagraph.formats.characters import CharacterFile, look_at
    from metagraph.formats.project.paths import make_path_relative

    document, jobs = shell.document, shell.jobs
    assert isinstance(jobs, Jobs)
    folder = document.folder
    name = make_path_relative(path, folder) if folder is not None else path.as_posix()
    left, skeleton = document.project.character, document.project.skeleton

    def done(found: CharacterFile) -> None:
        if document.folder != folder or document.project.character != left:
            return
        if found.why_not is not None:
            told = tr(
                "{name} cannot be drawn as a character: its mesh {why}.", name=path.name, why=found.why_not
            )
            shell.tell(told)
            return
        document.edit(tr("Choose character"), found.into)
        for note in found.notes:
            shell.tell(note)

    jobs.start(
        tr("Reading {name}", name=path.name),
        lambda _: look_at(name, folder, skeleton),
        done,
        lambda error: shell.tell(tr_error(error)),
    )
