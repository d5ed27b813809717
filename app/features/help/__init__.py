"""The list of shortcuts, and what this program is."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QMessageBox

from app.look.theme import KIND_MARKS
from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from metagraph.graph.model import KINDS


def contribute(shell: Shell) -> Contribution:
    def keys() -> None:
        rows = []
        for command in shell.actions.commands:
            shortcuts = shell.actions[command.id].shortcuts()
            words = ", ".join(k.toString(QKeySequence.SequenceFormat.NativeText) for k in shortcuts)
            if words and command.group != "stances":
                rows.append(
                    f"<tr><td style='padding-right:24px'>{command.plain}</td><td><b>{words}</b></td></tr>"
                )
        rows.append("<tr><td>Stance 1 to 9</td><td><b>Ctrl+1 … Ctrl+9</b></td></tr>")
        rows.append(
            "<tr><td colspan=2>In a conversation: 1 2 3 label, S split, M merge, P stress, Tab and arrows "
            "choose</td></tr>"
        )
        table = f"<table>{''.join(rows)}</table>"
        box = QMessageBox(
            QMessageBox.Icon.NoIcon, "Keyboard shortcuts", table, QMessageBox.StandardButton.Ok, shell.widget
        )
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()

    def about() -> None:
        from metagraph import __version__

        kinds = " &nbsp; ".join(f"{KIND_MARKS[k]} {k}" for k in KINDS)
        text = (
            f"<h3>Metagraph {__version__}</h3><p>Drop clips; the state machine draws "
            f"itself.</p><p>{kinds}</p>"
        )
        QMessageBox.about(shell.widget, "About Metagraph", text)

    return Contribution(
        commands=(
            Command("keys", "&Help", "", "&Keyboard shortcuts", keys, ("F1",), study=True),
            Command("about", "&Help", "", "&About Metagraph", about, study=True),
        ),
    )
