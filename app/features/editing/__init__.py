"""Remove, rename, copy, paste, select all: each means what is selected, wherever that is; several actions are
renamed at once. And the history of all that was done.
"""

from __future__ import annotations

from PySide6.QtWidgets import QFrame, QUndoView, QWidget

from app.shell.actions import Command, Standard
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verbs
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    verbs, session, document = shell.services[Verbs], shell.stage.session, shell.document
    meta = lambda: session.onstage.mode == "meta"  # noqa: E731

    def rename_several() -> None:
        from app.features.editing.batch_dialogs import RenameDialog

        RenameDialog(document, session.selection.actions, shell.widget).open()

    def replace() -> None:
        from app.features.editing.batch_dialogs import ReplaceDialog

        ReplaceDialog(document, session.selection.actions, shell.widget).open()

    def copy() -> None:
        session.selection.copied = session.selection.actions[0]

    def can_paste() -> bool:
        return (
            meta()
            and bool(session.selection.actions)
            and session.selection.copied is not None
            and document.project.action(session.selection.copied) is not None
        )

    def paste() -> None:
        from app.features.editing.batch_dialogs import PasteDialog

        PasteDialog(document, str(session.selection.copied), session.selection.actions, shell.widget).open()

    verbs.offer("rename", lambda: meta() and len(session.selection.actions) > 1, rename_several)
    verbs.offer("copy", lambda: meta() and len(session.selection.actions) == 1, copy)
    verbs.offer("paste", can_paste, paste)

    def do_copy() -> None:
        verbs.do("copy")
        shell.actions.refresh()

    def history() -> QWidget:
        view = QUndoView(document.undo_stack, shell.widget)
        view.setSpacing(3)
        view.setFrameShape(QFrame.Shape.NoFrame)
        view.setEmptyLabel(tr("As it was opened"))
        view.setAccessibleName(tr("What was done; a click goes back to it"))
        return view

    return Contribution(
        panels=(
            Panel(
                "history",
                tr("History"),
                "right below",
                history,
                study=False,
                opens={"label": "below", "graph": "list", "time": "list", "perform": "side", "talk": "side"},
                rank=8,
            ),
        ),
        commands=(
            Command(
                "history",
                "&Edit",
                "history",
                tr("&History"),
                lambda: shell.show("history"),
                tip=tr("What was done, step by step; a click goes back to it"),
            ),
            Command(
                "delete",
                "&Edit",
                "selection",
                tr("&Remove"),
                lambda: verbs.do("remove"),
                (Standard.Delete,),
                enabled=lambda: verbs.can("remove"),
                study=True,
            ),
            Command(
                "rename",
                "&Edit",
                "selection",
                tr("Re&name…"),
                lambda: verbs.do("rename"),
                ("F2",),
                study=True,
                menus=("action",),
            ),
            Command(
                "copy",
                "&Edit",
                "properties",
                tr("&Copy properties"),
                do_copy,
                (Standard.Copy,),
                enabled=lambda: verbs.can("copy"),
                study=True,
                menus=("action",),
            ),
            Command(
                "paste",
                "&Edit",
                "properties",
                tr("&Paste properties…"),
                lambda: verbs.do("paste"),
                (Standard.Paste,),
                tip=tr("Give the selected actions what another one has"),
                enabled=lambda: verbs.can("paste"),
                study=True,
                menus=("action",),
            ),
            Command(
                "replace_clip",
                "&Edit",
                "properties",
                tr("Replace c&lip…"),
                replace,
                tip=tr("Another clip, the same settings"),
                enabled=lambda: bool(session.selection.actions),
                when="meta",
                study=True,
                menus=("action",),
            ),
            Command(
                "select_all",
                "&Edit",
                "find",
                tr("Select &all"),
                lambda: verbs.do("select_all"),
                (Standard.SelectAll,),
                study=True,
            ),
        ),
    )
