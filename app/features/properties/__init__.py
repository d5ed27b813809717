"""The properties and the timing of the selected actions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.shell.places import PanelPlaces
from app.shell.verbs import Verbs
from app.stage.compatibility_state import Compatibility
from app.stage.problem_watch import ProblemWatch
from app.translation import tr

if TYPE_CHECKING:
    from app.features.properties.action_page import ActionPage


def contribute(shell: Shell) -> Contribution:
    session, compatibility, problems = (
        shell.stage.session,
        shell.services[Compatibility],
        shell.services[ProblemWatch],
    )

    def make() -> QWidget:
        from app.features.properties.properties_panel import PropertiesPanel

        places = shell.services[PanelPlaces]

        def furnish(page: ActionPage) -> None:
            problems.changed.connect(lambda: page.set_misfits(problems.misfits))
            page.set_misfits(problems.misfits)
            page.plot.set_compatibility(compatibility)
            page.timing_elsewhere = lambda: places.workspace.id == "time" and "timing" in places.panels
            page.time_wanted.connect(lambda: shell.actions["workspace_3"].trigger())

        return PropertiesPanel(shell.document, session, places.fetch, furnish, shell.widget)

    def rename() -> None:
        shell.show("properties")
        field = shell.panel("properties").action.name
        field.setFocus()
        field.selectAll()

    shell.services[Verbs].offer(
        "rename", lambda: session.onstage.mode == "meta" and len(session.selection.actions) == 1, rename
    )
    return Contribution(
        panels=(
            Panel(
                "properties",
                tr("Properties"),
                "right below",
                make,
                where={"time": "list", "graph": "below", "label": "below"},
                rank=1,
                imports=("app.features.properties.properties_panel",),
            ),
        ),
        commands=(
            Command(
                "use_times",
                "&Graph",
                "author",
                tr("Use proposed &times"),
                lambda: compatibility.use_proposed(session.selection.actions),
                tip=tr("Start and end the action where its blends show no jump"),
                enabled=lambda: bool(session.selection.actions) and compatibility.judged is not None,
                when="meta",
                study="labels",
            ),
        ),
    )
