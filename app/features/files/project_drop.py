"""A project that is dropped on the window opens in it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QTimer

from app.project.files import Files
from app.project.importing import FileDrop
from app.translation import tr
from metagraph.formats.store import SUFFIX


def make_project_drop(files: Files) -> FileDrop:
    """Return what opens a project that is dropped. It opens alone: clips that are dropped with it would come
    into the project that it replaces.
    """

    def claim(paths: Sequence[Path]) -> Sequence[Path]:
        return list(paths) if any(path.name.lower().endswith(SUFFIX) for path in paths) else []

    def take(paths: Sequence[Path]) -> None:
        if len(paths) > 1:
            files.told.emit(tr("A project opens alone. Drop the other files after it."))
        else:  # the questions about unsaved edits come after the drop, which a file manager waits for
            QTimer.singleShot(0, files, partial(files.open, paths[0]))

    return FileDrop((SUFFIX,), claim, take)
