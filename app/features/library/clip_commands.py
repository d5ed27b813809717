"""The commands of the clips' menu: marks, views, groups, and what is done with files."""

from __future__ import annotations

from functools import partial

from PySide6.QtWidgets import QApplication

from app.features.library.clip_columns import format_stars
from app.features.library.clip_groups import GROUPS
from app.features.library.clip_sizes import Style
from app.features.library.library_bar import BUTTONS
from app.features.library.library_panel import LibraryPanel
from app.look.domain_words import COLOR_LABELS
from app.project.importing import Importing
from app.shell.actions import Command, Standard
from app.shell.command_table import Feature, bind_commands, has_clips_selected
from app.shell.verbs import Verbs
from app.stage.problem_watch import ProblemWatch
from app.translation import tr, tr_noop, tr_plural
from metagraph.graph.clip_mark import COLORS, STARS

MENU = "C&lips"
SHOW_AS: dict[Style, str] = {"cards": tr_noop("Show as cards"), "columns": tr_noop("Show as columns")}
GROUP_BY = {
    "none": tr_noop("No groups"),
    "folder": tr_noop("Group by folder"),
    "stance": tr_noop("Group by stance"),
    "tag": tr_noop("Group by tag"),
    "layer": tr_noop("Group by layer"),
    "kind": tr_noop("Group by kind"),
}


class LibraryFeature(Feature):
    """Makes the panel of the clips, and does the commands of this module."""

    @property
    def panel(self) -> LibraryPanel:
        found: LibraryPanel = self.shell.panel("library")
        return found

    def make_panel(self) -> LibraryPanel:
        shell, importing = self.shell, self.shell.services[Importing]
        problems = shell.services[ProblemWatch]
        panel = LibraryPanel(
            self.document, self.session, shell.stage.thumbnails, shell.widget, lambda: problems.problems
        )
        problems.changed.connect(panel.problems_changed)
        panel.acts.row_actions = shell.actions.of_menu("clip")
        panel.acts.label_actions = shell.actions.of_menu("clip label")
        panel.import_wanted.connect(importing.ask_import_folder)
        panel.files_dropped.connect(lambda paths: importing.import_paths(list(paths)))
        return panel

    @property
    def clips(self) -> tuple[str, ...]:
        """The selected clips."""
        return self.session.selection.clips

    def has_focus(self) -> bool:
        return self.panel.isAncestorOf(QApplication.focusWidget() or self.shell.widget)

    def find(self) -> None:
        self.shell.services[Verbs].do("find")

    def search(self) -> None:
        self.panel.search.setFocus()

    def select_all(self) -> None:
        self.panel.list.selectAll()

    def remove(self) -> None:
        self.panel.acts.remove(self.clips)

    def rename(self) -> None:
        self.panel.acts.rename(self.clips[0])

    def mark(self, field: str, value: object) -> None:
        self.panel.acts.mark(self.clips, field, value)

    def favour(self) -> None:
        self.panel.acts.favour(self.clips)

    def duplicate(self) -> None:
        self.panel.acts.duplicate(self.clips)

    def reveal(self) -> None:
        self.panel.acts.reveal(self.clips[0])

    def show_as(self, style: Style) -> None:
        self.panel.show_as(style)

    def shows_as(self, style: Style) -> bool:
        return self.panel.list.style_of == style

    def group_by(self, group: str) -> None:
        self.panel.group_by(group)

    def groups_by(self, group: str) -> bool:
        return self.panel.rows.listing.group == group


COMMANDS = (
    Command(
        "find", "&Edit", "find", tr_noop("&Find clip"), LibraryFeature.find, (Standard.Find,), study=True
    ),
    Command(
        "favourite",
        MENU,
        "favourites",
        tr_noop("&Favourite"),
        LibraryFeature.favour,
        ("Ctrl+Shift+6",),
        tip=tr_noop("Add the selected clips to the favourites, or remove them"),
        enabled=has_clips_selected,
    ),
    Command(
        "duplicate_clips",
        MENU,
        "files",
        tr_noop("&Duplicate"),
        LibraryFeature.duplicate,
        ("Ctrl+Shift+D",),
        tip=tr_noop("List the selected clips again, so that each copy has its own timing"),
        enabled=has_clips_selected,
    ),
    Command(
        "reveal_clip",
        MENU,
        "files",
        tr_noop("&Reveal in folder"),
        LibraryFeature.reveal,
        tip=tr_noop("Show the first selected clip's file in the file manager"),
        enabled=has_clips_selected,
    ),
    *(
        Command(
            f"group_{key}",
            MENU,
            "groups",
            GROUP_BY[key],
            partial(LibraryFeature.group_by, group=key),
            checked=partial(LibraryFeature.groups_by, group=key),
        )
        for key in GROUPS
    ),
)


def list_clip_commands(library: LibraryFeature) -> tuple[Command, ...]:
    """Return all of them."""
    return (
        *bind_commands(COMMANDS, library),
        *(_rating(library, number) for number in range(STARS + 1)),
        *(_label(library, color) for color in (*COLORS, "")),
        *(_view(library, style) for style in BUTTONS),
    )


def _rating(library: LibraryFeature, number: int) -> Command:
    return Command(
        f"rate_{number}",
        MENU,
        "rating",
        f"&{number}  {format_stars(number)}" if number else tr("&0  No stars"),
        partial(library.mark, "rating", number),
        (f"Ctrl+Shift+{number}",),
        tip=tr(
            "Rate the selected clips {stars}", stars=tr_plural("{count:,} star", "{count:,} stars", number)
        ),
        enabled=partial(has_clips_selected, library),
    )


def _label(library: LibraryFeature, color: str) -> Command:
    on, off = (
        tr("Give the selected clips this colour label"),
        tr("Remove the colour label from the selected clips"),
    )
    return Command(
        f"color_{color or 'none'}",
        MENU,
        "labels",
        COLOR_LABELS[color] if color else tr("No label"),
        partial(library.mark, "color", color),
        tip=on if color else off,
        enabled=partial(has_clips_selected, library),
    )


def _view(library: LibraryFeature, style: Style) -> Command:
    _, _, tip = BUTTONS[style]
    return Command(
        f"clips_as_{style}",
        MENU,
        "view",
        tr(SHOW_AS[style]),
        partial(library.show_as, style),
        tip=tip,
        checked=partial(library.shows_as, style),
    )
