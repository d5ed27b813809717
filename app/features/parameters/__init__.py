"""Parameters: the values that a game sets, with live controls."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def make() -> QWidget:
        from app.features.parameters.parameters_panel import ParametersPanel

        return ParametersPanel(shell.document, shell.stage.session, shell.stage.performance, shell.widget)

    beside = {"label": "below", "graph": "below", "time": "below", "perform": "side", "talk": "side"}
    return Contribution(
        panels=(
            Panel(
                "parameters",
                tr("Parameters"),
                "right below",
                make,
                study=False,
                opens=beside,
                rank=9,
                imports=("app.features.parameters.parameters_panel",),
            ),
        ),
    )
