"""Dialogs that edit many actions at once: names by pattern or replaced text, pasted properties, another
clip.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QCompleter,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QTabWidget,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.document import Document
from app.translation import make_lazy_texts, tr, tr_error, tr_plural
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import batch

TITLES = make_lazy_texts(
    lambda: {
        "blends": tr("Blend in and out"),
        "part": tr("Start and end"),
        "exit": tr("Earliest exit"),
        "repeat": tr("Repeats"),
        "phases": tr("Ready, stroke, hold"),
        "limb": tr("Limb"),
        "joints": tr("Joints it moves"),
        "tags": tr("Tags"),
        "likelihood": tr("Likelihood"),
        "variation": tr("Cooldown, spacing and how much it stands out"),
    }
)


class BatchDialog(QDialog):
    """A dialog about some actions that ends in one edit. trouble: where it says what is wrong."""

    def __init__(
        self, document: Document, actions: Sequence[str], title: str, verb: str, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.edited = document, tuple(actions)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.setMinimumWidth(520)
        self.body = QVBoxLayout(self)
        self.trouble = QLabel(self, wordWrap=True)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self.go = self.buttons.addButton(verb, QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.go)
        self.buttons.accepted.connect(self.finish)
        self.buttons.rejected.connect(self.reject)

    def close_up(self) -> None:
        """Put trouble and buttons below what was added."""
        self.body.addWidget(self.trouble)
        self.body.addWidget(self.buttons)

    def finish(self) -> None:
        raise NotImplementedError


class RenameDialog(BatchDialog):
    """New names for many actions, seen before they are given."""

    def __init__(self, document: Document, actions: Sequence[str], parent: QWidget | None = None) -> None:
        super().__init__(
            document, actions, tr("Rename {actions} actions", actions=len(actions)), tr("Rename"), parent
        )
        self.names: dict[str, str] = {}
        self.tabs = QTabWidget(self)
        self.tabs.setAccessibleName(tr("Ways to rename"))
        self.pattern = QLineEdit("{stance} {name}", self)
        self.pattern.setAccessibleName(tr("Pattern"))
        words = QLabel(
            tr("In braces: {fields}. {{n:02}} counts 01, 02, ...", fields=", ".join(batch.FIELDS)),
            self,
            wordWrap=True,
        )
        words.setProperty("dim", True)
        self._page(tr("By pattern"), (tr("Pattern"), self.pattern), ("", words))
        self.sought, self.put, self.regex = (
            QLineEdit(self),
            QLineEdit(self),
            QCheckBox(tr("regular expression"), self),
        )
        self.sought.setAccessibleName(tr("Find"))
        self.put.setAccessibleName(tr("Replace with"))
        self._page(
            tr("Find and replace"),
            (tr("Find"), self.sought),
            (tr("Replace with"), self.put),
            ("", self.regex),
        )
        self.preview = make_widget(QTreeWidget, self, rootIsDecorated=False)
        self.preview.setHeaderLabels([tr("Current"), tr("New")])
        self.preview.setAccessibleName(tr("Current and new names"))
        self.preview.setColumnWidth(0, 240)
        self.body.addWidget(self.tabs)
        self.body.addWidget(self.preview, 1)
        self.close_up()
        for line in (self.pattern, self.sought, self.put):
            line.textChanged.connect(self._show)
        self.regex.toggled.connect(self._show)
        self.tabs.currentChanged.connect(self._show)
        self._show()

    def _page(self, title: str, *rows: tuple[str, QWidget]) -> None:
        page = QWidget(self)
        form = QFormLayout(page)
        for words, widget in rows:
            form.addRow(words, widget)
        self.tabs.addTab(page, title)

    def _show(self) -> None:
        project = self.document.project
        self.names, words = {}, ""
        try:
            if self.tabs.currentIndex() == 0:
                self.names = batch.rename_by_pattern(project, self.edited, self.pattern.text())
            elif self.sought.text():
                self.names = batch.rename_by_replacing(
                    project, self.edited, self.sought.text(), self.put.text(), self.regex.isChecked()
                )
        except EditError as error:
            words = tr_error(error)
        self.trouble.setText(words)
        self.go.setEnabled(bool(self.names))
        self.preview.clear()
        for ident, name in self.names.items():
            action = project.action(ident)
            QTreeWidgetItem(self.preview, [action.name if action is not None else "", name])

    def finish(self) -> None:
        names = self.names
        self.document.edit(
            tr("Rename {names} actions", names=len(names)), lambda p: batch.rename_actions(p, names)
        )
        self.accept()


class PasteDialog(BatchDialog):
    """Which properties of a copied action the selected ones get."""

    def __init__(
        self, document: Document, source: str, actions: Sequence[str], parent: QWidget | None = None
    ) -> None:
        super().__init__(
            document, [a for a in actions if a != source], tr("Paste properties"), tr("Paste"), parent
        )
        self.source = source
        copied = document.project.action(source)
        count = len(self.edited)
        name = copied.name if copied is not None else ""
        self.body.addWidget(
            QLabel(
                tr(
                    "From '{name}' to {actions}:",
                    name=name,
                    actions=tr_plural("{count:,} action", "{count:,} actions", count),
                ),
                self,
            )
        )
        self.boxes = {group: QCheckBox(TITLES[group], self) for group in batch.PROPERTIES}
        for group, box in self.boxes.items():
            box.setChecked(group in ("blends", "tags"))
            box.toggled.connect(self._enable)
            self.body.addWidget(box)
        self.close_up()
        self._enable()

    def _enable(self) -> None:
        self.go.setEnabled(bool(self.edited) and any(box.isChecked() for box in self.boxes.values()))

    def finish(self) -> None:
        groups = [group for group, box in self.boxes.items() if box.isChecked()]
        try:
            after = batch.paste_properties(self.document.project, self.source, self.edited, groups)
        except EditError as error:
            self.trouble.setText(tr_error(error))
            return
        self.document.edit(tr("Paste properties"), lambda p: after)
        self.accept()


class ReplaceDialog(BatchDialog):
    """Another clip for actions, which keep their settings."""

    def __init__(self, document: Document, actions: Sequence[str], parent: QWidget | None = None) -> None:
        super().__init__(document, actions, tr("Replace the clip"), tr("Replace"), parent)
        self.clips = ComboBox(self, editable=True)
        self.clips.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.clips.setAccessibleName(tr("Clip"))
        for clip in document.project.clips.values():
            self.clips.addItem(clip.name, clip.id)
        finder = self.clips.completer()
        if finder is not None:
            finder.setFilterMode(Qt.MatchFlag.MatchContains)
            finder.setCompletionMode(QCompleter.CompletionMode.PopupCompletion)
        form = QFormLayout()
        form.addRow(tr("Clip"), self.clips)
        words = QLabel(
            tr("Timing, limb, tags and everything else stay. Times after the clip's end are set to its end."),
            self,
            wordWrap=True,
        )
        words.setProperty("dim", True)
        self.body.addLayout(form)
        self.body.addWidget(words)
        self.close_up()
        first = document.project.action(self.edited[0]) if self.edited else None
        if first is not None:
            self.clips.setCurrentIndex(self.clips.findData(first.clip))

    def finish(self) -> None:
        place = self.clips.findText(self.clips.currentText(), Qt.MatchFlag.MatchFixedString)
        if place < 0:
            self.trouble.setText(tr("the library has no clip '{name}'", name=self.clips.currentText()))
            return
        clip = str(self.clips.itemData(place))
        self.document.edit(tr("Replace the clip"), lambda p: batch.replace_clip(p, self.edited, clip))
        self.accept()
