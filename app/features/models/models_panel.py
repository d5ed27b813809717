"""The models panel: what follows what on a layer when nobody asks for anything, edited as a heat map; what it
makes; how that compares.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from PySide6.QtCore import QPoint, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import (
    QDockWidget,
    QFrame,
    QHBoxLayout,
    QLabel,
    QMainWindow,
    QMenu,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from app.features.models.compare_plot import ComparePlot
from app.features.models.heatmap import HeatMap
from app.features.models.state_names import name_state
from app.look.theme import KIND_MARKS
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.session import StageSession
from app.translation import tr, tr_noop, tr_plural
from app.widgets.act_strip import ActStrip
from app.widgets.flow import FlowLayout
from app.widgets.form_fields import QuietChooser, Seconds
from app.widgets.making import make_widget
from app.widgets.sentence import OneLine
from metagraph.graph import edits
from metagraph.graph.model import LIMBS, Kind, Layer, Limb, Markov, Project
from metagraph.playback.learning.compare import ModelComparison, compare_model, generate
from metagraph.playback.learning.learn import (
    Act,
    State,
    list_model_states,
    read_acts_of_asks,
    remove_state,
    with_cell,
    with_state,
)
from metagraph.playback.planning.markov import model

HOUR = 3600.0  # seconds the model makes to be compared
SAMPLE = 60.0  # seconds of the sample
TALL = 430  # pixels the panel likes to have, its title included
IMPORTED = "imported"  # what was read last, whether or not it was kept
MERGE = "matrix"
TEACH = tr_noop(
    "<b>No annotation yet:</b> this is the {origin}. Annotate a video in ELAN, with a tier for each arm, the "
    "head and the body and labels such as <i>gesture, fidget, stance-transition, nodding</i>. "
    "<a href='learn'>Import the .eaf file</a> or drop it on the window to learn the model from it. "
    "<a href='sample'>Try the sample annotation.</a>"
)


class ModelsPanel(QWidget):
    """learn_wanted: an annotation is to be imported: "" asks which, "sample" is our own."""

    learn_wanted = Signal(str)

    def __init__(
        self, document: Document, session: StageSession, jobs: Jobs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.imported: Mapping[Layer, Sequence[Act]] = {}
        self.source: str | None = (
            None  # what is compared with: a performance's id or IMPORTED, None for the latest there is
        )
        self.seed = 1
        self._before: Markov | None = None  # the model before the drag that is going on
        self._stale, self._busy, self._again, self._grown = True, False, False, False
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._build()
        self._soon = QTimer(self, singleShot=True, interval=120)
        self._soon.timeout.connect(self._compare)
        document.changed.connect(self._edited)
        document.loaded.connect(self._loaded)
        session.place.layer_changed.connect(self.refresh)
        session.look.changed.connect(self.refresh)

    # --- building

    def _build(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.setSpacing(8)
        layout.addLayout(self._top())
        row = QHBoxLayout()
        row.setSpacing(24)
        row.addLayout(self._left(), 1)
        row.addLayout(self._right(), 1)
        layout.addLayout(row, 1)
        bottom = QHBoxLayout()
        bottom.setSpacing(12)
        self.again = make_widget(
            QPushButton,
            tr("Another sample"),
            self,
            toolTip=tr("Draw other random actions from the same model"),
        )
        self.again.clicked.connect(self._another)
        self.strip = ActStrip(self.session, self, titles=False)
        self.strip.setFixedHeight(60)
        bottom.addWidget(self.again)
        bottom.addWidget(self.strip, 1)
        layout.addLayout(bottom)

    def _top(self) -> QHBoxLayout:
        top = QHBoxLayout()
        top.setSpacing(10)
        self.title, self.origin = QLabel(self), OneLine(self)
        self.title.setProperty("title", True)
        self.origin.setProperty("dim", True)
        top.addWidget(self.title)
        top.addWidget(self.origin, 1)
        self.back = make_widget(
            QPushButton,
            tr("Reset to default"),
            self,
            toolTip=tr("Replace this layer's model by the default model"),
        )
        self.back.clicked.connect(self._reset)
        self.learn = make_widget(
            QPushButton,
            tr("Learn from annotation…"),
            self,
            toolTip=tr("Read an ELAN file (.eaf) and count which action follows which"),
        )
        self.learn.clicked.connect(lambda: self.learn_wanted.emit(""))
        top.addWidget(self.back)
        top.addWidget(self.learn)
        return top

    def _left(self) -> QVBoxLayout:
        left = QVBoxLayout()
        left.setSpacing(6)
        self.heat = HeatMap(self)
        self.heat.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.heat.edited.connect(self._cell)
        self.heat.cancelled.connect(self._cancel)
        self.heat.menu.connect(self._menu)
        scroll = QScrollArea(self)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setWidgetResizable(True)
        scroll.setWidget(self.heat)
        left.addWidget(scroll, 1)
        self.words = QLabel(self, wordWrap=True)
        self.heat.pointed.connect(self._say)
        left.addWidget(self.words)
        return left

    def _right(self) -> QVBoxLayout:
        right = QVBoxLayout()
        right.setSpacing(6)
        fields = FlowLayout(spacing=8)
        self.gap = Seconds(self, tr("Average pause between actions"), most=600)
        self.gap.valueChanged.connect(self._set_gap)
        self.shares: dict[str, Seconds] = {}
        self.share_words = QLabel(tr("positive and negative are separate states"), self)
        self.share_words.setProperty("dim", True)
        fields.addWidget(self._pair(QLabel(tr("Rest"), self), self.gap))
        self.share_labels = []
        for tag in ("positive", "negative"):
            field = Seconds(
                self,
                tr("Share of the gestures that are requested as {tag}", tag=tr(tag)),
                most=100,
                suffix=" %",
                step=1,
                decimals=0,
            )
            field.valueChanged.connect(lambda value, t=tag: self._set_share(t, value))
            self.shares[tag] = field
            label = QLabel(tr(tag.capitalize()), self)
            self.share_labels.append(label)
            fields.addWidget(self._pair(label, field))
        fields.addWidget(self.share_words)
        self.against = QLabel(tr("Compared with"), self)
        self.chooser = QuietChooser(self, tr("The annotation that the model's output is compared with"))
        self.chooser.activated.connect(self._choose)
        fields.addWidget(self._pair(self.against, self.chooser))
        right.addLayout(fields)
        self.teach = QLabel(self, wordWrap=True)
        self.teach.setTextFormat(Qt.TextFormat.RichText)
        self.teach.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.teach.linkActivated.connect(lambda link: self.learn_wanted.emit("" if link == "learn" else link))
        self.plot = ComparePlot(self.session, self)
        right.addWidget(self.teach)
        right.addWidget(self.plot, 1)
        return right

    def _pair(self, label: QLabel, field: QWidget) -> QWidget:
        """Return a label and its field, which stay together where the line is too short."""
        out = QWidget(self)
        row = QHBoxLayout(out)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        row.addWidget(label)
        row.addWidget(field)
        return out

    def sizeHint(self) -> QSize:
        return QSize(1100, TALL)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Catch up once it is seen: the docks behind others are only moved out of sight, which tells
        nobody.
        """
        super().paintEvent(event)
        if self._stale:
            QTimer.singleShot(0, self.refresh)
        if not self._grown:
            self._grown = True
            QTimer.singleShot(0, self._grow)

    def _grow(self) -> None:
        """The dock is low; a matrix is not. Once only: from then on it is as high as it is made."""
        window, dock = self.window(), self.parent()
        while dock is not None and not isinstance(dock, QDockWidget):
            dock = dock.parent()
        if isinstance(window, QMainWindow) and isinstance(dock, QDockWidget) and dock.height() < TALL:
            window.resizeDocks([dock], [min(TALL, window.height() // 2)], Qt.Orientation.Vertical)

    # --- showing

    def model(self) -> Markov:
        return model(self.document.project, self.session.place.layer)

    def refresh(self) -> None:
        """Show the model of the current layer."""
        self._stale = self.visibleRegion().isEmpty()
        if self._stale:
            return
        project, layer, shown = self.document.project, self.session.place.layer, self.model()
        own = layer in project.markov
        self.title.setText(tr("{layer}: which action follows which", layer=tr(layer.capitalize())))
        default = tr("default, from the paper") if layer == "arms" else tr("default")
        of = tr("learned or edited") if own else default
        self.origin.say(f"{of} · {tr_plural('{count:,} state', '{count:,} states', len(shown.states))}")
        self.back.setEnabled(own)
        kinds = {kind for _, kind in project.graphs[layer].index}
        closed = (
            frozenset(n for n, (_, kind) in enumerate(shown.states) if kind not in kinds)
            if kinds
            else frozenset()
        )
        self.heat.show_model(shown, layer, self.session.look.name, closed)
        self.gap.show_value(shown.gap)
        for tag, field in self.shares.items():
            field.show_value(100 * getattr(shown, tag))
            field.setVisible(not shown.tags)
        for label in self.share_labels:
            label.setVisible(not shown.tags)
        self.share_words.setVisible(bool(shown.tags))
        self._show_sources()
        self.strip.show_acts({layer: generate(shown, SAMPLE, self.seed, kinds or None)}, SAMPLE)
        self._soon.start()

    def _say(self, words: str) -> None:
        self.words.setText(words)

    def _sources(self) -> dict[str, tuple[str, tuple[Act, ...]]]:
        """Return what can be compared with: key -> name, acts of this layer."""
        layer, out = self.session.place.layer, {}
        for ident, kept in self.document.project.performances.items():
            acts = read_acts_of_asks(layer, kept.asks)
            if len(acts) > 1:
                out[ident] = kept.name, acts
        if len(self.imported.get(layer, ())) > 1:
            out[IMPORTED] = tr("the last import"), tuple(self.imported[layer])
        return out

    def _show_sources(self) -> None:
        sources = self._sources()
        chosen = self.source if self.source in sources else next(reversed(sources), None)
        self.chooser.show_entries([(name, key) for key, (name, _) in sources.items()], chosen)
        self.chooser.setVisible(bool(sources))
        self.against.setVisible(bool(sources))
        self.teach.setVisible(not sources)
        own = self.session.place.layer in self.document.project.markov
        layer = tr(self.session.place.layer)
        origin = (
            tr("edited model of the {layer}", layer=layer)
            if own
            else tr("default model of the {layer}", layer=layer)
        )
        self.teach.setText(tr(TEACH).format(origin=origin))

    def _choose(self, place: int) -> None:
        self.source = self.chooser.itemData(place)
        self._soon.start()

    def show_imported(self, observed: Mapping[Layer, Sequence[Act]], performance: str | None) -> None:
        """Compare with what was just read."""
        self.imported = {} if performance is not None else observed
        self.source = performance or IMPORTED
        self.refresh()

    def _compare(self) -> None:
        """Let the model make an hour, on a thread; only the latest is shown."""
        if self._busy:
            self._again = True
            return
        self._busy, self._again = True, False
        shown, sources = self.model(), self._sources()
        key = self.chooser.currentData()
        acts = [sources[key][1]] if key in sources else None
        self.jobs.start(
            "compare", lambda _: compare_model(shown, acts, HOUR), self._compared, self._failed, quick=True
        )

    def _compared(self, found: ModelComparison) -> None:
        self._busy = False
        if found.model == self.model():
            self.plot.show_comparison(found)
        if self._again:
            self._soon.start()

    def _failed(self, error: Exception) -> None:
        self._busy = False
        self.document.failed.emit(tr("The model cannot be compared: {error}", error=error))

    # --- following

    def _edited(self, before: Project, after: Project) -> None:
        if (
            before.markov is not after.markov
            or before.performances is not after.performances
            or before.graphs is not after.graphs
        ):
            self.refresh()

    def _loaded(self) -> None:
        self.imported, self.source, self._before = {}, None, None

    # --- editing

    def _edit(self, text: str, change: Callable[[Markov], Markov], merge: str | None = None) -> None:
        layer = self.session.place.layer
        self.document.edit(text, lambda p: edits.set_markov(p, change(model(p, layer))), merge)

    def _add_state(self, state: State) -> None:
        self._edit(tr("Add state"), lambda m: with_state(m, state))

    def _cell(self, row: int, column: int, probability: float, dragging: bool) -> None:
        if dragging and self._before is None:
            self._before = self.model()
        before = self._before
        if before is not None and dragging:
            self._edit(
                tr("Change transition probability"),
                lambda _: with_cell(before, row, column, probability),
                MERGE,
            )
        elif before is not None:
            self._before = None
            self.document.finish_merging()
        else:
            self._edit(tr("Change transition probability"), lambda m: with_cell(m, row, column, probability))

    def _cancel(self) -> None:
        if self._before is not None:
            self._before = None
            self.document.cancel_merging(MERGE)

    def _set_gap(self, value: float) -> None:
        if value > 0:
            self._edit(tr("Change average pause"), lambda m: replace(m, gap=round(value, 2)))
        else:
            self.refresh()

    def _set_share(self, tag: str, value: float) -> None:
        other = "negative" if tag == "positive" else "positive"
        if value < 0:
            self.refresh()
            return
        share = round(min(value, 100.0) / 100, 4)

        def change(m: Markov) -> Markov:
            return replace(m, **{tag: share, other: min(getattr(m, other), round(1 - share, 4))})

        self._edit(tr("Change share of {tag}", tag=tr(tag)), change)

    def _reset(self) -> None:
        layer = self.session.place.layer
        self.document.edit(tr("Reset to the default model"), lambda p: edits.reset_markov(p, layer))

    def _another(self) -> None:
        self.seed += 1
        self.refresh()

    # --- states

    def state_menu(self, row: int) -> QMenu:
        """Return the menu of a state: another one, or away with this one. row: -1 for none."""
        menu, shown, layer = QMenu(self), self.model(), self.session.place.layer
        there = set(list_model_states(shown))
        tags = dict.fromkeys(
            ("", *(tag for _, _, tag in there), *(("positive", "negative") if shown.tags else ()))
        )
        limbs: tuple[Limb, ...] = LIMBS if layer == "arms" else ("both",)
        kinds: tuple[Kind, ...] = ("gesture", "fidget", "transition")
        add = menu.addMenu(tr("Add state"))
        for limb in limbs:
            for kind in kinds:
                for tag in tags if kind == "gesture" else ("",):
                    state: State = (limb, kind, tag)
                    if state not in there:
                        words = f"{KIND_MARKS[kind]} {name_state(state, layer)}"
                        add.addAction(words, partial(self._add_state, state))
        add.setEnabled(not add.isEmpty())
        if 0 <= row < len(shown.states) and len(shown.states) > 1:
            words = name_state(list_model_states(shown)[row], layer)
            menu.addAction(
                tr("Remove {words}", words=words),
                lambda: self._edit(tr("Remove state"), lambda m: remove_state(m, row)),
            )
        return menu

    def _menu(self, row: int, at: QPoint) -> None:
        menu = self.state_menu(row)
        menu.exec(at)
        menu.deleteLater()
