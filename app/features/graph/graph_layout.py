"""Lay out the canvas, as a pure function of the project and the size, and test what is under a point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from PySide6.QtCore import QPointF, QRectF, QSizeF

from app.features.graph.graph_frames import GRID, HEADER, LINE, NARROW, PAD, ROW, Frames, place_frames
from app.look.names import name_node_rows
from app.translation import make_lazy_texts, tr
from metagraph.graph.model import Action, Kind, Layer, MetaGraph, Project

LEAST_WIDTH, LEAST_HEIGHT = 240.0, 300.0  # pixels; a smaller canvas is laid out as if it was so large
CHIP_HEIGHT, CHIP_TOP = 34, 12
BESIDE: tuple[Kind, ...] = ("gesture", "fidget", "transition")
BAR = 44  # width of a likelihood bar
ARROW = 26  # of a transition's arrow, which can be dragged
TITLE = 124  # of a node's mark and title
CHOOSER = 64.0  # at least, of the stance that transitions lead to
FOOT, FOOT_NARROW = 40, 62  # the sentence at the bottom, in two lines or three
CHIP_MIN, SHORT, CHIP_MAX = 108, 150, 230
BESIDES = 80  # pixels of a chip beside its words
BOLD = 1.12  # how much wider the card's name is than the chip's
MANY = 9  # stances, as many as keys go to; with more, the last chip finds one
BARE = 0  # in the place of a width: chips as wide as their names, which is all they show
TIGHT = -1  # and: as many in a line as can be distinguished
TIGHTEST = 84.0
CHOOSER = 196.0  # pixels from a chooser to the right edge of its node: "another stance?" is reported whole
LEAST_NODES = 300.0  # pixels of height for a card and its nodes below each other

Area = Literal[
    "chip", "add", "find", "card", "loop", "node", "row", "bar", "head", "other", "start", "nothing"
]


@dataclass(frozen=True)
class GraphHit:
    """What is under a point. ident: stance or action id. kind: of the node. behind: whether a drag is over
    the second half of a row.
    """

    area: Area
    ident: str | None = None
    kind: Kind | None = None
    behind: bool = False


@dataclass(frozen=True)
class GraphRow:
    action: Action
    rect: QRectF
    bar: QRectF
    head: QRectF = field(default_factory=QRectF)  # of a transition's arrow
    words: str = ""  # what it is called in its node
    picture: QRectF = field(default_factory=QRectF)  # empty where rows have none


@dataclass(frozen=True)
class NodeLayout:
    """The layout of a node. rows: the visible rows. count: of all rows. scroll, most: the first visible
    row and its maximum.
    """

    kind: Kind
    rect: QRectF
    header: QRectF
    body: QRectF
    rows: tuple[GraphRow, ...]
    count: int
    scroll: int
    most: int
    other: QRectF = field(default_factory=QRectF)  # the chooser of a transition's end
    columns: int = 1


@dataclass(frozen=True)
class Chip:
    """The chip of a stance; stance None is the "+" at the end, or what finds a stance there if `finds`.
    words:
    what the stance lacks. same: the other layers whose stance it is, too. bare: there is only room for the
    name.
    """

    stance: str | None
    rect: QRectF
    name: str
    count: int = 0
    words: str = ""
    bare: bool = False
    same: str = ""
    finds: bool = False


@dataclass(frozen=True)
class Layout:
    size: QSizeF
    chips: tuple[Chip, ...]
    card: QRectF
    loops: QRectF  # the part of the card where a drop adds a loop to the stance, during a drag
    nodes: Mapping[Kind, NodeLayout]
    foot: QRectF
    stance: str | None

    def areas(self) -> dict[str, QRectF]:
        """Return the rectangles of the nodes by name, in widget pixels."""
        return {"stance": self.card, **{str(kind): node.rect for kind, node in self.nodes.items()}}

    def hit(self, at: QPointF, dragging: bool = False) -> GraphHit:
        """Return what is under a point. `dragging` splits the card into "a new stance" and "another loop"."""
        for chip in self.chips:
            if chip.rect.contains(at):
                if chip.stance is not None:
                    return GraphHit("chip", chip.stance)
                return GraphHit("find" if chip.finds else "add")
        for node in self.nodes.values():
            if not node.rect.contains(at):
                continue
            if node.other.contains(at) and not dragging:
                return GraphHit("other", None, node.kind)
            for row in node.rows:
                if dragging and row.rect.contains(at):
                    middle = row.rect.center()
                    behind = at.x() > middle.x() if node.columns > 1 else at.y() > middle.y()
                    return GraphHit("row", row.action.id, node.kind, behind)
                if row.bar.adjusted(-4, -6, 4, 6).contains(at):
                    return GraphHit("bar", row.action.id, node.kind)
                if row.head.contains(at) and not dragging:
                    return GraphHit("head", row.action.id, node.kind)
                if row.rect.contains(at):
                    return GraphHit("row", row.action.id, node.kind)
            return GraphHit("node", None, node.kind)
        if self.card.contains(at):
            if dragging and self.stance is not None and self.loops.contains(at):
                return GraphHit("loop", self.stance, "stance")
            return GraphHit("card", self.stance, "stance")
        return GraphHit("nothing")

    def row(self, action: str) -> GraphRow | None:
        return next(
            (row for node in self.nodes.values() for row in node.rows if row.action.id == action), None
        )


HOLES = make_lazy_texts(lambda: (tr("no loop"), tr("no transition out"), tr("no gestures"), tr("no fidgets")))


def describe_hole(project: Project, layer: Layer, stance: str) -> str:
    """Return in words what a stance lacks, the worst first, or ""."""
    graph = project.graphs[layer]
    if not graph.of(stance, "stance"):
        return HOLES[0]
    if len(graph.stances) > 1 and not graph.of(stance, "transition"):
        return HOLES[1]
    if not graph.of(stance, "gesture"):
        return HOLES[2]
    if not graph.of(stance, "fidget"):
        return HOLES[3]
    return ""


def measure_least_canvas_height(width: float) -> float:
    """Return the least height at which a canvas of this width shows a row in each node. A narrow canvas needs
    more.
    """
    return LEAST_HEIGHT if width >= LINE else 440.0


def lay_out_canvas(
    project: Project,
    layer: Layer,
    stance: str | None,
    size: QSizeF,
    scroll: Mapping[Kind, int] | None = None,
    widths: Mapping[str, float] | None = None,
    same: Mapping[str, str] | None = None,
) -> Layout:
    """Lay out the canvas. scroll: the first visible row of each node. widths: text widths of the chips, in
    pixels. same: on which other layers a stance is, too, in words.
    """
    scroll, widths = scroll or {}, widths or {}
    width = max(size.width(), LEAST_WIDTH)
    height = max(size.height(), measure_least_canvas_height(width))
    graph = project.graphs[layer]

    # Many stances in a low window: narrower chips without words leave room for the nodes.
    for widest in (CHIP_MAX, SHORT, BARE):
        chips = _chips(project, graph, width, widths, widest, same or {})
        top = chips[-1].rect.bottom() + 2 * GRID
        # Names go before pictures and counts.
        whole = widest != SHORT or all(_told(c, widths) + BESIDES <= SHORT for c in chips if c.stance)
        if top < height - FOOT - 320 and whole:
            break
    if top > height - FOOT - LEAST_NODES:  # names alone take too much, too
        tight = _chips(project, graph, width, widths, TIGHT, same or {})
        if tight[-1].rect.bottom() < chips[-1].rect.bottom():  # else nothing is gained by cutting names
            chips = tight
            top = chips[-1].rect.bottom() + 2 * GRID
    actions = {kind: graph.of(stance, kind) if stance else () for kind in BESIDE}
    counts = {kind: len(found) for kind, found in actions.items()}
    found = graph.stances.get(stance or "")
    name = widths.get(found.name, 7.2 * len(found.name)) * BOLD + 44 if found is not None else 0.0
    foot = FOOT if width >= NARROW else FOOT_NARROW
    bottom = max(height - foot, top + 200.0)
    shared = place_frames(width, top, bottom, counts, name)
    if width < NARROW and not shared.all_seen(counts):  # rows before the sentence
        foot, bottom = 0, max(height - GRID, top + 200.0)
        shared = place_frames(width, top, bottom, counts, name)
    card = shared.card
    nodes = {
        kind: _node(
            kind,
            shared,
            actions[kind],
            name_node_rows(project, layer, stance or "", kind),
            scroll.get(kind, 0),
        )
        for kind in BESIDE
    }
    loops = QRectF(card.left(), card.top() + card.height() * 0.58, card.width(), card.height() * 0.42)
    return Layout(
        QSizeF(width, height),
        tuple(chips),
        card,
        loops,
        nodes,
        QRectF(2 * GRID, bottom, width - 4 * GRID, foot),
        stance,
    )


def _chips(
    project: Project,
    graph: MetaGraph,
    width: float,
    widths: Mapping[str, float],
    widest: float,
    same: Mapping[str, str],
) -> list[Chip]:
    """Return the stances as chips in lines, the "+" after them, and what finds one if there are many."""
    chips: list[Chip] = []
    x, y, room = 2.0 * GRID, float(CHIP_TOP), width - 4 * GRID
    for ident, s in graph.stances.items():
        count = sum(len(graph.of(ident, k)) for k in ("gesture", "fidget", "transition"))
        words = describe_hole(project, graph.layer, ident) if widest == CHIP_MAX else ""
        text = widths.get(s.name, 7.2 * len(s.name)) + widths.get(str(count), 16.0)
        if words:
            told = text + widths.get(words, 7 * len(words)) + 8
            words, text = (words, told) if told + BESIDES <= room else ("", text)  # its name goes before
        also = same.get(ident, "") if widest == CHIP_MAX else ""
        if also:
            told = text + widths.get(also, 7 * len(also)) + 8
            also, text = (also, told) if told + BESIDES <= room else ("", text)
        if widest == TIGHT:
            many = max(2, int(room // (TIGHTEST + GRID)))
            w = (room - (many - 1) * GRID) / many
        elif widest == BARE:
            w = min(widths.get(s.name, 7.2 * len(s.name)) + 26, room)
        else:
            w = min(max(text + BESIDES, CHIP_MIN), widest + BESIDES * (bool(words) + bool(also)), room)
        if x + w > width - 2 * GRID and x > 2 * GRID:
            x, y = 2.0 * GRID, y + CHIP_HEIGHT + GRID
        chips.append(Chip(ident, QRectF(x, y, w, CHIP_HEIGHT), s.name, count, words, widest <= BARE, also))
        x += w + GRID
    if x + CHIP_HEIGHT > width - GRID:
        x, y = 2.0 * GRID, y + CHIP_HEIGHT + GRID
    chips.append(Chip(None, QRectF(x, y, CHIP_HEIGHT, CHIP_HEIGHT), "+"))
    if len(graph.stances) > MANY:
        x += CHIP_HEIGHT + GRID
        if x + CHIP_HEIGHT > width - GRID:
            x, y = 2.0 * GRID, y + CHIP_HEIGHT + GRID
        chips.append(Chip(None, QRectF(x, y, CHIP_HEIGHT, CHIP_HEIGHT), "?", finds=True))
    return chips


def _told(chip: Chip, widths: Mapping[str, float]) -> float:
    """Return how wide a chip's name and count are."""
    return widths.get(chip.name, 7.2 * len(chip.name)) + widths.get(str(chip.count), 16.0)


