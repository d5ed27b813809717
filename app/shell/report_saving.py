"""Save a report about this program as a text file that the user chooses."""

from __future__ import annotations

import time
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QWidget

from app.translation import tr, tr_error
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically


def save_report(parent: QWidget, report: str) -> str | None:
    """Ask where to save a report, write it, and return what to say of it; None if the user chose no file."""
    name = f"metagraph report {time.strftime('%Y-%m-%d %H.%M')}.txt"
    place, _ = QFileDialog.getSaveFileName(
        parent, tr("Save report"), str(Path.home() / name), tr("Text (*.txt)")
    )
    if not place:
        return None
    try:
        write_atomically(Path(place), report.encode())
    except FileError as error:
        return tr_error(error)
    return tr("Saved {name}. Send it to the people who gave you Metagraph.", name=Path(place).name)
