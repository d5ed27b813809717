"""What is said about what the mouse is over on the timeline."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication

from app.features.timeline.what_if import get_ghost_seed
from app.look.names import describe_name_in_tooltip
from app.translation import tr, tr_noop
from app.widgets.lane_geometry import (
    LEFT,
    RULER,
    describe_mark,
    find_cue_at,
    find_lane_at,
    mark_at,
    place_lanes,
)
from app.widgets.lane_paint import describe_cue

# of actions, within a sentence
KINDS = (tr_noop("stance"), tr_noop("gesture"), tr_noop("fidget"), tr_noop("transition"))


def describe_place(view: Any, at: QPointF) -> str:
    """Return what to say about what is under a point of the lanes."""
    if at.x() < LEFT:
        return view.titles.tip(at)
    if at.y() < RULER:
        return view.ruler.tip(at)
    mark = mark_at(view.marks(), at)
    if mark is not None:
        return describe_mark(mark, view.performance.requests.editable)
    found = find_cue_at(view.performance.shown, view.scale(), view.height(), at, view.sizes)
    if found is not None:
        cue = found[1]
        name = describe_name_in_tooltip(
            describe_cue(view.performance.shown.project, cue.action), cue.action.name
        )
        words = tr(
            "{name}\n{kind}, {start:.2f} to {end:.2f} s",
            name=name,
            kind=tr(cue.action.kind),
            start=cue.start,
            end=cue.end,
        )
        if cue.hold > 0:
            words += tr(", held {hold:.2f} s", hold=cue.hold)
        return words + tr("\nClick to select it, double-click to play it in context")
    lane = find_lane_at(view.height(), at, view.sizes)
    if lane is None:
        return ""
    if lane == "cameras":
        return view.cameras.tip(at)
    seed = get_ghost_seed(lane)
    if seed is not None:
        row = place_lanes(view.height(), view.sizes)[lane]
        return view.what_if.tip(seed, view.scale().seconds(at.x()), (at.y() - row.top()) / row.height())
    if lane == "words":
        at_time = view.scale().seconds(at.x())
        word = next((w for w in view.words() if w[0] <= at_time < w[1]), None)
        return (
            tr("'{word}', {start:.2f} to {end:.2f} s", word=word[2], start=word[0], end=word[1])
            if word is not None
            else ""
        )
    shown, here = view.performance.shown, ""
    plan = next((p for layer, p in shown.plan.layers.items() if layer == lane), None)
    if plan is not None:
        stance = shown.project.stance(plan.stance_at(view.scale().seconds(at.x())))
        here = stance.name if stance is not None else ""
    more = "" if QApplication.mouseButtons() else tr("Double-click to add a request here")
    return "\n".join(x for x in (here, more) if x)
