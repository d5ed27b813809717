"""Notes on the project, its actions and its clips."""

from __future__ import annotations

from app.features.notes.notes_panel import NotesPanel
from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def write() -> None:
        shell.show("notes")
        shell.panel("notes").text.setFocus()

    return Contribution(
        panels=(
            Panel(
                "notes",
                tr("Notes"),
                "right below",
                lambda: NotesPanel(shell.document, shell.stage.session, shell.widget),
                study=False,
                opens={
                    "label": "below",
                    "graph": "below",
                    "time": "below",
                    "perform": "side",
                    "talk": "side",
                },
                rank=7,
            ),
        ),
        commands=(
            Command(
                "note",
                "&Edit",
                "properties",
                tr("N&ote…"),
                write,
                ("Ctrl+Shift+O",),
                tip=tr("Write a note on the selected action or clip, or on the project"),
                menus=("action", "clip"),
            ),
        ),
    )
