"""The dialog of one parameter: its name in game code, what it is for, its range or its choices."""

from __future__ import annotations

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.translation import tr, tr_error
from app.widgets.quiet_fields import DoubleSpinBox
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.parameters import rename_parameter, set_parameter
from metagraph.graph.model import Project
from metagraph.graph.parameter import CharacterParameter, ParameterChoice

LARGEST = 1000.0  # number that the fields offer


class ParameterDialog(QDialog):
    """Edits a copy of a parameter; `edit` makes the change in a project once the dialog was accepted."""

    def __init__(self, project: Project, name: str, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Parameter"))
        self._project, self._before = project, name
        self.parameter = project.parameters[name]
        self.name = QLineEdit(name, self)
        self.name.setToolTip(tr("As game code writes it: small letters, digits, underscores"))
        self.about = QLineEdit(self.parameter.about, self)
        self.about.setToolTip(tr("Becomes the comment in game code"))
        self.least, self.most = (
            DoubleSpinBox(self, minimum=-LARGEST, maximum=LARGEST, singleStep=0.1, decimals=2, value=value)
            for value in (self.parameter.least, self.parameter.most)
        )
        form = QFormLayout()
        for words, field in ((tr("Name"), self.name), (tr("Description"), self.about)):
            form.addRow(words, field)
            field.setAccessibleName(words)
        if self.parameter.type == "number":
            for words, number in ((tr("Lowest"), self.least), (tr("Highest"), self.most)):
                form.addRow(words, number)
                number.setAccessibleName(words)
        else:
            self.least.hide()
            self.most.hide()
        self.choices = self._make_choices()
        self.remove_button = QPushButton(tr("Remove choice"), self)
        self.remove_button.clicked.connect(self._remove)
        shown = self.parameter.type in ("enum", "list")
        self.choices.setVisible(shown)
        self.remove_button.setVisible(shown)
        self.wrong = QLabel(self)
        self.wrong.setWordWrap(True)
        self.wrong.setProperty("problem", True)
        self.wrong.hide()
        kinds = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(kinds.Ok | kinds.Cancel, self)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        for widget in (self.choices, self.remove_button, self.wrong, buttons):
            layout.addWidget(widget)
        self.resize(420, 420 if shown else 200)

    def _make_choices(self) -> QTableWidget:
        """Return the table of choices: the name in game code, and what it stands for."""
        table = QTableWidget(len(self.parameter.choices), 2, self)
        table.setHorizontalHeaderLabels([tr("Choice"), tr("Stands for")])
        table.setAccessibleName(tr("Choices"))
        table.verticalHeader().hide()
        table.horizontalHeader().setStretchLastSection(True)
        table.setSelectionBehavior(QTableWidget.SelectionBehavior.SelectRows)
        for row, choice in enumerate(self.parameter.choices):
            first = QTableWidgetItem(choice.name)
            first.setData(Qt.ItemDataRole.UserRole, row)
            second = QTableWidgetItem(describe_choice(self._project, choice))
            second.setFlags(second.flags() & ~Qt.ItemFlag.ItemIsEditable)
            table.setItem(row, 0, first)
            table.setItem(row, 1, second)
        table.resizeColumnToContents(0)
        return table

    def _remove(self) -> None:
        for row in sorted({item.row() for item in self.choices.selectedItems()}, reverse=True):
            self.choices.removeRow(row)

    def edit(self, project: Project) -> Project:
        """Return a project with what the dialog says. Raises EditError for what cannot be."""
        named = rename_parameter(project, self._before, self.name.text().strip())
        return set_parameter(named, self.name.text().strip(), self._collect())

    def _collect(self) -> CharacterParameter:
        found = msgspec.structs.replace(self.parameter, about=self.about.text().strip())
        if found.type == "number":
            return msgspec.structs.replace(found, least=self.least.value(), most=self.most.value())
        if found.type not in ("enum", "list"):
            return found
        choices = []
        for row in range(self.choices.rowCount()):
            item = self.choices.item(row, 0)
            assert item is not None
            before = found.choices[item.data(Qt.ItemDataRole.UserRole)]
            choices.append(msgspec.structs.replace(before, name=item.text().strip()))
        return msgspec.structs.replace(found, choices=tuple(choices))

    def accept(self) -> None:
        """Close, unless something cannot be; then say what."""
        try:
            self.edit(self._project)
        except EditError as error:
            self.wrong.setText(tr_error(error))
            self.wrong.show()
            return
        super().accept()


def describe_choice(project: Project, choice: ParameterChoice) -> str:
    """Return in words what a choice stands for."""
    stance = project.stance(choice.value) if isinstance(choice.value, str) else None
    if stance is not None:
        return stance.name
    return tr("automatic") if choice.value is None else str(choice.value)
