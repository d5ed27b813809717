"""The start page of an empty window: import, practice, the sample, recent projects."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QWidget

from app.features.welcome.welcome_page import WelcomeChoice, WelcomePage
from app.project.files import PRACTICE, SAMPLE, Files
from app.project.importing import Importing
from app.project.load import describe_readable_formats
from app.shell.context import Contribution, Shell
from app.shell.places import PanelPlaces
from app.shell.workspace_keeper import Workspaces
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    files, importing, document = shell.services[Files], shell.services[Importing], shell.document
    pages: list[WelcomePage] = []

    def begin() -> None:
        """Lay the page over the graph, or over the large panel if there is none; once there are places."""
        places = shell.services[PanelPlaces]

        def rooms() -> list[QWidget]:
            there = [name for name in ("graph", places.large(), "table") if name in places.docks]
            return [places.dock(name).widget() for name in there]

        choices = (
            WelcomeChoice(
                "import",
                tr("Import clips"),
                tr(
                    "Import a folder of your own motion: {formats}",
                    formats=describe_readable_formats().splitlines()[0],
                ),
                importing.ask_import_folder,
            ),
            WelcomeChoice(
                "practice",
                tr("Practice"),
                tr("152 clips without labels: label them and watch the graph grow"),
                lambda: files.open(PRACTICE, template=True),
            ),
            WelcomeChoice(
                "sample",
                tr("Explore the sample"),
                tr("A finished character that stands, gestures and talks"),
                lambda: files.open(SAMPLE, template=True),
            ),
        )

        def guide() -> None:
            shell.actions["guide"].trigger()

        page = WelcomePage(choices, files, shell.stage.session, document, rooms, guide)
        shell.services[Workspaces].changed.connect(page.follow_soon)
        pages.append(page)

    QTimer.singleShot(0, shell.widget, begin)
    return Contribution()
