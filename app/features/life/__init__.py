"""Breathing, gaze, blinks and lips."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def make() -> QWidget:
        from app.features.life.life_panel import LifePanel

        return LifePanel(shell.document, shell.stage.session, shell.widget)

    def find() -> None:
        from app.features.life.hand_contacts import find_hand_contacts

        find_hand_contacts(shell)

    return Contribution(
        commands=(
            Command(
                "hand contacts",
                "&Motion",
                "contacts",
                tr("Find hand c&ontacts"),
                find,
                tip=tr(
                    "Find in all actions where hands touch the body, and keep them there on any character"
                ),
                enabled=lambda: any(shell.document.project.actions()),
                when="meta",
            ),
        ),
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
