"""A clip as it would play if its proposal were accepted."""

from __future__ import annotations

from dataclasses import dataclass

from app.stage.playback_source import LEAD, ShownPlayback, play_clip_alone, play_in_context
from metagraph.graph.model import LAYERS, Project
from metagraph.suggest.review import Review


@dataclass(frozen=True)
class Span:
    """Where in what plays the clip is: seconds. words: what its parts are called before, amid, after. kind:
    gives the colour. stroke: seconds, None if there is none.
    """

    start: float
    end: float
    words: tuple[str, str, str]
    kind: str
    stroke: float | None = None


def make_trial(project: Project, review: Review, clip: str) -> tuple[ShownPlayback, Span | None]:
    """Return the clip as it would play if it were accepted: its stance, the clip, the stance it ends in;
    alone where it has no place.
    """
    taken = review.take(project, [clip])
    action = next(
        reversed(taken.project.uses.get(clip, ())), None
    )  # before it may stand one that only lends a stance a moment
    if action is None or clip not in taken.placed:
        return play_clip_alone(project, clip), None
    placed = taken.project
    stances = {layer: start for layer in LAYERS if (start := placed.graphs[layer].start) is not None}
    shown = play_in_context(placed, action.id, action.layer, stances)
    names = {
        s: found.name
        for s in (action.stance, action.end_stance or action.stance)
        if (found := placed.stance(s)) is not None
    }
    before, after = names.get(action.stance, ""), names.get(action.end_stance or action.stance, "")
    if action.kind == "stance":
        return shown, Span(0.0, shown.length, ("", action.name, ""), action.kind)
    first, last = placed.span(action)
    stroke = action.timing.stroke
    at = LEAD + stroke - first if stroke is not None and first <= stroke <= last else None
    return shown, Span(LEAD, LEAD + last - first, (before, action.name, after), action.kind, at)
