"""Mirrored twins of clips and actions."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    session = shell.stage.session

    def make() -> None:
        from app.features.twins.mirrored_twins import make_twins

        make_twins(shell)

    return Contribution(
        commands=(
            Command(
                "twins",
                "&Edit",
                "properties",
                tr("Make &mirrored twins"),
                make,
                tip=tr("Mirror the selection to the other side, as new clips and actions"),
                enabled=lambda: bool(session.selection.clips or session.selection.actions),
                when="meta",
                menus=("action", "clip"),
            ),
        ),
    )
