"""A gesture's phases: preparation, stroke, hold, retraction (Kendon; BML's ready, stroke-end and relax),
found from its motion.

The speed of what moves - the hands seen from the chest, the head seen from the hips, the trunk - falls into
bouts parted by rests and by clear slowings. The last bout is the retraction, the rest before it the hold, the
first bout before the stroke the preparation. Where a gesture is one bout, it prepares until halfway out and
retracts from where it is farthest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Action, Layer, MetaGraph, Project
from metagraph.graph.remembered import Latest
from metagraph.motion.clip import Clip
from metagraph.playback.timing.phase_times import Phases

Array = NDArray[Any]

RESTING = 0.1  # of the way from the least to the greatest speed: below is rest (Yang et al., section 3.1)
SLOWING = 0.5  # a slowing to less than this share of the slower peak beside it parts two bouts
SMOOTH = 0.06  # seconds, standard deviation of the filter on speeds
REMEMBERED = 32_768  # actions; were they fewer than a project has, an export would find all again each time
SHORTEST = 0.08  # seconds of a bout or rest worth the name


def find_phases(project: Project, action: Action) -> Phases:
    """Return an action's phases: what its timing says, and the rest as found; the middle of it where the clip
    is missing.
    """
    entry = project.clips.get(action.clip)
    return find_phases_within(
        project, action, entry.motion if entry is not None else None, *project.span(action)
    )


def find_phases_within(
    project: Project, action: Action, motion: Clip | None, start: float, end: float
) -> Phases:
    """Return an action's phases, where its clip and the part that plays (`Project.span`) are at hand."""
    timing = action.timing
    own = not timing.ready is timing.stroke is timing.stroke_end is timing.relax is None
    if motion is None or motion.frames < 4 or end - start < 4 / motion.fps:
        middle = (start + end) / 2
        found = Phases(start, middle, middle, middle, middle, end)
        if not own:
            return found
    else:
        joints, seen_from = find_movers(project, motion, action.layer, action.limb)
        found = _found(ref(motion), joints, seen_from, start, end)
    if not own and (
        start
        == found.start
        <= found.ready
        <= found.stroke
        <= found.stroke_end
        <= found.relax
        <= found.end
        == end
    ):
        return found
    ready = _within(timing.ready, found.ready, start, end)
    stroke = _within(timing.stroke, max(ready, found.stroke), start, end)
    stroke_end = _within(timing.stroke_end, max(stroke, found.stroke_end), start, end)
    relax = _within(timing.relax, max(stroke_end, found.relax), start, end)
    ready, stroke_end = min(ready, stroke), max(stroke_end, stroke)
    return Phases(start, ready, stroke, stroke_end, max(relax, stroke_end), end)


def lead(project: Project, action: Action) -> float:
    """Return the seconds from an action's start to its stroke; what is no gesture has it where it was set, or
    halfway.
    """
    if action.kind != "gesture":
        start, end = project.span(action)
        stroke = action.timing.stroke
        return min(max((start + end) / 2 if stroke is None else stroke, start), end) - start
    found = find_phases(project, action)
    return found.stroke - found.start


def find_longest_lead(project: Project, graph: MetaGraph, tags: tuple[str, ...]) -> float:
    """Return how long before its stroke any gesture with these tags begins; remembered as long as graph and
    clips stay as they are.
    """
    known = graph.__dict__.get("_leads")
    leads: dict[tuple[str, ...], float] = known[1] if known is not None and known[0] is project.clips else {}
    graph.__dict__["_leads"] = (project.clips, leads)
    if tags not in leads:
        gestures = (x for x in graph.actions.values() if x.kind == "gesture" and set(tags) <= set(x.tags))
        leads[tags] = max((lead(project, x) for x in gestures), default=0.0)
    return leads[tags]


def _within(own: float | None, found: float, start: float, end: float) -> float:
    return min(max(found if own is None else own, start), end)


def find_movers(project: Project, motion: Clip, layer: Layer, limb: str) -> tuple[tuple[int, ...], int]:
    """Return the joints that make the gesture and the joint they are seen from."""
    if motion.skeleton != project.skeleton:
        return _movers({}, motion, layer, limb)
    known = _of_skeleton(project)
    found = known.get((layer, limb))
    if found is None:
        found = known[layer, limb] = _movers(anatomy.project_roles(project), motion, layer, limb)
    return found


_of_skeleton: Latest[dict[tuple[Layer, str], tuple[tuple[int, ...], int]]] = Latest(lambda _: {})


def _movers(roles: Mapping[str, int], motion: Clip, layer: Layer, limb: str) -> tuple[tuple[int, ...], int]:
    if layer == "arms":
        names: Sequence[str] = [f"{side}_hand" for side in ("left", "right") if limb in (side, "both")]
        ground: Sequence[str] = ("upper_chest", "chest", "spine", "hips")
    elif layer == "head":
        names, ground = ("head",), ("upper_chest", "chest", "spine", "hips")
    else:
        names, ground = ("upper_chest", "chest", "hips", "left_foot", "right_foot"), ()
    found = tuple(roles[n] for n in names if n in roles)
    seen_from = next((roles[g] for g in ground if g in roles), -1)
    return found or tuple(range(len(motion.skeleton))), seen_from