def _node(
    kind: Kind, shared: Frames, actions: tuple[Action, ...], names: Mapping[str, str], scroll: int
) -> NodeLayout:
    rect, columns, high = shared.nodes[kind], shared.columns[kind], shared.row
    header = QRectF(rect.left(), rect.top(), rect.width(), HEADER)
    below = kind == "transition" and rect.width() < TITLE + CHOOSER + 42  # the chooser has a line of its own
    top = HEADER + (ROW + PAD if below else 0)
    body = QRectF(rect.left(), rect.top() + top, rect.width(), rect.height() - top - PAD)
    lines = max(1, int(body.height() // high))
    total = -(-len(actions) // columns)
    most = max(0, total - lines)
    first = min(max(0, scroll), most)
    column = (rect.width() - 2 * GRID - (columns - 1) * GRID) / columns
    rows: list[GraphRow] = []
    for place in range(first * columns, min(len(actions), (first + lines) * columns)):
        line, at = divmod(place - first * columns, columns)
        area = QRectF(
            rect.left() + GRID + at * (column + GRID),
            body.top() + line * high,
            column,
            min(high, body.height()),
        )
        long = BAR if column > 150 else BAR / 2
        bar = QRectF(area.right() - long - 6, area.center().y() - 1.5, long, 3)
        head = QRectF(area.left(), area.top(), ARROW, area.height()) if kind == "transition" else QRectF()
        left = area.left() + (ARROW if kind == "transition" else 6)
        picture = QRectF(left, area.top() + 2, high - 4, high - 4) if high > ROW else QRectF()
        action = actions[place]
        rows.append(GraphRow(action, area, bar, head, names[action.id], picture))
    other = QRectF()
    if below:
        other = QRectF(rect.left() + GRID, rect.top() + HEADER - 2, rect.width() - 2 * GRID, ROW)
    elif kind == "transition":  # right of the title, as far as the count
        x = max(rect.right() - CHOOSER, rect.left() + TITLE)
        other = QRectF(x, rect.top() + 7, max(0.0, rect.right() - 42 - x), HEADER - 14)
    return NodeLayout(kind, rect, header, body, tuple(rows), len(actions), first, most, other, columns)


def read_likelihood_at(row: GraphRow, x: float) -> float:
    """Return the likelihood at a place on a bar: 0.1 at the left, 1 in the middle, 3 at the right, in steps
    of 0.1.
    """
    part = min(1.0, max(0.0, (x - row.bar.left()) / row.bar.width()))
    value = 0.1 + part * 1.8 if part <= 0.5 else 1.0 + (part - 0.5) * 4.0
    return round(value, 1)


def measure_bar_part(likelihood: float) -> float:
    """Return the part of a bar that a likelihood fills, 0..1; the inverse of `read_likelihood_at` within its
    range.
    """
    part = (likelihood - 0.1) / 1.8 if likelihood <= 1 else 0.5 + (likelihood - 1.0) / 4.0
    return min(1.0, max(0.0, part))
