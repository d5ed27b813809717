"""The state machine drawn by hand: an editor in the meta-graph's place, and an inspector in that of the
properties.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QPointF

from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verb, Verbs
from app.stage.problem_watch import ProblemWatch
from app.translation import tr
from metagraph.formats.imports import Imported

if TYPE_CHECKING:
    from app.features.manual.manual_editor import ManualEditor


def contribute(shell: Shell) -> Contribution:
    stage, document, session = shell.stage, shell.document, shell.stage.session
    importing, problems, verbs = (
        shell.services[Importing],
        shell.services[ProblemWatch],
        shell.services[Verbs],
    )
    here = lambda: session.onstage.mode == "manual"  # noqa: E731

    def scrolled() -> None:
        if here():  # hidden, it follows the layer, too
            stage.scrolled.emit()

    def make() -> ManualEditor:
        from app.features.manual.manual_canvas import ManualCanvas
        from app.features.manual.manual_editor import ManualEditor

        canvas = ManualCanvas(document, session, stage.performance, stage.thumbnails, shell.widget)
        canvas.refused.connect(stage.refused)
        canvas.viewed.connect(scrolled)
        canvas.files_dropped.connect(lambda paths, at: importing.import_paths(list(paths), at))
        out = ManualEditor(canvas, shell.widget)
        problems.changed.connect(lambda: out.show_problems(problems.problems))
        out.show_problems(problems.problems)
        return out

    def editor() -> ManualEditor:
        found: ManualEditor = shell.panel("manual")
        return found

    def imported(result: Imported, place: object) -> None:
        load = importing.load_for(result)
        if isinstance(place, QPointF) and load.clips:
            editor().canvas.place(load.clips, place)

    def begin() -> None:
        if here():
            editor().canvas.setFocus()

    def rename() -> None:
        shell.show("inspector")
        field = editor().inspector.name
        field.setFocus()
        field.selectAll()

    def offer(verb: Verb, applies: Any = here) -> None:
        def do() -> None:
            from app.features.manual import manual_commands

            getattr(manual_commands, verb)(editor().canvas)

        verbs.offer(verb, lambda: here() and applies(), do, rank=1)

    drawn = lambda: bool(session.selection.states or session.selection.links)  # noqa: E731
    offer(
        "remove", lambda: drawn() and not session.selection.clips
    )  # what is selected in the library is the library's to remove
    offer("copy", drawn)
    offer("paste")
    offer("select_all")
    verbs.offer("rename", lambda: here() and len(session.selection.states) == 1, rename, rank=1)
    importing.imported.connect(imported)
    session.onstage.mode_changed.connect(begin)
    return Contribution(
        panels=(
            Panel("manual", tr("Manual state machine"), "centre", make, when="manual", instead_of="graph"),
            Panel(
                "inspector",
                tr("Properties"),
                "right below",
                lambda: editor().inspector,
                when="manual",
                instead_of="properties",
            ),
        ),
        commands=(
            Command(
                "manual",
                "&Graph",
                "author",
                tr("&Manual state machine"),
                lambda: session.set_mode("meta" if here() else "manual"),
                checked=here,
                tip=tr("Draw states and links one by one, as in the engines' editors"),
            ),
        ),
    )
