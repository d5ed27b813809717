"""Breathing, gaze, blinks and lips."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def make() -> QWidget:
        from app.features.life.life_panel import LifePanel

        return LifePanel(shell.document, shell.stage.session, shell.widget)

    return Contribution(
        panels=(
            Panel(
                "life",
                tr("Life"),
                "right below",
                make,
                where={"perform": "side"},
                opens={"talk": "side"},
                imports=("app.features.life.life_panel",),
            ),
        ),
    )
