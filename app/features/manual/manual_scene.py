"""Where a machine's nodes and arrows are, in the editor's own units, and what is under a point: values, no
widgets.

All arrows are worked out at once as arrays: a machine of 152 states may have thousands.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, QSizeF

from metagraph.graph.manual.machine import ANY, Link, Manual

Array = NDArray[Any]
NODE = QSizeF(196, 64)
ANY_NODE = QSizeF(112, 34)
ALIAS_NODE = QSizeF(156, 44)
APART = 11.0  # units between arrows that join the same two nodes
LOOP = 13.0  # radius of an arrow that leads back to its own node
EDGE = 10.0  # pixels at a node's border from which a link is drawn
NEAR = 6.0  # pixels within which an arrow is hit
MARGIN = 60.0


@dataclass(frozen=True)
class ManualView:
    """Units to pixels: the widget's left upper corner shows x, y; `scale` pixels a unit."""

    scale: float = 1.0
    x: float = -60.0
    y: float = -60.0

    def to(self, at: QPointF) -> QPointF:
        """Return where a place of the machine is on the widget."""
        return QPointF((at.x() - self.x) * self.scale, (at.y() - self.y) * self.scale)

    def back(self, at: QPointF) -> QPointF:
        """Return which place of the machine is at a point of the widget."""
        return QPointF(at.x() / self.scale + self.x, at.y() / self.scale + self.y)

    def rect(self, size: QSizeF) -> QRectF:
        """Return the part of the machine that a widget shows."""
        return QRectF(self.x, self.y, size.width() / self.scale, size.height() / self.scale)

    def zoomed(self, factor: float, at: QPointF) -> ManualView:
        """Return the view with another scale, 0.08 to 2, the place under `at` staying there."""
        scale = min(2.0, max(0.08, self.scale * factor))
        still = self.back(at)
        return ManualView(scale, still.x() - at.x() / scale, still.y() - at.y() / scale)

    def panned(self, by: QPointF) -> ManualView:
        return ManualView(self.scale, self.x - by.x() / self.scale, self.y - by.y() / self.scale)


def fit_view(rect: QRectF, size: QSizeF, most: float = 1.0) -> ManualView:
    """Return the view that shows all of `rect`, as large as it goes but `most`."""
    wide, high = rect.width() + 2 * MARGIN, rect.height() + 2 * MARGIN
    scale = min(most, max(0.08, min(size.width() / max(wide, 1), size.height() / max(high, 1))))
    return ManualView(
        scale, rect.center().x() - size.width() / scale / 2, rect.center().y() - size.height() / scale / 2
    )


@dataclass(frozen=True)
class ManualHit:
    """What is under a point. "edge" is a node's border, from which links are drawn. ident: a state's,
    alias's or link's id, or ANY.
    """

    area: Literal["node", "edge", "link", "nothing"]
    ident: str = ""


NOTHING = ManualHit("nothing")


