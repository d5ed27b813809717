"""The commands of the clips' menu: marks, views, groups, and what is done with files."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.features.library.clip_columns import stars
from app.features.library.clip_groups import GROUPS
from app.features.library.clip_sizes import Style
from app.features.library.library_bar import BUTTONS
from app.features.library.library_panel import LibraryPanel
from app.look.domain_words import COLOR_LABELS
from app.look.plural import many
from app.shell.actions import Command
from app.shell.context import Shell
from app.translation import tr
from metagraph.graph.clip_mark import COLORS, STARS

MENU = "C&lips"


SHOW_AS = {"cards": tr("Show as cards"), "columns": tr("Show as columns")}
GROUP_BY = {
    "none": tr("No groups"),
    "folder": tr("Group by folder"),
    "stance": tr("Group by stance"),
    "tag": tr("Group by tag"),
    "layer": tr("Group by layer"),
    "kind": tr("Group by kind"),
}


def commands(shell: Shell, library: Callable[[], LibraryPanel]) -> tuple[Command, ...]:
    """Return them. library: the panel, made where it was not yet."""
    selection = shell.stage.session.selection
    some = lambda: bool(selection.clips)  # noqa: E731

    def act(name: str, *more: object) -> None:
        getattr(library().acts, name)(selection.clips, *more)

    def show_as(style: Style) -> None:
        library().show_as(style)

    def shown_as(style: Style) -> bool:
        return library().list.style_of == style

    def group_by(group: str) -> None:
        library().group_by(group)

    def grouped_by(group: str) -> bool:
        return library().rows.listing.group == group

    rating = (
        Command(
            f"rate_{n}",
            MENU,
            "rating",
            f"&{n}  {stars(n)}" if n else tr("&0  No stars"),
            partial(act, "mark", "rating", n),
            (f"Ctrl+Shift+{n}",),
            tip=tr("Give the selected clips {stars}", stars=many(n, "star")),
            enabled=some,
        )
        for n in range(STARS + 1)
    )
    labels = (
        Command(
            f"color_{color or 'none'}",
            MENU,
            "labels",
            COLOR_LABELS[color] if color else tr("No label"),
            partial(act, "mark", "color", color),
            tip=tr("Put this label on the selected clips")
            if color
            else tr("Take labels off the selected clips"),
            enabled=some,
        )
        for color in (*COLORS, "")
    )
    views = (
        Command(
            f"clips_as_{style}",
            MENU,
            "view",
            SHOW_AS[style],
            partial(show_as, style),
            tip=tip,
            checked=partial(shown_as, style),
        )
        for style, (_, _, tip) in BUTTONS.items()
    )
    groups = (
        Command(
            f"group_{key}",
            MENU,
            "groups",
            GROUP_BY[key],
            partial(group_by, key),
            checked=partial(grouped_by, key),
        )
        for key in GROUPS
    )
    return (
        *rating,
        *labels,
        Command(
            "favourite",
            MENU,
            "favourites",
            tr("&Favourite"),
            partial(act, "favour"),
            ("Ctrl+Shift+6",),
            tip=tr("Put a heart on the selected clips, or take it away"),
            enabled=some,
        ),
        Command(
            "duplicate_clips",
            MENU,
            "files",
            tr("&Duplicate"),
            partial(act, "duplicate"),
            ("Ctrl+Shift+D",),
            tip=tr("List the selected clips once more, each to be timed for itself"),
            enabled=some,
        ),
        Command(
            "reveal_clip",
            MENU,
            "files",
            tr("&Reveal in folder"),
            lambda: library().acts.reveal(selection.clips[0]),
            tip=tr("Show the file of the first selected clip where it lies"),
            enabled=some,
        ),
        *views,
        *groups,
    )
