"""What follows what: models learned from annotations."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import QWidget

from app.project.files import Files
from app.project.importing import FileDrop
from app.project.load import ANNOTATIONS
from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    def annotate(path: str = "") -> None:
        from app.features.models.annotation_dialog import open_annotation

        open_annotation(shell, path)

    def claim(paths: Sequence[Path]) -> Sequence[Path]:
        return [p for p in paths if p.suffix.lower() == ANNOTATIONS]

    def take(paths: Sequence[Path]) -> None:
        if not shell.services[Files].refuse():
            annotate(str(paths[0]))  # one dialog is enough

    def make() -> QWidget:
        from app.features.models.models_panel import ModelsPanel

        panel = ModelsPanel(shell.document, shell.stage.session, shell.jobs, shell.widget)
        panel.learn_wanted.connect(annotate)
        return panel

    return Contribution(
        panels=(
            Panel(
                "models",
                tr("Models"),
                "bottom",
                make,
                study=False,
                opens={"talk": "below"},
                imports=("app.features.models.models_panel",),
            ),
        ),
        commands=(
            Command(
                "annotate",
                "&File",
                "import",
                tr("Import &annotation…"),
                annotate,
                tip=tr("Learn a model from an ELAN file: which action follows which"),
                when="meta",
            ),
        ),
        drops=(FileDrop((ANNOTATIONS,), claim, take),),
    )
