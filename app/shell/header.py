"""The bar on top: the project's name, the layers' tabs, problems, the machine, export."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QLabel, QPushButton, QSizePolicy, QToolBar, QToolButton, QWidget

from app.look import icons
from app.look.plural import many
from app.look.theme import theme
from app.project.document import Document
from app.shell.actions import Actions
from app.shell.commands import LAYER_KEYS
from app.stage.session import Session
from metagraph.graph.check import Problem
from metagraph.graph.model import LAYERS


class Header(QToolBar):
    """Shows the state of document and session; its buttons are wired by the window."""

    def __init__(self, document: Document, session: Session, actions: Actions, parent: QWidget) -> None:
        super().__init__("Main", parent)
        self.document, self.session, self.actions_ = document, session, actions
        self.setObjectName("toolbar")
        self.setMovable(False)
        self.setIconSize(QSize(18, 18))
        self.name = QLabel(self)
        self.name.setMinimumWidth(190)
        self.name.setContentsMargins(6, 0, 12, 0)
        self.name.setTextFormat(Qt.TextFormat.RichText)
        self.addWidget(self.name)
        for ident in ("import", "undo", "redo"):
            self.addAction(actions[ident])
        self.addWidget(_stretch(self))
        self.addWidget(self._tabs())
        self.addWidget(_stretch(self))
        self.problem_button = QToolButton(self, toolTip="Problems of the project")
        self.problem_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.machine_button = QToolButton(self, text="Machine", toolTip="The state machine you did not have to draw (M)", checkable=True)
        self.export_button = QPushButton("Export", self, toolTip="JSON and GLB for engines (Ctrl+E)")
        self.export_button.setProperty("strong", True)
        self.export_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        for button in (self.problem_button, self.machine_button, self.export_button):
            self.addWidget(button)

    def _tabs(self) -> QWidget:
        self.layer_buttons = QButtonGroup(self)
        tabs = QWidget(self)
        row = QHBoxLayout(tabs)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(2)
        for layer in LAYERS:
            button = QToolButton(tabs, text=layer.capitalize(), checkable=True, toolTip=f"The {layer} layer ({LAYER_KEYS[layer]})")
            button.setMinimumWidth(72)
            button.clicked.connect(lambda _=False, x=layer: self.session.set_layer(x))
            self.layer_buttons.addButton(button, LAYERS.index(layer))
            row.addWidget(button)
        return tabs

    def refresh(self) -> None:
        """Show name, dirty mark, layer and counts as they are now."""
        d = self.document
        saved = "not saved yet" if d.path is None else "edited" if d.dirty else "saved"
        dim = theme(self.session.theme).dim
        self.name.setText(f"<b>{escape(d.project.name)}</b>&nbsp;&nbsp;<span style='color:{dim}'>{saved}</span>")
        self.layer_buttons.button(LAYERS.index(self.session.layer)).setChecked(True)
        for number, layer in enumerate(LAYERS):
            count = len(d.project.graphs[layer].actions)
            self.layer_buttons.button(number).setText(f"{layer.capitalize()}  {count}" if count else layer.capitalize())
        self.export_button.setEnabled(self.actions_["export"].isEnabled())

    def show_problems(self, problems: Sequence[Problem]) -> None:
        """Count the problems; hints are only counted when there is nothing worse."""
        look = theme(self.session.theme)
        grave = [p for p in problems if p.severity != "hint"]
        hints = len(problems) - len(grave)
        color = look.error if any(p.severity == "error" for p in grave) else look.warning if grave else look.dim
        self.problem_button.setText(many(len(grave), "problem") if grave else many(hints, "hint") if hints else "No problems")
        self.problem_button.setIcon(icons.icon("warning", color))
        self.problem_button.setStyleSheet(f"color: {color}")


def _stretch(parent: QWidget) -> QWidget:
    out = QWidget(parent)
    out.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    return out
