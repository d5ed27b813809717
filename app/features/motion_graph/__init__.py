"""New motion from takes."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr
from app.widgets.one_dialog import show_one


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.motion_graph.motion_graph_dialog import MotionGraphDialog

        show_one(
            shell.widget,
            MotionGraphDialog,
            lambda: MotionGraphDialog(shell.document, shell.stage.session, shell.jobs, shell.widget),
        )

    return Contribution(
        commands=(
            Command(
                "motion_graph",
                "&Motion",
                "make",
                tr("Motion &graph of takes…"),
                show,
                tip=tr("Assemble new motion from takes, and cut clips from takes"),
                enabled=lambda: bool(shell.document.project.clips),
            ),
        ),
    )
