"""Props: what stands beside the character, and what it carries."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.project.files import Files
from app.project.importing import FileDrop
from app.shell.actions import Command
from app.shell.command_table import Feature, bind_commands, has_skeleton
from app.shell.context import Contribution, Panel, Shell
from app.translation import tr, tr_noop

if TYPE_CHECKING:
    from app.features.props.props_panel import PropsPanel

DROPPED = (".obj", ".stl", ".ply", ".off")  # a GLB that is dropped is a clip or a character


class PropsFeature(Feature):
    """Makes the panel, and does the command."""

    def make_panel(self) -> QWidget:
        from app.features.props.props_panel import PropsPanel

        shell = self.shell
        return PropsPanel(self.document, self.session, shell.stage.figures, shell.jobs, shell.widget)

    def ask(self) -> None:
        if not self.shell.services[Files].refuse():
            self._open().ask()

    def take(self, paths: Sequence[Path]) -> None:
        """Add files that were dropped."""
        if not self.shell.services[Files].refuse():
            self._open().add(paths)

    def _open(self) -> PropsPanel:
        self.shell.show("props")
        found: PropsPanel = self.shell.panel("props")
        return found


def pick_props(paths: Sequence[Path]) -> Sequence[Path]:
    """Return the files that are props, by their names."""
    return [path for path in paths if path.suffix.lower() in DROPPED]


COMMANDS = (
    Command(
        "prop",
        "&File",
        "import",
        tr_noop("Add &props…"),
        PropsFeature.ask,
        enabled=has_skeleton,
        tip=tr_noop("Furniture, walls, things in a hand: OBJ, STL, PLY, OFF or GLB"),
    ),
)


def contribute(shell: Shell) -> Contribution:
    feature = PropsFeature(shell)
    shell.stage.figures.props.told.connect(shell.tell)
    beside = {"label": "below", "graph": "below", "time": "below", "perform": "side", "talk": "side"}
    return Contribution(
        panels=(
            Panel(
                "props",
                tr("Props"),
                "right below",
                feature.make_panel,
                study=False,
                opens=beside,
                rank=8,
                imports=("app.features.props.props_panel",),
            ),
        ),
        commands=bind_commands(COMMANDS, feature),
        drops=(FileDrop(DROPPED, pick_props, feature.take),),
    )
