"""All actions and clips as a table, to edit many at once as in a spreadsheet."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verbs
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def make() -> QWidget:
        from app.features.table.table_panel import TablePanel

        return TablePanel(shell.document, shell.stage.session, shell.services[Verbs], shell.widget)

    def show() -> None:
        shell.show("table")
        shell.panel("table").take_focus()

    return Contribution(
        panels=(
            Panel(
                "table",
                tr("Table"),
                "bottom",
                make,
                when="meta",
                study=False,
                opens={"label": "large", "graph": "large"},
                rank=8,
                least=(240, 120),
                imports=("app.features.table.table_panel",),
            ),
        ),
        commands=(
            Command(
                "table",
                "&Graph",
                "author",
                tr("&Table"),
                show,
                ("Ctrl+T",),
                tip=tr("Edit many actions and clips at once: type, fill down, paste from a spreadsheet"),
                when="meta",
            ),
        ),
    )
