"""Timing studies with people, and counting what hands do."""

from __future__ import annotations

from app.features.study.operator_counting import OperatorCounting
from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    counting = shell.services.add(OperatorCounting(shell))

    def run() -> None:
        """Lead a participant through a timing study; which and who is asked."""
        from app.features.study.study_chooser import run_study

        run_study(shell)

    return Contribution(
        commands=(
            Command(
                "study",
                "&Study",
                "",
                tr("&Run a study…"),
                run,
                tip=tr("Guide a participant through a timing study"),
            ),
            Command(
                "count_operators",
                "&Study",
                "",
                tr("&Count operators"),
                counting.toggle,
                checked=lambda: counting.on,
                tip=tr("Count keystrokes, pointing, clicks and drags live"),
            ),
        ),
    )
