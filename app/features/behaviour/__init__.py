"""What the character does by itself in an hour, next to what people do, and temperaments."""

from __future__ import annotations

from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr
from app.widgets.beside import stand_beside
from app.widgets.one_dialog import show_one


def contribute(shell: Shell) -> Contribution:
    def show() -> None:
        from app.features.behaviour.behaviour_dialog import BehaviourDialog

        def make() -> BehaviourDialog:
            dialog = BehaviourDialog(shell.document, shell.stage.session, shell.jobs, shell.widget)
            stand_beside(dialog, shell.panel("character"))  # the character shows what is changed
            return dialog

        show_one(shell.widget, BehaviourDialog, make)

    return Contribution(
        commands=(
            Command(
                "behaviour",
                "&Play",
                "show",
                tr("&Behaviour…"),
                show,
                tip=tr("Count what the character does by itself in an hour, and choose its temperament"),
                enabled=lambda: (
                    bool(shell.document.project.graphs["arms"].actions)
                    or bool(shell.document.project.graphs["body"].actions)
                ),
                when="meta",
            ),
        ),
    )
