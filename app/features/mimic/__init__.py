"""Keypoints of a person, mimicked."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def mimic() -> None:
        from app.features.mimic.mimic_dialog import open_keypoints

        open_keypoints(shell)

    can = lambda: shell.document.project.skeleton is not None and shell.stage.performance.live.stage is None  # noqa: E731
    return Contribution(
        commands=(
            Command(
                "mimic",
                "&Motion",
                "make",
                tr("Mimic &keypoints…"),
                mimic,
                tip=tr("Make the character copy the stances of a person on video"),
                enabled=can,
                when="meta",
            ),
        ),
    )
