"""The clips of the project."""

from __future__ import annotations

from PySide6.QtWidgets import QApplication

from app.features.library.clip_commands import commands
from app.features.library.library_panel import LibraryPanel
from app.project.importing import Importing
from app.shell.actions import Command, Standard
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verbs
from app.stage.problem_watch import ProblemWatch
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    session, importing, verbs = shell.stage.session, shell.services[Importing], shell.services[Verbs]

    def make() -> LibraryPanel:
        problems = shell.services[ProblemWatch]
        panel = LibraryPanel(
            shell.document, session, shell.stage.thumbnails, shell.widget, lambda: problems.problems
        )
        problems.changed.connect(panel.problems_changed)
        panel.acts.row_actions = shell.actions.of_menu("clip")
        panel.acts.label_actions = shell.actions.of_menu("clip label")
        panel.import_wanted.connect(importing.ask_import_folder)
        panel.files_dropped.connect(lambda paths: importing.import_paths(list(paths)))
        return panel

    def library() -> LibraryPanel:
        panel: LibraryPanel = shell.panel("library")
        return panel

    verbs.offer(
        "remove",
        lambda: bool(session.selection.clips),
        lambda: library().acts.remove(session.selection.clips),
        rank=6,
    )
    verbs.offer(
        "rename",
        lambda: len(session.selection.clips) == 1,
        lambda: library().acts.rename(session.selection.clips[0]),
        rank=0,
    )
    verbs.offer(
        "select_all",
        lambda: library().isAncestorOf(QApplication.focusWidget() or shell.widget),
        lambda: library().list.selectAll(),
        rank=0,
    )
    return Contribution(
        panels=(
            Panel(
                "library",
                tr("Clips"),
                "left",
                make,
                late=False,
                where={"label": "large", "graph": "list"},
                opens={"time": "list"},
                least=(200, 180),
            ),
        ),
        commands=(
            Command(
                "find",
                "&Edit",
                "find",
                tr("&Find clip"),
                lambda: library().search.setFocus(),
                (Standard.Find,),
                study=True,
            ),
            *commands(shell, library),
        ),
    )
