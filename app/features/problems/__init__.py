"""Problems of the project, and their remedies."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QToolButton, QWidget

from app.look import icons
from app.look.theme import get_theme
from app.shell.context import Contribution, HeaderItem, Panel, Shell
from app.stage.compatibility_state import Compatibility
from app.stage.fixes import Fix
from app.stage.problem_watch import ProblemWatch
from app.translation import tr, tr_plural
from app.widgets.restyling import set_sheet


def contribute(shell: Shell) -> Contribution:
    watch, compatibility = shell.services[ProblemWatch], shell.services[Compatibility]

    def mend(fixes: Sequence[Fix]) -> None:
        compatibility.mend(fix for fix in fixes if not fix.command)
        for fix in fixes:
            if fix.command:
                shell.stage.session.selection.select_actions(fix.actions)
                shell.actions[fix.command].trigger()

    def make() -> QWidget:
        from app.features.problems.problems_panel import ProblemsPanel

        panel = ProblemsPanel(shell.stage.session, shell.widget)
        panel.mend_wanted.connect(mend)
        panel.show_problems(watch.problems, watch.fixes)
        watch.changed.connect(lambda: panel.show_problems(watch.problems, watch.fixes))
        panel.play_wanted.connect(watch.play)
        panel.moment_wanted.connect(shell.stage.performance.show_moment)
        watch.played.connect(panel.show_playing)
        watch.progressed.connect(panel.show_progress)
        panel.show_playing(watch.is_playing)
        return panel

    return Contribution(
        panels=(
            Panel(
                "problems",
                tr("Problems"),
                "bottom",
                make,
                opens={"graph": "below", "label": "below", "time": "below"},
                imports=("app.features.problems.problems_panel",),
            ),
        ),
        header=(HeaderItem("right", lambda parent: ProblemButton(shell, watch, parent)),),
    )


class ProblemButton(QToolButton):
    """Counts the problems, and shows them when it is pressed; hints are only counted when there is nothing
    worse.
    """

    def __init__(self, shell: Shell, watch: ProblemWatch, parent: QWidget) -> None:
        super().__init__(parent)
        self.watch, self.session = watch, shell.stage.session
        self.setToolTip(tr("Problems in the project"))
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.setProperty("gives_way", True)  # where the header has no room for its words
        self.clicked.connect(lambda: shell.show("problems"))
        watch.changed.connect(self.refresh)
        self.session.look.changed.connect(self.refresh)
        self.refresh()

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip:
            words = tr("Problems in the project")
            unsaid = self.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonIconOnly
            self.setToolTip(f"{self.text()}\n{words}" if unsaid else words)
        return super().event(event)

    def refresh(self) -> None:
        """Show how many there are now."""
        problems, look = self.watch.problems, get_theme(self.session.look.name)
        grave = [p for p in problems if p.severity != "hint"]
        hints = len(problems) - len(grave)
        color = (
            look.error if any(p.severity == "error" for p in grave) else look.warning if grave else look.dim
        )
        self.setText(
            tr_plural("{count:,} problem", "{count:,} problems", len(grave))
            if grave
            else tr_plural("{count:,} hint", "{count:,} hints", hints)
            if hints
            else tr("No problems")
        )
        self.setIcon(icons.make_icon("warning" if grave else "done", color))
        set_sheet(self, f"color: {color}")
