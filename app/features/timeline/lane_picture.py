"""Everything on the timeline that stands still while it plays: lanes, words, other seeds, padlocks."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter

from app.features.timeline.lane_titles import LOCK, paint_padlock
from app.features.timeline.stage_words import explain_silence
from app.features.timeline.voice_lane import paint_voice
from app.features.timeline.what_if import get_ghost_seed, paint_ghost
from app.look.theme import get_theme
from app.widgets.lane_geometry import LEFT, NAMES, RULER, RequestMark, place_lanes, split_lane
from app.widgets.lane_paint import LaneScene, paint_lane_scene
from app.widgets.request_menu import STAGE


def paint_lanes(
    view: Any, painter: QPainter, found: Sequence[RequestMark], ends: float | None, locked: Collection[str]
) -> None:
    """Paint all lanes. view: their widget. found: requests as they stand. ends: seconds at which all ends."""
    t, ratio = get_theme(view.session.look.name), view.devicePixelRatioF()
    scene = LaneScene(
        view.performance.shown,
        found,
        view.scale(),
        view.width(),
        view.height(),
        view.session.place.layer,
        ends,
        set(view.session.selection.actions),
        set(view.session.onstage.requests),
        view.sizes,
        locked,
    )
    paint_lane_scene(painter, t, scene)
    words = explain_silence(view.performance.shown, view.session)
    if words:
        room = QRectF(LEFT + 20, RULER, view.width() - LEFT - 40, view.height() - RULER)
        painter.setPen(QColor(t.dim))
        painter.drawText(room, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, words)
    for name, lane in place_lanes(view.height(), view.sizes).items():
        if name == "words":
            paint_voice(painter, t, lane, view.scale(), view.width(), view.voices, ratio)
        elif (seed := get_ghost_seed(name)) is not None:
            plan = view.what_if.plans.get(seed)
            paint_ghost(painter, t, lane, view.scale(), view.width(), plan)
        if name == STAGE and "words" not in view.sizes.extra and view.voices.words():
            row = split_lane(lane)[1]
            painter.fillRect(row.adjusted(LEFT, 0, 0, -3), QColor(t.panel))
            paint_voice(painter, t, row, view.scale(), view.width(), view.voices, ratio)
        if name in NAMES:
            at = QPointF(LEFT - LOCK / 2, lane.center().y())
            paint_padlock(painter, t, at, name in locked)
