"""The performance: what is asked for and what plays, live or kept."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.features.timeline.timeline_commands import commands
from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.shell.verbs import Verbs
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    stage, document = shell.stage, shell.document
    session, performance = stage.session, stage.performance

    def make() -> QWidget:
        from app.features.timeline.lane_drops import LaneDrops
        from app.features.timeline.timeline_panel import TimelinePanel

        panel = TimelinePanel(document, session, performance, shell.jobs, shell.widget)
        LaneDrops(panel.lanes, shell.services[Importing])
        return panel

    def toggle_live() -> None:
        (performance.live.begin if performance.live.stage is None else performance.live.end)()
        shell.show("timeline")

    shell.services[Verbs].offer(
        "remove",
        lambda: session.onstage.mode == "meta" and bool(session.onstage.requests),
        lambda: performance.requests.withdraw(*session.onstage.requests),
        rank=1,
    )
    noted = performance.timeline
    shell.services[Verbs].offer(
        "remove",
        lambda: session.onstage.mode == "meta" and noted.selected is not None,
        lambda: noted.remove_marker(str(noted.marker)),
        rank=1,
    )
    shell.services[Verbs].offer(
        "rename",
        lambda: session.onstage.mode == "meta" and noted.selected is not None,
        lambda: shell.panel("timeline").lanes.ruler.rename(str(noted.marker)),
        rank=1,
    )
    # Whether there is something to remove is asked when something else is selected.
    noted.changed.connect(lambda: shell.actions["delete"].setEnabled(shell.services[Verbs].can("remove")))
    return Contribution(
        panels=(
            Panel(
                "timeline",
                tr("Performance"),
                "bottom",
                make,
                least=(400, 236),
                where={"perform": "below"},
                opens={"talk": "below"},
                imports=("app.features.timeline.timeline_panel",),
            ),
        ),
        commands=(
            *commands(shell),
            Command(
                "live",
                "&Play",
                "live",
                tr("Li&ve"),
                toggle_live,
                ("Ctrl+L",),
                tip=tr("Let programs on this machine drive the character"),
                enabled=lambda: document.project.skeleton is not None,
                checked=lambda: performance.live.stage is not None,
                when="meta",
            ),
        ),
    )
