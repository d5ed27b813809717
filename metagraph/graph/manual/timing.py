"""When a state of a manual machine plays, and when a link may take over from it, in seconds of its clip."""

from __future__ import annotations

from metagraph.graph.manual.machine import Link, State
from metagraph.graph.model import Project


def find_state_span(project: Project, state: State) -> tuple[float, float]:
    """Return the part of its clip a state plays, clamped to the clip; nothing if the clip is gone."""
    entry = project.clips.get(state.clip)
    length = entry.duration if entry is not None else 0.0
    start = min(max(0.0, state.start), length)
    return start, max(start, length if state.end is None else min(state.end, length))


def find_exit_moment(project: Project, state: State, link: Link) -> float | None:
    """Return the clip seconds at which a link leaves a state, None for as soon as it is asked for.

    An exit time holds before a share. The blend is over with the share; at the end it is over with the
    source, and a loop that is asked to leave, which has no end, is left at once.
    """
    start, end = find_state_span(project, state)
    if link.exit_time is not None:
        return min(max(start, link.exit_time), end)
    asked = link.condition.when == "request"
    if asked and (link.exit_part is None or (link.exit_part >= 1 and state.loop)):
        return None
    part = 1.0 if link.exit_part is None else link.exit_part
    return max(start, start + (end - start) * part - link.blend)
