"""A person in a video, before a camera or in keypoints, mimicked."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def mimic() -> None:
        from app.features.mimic.mimic_dialog import open_keypoints

        open_keypoints(shell)

    def mimic_camera() -> None:
        from app.features.mimic.mimic_dialog import open_camera

        open_camera(shell)

    can = lambda: shell.document.project.skeleton is not None and shell.stage.performance.live.stage is None  # noqa: E731
    return Contribution(
        commands=(
            Command(
                "mimic",
                "&Motion",
                "make",
                tr("Mimic a &person…"),
                mimic,
                tip=tr("Make the character copy the stances of a person in a video or in keypoints"),
                enabled=can,
                when="meta",
            ),
            Command(
                "mimic_camera",
                "&Motion",
                "make",
                tr("Mimic from &camera…"),
                mimic_camera,
                tip=tr("Film yourself, and make the character copy your stances"),
                enabled=can,
                when="meta",
            ),
        ),
    )