class ManualScene:
    """A machine's geometry. moved: where nodes stand instead while they are dragged."""

    def __init__(self, manual: Manual, moved: Mapping[str, tuple[float, float]] | None = None) -> None:
        self.manual = manual
        moved = moved or {}
        self.nodes: dict[str, QRectF] = {}
        for state in manual.states.values():
            x, y = moved.get(state.id, (state.x, state.y))
            self.nodes[state.id] = QRectF(QPointF(x, y), NODE)
        for alias in manual.aliases.values():
            x, y = moved.get(alias.id, (alias.x, alias.y))
            self.nodes[alias.id] = QRectF(QPointF(x, y), ALIAS_NODE)
        x, y = moved.get(ANY, (manual.any_x, manual.any_y))
        self.nodes[ANY] = QRectF(QPointF(x, y), ANY_NODE)

    @cached_property
    def bounds(self) -> QRectF:
        """What all nodes cover; the node for any state counts where it is used, or alone."""
        out = QRectF()
        for ident, rect in self.nodes.items():
            if ident != ANY or not self.manual.states or ANY in self.manual.out:
                out = out.united(rect)
        return out

    def first_view(self, size: QSizeF) -> ManualView:
        """Return what is seen of a machine not looked at yet: all of it, or where the first clips go."""
        if not self.manual.states:
            return ManualView(1.0, self.manual.any_x - 50, self.manual.any_y - 120)
        return fit_view(self.bounds, size)

    @cached_property
    def straight(self) -> tuple[Link, ...]:
        """Links between two nodes, in the order of `lines`."""
        return tuple(
            x
            for x in self.manual.links.values()
            if x.source != x.target and x.source in self.nodes and x.target in self.nodes
        )

    @cached_property
    def places(self) -> Mapping[str, int]:
        """Link id -> its row of `lines`."""
        return {x.id: n for n, x in enumerate(self.straight)}

    @cached_property
    def lines(self) -> Array:
        """Where each straight arrow begins and ends, `[L, 4]`: from border to border, those of the same two
        nodes side by side.
        """
        return measure_arrow_lines(self.nodes, self.straight)

    @cached_property
    def requests(self) -> Array:
        """Whether each straight arrow waits for a request, `[L]`."""
        return np.array([x.condition.when == "request" for x in self.straight], bool)

    @cached_property
    def loops(self) -> Mapping[str, QRectF]:
        """Link id -> the circle of an arrow that leads back to its own node."""
        out: dict[str, QRectF] = {}
        count: dict[str, int] = {}
        for link in self.manual.links.values():
            if link.source == link.target and link.source in self.nodes:
                n = count[link.source] = count.get(link.source, -1) + 1
                rect = self.nodes[link.source]
                middle = QPointF(rect.right() - 24 - n * 2.4 * LOOP, rect.top() - LOOP * 0.45)
                out[link.id] = QRectF(middle.x() - LOOP, middle.y() - LOOP, 2 * LOOP, 2 * LOOP)
        return out

    # --- what is where

    def hit(self, at: QPointF, scale: float) -> ManualHit:
        """Return what is under a point, the last drawn first: nodes over arrows."""
        outer = 4 / scale
        ring = min(EDGE / scale, 13.0)
        for ident in reversed(self.nodes):
            rect = self.nodes[ident]
            if rect.adjusted(-outer, -outer, outer, outer).contains(at):
                inner = rect.adjusted(ring, ring, -ring, -ring)
                return ManualHit("node" if inner.contains(at) else "edge", ident)
        return self.link_at(at, NEAR / scale)

    def link_at(self, at: QPointF, near: float) -> ManualHit:
        """Return the arrow within `near` units of a point, the nearest of several."""
        for ident, circle in self.loops.items():
            away = np.hypot(at.x() - circle.center().x(), at.y() - circle.center().y())
            if abs(away - LOOP) <= near:
                return ManualHit("link", ident)
        if not len(self.lines):
            return NOTHING
        start, end = self.lines[:, :2], self.lines[:, 2:]
        point = np.array([at.x(), at.y()])
        along = end - start
        length = np.maximum((along**2).sum(1), 1e-9)
        part = np.clip(((point - start) * along).sum(1) / length, 0, 1)
        away = np.hypot(*(start + along * part[:, None] - point).T)
        nearest = int(away.argmin())
        return ManualHit("link", self.straight[nearest].id) if away[nearest] <= near else NOTHING

    def inside(self, band: QRectF) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the states and links a rubber band takes: nodes it touches, or if there are none the arrows
        it holds.
        """
        states = tuple(i for i, rect in self.nodes.items() if i != ANY and rect.intersects(band))
        if states or not len(self.lines):
            return states, ()
        inner = self.lines + (self.lines[:, [2, 3, 0, 1]] - self.lines) * 0.1  # their tips touch the nodes
        x, y = inner[:, ::2], inner[:, 1::2]
        held = ((x >= band.left()) & (x <= band.right()) & (y >= band.top()) & (y <= band.bottom())).all(1)
        return (), tuple(self.straight[n].id for n in np.flatnonzero(held))

    def touching(self, idents: Collection[str]) -> tuple[str, ...]:
        """Return the links that begin or end at some nodes."""
        return tuple(x.id for x in self.manual.links.values() if x.source in idents or x.target in idents)

    def middle(self, link: str) -> QPointF:
        """Return where an arrow's words stand."""
        if link in self.loops:
            return QPointF(self.loops[link].center().x(), self.loops[link].top())
        x1, y1, x2, y2 = self.lines[self.places[link]]
        return QPointF((x1 + x2) / 2, (y1 + y2) / 2)


def measure_arrow_lines(nodes: Mapping[str, QRectF], links: Iterable[Link]) -> Array:
    """Return where arrows between nodes begin and end, `[L, 4]`."""
    links = tuple(links)
    if not links:
        return np.zeros((0, 4))
    rects = {i: (r.center().x(), r.center().y(), r.width() / 2, r.height() / 2) for i, r in nodes.items()}
    a = np.array([rects[x.source] for x in links])
    b = np.array([rects[x.target] for x in links])
    among: dict[tuple[str, str], int] = {}
    nth = np.empty(len(links))
    for n, link in enumerate(links):
        key = (link.source, link.target)
        nth[n] = among[key] = among.get(key, -1) + 1
    both = np.array([(x.target, x.source) in among for x in links])
    many = np.array([among[x.source, x.target] for x in links])
    along = b[:, :2] - a[:, :2]
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-6)
    unit = np.where(length[:, None] > 1e-3, along / length[:, None], (1.0, 0.0))
    aside = np.where(both, nth + 0.5, nth - many / 2) * APART  # arrows keep to the right, as cars do
    normal = np.stack([-unit[:, 1], unit[:, 0]], 1) * aside[:, None]
    start = a[:, :2] + normal + unit * _way_out(a[:, 2:], normal, unit)[:, None]
    end = b[:, :2] + normal - unit * (_way_out(b[:, 2:], normal, -unit) + 2.0)[:, None]
    over = ((end - start) * unit).sum(1) < 0  # nodes that overlap: from middle to middle
    out = np.concatenate([start, end], 1)
    out[over] = np.concatenate([a[over, :2], b[over, :2]], 1)
    return out


def _way_out(half: Array, offset: Array, unit: Array) -> Array:
    """Return how far it is from inside a rectangle of half sizes `[L, 2]`, at an offset from its middle, to
    its border along `unit`.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ways = (np.sign(unit) * half - offset) / unit
    ways = np.where(np.abs(unit) < 1e-9, np.inf, ways)
    return np.asarray(np.maximum(ways.min(1), 0.0))
