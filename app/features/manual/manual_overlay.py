"""Paint what changes on the canvas of the manual editor: the selection, drags, new links, and what plays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.features.manual import manual_painter as painter
from app.features.manual.manual_scene import ManualHit
from app.stage.playback_source import ShownPlayback
from app.translation import tr, tr_noop
from metagraph.graph.model import Layer
from metagraph.playback.manual_playback import compute_clip_seconds

TOLD = 8  # selected links, up to which each tells what it waits for
EMPTY = tr_noop("Drop clips here to add states. Drag from a state's border to draw a link.")


@dataclass(frozen=True)
class ManualMarks:
    """dragged: nodes that are, and where they stand now. source, end, target: of a link that is being drawn,
    no source for none. sources: all that it is drawn from.

    band: a rubber band. turn: the state that plays, and how far it is, 0..1. at: the mouse. busy: it drags
    something. dropping: words about what is dragged in. map_place: where the map goes.
    """

    dragged: Mapping[str, tuple[float, float]]
    hover: ManualHit
    source: str
    end: QPointF
    target: str
    sources: tuple[str, ...]
    band: QRectF | None
    turn: tuple[str, float]
    at: QPointF
    busy: bool
    dropping: str
    map_place: QRectF


def find_playing_state(shown: ShownPlayback, layer: Layer, seconds: float) -> tuple[str, float]:
    """Return the playing state of a layer ("" for none) and its progress, 0..1."""
    of = shown.manual.layers.get(layer) if shown.manual is not None else None
    turn = of.at(seconds) if of is not None else None
    if turn is None:
        return "", 0.0
    start, end = shown.project.span(turn.action)
    return turn.action.id, round(
        (float(compute_clip_seconds(shown.project, turn, seconds)) - start) / max(1e-6, end - start), 2
    )


def paint_over(p: QPainter, look: painter.ManualLook, marks: ManualMarks, rect: QRectF) -> None:
    """Paint what changes under the mouse. rect: the widget."""
    links = look.scene.manual.links
    dim, strong = QColor(look.theme.dim), QColor(look.theme.text)
    for ident in look.scene.touching(marks.dragged) if marks.dragged else ():
        painter.paint_link(p, look, links[ident], dim, 1.3, told=False)
    for ident in look.scene.touching(look.states) if not marks.dragged else ():
        painter.paint_link(p, look, links[ident], strong, 1.2, told=False)
    if marks.hover.area == "link" and marks.hover.ident in links:
        painter.paint_link(p, look, links[marks.hover.ident], strong, 1.8)
    for ident in look.links:
        if ident in links:
            painter.paint_link(p, look, links[ident], strong, 2.4, told=len(look.links) <= TOLD)
    _nodes(p, look, marks)
    for source in marks.sources if marks.source else ():
        begin = look.view.to(look.scene.nodes[source].center())
        painter.paint_arrow(p, begin, marks.end, look.theme.kind("stance"), 2.2, 1.0)
    if marks.band is not None:
        fill = QColor(look.theme.text)
        fill.setAlpha(26)
        p.setPen(QPen(dim, 1))
        p.setBrush(fill)
        p.drawRect(QRectF(look.view.to(marks.band.topLeft()), look.view.to(marks.band.bottomRight())))
    if look.scene.manual.states and not look.view.rect(rect.size()).contains(look.scene.bounds):
        painter.paint_map(p, look, marks.map_place, rect)
    if marks.dropping or not look.scene.manual.states:
        p.setPen(strong if marks.dropping else dim)
        p.setFont(look.font)
        where = Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom
        p.drawText(rect.adjusted(20, 20, -20, -20), where, marks.dropping or tr(EMPTY))


def _nodes(p: QPainter, look: painter.ManualLook, marks: ManualMarks) -> None:
    over = {marks.hover.ident} if marks.hover.area in ("node", "edge") else set()
    for ident in dict.fromkeys((*marks.dragged, *look.states, *over, marks.source, marks.target)):
        if ident in look.scene.nodes:
            painter.paint_node(
                p,
                look,
                ident,
                ident in look.states,
                ident in over,
                bool(marks.target) and ident == marks.target,
            )
    for ident in look.states:
        alias = look.scene.manual.aliases.get(ident)
        for member in look.scene.manual.members(alias) if alias is not None else ():
            p.setPen(QPen(QColor(look.theme.kinds["stance"]), 1.6, Qt.PenStyle.DashLine))
            p.setBrush(Qt.BrushStyle.NoBrush)
            box = look.scene.nodes[member]
            place = QRectF(look.view.to(box.topLeft()), look.view.to(box.bottomRight()))
            p.drawRoundedRect(place.adjusted(-4, -4, 4, 4), 8, 8)
    if marks.turn[0] in look.scene.nodes:
        painter.paint_playing(p, look, *marks.turn)
    if (
        marks.hover.area == "edge"
        and marks.hover.ident in look.scene.nodes
        and not marks.source
        and not marks.busy
    ):
        painter.paint_port(p, look, marks.hover.ident, marks.at)
