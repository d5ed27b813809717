"""What reading clips put right, and what to leave as it is in the files."""

from __future__ import annotations

from collections.abc import Sequence

from app.look.plural import count_clips
from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.shell.notice import Notice
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    document, session, importing, notice = (
        shell.document,
        shell.stage.session,
        shell.services[Importing],
        shell.services[Notice],
    )

    def show(title: str = "", clips: Sequence[str] = (), lines: Sequence[str] = ()) -> None:
        """Show the repairs of the clips given, else of the selected ones, else of all."""
        from app.features.repairs.repairs_dialog import RepairsDialog

        chosen = (
            clips
            or session.selection.clips
            or tuple(a.clip for a in session.selection.selected_actions())
            or tuple(document.project.clips)
        )
        words = title or tr("Repairs of {clips}", clips=count_clips(len(set(chosen))))
        RepairsDialog(document, shell.jobs, words, dict.fromkeys(chosen), lines, shell.widget).show()

    def noticed(title: str, clips: Sequence[str], lines: Sequence[str]) -> None:
        notice.tell(
            tr("Some clips were repaired. Review…"),
            tr("See what was repaired on import, and choose what to leave as it is in the files"),
            lambda: show(title, clips, tuple(lines)),
        )

    importing.noticed.connect(noticed)
    return Contribution(
        commands=(
            Command(
                "repairs",
                "&Edit",
                "properties",
                tr("Repa&irs…"),
                show,
                tip=tr("See what was repaired on import, and choose what to leave as it is"),
                enabled=lambda: bool(document.project.clips),
                menus=("clip",),
            ),
        ),
    )
