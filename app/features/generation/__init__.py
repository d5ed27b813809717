"""Motion that is learned from takes and made from speech."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr
from app.widgets.one_dialog import show_one


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.generation.generation_dialog import GenerationDialog

        show_one(
            shell.widget,
            GenerationDialog,
            lambda: GenerationDialog(shell.document, shell.stage.session, shell.jobs, shell.widget),
        )

    return Contribution(
        commands=(
            Command(
                "generate_motion",
                "&Motion",
                "make",
                tr("&Generate…"),
                show,
                tip=tr("Train a model on takes of people who talk, and move characters with it"),
            ),
        ),
    )
