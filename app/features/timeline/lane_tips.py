"""What is said about what the mouse is over on the timeline."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication

from app.features.timeline.what_if import seed_of
from app.look.names import told_names
from app.widgets.lane_geometry import LEFT, RULER, cue_at, lane_at, lanes, mark_at, told
from app.widgets.lane_paint import cue_words


def tip_at(view: Any, at: QPointF) -> str:
    """Return what to say about what is under a point of the lanes."""
    if at.x() < LEFT:
        return view.titles.tip(at)
    if at.y() < RULER:
        return view.ruler.tip(at)
    mark = mark_at(view.marks(), at)
    if mark is not None:
        return told(mark, view.performance.requests.editable)
    found = cue_at(view.performance.shown, view.scale(), view.height(), at, view.sizes)
    if found is not None:
        cue = found[1]
        name = told_names(cue_words(view.performance.shown.project, cue.action), cue.action.name)
        words = f"{name}\n{cue.action.kind}, {cue.start:.2f} to {cue.end:.2f} s"
        if cue.hold > 0:
            words += f", held {cue.hold:.2f} s"
        return words + "\nClick selects it, double-click plays it in context"
    lane = lane_at(view.height(), at, view.sizes)
    if lane is None:
        return ""
    if lane == "cameras":
        return view.cameras.tip(at)
    seed = seed_of(lane)
    if seed is not None:
        row = lanes(view.height(), view.sizes)[lane]
        return view.what_if.tip(seed, view.scale().seconds(at.x()), (at.y() - row.top()) / row.height())
    if lane == "words":
        at_time = view.scale().seconds(at.x())
        word = next((w for w in view.words() if w[0] <= at_time < w[1]), None)
        return f"'{word[2]}', {word[0]:.2f} to {word[1]:.2f} s" if word is not None else ""
    shown, here = view.performance.shown, ""
    plan = next((p for layer, p in shown.plan.layers.items() if layer == lane), None)
    if plan is not None:
        stance = shown.project.stance(plan.stance_at(view.scale().seconds(at.x())))
        here = stance.name if stance is not None else ""
    more = "" if QApplication.mouseButtons() else "Double-click to ask for something here"
    return "\n".join(x for x in (here, more) if x)
