"""Roles and body parts of the joints."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.skeleton.skeleton_dialog import SkeletonDialog

        SkeletonDialog(shell.document, shell.stage.session, shell.widget).open()

    return Contribution(
        commands=(
            Command(
                "skeleton",
                "&Graph",
                "skeleton",
                tr("S&keleton…"),
                show,
                tip=tr("Roles and body parts of the joints"),
                enabled=lambda: shell.document.project.skeleton is not None,
            ),
        ),
    )
