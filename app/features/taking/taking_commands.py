"""Commands that copy stances and actions between projects and windows."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QApplication, QFileDialog

from app.look.theme import get_theme
from app.project.files import Files
from app.project.jobs import WindowJob
from app.shell.actions import Command
from app.shell.command_table import Feature, has_actions_selected, require_any
from app.shell.context import Shell
from app.translation import tr, tr_noop, tr_plural
from metagraph.common.studio import find_start_folder
from metagraph.formats.store import SUFFIX

if TYPE_CHECKING:
    from metagraph.formats.project.pieces import ProjectPiece


class TakingFeature(Feature):
    """Does the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.files, self.selection = shell.services[Files], self.session.selection

    def ask_project(self) -> None:
        if self.files.refuse():
            return
        chosen, _ = QFileDialog.getOpenFileName(
            self.shell.widget,
            tr("Import a project"),
            str(find_start_folder(self.document.folder)),
            tr("Projects (*{suffix});;All files (*)", suffix=SUFFIX),
        )
        if chosen:
            self.read(Path(chosen))

    def read(self, path: Path) -> None:
        """Read a project beside the window, and offer what is in it."""
        from metagraph.formats.project.pieces import read_other_project

        into = self.document.path

        def work(job: WindowJob) -> ProjectPiece:
            return read_other_project(path, into, job.tell)

        self.shell.jobs.start(
            tr("Reading {name}", name=path.name),
            work,
            lambda piece: self.offer(path.name.removesuffix(SUFFIX), piece),
            self.files.show_failure,
        )

    def offer(self, name: str, piece: ProjectPiece) -> None:
        """Show what can be imported. name: the name of the source."""
        from app.features.taking.taking_dialog import TakingDialog

        shell, look = self.shell, get_theme(self.session.look.name)
        TakingDialog(self.document, shell.jobs, piece, name, look, shell.widget).open()

    def copy(self) -> None:
        """Copy the selected actions, or else the stance in view with all that is placed on it."""
        from metagraph.formats.project.pieces import encode_piece

        actions, stance = self.selection.actions, self.session.place.stance()
        stances = () if actions or stance is None else (stance,)
        text = encode_piece(self.document.project, self.document.folder, actions, stances)
        QApplication.clipboard().setText(text)
        self.shell.tell(
            tr_plural(
                "Copied {count:,} action. Paste it in another window.",
                "Copied {count:,} actions. Paste them in another window.",
                len(actions),
            )
            if actions
            else tr("Copied the stance and everything placed on it. Paste it in another window.")
        )
        self.shell.actions.refresh()

    def paste(self) -> None:
        from metagraph.formats.project.pieces import is_piece, read_piece

        if self.files.refuse():
            return
        text, into = QApplication.clipboard().text(), self.document.path
        if not is_piece(text):
            self.shell.tell(tr("Copy stances or actions in another window first."))
            return

        def work(job: WindowJob) -> ProjectPiece:
            return read_piece(text, into)

        name = tr("the other window")
        self.shell.jobs.start(
            tr("Reading the clipboard"), work, lambda piece: self.offer(name, piece), self.files.show_failure
        )


def find_stance_in_view(feature: TakingFeature) -> bool:
    return bool(feature.session.place.stance())


COMMANDS = (
    Command(
        "import_project",
        "&File",
        "import",
        tr_noop("Import &project…"),
        TakingFeature.ask_project,
        tip=tr_noop("Import stances and actions of another project, with their clips"),
    ),
    Command(
        "copy_over",
        "&Edit",
        "properties",
        tr_noop("Copy to an&other project"),
        TakingFeature.copy,
        ("Ctrl+Alt+C",),
        tip=tr_noop("Copy the selected actions, or else the visible stance with everything placed on it"),
        enabled=require_any(has_actions_selected, find_stance_in_view),
        when="meta",
        menus=("action",),
    ),
    Command(
        "paste_over",
        "&Edit",
        "properties",
        tr_noop("Paste &from another project…"),
        TakingFeature.paste,
        ("Ctrl+Alt+V",),
        tip=tr_noop("Paste what was copied in another window, with its clips"),
        when="meta",
    ),
)
