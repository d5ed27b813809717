"""Which clip enters and leaves which stance without a jump, as a table."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.stage.compatibility_state import Compatibility
from app.translation import tr
from app.widgets.beside import stand_beside
from app.widgets.one_dialog import show_one


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.compatibility.matrix_dialog import MatrixDialog

        def make() -> MatrixDialog:
            dialog = MatrixDialog(
                shell.document,
                shell.stage.session,
                shell.services[Compatibility],
                shell.jobs,
                shell.widget,
            )
            stand_beside(dialog, shell.panel("character"))  # what is clicked plays there
            return dialog

        show_one(shell.widget, MatrixDialog, make)

    return Contribution(
        commands=(
            Command(
                "compatibility",
                "&View",
                "graph",
                tr("&Compatibility…"),
                show,
                ("Ctrl+K",),
                tip=tr("Show which clips begin and end in which stance without a jump"),
                enabled=lambda: bool(shell.document.project.clips),
                when="meta",
                study="labels",
            ),
        ),
    )
