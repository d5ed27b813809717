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
    from app.features.props.placing import Placing
    from app.features.props.props_panel import PropsPanel

DROPPED = (".obj", ".stl", ".ply", ".off", ".3mf")  # a GLB that is dropped is a clip or a character


class PropsFeature(Feature):
    """Makes the panel, and does the command. Takes the mouse in the view once there are props."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self._hand: object = None
        self._placing: Placing | None = None

    @property
    def placing(self) -> Placing:
        """Which prop is chosen."""
        from app.features.props.placing import Placing

        if self._placing is None:
            self._placing = Placing(self.document, self.shell.widget)
        return self._placing

    def follow(self) -> None:
        """Let the mouse take props in the view, from the first prop on."""
        if self._hand is None and self.document.project.props:
            from app.features.props.view_hand import PropHand

            props = self.shell.stage.figures.props
            self._hand = PropHand(self.shell.panel("character"), self.placing, props)

    def make_panel(self) -> QWidget:
        from app.features.props.props_panel import PropsPanel

        shell = self.shell
        return PropsPanel(self.session, shell.stage.figures, shell.jobs, self.placing, shell.widget)

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
        tip=tr_noop("Furniture, walls, things in a hand: OBJ, STL, PLY, OFF, 3MF or GLB"),
    ),
)


def contribute(shell: Shell) -> Contribution:
    feature = PropsFeature(shell)
    shell.stage.figures.props.told.connect(shell.tell)
    shell.stage.figures.props.changed.connect(feature.follow)
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
