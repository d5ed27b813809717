"""New, open, save, import: the document's files as commands, and what is reported about an import."""

from __future__ import annotations

from PySide6.QtCore import Qt

from app.features.files.file_commands import COMMANDS, FileFeature
from app.features.files.project_drop import make_project_drop
from app.shell.command_table import bind_commands
from app.shell.context import Contribution, HeaderItem, Shell


def contribute(shell: Shell) -> Contribution:
    files = FileFeature(shell)
    line = files.make_import_line()
    shell.widget.addToolBar(Qt.ToolBarArea.BottomToolBarArea, line)
    line.hide()
    return Contribution(
        commands=bind_commands(COMMANDS, files),
        header=(HeaderItem("left", "import"), HeaderItem("left", "undo"), HeaderItem("left", "redo")),
        drops=(files.labels.drop, make_project_drop(files.files)),
    )
