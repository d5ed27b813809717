"""Ways between stances that no clip leads to or from: blends from pose to pose, told as what they are.

A set of takes often lacks a transition. Without it a stance is never reached and all its gestures never play.
A bridge is a transition that plays the loop of the stance it ends in and takes long to blend into it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from metagraph.graph import edits
from metagraph.graph.expand import reachable
from metagraph.graph.model import LAYERS, Action, MetaGraph, Project
from metagraph.motion.features import pose_distance
from metagraph.motion.skeleton import Pose

SPEED = 0.6  # metres a second that the farthest joint goes on a bridge, on average: an unhurried movement
SHORTEST, LONGEST = 0.6, 1.6  # seconds of a bridge
CAREFUL = 0.9  # seconds of a bridge to a stance that is held in a moment shorter than the bridge, at least
NOTICED = 0.3  # metres that a joint goes on a bridge, from which on a clip would look better
FADE = 0.25  # of a bridge, that it takes to blend out into the loop at its end


@dataclass(frozen=True)
class Bridge:
    """A transition made of nothing but a blend. start, end: ids of stances. metres: how far the farthest
    joint goes. seconds: how long it takes.
    """

    action: str
    start: str
    end: str
    metres: float
    seconds: float


def bridged(project: Project) -> tuple[Project, tuple[Bridge, ...]]:
    """Return the project with transitions by blending to stances its start does not lead to, and back from
    those that do not lead to it; and what was made. Stances without a loop are left as they are.
    """
    out: list[Bridge] = []
    for layer in LAYERS:
        poses = _poses(project, project.graphs[layer])
        start = project.graphs[layer].start
        if start not in poses:
            continue
        for there in (True, False):
            while True:
                graph = project.graphs[layer]
                home = {s for s in poses if _leads(graph, start, s, there)}
                lost = [s for s in poses if s not in home]
                if not lost:
                    break
                one, other = min(
                    ((a, b) for a in sorted(home) for b in lost),
                    key=lambda pair: _metres(project, poses[pair[0]], poses[pair[1]]),
                )
                ends = (one, other) if there else (other, one)
                project, made = _bridge(project, *ends, _metres(project, poses[one], poses[other]))
                out.append(made)
    return project, tuple(out)


def told(project: Project, bridges: Iterable[Bridge]) -> list[str]:
    """Return a line for each bridge, in words."""
    names: Mapping[str, str] = {s.id: s.name for g in project.graphs.values() for s in g.stances.values()}
    return [
        f'no clip leads from "{names[x.start]}" to "{names[x.end]}": blended in {x.seconds:.1f} s over '
        f"{100 * x.metres:.0f} cm" + (", which shows; a clip would look better" if x.metres > NOTICED else "")
        for x in bridges
    ]


def _leads(graph: MetaGraph, start: str, stance: str, there: bool) -> bool:
    return stance in reachable(graph, start) if there else start in reachable(graph, stance)


def _loop(graph: MetaGraph, stance: str) -> Action | None:
    return next(iter(graph.of(stance, "stance")), None)


def _poses(project: Project, graph: MetaGraph) -> dict[str, Pose]:
    """Return stance -> the pose its loop begins in, of those that have one that is there."""
    out = {}
    for stance in graph.stances:
        loop = _loop(graph, stance)
        motion = project.clips[loop.clip].motion if loop is not None and loop.clip in project.clips else None
        if loop is not None and motion is not None:
            out[stance] = motion.pose_at(loop.timing.start)
    return out


def _metres(project: Project, one: Pose, other: Pose) -> float:
    assert project.skeleton is not None
    return float(pose_distance(project.skeleton, one, other))


def _bridge(project: Project, start: str, end: str, metres: float) -> tuple[Project, Bridge]:
    stance = project.stance(end)
    assert stance is not None
    loop = _loop(project.graphs[stance.layer], end)
    assert loop is not None
    entry = project.clips[loop.clip]
    seconds = float(np.clip(metres / SPEED, SHORTEST, LONGEST))
    held = (entry.duration if loop.timing.end is None else loop.timing.end) - loop.timing.start
    fade = FADE
    if held < seconds:  # a moment of a clip that goes on to move: it is never shown alone
        seconds, fade = max(seconds, CAREFUL), 0.5
    first = min(loop.timing.start, max(0.0, entry.duration - seconds))
    last = min(first + seconds, entry.duration)
    project = edits.place(project, [entry.id], stance.layer, "transition", start, end)
    made = list(project.graphs[stance.layer].actions)[-1]
    timing = {
        "start": round(first, 3),
        "end": round(last, 3),
        "blend_in": round((last - first) * (1 - fade), 3),
        "blend_out": round((last - first) * fade, 3),
    }
    project = edits.update_actions(project, [made], timing=timing, name=f"to {stance.name}, blended")
    return project, Bridge(made, start, end, metres, last - first)
