"""Properties of an alias: its name, the states it stands for, and the one it is entered by."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.features.manual import manual_many
from app.features.manual.manual_canvas import ManualCanvas
from app.translation import tr, tr_noop, tr_plural
from app.widgets.form_fields import Field, QuietChooser
from app.widgets.making import make_widget
from metagraph.graph.manual import groups as manual_groups
from metagraph.graph.manual.machine import Alias
from metagraph.graph.name_search import matches_search

NO_ENTRY = tr_noop("no entry state: no link leads to it")
IDENT = Qt.ItemDataRole.UserRole


class AliasPage(QWidget):
    """Shows one alias; several are given by their number and can only be removed."""

    def __init__(self, canvas: ManualCanvas, parent: QWidget) -> None:
        super().__init__(parent)
        self.canvas, self.alias = canvas, ""
        self.name = Field(self, tr("Name of the alias"), tr("Name of the alias"))
        self.name.editingFinished.connect(self._rename)
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        self.every = make_widget(QCheckBox, tr("every state, including new ones"), self)
        self.every.clicked.connect(lambda on: self._set(tr("Change alias"), every=on))
        self.again = make_widget(
            QCheckBox,
            tr("can lead a state back to itself"),
            self,
            toolTip=tr("If off, a link does not start from the state that it leads to"),
        )
        self.again.clicked.connect(lambda on: self._set(tr("Change alias"), again=on))
        self.entry = QuietChooser(
            self,
            toolTip=tr("Links to this alias lead to this state. An alias with an entry state is a group."),
        )
        self.entry.activated.connect(
            lambda n: self._set(tr("Change entry"), entry=self.entry.itemData(n) or None)
        )
        form = QFormLayout()
        form.setHorizontalSpacing(14)
        form.setVerticalSpacing(7)
        form.setLabelAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        form.addRow(tr("Contains"), self.every)
        form.addRow(tr("Self-links"), self.again)
        form.addRow(tr("Entry state"), self.entry)
        self.search = QLineEdit(self)
        self.search.setPlaceholderText(tr("Find states"))
        self.search.setAccessibleName(tr("Find states of the alias"))
        self.search.setClearButtonEnabled(True)
        self.search.textChanged.connect(self._filter)
        self.list = QListWidget(self)
        self.list.setAccessibleName(tr("States of the alias"))
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.list.setUniformItemSizes(True)
        self.list.setMinimumHeight(220)
        self.list.itemChanged.connect(self._ticked)
        self.members = make_widget(
            QPushButton, tr("Select its states"), self, toolTip=tr("You can also double-click the alias")
        )
        self.members.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.members.clicked.connect(lambda: manual_many.select_members(self.canvas, self.alias))
        box = QVBoxLayout(self)
        box.setContentsMargins(14, 10, 14, 14)
        box.setSpacing(8)
        box.addWidget(self.name)
        box.addWidget(self.words)
        box.addLayout(form)
        box.addWidget(self.search)
        box.addWidget(self.list, 1)
        box.addWidget(self.members)
        self.trouble = QLabel(self, wordWrap=True)
        box.addWidget(self.trouble)

    def show_aliases(self, aliases: list[Alias]) -> None:
        """Show what is selected."""
        one, first, manual = len(aliases) == 1, aliases[0], self.canvas.scene().manual
        self.alias = first.id
        for part in (self.name, self.every, self.again, self.entry, self.search, self.list, self.members):
            part.setEnabled(one)
        self.name.show_text(first.name if one else tr("{aliases} aliases", aliases=len(aliases)), first.id)
        inside = frozenset(manual.members(first))
        leave = len(manual.out.get(first.id, ()))
        self.words.setText(
            tr(
                "An alias contains {inside}; {leave} can be taken from each of them.",
                inside=tr_plural("{count:,} state", "{count:,} states", len(inside)),
                leave=tr_plural("{count:,} link", "{count:,} links", leave),
            )
        )
        self.every.setChecked(first.every)
        self.again.setChecked(first.again)
        entries: list[tuple[str, object]] = [(tr(NO_ENTRY), "")]
        entries += [(manual.states[i].name, i) for i in manual.states if i in inside or i == first.entry]
        self.entry.show_entries(entries, first.entry or "")
        self.list.blockSignals(True)
        if [self.list.item(n).data(IDENT) for n in range(self.list.count())] != list(manual.states):
            self.list.clear()
            for state in manual.states.values():
                item = QListWidgetItem(state.name, self.list)
                item.setData(IDENT, state.id)
        for n, state in enumerate(manual.states.values()):
            item = self.list.item(n)
            item.setText(state.name)
            flags = Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsUserCheckable
            item.setFlags(flags if first.every else flags | Qt.ItemFlag.ItemIsEnabled)
            item.setCheckState(Qt.CheckState.Checked if state.id in inside else Qt.CheckState.Unchecked)
        self.list.blockSignals(False)
        self._filter(self.search.text())

    def _filter(self, words: str) -> None:
        for n in range(self.list.count()):
            item = self.list.item(n)
            item.setHidden(bool(words.strip()) and not matches_search(words, item.text()))

    def _ticked(self, item: QListWidgetItem) -> None:
        """A tick counts for all rows that are selected with it."""
        on = item.checkState() == Qt.CheckState.Checked
        rows = self.list.selectedItems() if item.isSelected() else [item]
        states = tuple(r.data(IDENT) for r in rows if not r.isHidden())
        manual_many.choose_for_alias(self.canvas, self.alias, states, on)

    def _set(self, text: str, **changes: object) -> None:
        self.canvas.do(text, lambda p: manual_groups.update_aliases(p, [self.alias], **changes))

    def _rename(self) -> None:
        alias = self.canvas.document.project.alias(self.alias)
        name = " ".join(self.name.text().split())
        if alias is not None and self.name.isEnabled() and name != alias.name:
            self._set(tr("Rename alias"), name=name)
            self.name.show_text(getattr(self.canvas.document.project.alias(self.alias), "name", ""), None)
