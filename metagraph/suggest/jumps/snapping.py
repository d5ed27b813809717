"""Where a handle of an action's timing comes to rest while it is dragged, and why there."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.graph.checks import end_gaps
from metagraph.graph.model import Action, Project
from metagraph.playback.timing.handles import EDGES, handle_times
from metagraph.playback.timing.phases import find_phases
from metagraph.suggest.jumps.seen_jumps import SeenJumps

Array = NDArray[Any]

CLEAR = 0.15  # of the greatest speed: how far a peak or a slowing stands out to be worth stopping at
SLACK = 0.005  # seconds a blend is longer than it must be, so that it covers as much once it is rounded


@dataclass(frozen=True, slots=True)
class Snap:
    """at: seconds of the clip. why: what is there, in words."""

    at: float
    why: str


def list_snaps(
    project: Project,
    action: Action,
    handle: str,
    seen: SeenJumps | None = None,
    speeds: Sequence[float] | Array = (),
    stresses: Iterable[float] = (),
    playhead: float | None = None,
) -> tuple[Snap, ...]:
    """Return where a handle (one of `timing.HANDLES`) may come to rest, what tells most first.

    seen: what is known of its jumps. speeds `[F]`: of what it moves, a frame of the clip each, metres
    a second. stresses: moments a spoken line stresses, playhead: where it stands, seconds of the clip.
    """
    entry = project.clips[action.clip]
    if handle in ("start", "end"):
        found = list(_edge(seen, handle))
        found.append(
            Snap(0.0, phrase("the clip's first frame")) if handle == "start" else _last(entry.duration)
        )
    elif handle in ("in", "out"):
        found = list(_blend(project, action, handle))
    else:
        found = list(_moment(project, action, handle, np.asarray(speeds, float), entry.fps))
    found += [Snap(at, phrase("the line has a stress here")) for at in stresses]
    if playhead is not None:
        found.append(Snap(playhead, phrase("the playhead")))
    return tuple(s for s in found if -1e-6 <= s.at <= entry.duration + 1e-6)


def find_nearest_snap(snaps: Iterable[Snap], seconds: float, within: float) -> Snap | None:
    """Return the nearest place to rest within some seconds, of equally near ones the first; None if there is
    none.
    """
    best = min(snaps, key=lambda s: round(abs(s.at - seconds), 4), default=None)
    return best if best is not None and abs(best.at - seconds) <= within else None


def _last(duration: float) -> Snap:
    return Snap(duration, phrase("the clip's last frame"))


def _edge(seen: SeenJumps | None, handle: str) -> Iterator[Snap]:
    if seen is None:
        return
    if seen.loops:
        proposed = phrase("proposed: it loops smoothly")
    elif handle == "start":
        proposed = phrase("proposed: it begins without a jump")
    else:
        proposed = phrase("proposed: it ends without a jump")
    other = (
        phrase("latest moment without a jump")
        if handle == "start"
        else phrase("earliest moment without a jump")
    )
    for n, at in enumerate(seen.snaps(handle)):
        yield Snap(at, proposed if n == 0 else other)


def _blend(project: Project, action: Action, handle: str) -> Iterator[Snap]:
    """The shortest blend that covers the way from or to the stance, and the phases it may reach to."""
    start, end = project.span(action)
    graph, motion = project.graphs[action.layer], end_gaps.get_action_motion(project, action)
    edge = "begins" if handle == "in" else "ends"
    for gap in end_gaps.find_end_gaps(project, graph, action):
        if (
            gap.edge != edge
            or motion is None
            or gap.metres <= end_gaps.measure_hidden_gap(motion.skeleton.height, 0.0)
        ):
            continue
        needed = end_gaps.blend_for(motion.skeleton.height, gap.metres) + SLACK
        if needed <= end - start:
            at = start + needed if handle == "in" else end - needed
            yield Snap(at, phrase("long enough for {length:.0f} cm to the stance", length=gap.metres * 100))
    now = handle_times(project, action)
    ready, relax = now["ready"], now["relax"]
    if handle == "in" and ready is not None:
        yield Snap(ready, phrase("its preparation ends"))
    if handle == "out" and relax is not None:
        yield Snap(relax, phrase("its retraction begins"))


def _moment(project: Project, action: Action, handle: str, speeds: Array, fps: float) -> Iterator[Snap]:
    """What the motion says of a moment within the action: phases as found, its fastest and slowest."""
    start, end = project.span(action)
    if action.kind == "gesture" and (handle in EDGES or handle == "stroke"):
        bare = replace(action.timing, ready=None, stroke_end=None, relax=None, stroke=None)
        found = find_phases(project, replace(action, timing=bare))
        by = {"ready": found.ready, "hold": found.stroke_end, "relax": found.relax, "stroke": found.stroke}
        yield Snap(round(by[handle], 3), phrase("as detected from the motion"))
    if handle == "exit":
        relax = handle_times(project, action)["relax"]
        if relax is not None:
            yield Snap(relax, phrase("its hold ends"))
    for frame in find_turning_frames(speeds, most=handle == "stroke"):
        at = frame / fps
        if start <= at <= end:
            words = (
                phrase("fastest here, {speed:.1f} m/s", speed=float(speeds[frame]))
                if handle == "stroke"
                else phrase("slowest here")
            )
            yield Snap(round(at, 3), words)


def find_turning_frames(speeds: Array, most: bool) -> list[int]:
    """Return the frames at which speeds `[F]` are greater (else smaller) than all about them, and that stand
    out.
    """
    values = np.asarray(speeds, float) if most else -np.asarray(speeds, float)
    if len(values) < 3 or np.ptp(values) <= 1e-6:
        return []
    out, clear = [], CLEAR * float(np.abs(speeds).max())
    for frame in np.flatnonzero((values[1:-1] >= values[:-2]) & (values[1:-1] > values[2:])) + 1:
        left = _fall(values[frame::-1])
        right = _fall(values[frame:])
        if min(left, right) >= clear:
            out.append(int(frame))
    return out


def _fall(values: Array) -> float:
    """Return how far values `[N]` fall below their first before they rise above it."""
    above = np.flatnonzero(values > values[0])
    part = values[: int(above[0])] if len(above) else values
    return float(values[0] - part.min())
