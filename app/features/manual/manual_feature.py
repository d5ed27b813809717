"""The editor of the manual state machine in its window: what is dropped on it, and what verbs mean there."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF

from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.command_table import (
    Condition,
    Feature,
    has_clips_selected,
    require_all,
    require_any,
    require_not,
)
from app.shell.context import Shell
from app.shell.verbs import Verb, Verbs
from app.stage.problem_watch import ProblemWatch
from app.translation import tr_noop
from metagraph.formats.imports import Imported

if TYPE_CHECKING:
    from app.features.manual.manual_editor import ManualEditor


class ManualFeature(Feature):
    """Makes the editor, and does the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.importing = shell.services[Importing]
        self.importing.imported.connect(self.place_imported)
        self.session.onstage.mode_changed.connect(self.take_focus)

    @property
    def editor(self) -> ManualEditor:
        found: ManualEditor = self.shell.panel("manual")
        return found

    def make_editor(self) -> ManualEditor:
        from app.features.manual.manual_canvas import ManualCanvas
        from app.features.manual.manual_editor import ManualEditor

        stage, widget, problems = self.shell.stage, self.shell.widget, self.shell.services[ProblemWatch]
        canvas = ManualCanvas(self.document, self.session, stage.performance, stage.thumbnails, widget)
        canvas.refused.connect(stage.refused)
        canvas.viewed.connect(self.tell_scrolled)
        canvas.files_dropped.connect(lambda paths, at: self.importing.import_paths(list(paths), at))
        editor = ManualEditor(canvas, widget)
        problems.changed.connect(lambda: editor.show_problems(problems.problems))
        editor.show_problems(problems.problems)
        return editor

    def tell_scrolled(self) -> None:
        if is_manual_shown(self):  # hidden, it follows the layer, too
            self.shell.stage.scrolled.emit()

    def place_imported(self, result: Imported, place: object) -> None:
        """Make states of what was dropped on the canvas, once it is read."""
        load = self.importing.load_for(result)
        if isinstance(place, QPointF) and load.clips:
            self.editor.canvas.place(load.clips, place)

    def take_focus(self) -> None:
        if is_manual_shown(self):
            self.editor.canvas.setFocus()

    def toggle(self) -> None:
        self.session.set_mode("meta" if is_manual_shown(self) else "manual")

    def rename(self) -> None:
        self.shell.show("inspector")
        field = self.editor.inspector.name
        field.setFocus()
        field.selectAll()

    def do(self, verb: Verb) -> None:
        """Do one of `manual_commands`."""
        from app.features.manual import manual_commands

        do = {
            "remove": manual_commands.remove_selected,
            "copy": manual_commands.copy,
            "paste": manual_commands.paste_here,
            "select_all": manual_commands.select_all,
        }
        do[verb](self.editor.canvas)

    def offer_verbs(self) -> None:
        for verb, applies in VERBS.items():
            do = self.rename if verb == "rename" else partial(self.do, verb)
            self.shell.services[Verbs].offer(verb, partial(applies, self), do, rank=1)


def is_manual_shown(feature: Feature) -> bool:
    return feature.session.onstage.mode == "manual"


def has_states_selected(feature: Feature) -> bool:
    return bool(feature.session.selection.states)


def has_one_state_selected(feature: Feature) -> bool:
    return len(feature.session.selection.states) == 1


def has_links_selected(feature: Feature) -> bool:
    return bool(feature.session.selection.links)


drawn = require_all(is_manual_shown, require_any(has_states_selected, has_links_selected))
VERBS: dict[Verb, Condition] = {
    "remove": require_all(
        drawn, require_not(has_clips_selected)
    ),  # a clip of the library is the library's to remove
    "copy": drawn,
    "paste": is_manual_shown,
    "select_all": is_manual_shown,
    "rename": require_all(is_manual_shown, has_one_state_selected),
}
COMMANDS = (
    Command(
        "manual",
        "&Graph",
        "author",
        tr_noop("&Manual state machine"),
        ManualFeature.toggle,
        checked=is_manual_shown,
        tip=tr_noop("Draw states and links by hand, as in the editors of game engines"),
    ),
)
