"""What is drawn on the canvas besides its layout, and the strokes all its parts are made of."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QImage, QPainter, QPen

from app.features.graph.graph_drops import Drop
from app.features.graph.graph_layout import GraphHit
from app.look.shortening import shorten_to_font
from app.look.theme import WindowTheme
from metagraph.graph.model import Kind, Project, Stance

RADIUS = 8.0
KNOWN = 512  # pictures
GRAIN = 24  # points across, by which a picture is looked through
FAINT = 40  # of 255: what is more transparent is paper
LYING = 0.36  # of a picture, down to if nothing is of who lies
NOWHERE = GraphHit("nothing")


@dataclass(frozen=True)
class GraphLook:
    """Everything that is drawn besides the layout."""

    theme: WindowTheme
    project: Project
    selected: Collection[str] = ()
    fresh: Collection[str] = ()  # just made
    hover: GraphHit = NOWHERE
    focus: str | None = None
    playing: Collection[str] = ()  # actions under the playhead
    misfits: dict[str, str] = field(default_factory=dict)  # action -> what is wrong with its ends
    picture: QImage | None = None
    chip_pictures: dict[str, QImage] = field(default_factory=dict)
    row_pictures: Mapping[str, QImage] = field(default_factory=dict)  # by clip
    other: str | None = None
    drop: Drop | None = None
    drop_hit: GraphHit = NOWHERE
    drop_at: QPointF | None = None  # where something is held: what a drop does stands beside it
    arrow: tuple[QPointF, QPointF] | None = None  # being dragged, from where to where
    mark: QRectF | None = None  # between two chips, where one that is dragged would be listed
    same: Mapping[str, tuple[Stance, ...]] = field(default_factory=dict)  # see `find_same_stances`
    sentence: str = ""


def make_bold(font: QFont) -> QFont:
    out = QFont(font)
    out.setWeight(QFont.Weight.DemiBold)
    return out


def draw_box(
    painter: QPainter,
    rect: QRectF,
    fill: QColor,
    edge: QColor | None,
    width: float = 1.0,
    dashed: bool = False,
) -> None:
    painter.setBrush(fill)
    if edge is None:
        painter.setPen(Qt.PenStyle.NoPen)
    else:
        pen = QPen(edge, width)
        if dashed:
            pen.setDashPattern([4, 3])
        painter.setPen(pen)
    painter.drawRoundedRect(rect.adjusted(width / 2, width / 2, -width / 2, -width / 2), RADIUS, RADIUS)


def shorten_between(font: QFont, text: str, width: float, others: tuple[str, ...] = ()) -> str:
    """Return as much of a text as there is room for, with what tells it from those beside it."""
    return shorten_to_font(text, int(width), font.toString(), others)


def crop_upper(picture: QImage) -> QRectF:
    """Return the part of a picture in which arms and head are: the upper middle, or all of who lies."""
    key = picture.cacheKey()
    if key not in _UPPER:
        if len(_UPPER) >= KNOWN:
            _UPPER.clear()
        _UPPER[key] = _found_upper(picture)
    return _UPPER[key]


def _found_upper(picture: QImage) -> QRectF:
    wide, high = picture.width(), picture.height()
    small = picture.scaled(GRAIN, GRAIN, mode=Qt.TransformationMode.SmoothTransformation)
    seen = [(x, y) for x in range(GRAIN) for y in range(GRAIN) if small.pixelColor(x, y).alpha() > FAINT]
    if not seen or min(y for _, y in seen) < LYING * GRAIN:
        return QRectF(wide * 0.24, high * 0.03, wide * 0.52, high * 0.52)
    left, top = (min(at) for at in zip(*seen, strict=True))
    right, bottom = (1 + max(at) for at in zip(*seen, strict=True))
    side = min(GRAIN, max(right - left, bottom - top))
    x, y = (max(0.0, min(GRAIN - side, (a + b - side) / 2)) for a, b in ((left, right), (top, bottom)))
    return QRectF(x / GRAIN * wide, y / GRAIN * high, side / GRAIN * wide, side / GRAIN * high)


_UPPER: dict[int, QRectF] = {}  # by picture


def draw_offer(painter: QPainter, rect: QRectF, look: GraphLook, kind: Kind, font: QFont) -> None:
    """Say in a dashed box what a drop will do, or why it will not."""
    assert look.drop is not None
    t = look.theme
    color = QColor(t.kinds[kind]) if look.drop.possible else QColor(t.warning)
    fill = QColor(t.ground)
    fill.setAlpha(225)
    draw_box(painter, rect.adjusted(5, 5, -5, -5), fill, color, 1.4, dashed=True)
    if look.drop_at is not None:
        return  # it stands beside what is held
    painter.setPen(color)
    painter.setFont(font)
    painter.drawText(
        rect.adjusted(14, 8, -14, -8),
        Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap,
        look.drop.words.replace("*", ""),
    )
