"""What screen readers report about the timeline: the requests, and the actions that play."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from PySide6.QtCore import QRectF

from app.translation import tr
from app.widgets.lane_geometry import describe_mark, place_lanes
from app.widgets.lane_paint import describe_cue
from app.widgets.spoken_items import SpokenItem
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import LAYERS


def list_lane_items(view: Any) -> Sequence[SpokenItem]:
    """Return the requests on a timeline in the order of their times, then the actions of each layer."""
    chosen = view.session.onstage.requests
    out = []
    for mark in sorted(view.marks(), key=lambda m: m.at):
        words = describe_mark(mark, view.performance.requests.editable).splitlines()
        name = tr("Request at {at:.2f} s: {what}", at=mark.at, what=words[0])
        selected = mark.ask.id in chosen
        focused = selected and mark.ask.id == chosen[-1]
        out.append(
            SpokenItem(name, mark.rect, description=", ".join(words[1:]), selected=selected, focused=focused)
        )
    if view.session.transport.show == "plan":
        out += _list_cues(view)
    return out


def _list_cues(view: Any) -> Iterable[SpokenItem]:
    shown, lanes, scale = view.performance.shown, place_lanes(view.height(), view.sizes), view.scale()
    for layer in LAYERS:
        plan, lane = shown.plan.layers.get(layer), lanes.get(layer)
        if plan is None or lane is None:
            continue
        for cue in plan.cues:
            left, right = scale.x(cue.start), scale.x(cue.end)
            name = tr(
                "{layer}: {name}, {kind}",
                layer=get_vocabulary_title(layer),
                name=describe_cue(shown.project, cue.action),
                kind=tr(cue.action.kind),
            )
            words = tr("{start:.2f} to {end:.2f} s", start=cue.start, end=cue.end)
            selected = cue.action.id in view.session.selection.actions
            rect = QRectF(left, lane.top(), max(1.0, right - left), lane.height())
            yield SpokenItem(name, rect, description=words, selected=selected)
