"""The expanded state machine beside the meta-graph."""

from __future__ import annotations

from PySide6.QtWidgets import QToolButton, QWidget

from app.shell.actions import Command
from app.shell.context import Contribution, HeaderItem, Panel, Shell
from app.shell.places import PanelPlaces
from app.translation import tr
from app.widgets.making import make_widget


def contribute(shell: Shell) -> Contribution:
    def wanted() -> bool:
        return shell.services[PanelPlaces].wanted("machine")

    def make() -> QWidget:
        from app.features.machine.machine_panel import MachinePanel

        return MachinePanel(shell.document, shell.stage.session, shell.widget)

    def button(parent: QWidget) -> QWidget:
        action = shell.actions["machine"]
        out = make_widget(QToolButton, parent, text=tr("Machine"), toolTip=action.toolTip(), checkable=True)
        out.clicked.connect(lambda _: action.trigger())
        action.toggled.connect(out.setChecked)
        action.enabledChanged.connect(out.setEnabled)
        return out

    return Contribution(
        panels=(
            Panel(
                "machine",
                tr("Machine"),
                "beside",
                make,
                when="meta",
                imports=("app.features.machine.machine_panel",),
            ),
        ),
        commands=(
            Command(
                "machine",
                "&View",
                "graph",
                tr("&Machine beside the graph"),
                lambda: shell.show("machine", not wanted()),
                ("M",),
                tip=tr("Show the state machine that the graph stands for, beside the graph"),
                checked=wanted,
                when="meta",
                study=True,
            ),
        ),
        header=(HeaderItem("right", button),),
    )
