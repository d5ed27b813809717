"""Stances and actions from other projects: a whole project file, or what was copied in another window."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QApplication, QFileDialog

from app.look.theme import theme
from app.project.files import Files
from app.project.jobs import Job
from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr
from metagraph.formats.store import SUFFIX

if TYPE_CHECKING:
    from metagraph.formats.project_pieces import Piece


def contribute(shell: Shell) -> Contribution:
    document, session, files = shell.document, shell.stage.session, shell.services[Files]

    def look_at(name: str, piece: Piece) -> None:
        from app.features.taking.taking_dialog import TakingDialog

        look = theme(session.look.name)
        TakingDialog(document, shell.jobs, piece, name, look, shell.widget).open()

    def ask_project() -> None:
        if files.refuse():
            return
        chosen, _ = QFileDialog.getOpenFileName(
            shell.widget,
            tr("Import a project"),
            str(document.folder or Path.home()),
            tr("Projects (*{suffix});;All files (*)", suffix=SUFFIX),
        )
        if chosen:
            read(Path(chosen))

    def read(path: Path) -> None:
        from metagraph.formats.project_pieces import read_other_project

        into = document.path

        def work(job: Job) -> Piece:
            return read_other_project(path, into, job.tell)

        shell.jobs.start(
            tr("Reading {name}", name=path.name),
            work,
            lambda piece: look_at(path.name.removesuffix(SUFFIX), piece),
            files.show_failure,
        )

    def chosen_stances() -> tuple[str, ...]:
        stance = session.place.stance()
        return () if session.selection.actions or stance is None else (stance,)

    def copy() -> None:
        from metagraph.formats.project_pieces import piece_text

        actions, stances = session.selection.actions, chosen_stances()
        text = piece_text(document.project, document.folder, actions, stances)
        QApplication.clipboard().setText(text)
        shell.tell(
            tr("Copied {count} actions; paste them in another window", count=len(actions))
            if actions
            else tr("Copied the stance and all that is placed on it; paste it in another window")
        )
        shell.actions.refresh()

    def paste() -> None:
        from metagraph.formats.project_pieces import is_piece, read_piece

        if files.refuse():
            return
        text, into = QApplication.clipboard().text(), document.path
        if not is_piece(text):
            shell.tell(tr("Copy stances or actions in another window first"))
            return

        def work(job: Job) -> Piece:
            return read_piece(text, into)

        name = tr("the other window")
        shell.jobs.start(
            tr("Reading the clipboard"), work, lambda piece: look_at(name, piece), files.show_failure
        )

    return Contribution(
        commands=(
            Command(
                "import_project",
                "&File",
                "import",
                tr("Import &project…"),
                ask_project,
                tip=tr("Stances and actions of another project, with their clips"),
            ),
            Command(
                "copy_over",
                "&Edit",
                "properties",
                tr("Copy to an&other project"),
                copy,
                ("Ctrl+Alt+C",),
                tip=tr("The selected actions, or else the stance in view with all that is placed on it"),
                enabled=lambda: bool(session.selection.actions or session.place.stance()),
                when="meta",
                menus=("action",),
            ),
            Command(
                "paste_over",
                "&Edit",
                "properties",
                tr("Paste &from another project…"),
                paste,
                ("Ctrl+Alt+V",),
                tip=tr("What was copied in another window, with its clips"),
                when="meta",
            ),
        ),
    )
