"""The commands of the Edit menu. Each works on the selection, in any panel."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QUndoView, QWidget

from app.shell.actions import Command, Standard
from app.shell.command_table import Feature, has_actions_selected, is_meta_graph_shown
from app.shell.context import Shell
from app.shell.verbs import Verbs
from app.translation import tr, tr_noop

MENU = "&Edit"


class EditingFeature(Feature):
    """Makes the History panel and runs the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.verbs, self.selection = shell.services[Verbs], self.session.selection

    def offer_verbs(self) -> None:
        """Rename several actions at once; copy the properties of one, and paste them."""
        self.verbs.offer(
            "rename", lambda: self._in_graph(len(self.selection.actions) > 1), self.rename_several
        )
        self.verbs.offer(
            "copy", lambda: self._in_graph(len(self.selection.actions) == 1), self.copy_properties
        )
        self.verbs.offer("paste", self.can_paste_properties, self.paste_properties)

    def _in_graph(self, selected: bool) -> bool:
        return selected and is_meta_graph_shown(self)

    def make_history(self) -> QWidget:
        view = QUndoView(self.document.undo_stack, self.shell.widget)
        view.setSpacing(3)
        view.setFrameShape(QFrame.Shape.NoFrame)
        view.setEmptyLabel(tr("Before these steps"))
        view.setWordWrap(True)  # whole steps in a narrow panel
        view.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        view.setResizeMode(QUndoView.ResizeMode.Adjust)
        view.setAccessibleName(tr("Every step so far; click one to go back to it"))
        return view

    # --- what is done with actions

    def rename_several(self) -> None:
        from app.features.editing.batch_dialogs import RenameDialog

        RenameDialog(self.document, self.selection.actions, self.shell.widget).open()

    def replace_clip(self) -> None:
        from app.features.editing.batch_dialogs import ReplaceDialog

        ReplaceDialog(self.document, self.selection.actions, self.shell.widget).open()

    def copy_properties(self) -> None:
        self.selection.copied = self.selection.actions[0]

    def can_paste_properties(self) -> bool:
        copied = self.selection.copied
        there = copied is not None and self.document.project.action(copied) is not None
        return self._in_graph(there and bool(self.selection.actions))

    def paste_properties(self) -> None:
        from app.features.editing.batch_dialogs import PasteDialog

        copied = str(self.selection.copied)
        PasteDialog(self.document, copied, self.selection.actions, self.shell.widget).open()

    # --- the verbs, whatever they mean where the hand is

    def remove(self) -> None:
        self.verbs.do("remove")

    def can_remove(self) -> bool:
        return self.verbs.can("remove")

    def rename(self) -> None:
        self.verbs.do("rename")

    def copy(self) -> None:
        self.verbs.do("copy")
        self.shell.actions.refresh()

    def can_copy(self) -> bool:
        return self.verbs.can("copy")

    def paste(self) -> None:
        self.verbs.do("paste")

    def can_paste(self) -> bool:
        return self.verbs.can("paste")

    def select_all(self) -> None:
        self.verbs.do("select_all")

    def show_history(self) -> None:
        self.shell.show("history")


COMMANDS = (
    Command(
        "history",
        MENU,
        "history",
        tr_noop("&History"),
        EditingFeature.show_history,
        tip=tr_noop("List every step so far; click one to go back to it"),
    ),
    Command(
        "delete",
        MENU,
        "selection",
        tr_noop("&Remove"),
        EditingFeature.remove,
        (Standard.Delete,),
        enabled=EditingFeature.can_remove,
        study=True,
    ),
    Command(
        "rename",
        MENU,
        "selection",
        tr_noop("Re&name…"),
        EditingFeature.rename,
        ("F2",),
        study=True,
        menus=("action",),
    ),
    Command(
        "copy",
        MENU,
        "properties",
        tr_noop("&Copy properties"),
        EditingFeature.copy,
        (Standard.Copy,),
        enabled=EditingFeature.can_copy,
        study=True,
        menus=("action",),
    ),
    Command(
        "paste",
        MENU,
        "properties",
        tr_noop("&Paste properties…"),
        EditingFeature.paste,
        (Standard.Paste,),
        tip=tr_noop("Give the selected actions the copied properties"),
        enabled=EditingFeature.can_paste,
        study=True,
        menus=("action",),
    ),
    Command(
        "replace_clip",
        MENU,
        "properties",
        tr_noop("Replace c&lip…"),
        EditingFeature.replace_clip,
        tip=tr_noop("Use another clip with the same settings"),
        enabled=has_actions_selected,
        when="meta",
        study=True,
        menus=("action",),
    ),
    Command(
        "select_all",
        MENU,
        "find",
        tr_noop("Select &all"),
        EditingFeature.select_all,
        (Standard.SelectAll,),
        study=True,
    ),
)
