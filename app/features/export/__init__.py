"""Exporting for engines."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton, QWidget

from app.shell.actions import Command
from app.shell.context import Contribution, HeaderItem, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    document, session = shell.document, shell.stage.session

    def export() -> None:
        from app.features.export.export_dialog import ExportDialog
        from app.project.finish_typing import finish_typing

        finish_typing()
        ExportDialog(document, shell.jobs, shell.widget, session.onstage.mode == "manual").open()

    def something() -> bool:
        return any(True for _ in document.project.actions()) or any(
            m.states for m in document.project.manual.values()
        )

    return Contribution(
        commands=(
            Command(
                "export",
                "&File",
                "write",
                tr("&Export…"),
                export,
                ("Ctrl+E",),
                icon="export",
                tip=tr("Export JSON and GLB for game engines"),
                enabled=something,
            ),
        ),
        header=(HeaderItem("right", lambda parent: ExportButton(shell, parent)),),
    )


class ExportButton(QPushButton):
    """The way out, always in sight."""

    def __init__(self, shell: Shell, parent: QWidget) -> None:
        super().__init__(tr("Export"), parent)
        action = shell.actions["export"]
        self.setToolTip(action.toolTip())
        self.setObjectName("export button")
        self.setProperty("strong", True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.clicked.connect(action.trigger)
        action.enabledChanged.connect(self.setEnabled)
        self.setEnabled(action.isEnabled())
