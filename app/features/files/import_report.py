"""Shows what is reported about an import, or about opening a project."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMessageBox

from app.shell.context import Shell
from app.translation import tr

LINES = 6  # of a report that are shown at once


def show_report(shell: Shell, title: str, lines: Sequence[str]) -> None:
    """Show the first lines of a report, and all of it on demand."""
    box = QMessageBox(
        QMessageBox.Icon.Information, "Metagraph", title, QMessageBox.StandardButton.Ok, shell.widget
    )
    more = tr("\n… and {count} more", count=len(lines) - LINES) if len(lines) > LINES else ""
    box.setInformativeText("\n".join(lines[:LINES]) + more)
    if more:
        box.setDetailedText("\n".join(lines))
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.open()
