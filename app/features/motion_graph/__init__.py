"""New motion from takes."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.motion_graph.motion_graph_dialog import MotionGraphDialog

        widget = shell.widget
        dialog = widget.findChild(MotionGraphDialog) or MotionGraphDialog(
            shell.document, shell.stage.session, shell.jobs, widget
        )
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()

    return Contribution(
        commands=(
            Command(
                "motion_graph",
                "&Graph",
                "author",
                "Motion &graph of takes…",
                show,
                tip="New motion from takes, and clips cut from them",
                enabled=lambda: bool(shell.document.project.clips),
            ),
        ),
    )
