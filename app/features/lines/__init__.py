"""Lines of dialogue."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import QWidget

from app.project.files import Files
from app.project.importing import FileDrop
from app.project.speech_files import SOUNDS, sort_speech_files
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def make() -> QWidget:
        from app.features.lines.lines_panel import LinesPanel

        panel = LinesPanel(
            shell.document, shell.stage.session, shell.stage.performance, shell.jobs, shell.widget
        )
        panel.told.connect(shell.tell)
        return panel

    def claim(paths: Sequence[Path]) -> Sequence[Path]:
        """What is said, and the words and phones that lie beside it."""
        sounds, transcripts = sort_speech_files(paths)
        return (*sounds, *transcripts) if sounds else ()

    def take(paths: Sequence[Path]) -> None:
        if not shell.services[Files].refuse():
            shell.show("lines")
            shell.panel("lines").add_files(list(sort_speech_files(paths)[0]))

    return Contribution(
        panels=(
            Panel(
                "lines",
                tr("Lines"),
                "bottom",
                make,
                study=False,
                where={"perform": "side"},
                opens={"talk": "side"},
                rank=6,
                imports=("app.features.lines.lines_panel",),
            ),
        ),
        drops=(FileDrop(SOUNDS, claim, take),),
    )
