"""Proposals for clips, looked through and accepted."""

from __future__ import annotations

from app.project.learned import Learned
from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    document, session = shell.document, shell.stage.session

    def label() -> None:
        from app.features.labelling.review_dialog import ReviewDialog

        stage, learned = shell.stage, shell.services[Learned]
        ReviewDialog(
            document, session, shell.jobs, stage.figures, learned, stage.thumbnails, shell.widget
        ).show()

    def patterns() -> None:
        from app.features.labelling.patterns_dialog import PatternsDialog

        PatternsDialog(document, session, shell.services[Learned], shell.widget).open()

    return Contribution(
        commands=(
            Command(
                "propose",
                "&Graph",
                "author",
                tr("&Label clips…"),
                label,
                ("Ctrl+P",),
                tip=tr("Propose a label for each clip from its name and motion"),
                enabled=lambda: any(clip not in document.project.uses for clip in document.project.clips),
                when="meta",
                study="labels",
            ),
            Command(
                "patterns",
                "&Graph",
                "author",
                tr("Name &patterns…"),
                patterns,
                tip=tr("Set what words in clip names mean"),
                when="meta",
                study="labels",
            ),
        ),
    )
