"""How the card of a stance and its three nodes share a room: round the card where there is room all round, in
one column where it is narrow, in one line where it is low.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import QRectF

from metagraph.graph.model import Kind

GRID = 8
HEADER, ROW, PAD = 38, 24, 8
ROWS = (84.0, 60.0, 42.0)  # pixels of rows with a picture: the highest with which all are in sight
NARROW, LOW = 440.0, 320.0  # pixels below which there is no room all round the card
TALL = 700.0  # pixels below which a room that is higher than wide is one column
LINE = 560.0  # the least width of a line of the card and its nodes
PICTURE = 96.0  # the least height of a card with a picture
PICTURED = 480.0  # pixels of height from which rows may have pictures
COLUMN = 170.0  # the least width of a column of rows, where a node has several


@dataclass(frozen=True)
class Frames:
    """card, nodes: their rectangles. columns: of rows, in each node. row: pixels of each, the same in all."""

    card: QRectF
    nodes: Mapping[Kind, QRectF]
    columns: Mapping[Kind, int]
    row: float = ROW

    def all_seen(self, counts: Mapping[Kind, int]) -> bool:
        """Return whether no node has to be scrolled. counts: of the actions of each."""
        return all(
            int((rect.height() - HEADER - PAD) // self.row) * self.columns[kind] >= counts[kind]
            for kind, rect in self.nodes.items()
        )


def place_frames(
    width: float, top: float, bottom: float, counts: Mapping[Kind, int], name: float = 0.0
) -> Frames:
    """Share a room of a width between two heights. counts: of the actions of each node. name: pixels that the
    card's name needs.
    """
    if width < (LINE if bottom - top < LOW else NARROW) or width < min(TALL, 0.9 * (bottom - top)):
        return _column(width, top, bottom, counts)
    if bottom - top < LOW:
        return _line(width, top, bottom, counts)
    if bottom - top >= PICTURED:
        for row in ROWS:
            found = _round(width, top, bottom, counts, name, row)
            if found.all_seen(counts):
                return found
    return _round(width, top, bottom, counts, name, ROW)


def _round(
    width: float, top: float, bottom: float, counts: Mapping[Kind, int], name: float, row: float
) -> Frames:
    usable = bottom - top
    gap = min(max(width * 0.045, 16.0), 56.0)
    middle = max(width * 0.2, 112.0, min(name, width * 0.3))
    side = min(max(300.0, width * 0.36), (width - 4 * GRID - middle - 2 * gap) / 2)
    card_w = min(width - 4 * GRID - 2 * side - 2 * gap, max(240.0, usable * 0.5))
    wide = min(max(width * 0.56, 300.0), max(520.0, width * 0.6))
    each = COLUMN + (row if row > ROW else 0)  # a picture takes its part of a row
    columns: dict[Kind, int] = {"transition": max(1, min(4, int((wide - 2 * GRID) // (each + 15))))}
    lines = -(-counts["transition"] // columns["transition"])
    low_h = min(HEADER + max(lines, 1) * row + PAD + 2, usable * 0.36)
    low_h = max(low_h, HEADER + 2.0 * ROW)
    card_h = min(max(usable - low_h - 5 * GRID, 80.0), card_w * 1.5)
    slack = max(0.0, usable - low_h - card_h)
    card = QRectF((width - card_w) / 2, top + slack * 0.42, card_w, card_h)
    low_top = min(card.bottom() + max(3.0 * GRID, slack * 0.3), bottom - low_h - GRID)
    meets = wide > width - 2 * side - 6 * GRID  # the node below reaches under those beside the card
    beside = max(low_top - 2 * GRID - top if meets else bottom - top - GRID, 120.0)
    nodes: dict[Kind, QRectF] = {}
    lefts: dict[Kind, float] = {"gesture": 2.0 * GRID, "fidget": width - side - 2.0 * GRID}
    for kind, left in lefts.items():
        most = max(1, int((side - 2 * GRID) // each))
        fits = max(1, int((beside - HEADER - PAD) // row))
        columns[kind] = min(most, max(1, -(-counts[kind] // fits)))
        rows = -(-counts[kind] // columns[kind])
        wanted = HEADER + max(rows, 2) * row + PAD + (ROW if rows else 0)
        nodes[kind] = QRectF(left, top, side, min(wanted, beside))
    nodes["transition"] = QRectF((width - wide) / 2, low_top, wide, low_h)
    return Frames(card, nodes, columns, row)


def _column(width: float, top: float, bottom: float, counts: Mapping[Kind, int]) -> Frames:
    """The card above its nodes, which get as much as they need as long as there is enough."""
    inner = width - 2 * GRID
    least = HEADER + ROW + PAD
    room = bottom - top - 4 * GRID
    card_h = max(36.0, min(room * 0.26, 200.0, room - sum(map(_wanted, counts.values()))))
    if card_h < PICTURE:
        card_h = 36.0  # its name alone
    wanted = {kind: _wanted(n) for kind, n in counts.items()}
    left = max(room - card_h, 3.0 * least)
    heights: dict[Kind, float] = {}
    for place, kind in enumerate(sorted(wanted, key=lambda k: wanted[k])):  # who needs little leaves more
        heights[kind] = min(wanted[kind], left / (3 - place))
        left -= heights[kind]
    y, nodes = top + card_h + GRID, {}
    for kind in counts:
        nodes[kind] = QRectF(GRID, y, inner, heights[kind])
        y += heights[kind] + GRID
    return Frames(QRectF(GRID, top, inner, card_h), nodes, dict.fromkeys(counts, 1))


def _wanted(count: int) -> float:
    """Return how high a node of one column is that has all its actions in sight."""
    return HEADER + max(count, 1) * ROW + PAD


def _line(width: float, top: float, bottom: float, counts: Mapping[Kind, int]) -> Frames:
    """The card at the left of its nodes, all equally high."""
    height = bottom - top - GRID
    card_w = min(max(width * 0.18, 110.0), height * 1.1)
    each = (width - 2 * GRID - card_w - 3 * GRID) / 3
    x, nodes = GRID + card_w + GRID, {}
    for kind in counts:
        nodes[kind] = QRectF(x, top, each, height)
        x += each + GRID
    count = max(1, int((each - 2 * GRID) // COLUMN))
    return Frames(QRectF(GRID, top, card_w, height), nodes, dict.fromkeys(counts, count))
