"""The timing of the selected actions, large: poses, speeds, phases, numbers, and how far they are from their
stances.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.features.timing_editor.since import Since
from app.shell.actions import Command
from app.shell.command_table import (
    Feature,
    bind_commands,
    has_actions_selected,
    is_meta_graph_shown,
    require_all,
)
from app.shell.context import Contribution, Panel, Shell
from app.stage.compatibility_state import Compatibility
from app.translation import tr, tr_noop

if TYPE_CHECKING:
    from app.features.timing_editor.subject import Subject


class TimingFeature(Feature):
    """Shows the selected actions as they were, or as they are."""

    subject: Subject | None = None  # made with the panel

    def has_subject(self) -> bool:
        return self.subject is not None

    def is_before_shown(self) -> bool:
        return self.subject is not None and self.subject.before is not None

    def flip(self) -> None:
        """Show them as they were when they were selected, or as they are again."""
        assert self.subject is not None
        self.subject.compare(not self.is_before_shown())
        self.shell.actions.refresh_soon()


COMMANDS = (
    Command(
        "compare_before",
        "&Play",
        "show",
        tr_noop("As &before (A/B)"),
        TimingFeature.flip,
        ("A",),
        tip=tr_noop("Show the selected actions as they were when you selected them, or as they are again"),
        enabled=require_all(TimingFeature.has_subject, has_actions_selected, is_meta_graph_shown),
        checked=TimingFeature.is_before_shown,
    ),
)


def contribute(shell: Shell) -> Contribution:
    stage, document = shell.stage, shell.document
    since, feature = Since(document, stage.session), TimingFeature(shell)

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
        feature.subject = subject
        return panel

    return Contribution(
        commands=bind_commands(COMMANDS, feature),
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
