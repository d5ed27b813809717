"""The timing of the selected actions, large: poses, speeds, phases, numbers, and how far they are from their
stances.
"""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.features.timing_editor.since import Since
from app.shell.context import Contribution, Panel, Shell
from app.stage.compatibility_state import Compatibility
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    stage, document = shell.stage, shell.document
    since = Since(document, stage.session)

    def make() -> QWidget:
        from app.features.timing_editor.subject import Subject
        from app.features.timing_editor.timing_panel import TimingPanel

        subject = Subject(
            document,
            stage.session,
            stage.performance,
            shell.services[Compatibility],
            stage.thumbnails,
            stage.sound,
            since,
        )
        panel = TimingPanel(document, stage.session, subject, shell.widget)
        subject.setParent(panel)
        return panel

    return Contribution(
        panels=(
            Panel(
                "timing",
                tr("Timing"),
                "bottom",
                make,
                where={"time": "below"},
                opens={"label": "below", "graph": "below"},
                least=(420, 200),
                rank=0,
                imports=("app.features.timing_editor.timing_panel",),
            ),
        ),
    )
