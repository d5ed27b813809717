"""What is under the pointer in the editor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import QPointF, QRectF

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.rows import RULER, TrackRows
from app.features.timing_editor.track import Facts

REACH = 5.0  # pixels from a line at which it is still taken
EDGE = 4.0  # pixels from a block's edge
FIRST = (
    "start",
    "end",
    "in",
    "out",
    "stroke",
    "exit",
)  # of lines on one another
What = Literal["handle", "block", "stay", "kept", "ruler", "row"]


@dataclass(frozen=True)
class Hit:
    """ident: of the action. name: of the handle, the block or the row, of a hold its moment in the file, of a
    kept hand what `kept_rows` calls its part.
    """

    what: What
    ident: str
    name: str = ""


def find_timing_hit(
    tracks: Sequence[TrackRows],
    facts: Mapping[str, Facts],
    axis: Axis,
    numbers: Mapping[str, Mapping[str, QRectF]],
    at: QPointF,
) -> Hit | None:
    """Return what is under a point; None beside everything. numbers: where the handles' numbers stand."""
    if not tracks:
        return None
    if at.y() < RULER:
        return Hit("ruler", tracks[0].ident) if at.x() >= axis.left - REACH else None
    for rows in tracks:
        if not rows.top <= at.y() <= rows.bottom or at.x() < axis.left - REACH:
            continue
        for name, box in numbers.get(rows.ident, {}).items():
            if box.contains(at):
                return Hit("handle", rows.ident, name)
        return _in(rows, facts[rows.ident], axis, at)
    return None


def _in(rows: TrackRows, facts: Facts, axis: Axis, at: QPointF) -> Hit | None:
    phases = rows.rows.get("phases")
    if phases is not None and phases.contains(at):
        found = _in_phases(rows.ident, facts, axis, at.x())
        if found is not None:
            return found
    elif rows.handles.contains(at):
        near = [
            (round(abs(axis.x(h.at) - at.x())), FIRST.index(h.name), h.name)
            for h in facts.handles
            if h.name in FIRST and abs(axis.x(h.at) - at.x()) <= REACH
        ]
        if near:
            return Hit("handle", rows.ident, min(near)[2])
        for stay in facts.stays:
            if axis.x(stay.first) <= at.x() <= axis.x(stay.last) + REACH and rows.rows["speed"].contains(at):
                return Hit("stay", rows.ident, f"{stay.hold.at}")
    name = next((n for n, r in rows.rows.items() if r.contains(at)), "")
    return Hit("row", rows.ident, name)


def _in_phases(ident: str, facts: Facts, axis: Axis, x: float) -> Hit | None:
    """Return an edge of a block, or the block itself."""
    names = ("ready", "hold", "relax") if facts.blocks else ()
    edges = [(abs(axis.x(h.at) - x), h.name) for h in facts.handles if h.name in (*names, "start", "end")]
    distance, name = min(edges)
    if distance <= EDGE:
        return Hit("handle", ident, name)
    inside = [b.name for b in facts.blocks if axis.x(b.first) <= x <= axis.x(b.last)]
    if inside:
        return Hit("block", ident, inside[0])
    if not facts.blocks and axis.x(facts.span[0]) <= x <= axis.x(facts.span[1]):
        return Hit("block", ident, facts.action.kind)
    return None
