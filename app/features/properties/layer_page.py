"""The properties of a layer, and what holds for all of them."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtWidgets import QFrame, QLabel, QWidget

from app.features.properties.page_form import Edit, add_form, make_page_box
from app.features.properties.variation_rows import PlannerRows
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.form_fields import QuietChooser, Seconds
from app.widgets.vocabulary import get_vocabulary_title, get_vocabulary_word
from metagraph.graph import edits
from metagraph.graph.model import PARTS, REACH
from metagraph.graph.words import Part


class LayerPage(QWidget):
    def __init__(self, document: Document, session: StageSession, edit: Edit, parent: QWidget) -> None:
        super().__init__(parent)
        self.document, self.session, self.edit = document, session, edit
        box = make_page_box(self)
        self.title = QLabel(self)
        self.title.setProperty("title", True)
        box.addWidget(self.title)
        words = QLabel(
            tr(
                "Select an action to see its timing. The layer moves these body parts, on top of the "
                "base pose:"
            ),
            self,
            wordWrap=True,
        )
        words.setProperty("dim", True)
        box.addWidget(words)
        form = add_form(box)
        self.weights: dict[str, Seconds] = {}
        for part in PARTS:
            field = Seconds(
                self,
                tr(
                    "How much the layer moves the {part}: 0 not at all, 1 as in the clip, 2 twice as much",
                    part=get_vocabulary_word(part),
                ),
                2,
                "",
                0.1,
            )
            field.valueChanged.connect(lambda v, p=part: self._weigh(p, v))
            self.weights[part] = field
            form.addRow(get_vocabulary_title(part), field)
        line = QFrame(self, frameShape=QFrame.Shape.HLine)
        line.setStyleSheet("color: palette(mid)")
        box.addWidget(line)
        form = add_form(box)
        self.gap = Seconds(
            self, tr("Average pause between two actions that play without a request"), 60, " s", 0.2
        )
        self.gap.valueChanged.connect(self._set_gap)
        form.addRow(tr("Average pause"), self.gap)
        self.base = QuietChooser(
            self, toolTip=tr("The neutral pose that all layers are added to, with the hands at the sides")
        )
        self.base.activated.connect(self._set_base)
        form.addRow(tr("Base pose"), self.base)
        self.base_frame = Seconds(self, tr("Which frame of the clip is the base pose"), 1e6, "", 1, 0)
        self.base_frame.valueChanged.connect(self._set_base_frame)
        form.addRow(tr("Frame"), self.base_frame)
        line = QFrame(self, frameShape=QFrame.Shape.HLine)
        line.setStyleSheet("color: palette(mid)")
        box.addWidget(line)
        words = QLabel(tr("For all layers, when the planner picks an action:"), self, wordWrap=True)
        words.setProperty("dim", True)
        box.addWidget(words)
        self.planner = PlannerRows(add_form(box), self, edit)
        box.addStretch(1)

    def show_layer(self) -> None:
        """Show the current layer's."""
        project, layer = self.document.project, self.session.place.layer
        graph = project.graphs[layer]
        self.title.setText(tr("{layer} layer", layer=get_vocabulary_title(layer)))
        for part in PARTS:
            self.weights[part].show_value(graph.weights.get(part, REACH[layer][part]))
        from metagraph.playback.planning.markov import model

        self.gap.show_value(model(project, layer).gap)
        clips = [(tr("Rest pose of the skeleton"), None), *((e.name, e.id) for e in project.clips.values())]
        self.base.show_entries(clips, project.base.clip, tr("a missing clip"))
        self.base.setEnabled(bool(project.clips))
        self.base_frame.setEnabled(project.base.clip is not None)
        self.base_frame.show_value(project.base.frame)
        self.planner.show_settings(project.settings)

    def _weigh(self, part: Part, value: float) -> None:
        if value < 0:
            self.show_layer()
        else:
            layer = self.session.place.layer
            self.edit(tr("Change layer weight"), lambda p: edits.set_weight(p, layer, part, round(value, 2)))

    def _set_gap(self, value: float) -> None:
        from metagraph.playback.planning.markov import model

        layer = self.session.place.layer
        if value <= 0:
            self.show_layer()
        else:
            self.edit(
                tr("Change average pause"),
                lambda p: edits.set_markov(p, replace(model(p, layer), gap=round(value, 2))),
            )

    def _set_base(self, place: int) -> None:
        clip = self.base.itemData(place)
        self.edit(tr("Set base pose"), lambda p: edits.set_base(p, clip, 0))

    def _set_base_frame(self, value: float) -> None:
        clip = self.document.project.base.clip
        if clip is not None and value >= 0:
            self.edit(tr("Set base pose"), lambda p: edits.set_base(p, clip, int(value)))
