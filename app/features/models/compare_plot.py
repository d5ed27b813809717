"""What was seen beside what a model makes: how often each state comes, and how long it lasts. Outlined is
seen, filled is made.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor, QFont, QFontMetricsF
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.features.models.heatmap import SIDES
from app.features.models.state_names import name_state
from app.look.theme import KIND_MARKS, get_theme
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.still_plot import clear_plot, make_still_plot
from metagraph.playback.learning.compare import SURE, ModelComparison, compute_quantiles
from metagraph.playback.learning.learn import State

WIDTH = 0.34  # of a bar; two stand side by side
TOP = 6.0  # pixels, so that a number at the upper end is whole
LETTERS, NARROW_LETTERS, NARROW = 14, 11, 600  # pixels of letters under bars, and of a plot with smaller ones
APART = 4.0  # pixels between the words under bars, at least


def shorten_state(state: State, layer: str) -> str:
    """Return a state as it stands under a bar: "▲L", "◆LR", "▲+"."""
    limb, kind, tags = state
    return (
        KIND_MARKS[kind]
        + (SIDES[limb] if layer == "arms" else "")
        + {"": "", "positive": "+", "negative": "−"}.get(tags, " …")
    )


def describe_model_fit(found: ModelComparison) -> str:
    """Say in a sentence how well a model makes what was seen."""
    layer = found.model.layer
    if found.observed is None:
        return tr("Nothing to compare with yet. The outlines show the long-run shares of the matrix.")
    apart = found.apart()
    worst = int(np.argmax(np.abs(np.nan_to_num(apart, posinf=1e9, neginf=-1e9))))
    if abs(apart[worst]) <= SURE:
        return tr("The model makes each action about as often as it was seen.")
    name, seen, made = (
        name_state(found.observed.states[worst], layer),
        found.observed.shares()[worst],
        found.expected[worst],
    )
    return tr(
        "Differs from what was seen: {name} was {seen:.0f} % of the actions, but the model makes "
        "{made:.0f} %.",
        name=name,
        seen=100 * seen,
        made=100 * made,
    )


class ComparePlot(QWidget):
    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.found: ModelComparison | None = None
        self.often, self.long = self._plot(), self._plot()
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        row = QHBoxLayout()
        row.setSpacing(12)
        for title, plot in (
            (tr("How often, % of actions"), self.often),
            (tr("How long, seconds"), self.long),
        ):
            box = QVBoxLayout()
            box.setSpacing(0)
            label = QLabel(title, self)
            label.setProperty("title", True)
            box.addWidget(label)
            box.addWidget(plot, 1)
            row.addLayout(box, 1)
        layout.addLayout(row, 1)
        layout.addWidget(self.words)
        session.look.changed.connect(self._draw)
        self._draw()  # in the theme's colours before there is anything, too

    def _plot(self) -> Any:
        plot = make_still_plot(self)
        plot.getAxis("left").setWidth(34)
        plot.plotItem.vb.sigResized.connect(self._name_bars)
        plot.setMinimumHeight(76)
        plot.plotItem.layout.setContentsMargins(0, TOP, 0, 0)
        plot.setYRange(0, 1.08, padding=0.05)  # the uppermost number is whole, too
        plot.scene().sigMouseMoved.connect(lambda at, p=plot: self._hover(p, at))
        return plot

    def show_comparison(self, found: ModelComparison) -> None:
        self.found = found
        self._draw()

    def _draw(self) -> None:
        t = get_theme(self.session.look.name)
        for plot in (self.often, self.long):
            clear_plot(plot, t)
        if self.found is None:
            return
        found = self.found
        seen = found.expected if found.observed is None else found.observed.shares()
        made = found.generated.shares()
        chance = 2 * found.deviation
        for n, state in enumerate(found.generated.states):
            color = t.fill(state[1])
            self._bar(self.often, n - WIDTH / 2, 100 * seen[n], color, False)
            self._bar(self.often, n + WIDTH / 2, 100 * made[n], color, True)
            whisker = pg.PlotDataItem(
                [n + WIDTH / 2] * 2, [100 * max(0.0, made[n] - chance[n]), 100 * (made[n] + chance[n])]
            )
            whisker.setPen(pg.mkPen(t.text, width=1.3))
            self.often.addItem(whisker)
            if found.observed is not None:
                self._box(self.long, n - WIDTH / 2, found.observed.lengths[n], color, False)
            self._box(self.long, n + WIDTH / 2, found.generated.lengths[n], color, True)
        count = len(found.generated.states)
        if found.observed is not None:
            self._box(self.long, count - WIDTH / 2, found.observed.rests, QColor(t.dim), False)
        self._box(self.long, count + WIDTH / 2, found.generated.rests, QColor(t.dim), True)
        self._name_bars()
        self.often.setXRange(-0.5, count - 0.5, padding=0.02)
        self.often.setYRange(0, 108 * float(max(np.max(seen), np.max(made + chance), 0.05)), padding=0.0)
        self.long.setXRange(-0.5, count + 0.5, padding=0.02)
        tallies = [x for x in (found.observed, found.generated) if x is not None]
        tops = [
            compute_quantiles(x)[-1] for tally in tallies for x in (*tally.lengths, tally.rests) if len(x)
        ]
        self.long.setYRange(0, 1.08 * max(tops, default=1.0), padding=0)
        self.words.setText(describe_model_fit(found))

    def _name_bars(self) -> None:
        """Write states under their bars; where these stand close without marks, as bars have their
        colours.
        """
        if self.found is None:
            return
        states, layer = self.found.generated.states, self.found.model.layer
        font, rest = QFont(self.font()), tr("rest")
        font.setPixelSize(NARROW_LETTERS if self.width() < NARROW else LETTERS)
        metrics = QFontMetricsF(font)
        for plot, more in ((self.often, []), (self.long, [rest])):
            names = [shorten_state(state, layer) for state in states]
            room = plot.plotItem.vb.width() / (1.04 * (len(names) + len(more))) - APART
            if layer == "arms" and max(map(metrics.horizontalAdvance, names)) > room:
                names = [name[1:] for name in names]
            plot.getAxis("bottom").setTickFont(font)
            plot.getAxis("bottom").setTicks([list(enumerate([*names, *more]))])

    def _bar(self, plot: Any, x: float, height: float, color: QColor, filled: bool) -> None:
        pale = QColor(color)
        pale.setAlpha(36)
        bar = pg.BarGraphItem(x=[x], width=WIDTH - 0.05, height=[height])
        bar.setOpts(pen=pg.mkPen(color, width=1.4), brush=color if filled else pale)
        plot.addItem(bar)

    def _box(self, plot: Any, x: float, lengths: np.ndarray, color: QColor, filled: bool) -> None:
        """Draw the middle half of lengths as a box, the middle 80 % as a line, the median across."""
        if not len(lengths):
            return
        low, quarter, middle, three, high = compute_quantiles(lengths)
        line = pg.PlotDataItem([x, x], [low, high])
        line.setPen(pg.mkPen(color, width=1.4))
        plot.addItem(line)
        pale = QColor(get_theme(self.session.look.name).panel)
        box = pg.BarGraphItem(x=[x], width=WIDTH - 0.05, y0=[quarter], height=[three - quarter])
        box.setOpts(pen=pg.mkPen(color, width=1.4), brush=color if filled else pale)
        plot.addItem(box)
        median = pg.PlotDataItem([x - WIDTH / 2 + 0.03, x + WIDTH / 2 - 0.03], [middle, middle])
        median.setPen(pg.mkPen("#17181b" if filled else color, width=2))
        plot.addItem(median)

    def _hover(self, plot: Any, at: QPointF) -> None:
        if self.found is None:
            return
        n = round(plot.plotItem.vb.mapSceneToView(at).x())
        states = self.found.generated.states
        if plot is self.often and 0 <= n < len(states):
            self.words.setText(describe_often(self.found, n))
        elif plot is self.long and 0 <= n <= len(states):
            self.words.setText(describe_long(self.found, n))

    def leaveEvent(self, event: object) -> None:
        if self.found is not None:
            self.words.setText(describe_model_fit(self.found))


def describe_often(found: ModelComparison, n: int) -> str:
    """Say how often a state was seen and made."""
    name = name_state(found.generated.states[n], found.model.layer)
    made = tr(
        "made {share:.1%} ± {chance:.1%} by chance",
        share=found.generated.shares()[n],
        chance=2 * found.deviation[n],
    )
    if found.observed is None:
        return tr(
            "{name}: {made}; in the long run {expected:.1%}", name=name, made=made, expected=found.expected[n]
        ).replace("%", " %")
    return tr(
        "{name}: seen {share:.1%}, {made}", name=name, share=found.observed.shares()[n], made=made
    ).replace("%", " %")


def describe_long(found: ModelComparison, n: int) -> str:
    """Say how long a state, or the rest between, lasts: the median, and what four of five lie between."""
    states = found.generated.states
    name = name_state(states[n], found.model.layer) if n < len(states) else tr("rest between actions")
    parts = []
    for word, tally in ((tr("seen"), found.observed), (tr("made"), found.generated)):
        lengths = None if tally is None else tally.lengths[n] if n < len(states) else tally.rests
        if lengths is not None and len(lengths):
            low, _, middle, _, high = compute_quantiles(lengths)
            parts.append(
                tr(
                    "{word} {middle:.1f} s (mostly {low:.1f} to {high:.1f})",
                    word=word,
                    middle=middle,
                    low=low,
                    high=high,
                )
            )
    return f"{name}: {', '.join(parts) or tr('never')}"
