"""Fields for the label of clips, each set alone for all selected clips, whether they have actions or not."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCompleter, QFormLayout, QLabel, QWidget

from app.look.theme import KIND_MARKS, KIND_TITLES
from app.translation import tr
from app.widgets.form_fields import MIXED, Field, Mixed, QuietChooser, find_common_value
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.editing.half_labels import find_half_label, has_half_label
from metagraph.graph.model import KINDS, LAYERS, LIMBS, Project
from metagraph.playback.action_table import Column, list_clip_rows, read_cell


class LabelRows(QWidget):
    """wanted: a column of the table, and its text for all clips that are shown."""

    wanted = Signal(str, str)

    def __init__(self, form: QFormLayout, parent: QWidget) -> None:
        super().__init__(parent)
        self.hide()  # it only holds the fields of the form
        self.form = form
        self._project, self._rows = Project(), list_clip_rows(Project(), ())
        self.choosers = {
            "kind": QuietChooser(parent, toolTip=tr("What kind of action it is; its stance stays")),
            "layer": QuietChooser(parent, toolTip=tr("Which layer it plays on")),
            "limb": QuietChooser(parent, toolTip=tr("The arm it needs")),
        }
        self.fields = {
            "stance": Field(parent, tr("The stance it starts from"), tr("Stance")),
            "end_stance": Field(parent, tr("The stance it ends in; it makes a transition"), tr("Ends in")),
            "tags": Field(parent, tr("Words separated by commas"), tr("Tags")),
        }
        self.waits = QLabel(parent, wordWrap=True)
        self.waits.setProperty("dim", True)
        for title, name in (
            (tr("Kind"), "kind"),
            (tr("Stance"), "stance"),
            (tr("Ends in"), "end_stance"),
            (tr("Layer"), "layer"),
            (tr("Limb"), "limb"),
            (tr("Tags"), "tags"),
        ):
            form.addRow(title, self.choosers.get(name) or self.fields[name])
        form.addRow("", self.waits)
        for name, chooser in self.choosers.items():
            chooser.activated.connect(partial(self._choose, name))
        for name, field in self.fields.items():
            field.editingFinished.connect(partial(self._type, name))

    def show_clips(self, project: Project, clips: Collection[str]) -> None:
        """Show what the labels of clips have in common."""
        self._project, self._rows = project, list_clip_rows(project, clips)
        titles: dict[str, list[tuple[str, object]]] = {
            "kind": [(f"{KIND_MARKS[kind]} {tr(KIND_TITLES[kind])}", kind) for kind in KINDS],
            "layer": [(get_vocabulary_title(layer), layer) for layer in LAYERS],
            "limb": [(get_vocabulary_title(limb), limb) for limb in LIMBS],
        }
        for name, entries in titles.items():
            shared = self._shared(name)
            self.choosers[name].show_entries(entries, shared, tr(MIXED) if shared is Mixed else tr("unknown"))
        for name, field in self.fields.items():
            shared = self._shared(name)
            field.show_text("" if shared is Mixed else str(shared), tuple(clips))
            field.setPlaceholderText(tr(MIXED) if shared is Mixed else "")
        names = list(dict.fromkeys(s.name for g in project.graphs.values() for s in g.stances.values()))
        for name in ("stance", "end_stance"):
            completer = QCompleter(names, self.fields[name])
            completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
            self.fields[name].setCompleter(completer)
        waiting = [clip for clip in clips if has_half_label(project, clip)]
        self.waits.setText(describe_waiting(project, waiting[0]) if waiting else "")
        self.form.setRowVisible(self.waits, bool(waiting))

    def _shared(self, name: str) -> object:
        column: Column = name  # type: ignore[assignment]
        return find_common_value([read_cell(self._project, row, column) for row in self._rows] or [""])

    def _choose(self, name: str, place: int) -> None:
        self.wanted.emit(name, str(self.choosers[name].itemData(place)))

    def _type(self, name: str) -> None:
        words, shared = self.fields[name].text().strip(), self._shared(name)
        if words != shared and not (shared is Mixed and not words):
            self.wanted.emit(name, words)


def describe_waiting(project: Project, clip: str) -> str:
    """Return what a half labelled clip waits for."""
    known = find_half_label(project, clip)
    if not known.kind:
        return tr("It is placed as soon as its kind is known, too.")
    if not known.stance:
        return tr("It is placed as soon as its stance is known, too.")
    if known.kind == "transition" and not known.end_stance:
        return tr("It is placed as soon as the stance it ends in is known, too.")
    return tr("It is placed as soon as there is a stance '{name}' on one layer.", name=known.stance)
