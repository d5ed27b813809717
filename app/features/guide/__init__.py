"""A guide of two minutes to a first character, in the real window and on a real project."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton, QWidget

from app.project.files import Files
from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.command_table import Feature, bind_commands
from app.shell.context import Contribution, Shell
from app.shell.places import PanelPlaces
from app.shell.workspace_keeper import Workspaces
from app.translation import tr_noop

if TYPE_CHECKING:
    from app.features.guide.guide_line import GuideLine


class GuideFeature(Feature):
    """Makes the line of the guide when it is first asked for."""

    line: GuideLine | None = None

    def begin(self) -> None:
        """Lead to a first character, in a new project if there are clips in this one."""
        if self.document.project.clips:
            files = self.shell.services[Files]
            files.new()
            if self.document.project.clips:  # it was not to be left
                return
        self.shell.services[Workspaces].choose("graph")
        if self.line is None:
            from app.features.guide.guide_line import GuideLine

            window = self.shell.widget
            self.line = GuideLine(self.document, self.session, self.find_part, self.take_samples, window)
            self.line.turned.connect(self.shell.show)
            self.line.left.connect(self._leave)
            window.addToolBarBreak(Qt.ToolBarArea.BottomToolBarArea)  # below the line of an import
            window.addToolBar(Qt.ToolBarArea.BottomToolBarArea, self.line)
            self.document.exported.connect(self.line.notice_export)
        self.shell.services[Importing].guided = True
        self.line.begin()

    def _leave(self) -> None:
        self.shell.services[Importing].guided = False

    def find_part(self, panel: str) -> QWidget | None:
        """Return the panel of an id; for "" the button that exports."""
        if panel:
            return self.shell.services[PanelPlaces].dock(panel)
        return self.shell.widget.findChild(QPushButton, "export button")

    def take_samples(self) -> None:
        from app.features.guide.guide_steps import CLIPS

        self.shell.services[Importing].import_paths([str(path) for path in CLIPS])


COMMANDS = (
    Command(
        "guide",
        "&Help",
        "",
        tr_noop("&First character in two minutes"),
        GuideFeature.begin,
        tip=tr_noop("A guide through importing, labelling, watching and exporting, in this window"),
    ),
)


def contribute(shell: Shell) -> Contribution:
    return Contribution(commands=bind_commands(COMMANDS, GuideFeature(shell)))
