"""The performance: what is requested and what plays, live or kept."""

from __future__ import annotations

from functools import partial

from app.features.timeline.timeline_commands import (
    COMMANDS,
    TimelineFeature,
    has_marker_selected,
    has_requests_selected,
)
from app.shell.command_table import bind_commands, is_meta_graph_shown, require_all
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verbs
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    timeline, verbs = TimelineFeature(shell), shell.services[Verbs]
    with_requests = partial(require_all(is_meta_graph_shown, has_requests_selected), timeline)
    with_marker = partial(require_all(is_meta_graph_shown, has_marker_selected), timeline)
    verbs.offer("remove", with_requests, timeline.withdraw_requests, rank=1)
    verbs.offer("remove", with_marker, timeline.remove_marker, rank=1)
    verbs.offer("rename", with_marker, timeline.rename_marker, rank=1)
    # Whether there is something to remove is asked when something else is selected.
    timeline.noted.changed.connect(lambda: shell.actions.refresh_soon())  # there are none yet
    return Contribution(
        panels=(
            Panel(
                "timeline",
                tr("Performance"),
                "bottom",
                timeline.make_panel,
                least=(400, 236),
                where={"perform": "below"},
                opens={"talk": "below"},
                imports=("app.features.timeline.timeline_panel",),
            ),
        ),
        commands=bind_commands(COMMANDS, timeline),
    )
