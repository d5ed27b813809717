"""The clips of the project."""

from __future__ import annotations

from functools import partial

from app.features.library.clip_commands import LibraryFeature, list_clip_commands
from app.shell.command_table import has_clips_selected
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verbs
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    library, verbs = LibraryFeature(shell), shell.services[Verbs]
    verbs.offer("remove", partial(has_clips_selected, library), library.remove, rank=6)
    verbs.offer("rename", lambda: len(library.clips) == 1, library.rename, rank=0)
    verbs.offer("select_all", library.has_focus, library.select_all, rank=0)
    verbs.offer("find", lambda: True, library.search, rank=9)
    return Contribution(
        panels=(
            Panel(
                "library",
                tr("Clips"),
                "left",
                library.make_panel,
                late=False,
                where={"label": "large", "graph": "list"},
                opens={"time": "list", "perform": "side"},
                least=(200, 180),
            ),
        ),
        commands=list_clip_commands(library),
    )
