"""The panel of parameters: a live control for each, and what can be added."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import (
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app.features.parameters.parameter_controls import make_control
from app.features.parameters.parameter_dialog import ParameterDialog
from app.project.document import Document
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_noop, tr_phrase
from app.widgets.more_button import MoreButton
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.parameters import (
    OfferedParameter,
    add_parameter,
    list_offered_parameters,
    remove_parameter,
)
from metagraph.graph.model import Project
from metagraph.graph.parameter import ParameterValues
from metagraph.graph.requests import RequestError

GROUPS = {
    "state": tr_noop("What lasts"),
    "gesture": tr_noop("Gestures"),
    "action": tr_noop("One action"),
    "line": tr_noop("Lines"),
}
SOON = 60  # milliseconds in which values are collected, so that a dragged slider makes few requests


class ParametersPanel(QWidget):
    """Declares parameters, and sets them in the preview. What is set there is not saved."""

    def __init__(
        self, document: Document, session: StageSession, performance: StagePerformance, parent: QWidget
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.values = ParameterValues()
        self.controls: dict[str, QWidget] = {}
        self.menus: dict[str, QMenu] = {}
        self._later: dict[str, Any] = {}
        self._shown: list[QWidget] = []
        self._timer = QTimer(self, singleShot=True, interval=SOON)
        self._timer.timeout.connect(self.send)
        self.add_button = QPushButton(tr("Add a parameter"), self)
        self.add_menu = QMenu(self.add_button)
        self.add_menu.aboutToShow.connect(self.fill_menu)
        self.add_button.setMenu(self.add_menu)
        self.empty = QLabel(
            tr(
                "A parameter is a value that a game sets: the mood, where the character looks, a gesture. "
                "Add one, and try it here. Games get it with its type."
            ),
            self,
        )
        self.empty.setWordWrap(True)
        self.empty.setProperty("dim", True)
        self.rows = QWidget(self)
        self.grid = QGridLayout(self.rows)
        self.grid.setContentsMargins(0, 0, 0, 0)
        self.grid.setColumnStretch(1, 1)
        self._lay_out()
        document.changed.connect(self._follow)
        document.loaded.connect(self._load)
        self.refresh()

    def _lay_out(self) -> None:
        inner = QWidget(self)
        layout = QVBoxLayout(inner)
        layout.setContentsMargins(12, 8, 12, 8)
        top = QHBoxLayout()
        top.addWidget(self.add_button)
        top.addStretch(1)
        layout.addLayout(top)
        layout.addWidget(self.empty)
        layout.addWidget(self.rows)
        layout.addStretch(1)
        area = QScrollArea(self)
        area.setWidgetResizable(True)
        area.setWidget(inner)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(area)

    # --- showing

    def _load(self) -> None:
        self.values = ParameterValues()
        self._later.clear()
        self.refresh()

    def _follow(self, before: Project, after: Project) -> None:
        if before.parameters is not after.parameters:
            changed = [
                x for x in self.values.values if before.parameters.get(x) is not after.parameters.get(x)
            ]
            for name in changed:
                self.values.values.pop(name)
            self.refresh()
        if (before.skeleton is None) != (after.skeleton is None):
            self.refresh()

    def refresh(self) -> None:
        """Show the parameters as they are now, with their first values."""
        for widget in self._shown:
            self.grid.removeWidget(widget)
            widget.deleteLater()
        self._shown.clear()
        self.controls.clear()
        self.menus.clear()
        parameters = self.document.project.parameters
        for row, (name, parameter) in enumerate(parameters.items()):
            label = QLabel(name, self.rows)
            label.setToolTip(parameter.about)
            control = make_control(name, parameter, partial(self.set_later, name), self.rows)
            control.setToolTip(parameter.about)
            more = MoreButton(self.session.look, name, tr("Edit or remove this parameter"), self.rows)
            self._fill_more(more.menu_of, name)
            self.controls[name], self.menus[name] = control, more.menu_of
            for column, widget in enumerate((label, control, more)):
                self.grid.addWidget(widget, row, column)
                self._shown.append(widget)
        self.rows.setVisible(bool(parameters))
        self.empty.setVisible(not parameters)
        self.add_button.setEnabled(self.document.project.skeleton is not None)

    def _fill_more(self, menu: QMenu, name: str) -> None:
        menu.addAction(tr("Edit…"), partial(self.edit, name))
        menu.addAction(tr("Remove"), partial(self.remove, name))

    def fill_menu(self) -> None:
        """Offer what a new parameter can set, as the project is now."""
        self.add_menu.clear()
        offered = list_offered_parameters(self.document.project)
        for group, words in GROUPS.items():
            some = [one for one in offered if one.group == group]
            if some:
                self._fill_group(self.add_menu.addMenu(tr(words)), some)

    def _fill_group(self, menu: QMenu, some: Sequence[OfferedParameter]) -> None:
        """Offer parameters; actions, which may be thousands, in menus of stances that fill when opened."""
        places = dict.fromkeys(one.under for one in some)
        if len(places) == 1:
            for one in some:
                menu.addAction(tr_phrase(one.words).replace("&", "&&"), partial(self.add, one))
            return
        for layer, stance in places:
            inside = menu.addMenu(f"{tr(layer)}: {stance}".replace("&", "&&"))
            found = [replace(one, under=("", "")) for one in some if one.under == (layer, stance)]
            inside.aboutToShow.connect(partial(self._fill_once, inside, found))

    def _fill_once(self, menu: QMenu, some: Sequence[OfferedParameter]) -> None:
        if menu.isEmpty():
            self._fill_group(menu, some)

    # --- declaring: each is a step to undo

    def add(self, offered: OfferedParameter) -> None:
        self._edit(
            tr("Add parameter"), lambda project: add_parameter(project, offered.name, offered.parameter)[0]
        )

    def edit(self, name: str) -> None:
        """Ask how a parameter is to be, and change it."""
        dialog = ParameterDialog(self.document.project, name, self)
        if dialog.exec() == QDialog.DialogCode.Accepted:
            self._edit(tr("Change parameter"), dialog.edit)

    def remove(self, name: str) -> None:
        self._edit(tr("Remove parameter"), lambda project: remove_parameter(project, name))

    def _edit(self, words: str, change: Any) -> None:
        try:
            self.document.edit(words, change)
        except EditError as error:
            self.document.failed.emit(tr_error(error))

    # --- trying

    def set_later(self, name: str, value: Any) -> None:
        """Set a parameter in the preview, in a moment."""
        self._later[name] = value
        self._timer.start()

    def send(self) -> None:
        """Set what waits to be set."""
        parameters = self.document.project.parameters
        waiting, self._later = self._later, {}
        for name, value in waiting.items():
            try:
                request = self.values.take(parameters, name, value)
            except RequestError as error:
                self.document.failed.emit(str(error))
                continue
            before = self.values.made.get(name, "") if parameters[name].type != "trigger" else ""
            self.values.made[name] = self.performance.direct(request, before)
