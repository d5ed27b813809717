"""Writing a performance as video, contact sheet or motion."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def render() -> None:
        from app.features.render.render_dialog import RenderDialog

        RenderDialog(shell.stage.performance, shell.stage.session, shell.jobs, shell.widget).open()

    return Contribution(
        commands=(
            Command("render", "&File", "write", tr("&Write performance…"), render, ("Ctrl+R",),
                    tip=tr("Save a video with sound, a contact sheet, or a motion file"),
                    enabled=lambda: shell.document.project.skeleton is not None, when="meta"),
        ),
    )  # fmt: skip
