"""What the time of a task went into, as finely as the log tells: the seconds before each event belong to
it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from metagraph.research.study.logs.gaps import place_of
from metagraph.research.study.scores.tasks import Event, list_event_steps

USES = (
    "dragging",
    "placing clips",
    "drawing links",
    "setting times",
    "settings, names",
    "watching motion",
    "looking around",
    "dialogs",
    "stepping back",
    "refused",
    "before the end",
)
_EDITS: Mapping[str, str] = {
    "place": "placing clips",
    "stance": "placing clips",
    "import": "placing clips",
    "link": "drawing links",
    "timing": "setting times",
}
_KINDS: Mapping[str, str] = {
    "undo": "stepping back",
    "redo": "stepping back",
    "view": "looking around",
    "playback": "watching motion",
    "dialog": "dialogs",
    "import": "placing clips",
}


def uses(events: Sequence[Event]) -> dict[int, dict[str, float]]:
    """Return for each task, by its place in the sitting, active seconds by what they went into; they add up
    to the task's. Seconds with the button held are dragging, but before a change of times.
    """
    out: dict[int, dict[str, float]] = {}
    task: int | None = None
    loose = held = 0.0  # seconds that no event has told the use of, and those of drags among them
    for event, seconds, why in list_event_steps(events):
        if task is not None:
            loose += seconds if why == "active" else 0.0
            on = _use(event)
            if event["type"] == "ops":
                held += _number(event.get("drag_s"))
            if on is not None:
                dragged = 0.0 if on == "setting times" else min(loose, held)
                mine = out[task]
                mine["dragging"] = mine.get("dragging", 0.0) + dragged
                mine[on] = mine.get(on, 0.0) + loose - dragged
                loose = held = 0.0
        if event["type"] == "phase":
            begins = event.get("name") == "task" and event.get("state") == "begin"
            task = place_of(event) if begins else None
            if task is not None:
                out[task] = {}
                loose = held = 0.0
    if task is not None and loose:
        out[task]["before the end"] = out[task].get("before the end", 0.0) + loose
    return {index: {use: mine[use] for use in USES if mine.get(use, 0.0) > 0} for index, mine in out.items()}


def _use(event: Event) -> str | None:
    """Return what the time before an event went into; None if it says nothing about that."""
    kind = event["type"]
    if kind == "edit":
        return _EDITS.get(str(event.get("what")), "settings, names")
    if kind == "error":
        return None if event.get("what") == "warning" else "refused"
    return "before the end" if kind == "phase" else _KINDS.get(kind)


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0