@lru_cache(maxsize=REMEMBERED)
def _found(whose: ref[Clip], joints: tuple[int, ...], seen_from: int, start: float, end: float) -> Phases:
    # What is remembered must not keep a clip whose project was closed; a `ref` is equal while its clip lives.
    motion = whose()
    assert motion is not None
    first, last = int(np.ceil(start * motion.fps)), int(np.floor(end * motion.fps + 1e-6))
    path = track(whose, joints, seen_from)[first : last + 1]
    speed, away = _speed(path, motion.fps), np.linalg.norm(path - path[0], axis=-1).max(-1)
    times = start + np.arange(len(path)) / motion.fps
    bouts = _bouts(speed, motion.fps)
    peak = int(np.argmax(speed))
    if len(bouts) == 0 or away.max() < 1e-4:
        middle = (start + end) / 2
        return Phases(start, middle, float(times[peak]), middle, middle, end)
    if len(bouts) == 1:
        farthest = max(int(np.argmax(away)), 1)
        ready = int(np.argmax(away >= away[farthest] / 2))
        stroke = int(np.argmax(speed[: farthest + 1]))
        return _of(times, start, end, min(ready, stroke), stroke, farthest, farthest)
    (_, gone), (back, _) = bouts[-2], bouts[-1]
    if len(bouts) == 2:
        before = bouts[0]
        top = before[0] + int(np.argmax(speed[before[0] : before[1] + 1]))
        ready = int(np.argmax(away >= away[: gone + 1].max() / 2))
        return _of(times, start, end, min(ready, top), top, gone, back)
    ready = bouts[1][0]
    stroke = ready + int(np.argmax(speed[ready : gone + 1]))
    return _of(times, start, end, ready, stroke, gone, back)


def _of(times: Array, start: float, end: float, ready: int, stroke: int, gone: int, back: int) -> Phases:
    at = [float(times[min(max(i, 0), len(times) - 1)]) for i in (ready, stroke, gone, back)]
    return Phases(start, at[0], at[1], max(at[1], at[2]), max(at[1], at[2], at[3]), end)


@lru_cache(maxsize=512)
def track(whose: ref[Clip], joints: tuple[int, ...], seen_from: int) -> Array:
    """Return where the joints are `[F, n, 3]`, metres, in the frame of the joint they are seen from, or of
    the clip.
    """
    from metagraph.motion import rotation

    motion = whose()
    assert motion is not None
    turns, places = motion.skeleton.globals(motion.poses())
    chosen = places[:, list(joints)]
    if seen_from >= 0:
        chosen = rotation.rotate_vectors(
            rotation.conjugate(turns[:, seen_from])[:, None], chosen - places[:, seen_from, None]
        )
    return np.asarray(chosen, np.float64)


def _speed(path: Array, fps: float) -> Array:
    """Return `[F]` the fastest joint's speed, metres a second, smoothed."""
    speed = np.linalg.norm(np.gradient(path, 1 / fps, axis=0), axis=-1).max(-1)
    reach = max(1, round(3 * SMOOTH * fps))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / (SMOOTH * fps)) ** 2)
    padded = np.pad(speed, reach, mode="edge")
    return np.asarray(np.convolve(padded, kernel / kernel.sum(), "valid"))


def _bouts(speed: Array, fps: float) -> list[tuple[int, int]]:
    """Return first and last frame of each bout of movement, in order."""
    low, high = float(speed.min()), float(speed.max())
    if high - low < 1e-4:
        return []
    moving = speed >= low + RESTING * (high - low)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], moving.astype(int), [0]))))
    runs = [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
    least = max(1, round(SHORTEST * fps))
    merged: list[tuple[int, int]] = []
    for run in runs:
        if merged and run[0] - merged[-1][1] <= least:
            merged[-1] = (merged[-1][0], run[1])
        else:
            merged.append(run)
    out: list[tuple[int, int]] = []
    for a, b in merged:
        if b - a + 1 >= least:
            out += _parted(speed, a, b, least)
    return out


def _parted(speed: Array, a: int, b: int, least: int) -> list[tuple[int, int]]:
    """Part a bout at its clearest slowing, and its parts in turn."""
    inner = speed[a : b + 1]
    left, right = np.maximum.accumulate(inner), np.maximum.accumulate(inner[::-1])[::-1]
    depth = inner / np.maximum(np.minimum(left, right), 1e-9)
    if len(inner) <= 2 * least:
        return [(a, b)]
    place = least + int(np.argmin(depth[least : len(inner) - least]))
    if depth[place] >= SLOWING:
        return [(a, b)]
    return [*_parted(speed, a, a + place, least), *_parted(speed, a + place, b, least)]
