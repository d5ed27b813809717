"""Which clip enters and leaves which stance without a jump, as a table."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.stage.compatibility_state import Compatibility
from app.widgets.beside import stand_beside


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.compatibility.matrix_dialog import MatrixDialog

        widget, stage = shell.widget, shell.stage
        dialog = widget.findChild(MatrixDialog)
        if dialog is None:
            dialog = MatrixDialog(
                shell.document, stage.session, shell.services[Compatibility], shell.jobs, widget
            )
            stand_beside(dialog, shell.panel("character"))  # what is clicked plays there
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()

    return Contribution(
        commands=(
            Command(
                "compatibility",
                "&View",
                "graph",
                "&Compatibility…",
                show,
                ("Ctrl+K",),
                tip="Which clip enters and leaves which stance without a jump",
                enabled=lambda: bool(shell.document.project.clips),
                when="meta",
                study="labels",
            ),
        ),
    )
