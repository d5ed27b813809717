"""Find where the feet of a standing body should be while the body's layer blends. They do not glide from one
pose to the other: they are held, and move one after the other in a step.

A clip gives the positions of its feet, and when they stand. A pose depends only on plan and time, so each
step's time, order and height follow from the two poses that it joins.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import floor

from metagraph.graph.model import Project
from metagraph.motion.feet_solve import FootGoal, foot_way
from metagraph.motion.plain_vectors import dot, minus, plus, scaled, unit_turn
from metagraph.playback.plan import Cue, LayerPlan, Rest
from metagraph.playback.posing.cue_times import cue_seconds, ease, loop_spot

FOOT_RATE = 10.0  # rows of a track in a second of its clip
FOOT_UNIT = 1e-5  # the value of 1 in a row
FOOT_NUMBERS = 8  # in a row, for each foot
STEPPING = 0.5  # seconds that two steps take if a cue leaves them time
LEAST_PART = 0.15  # of that time for the foot with the shorter way
NEARBY = 0.015  # metres: feet with a shorter way move together, slowly
WAITS = 0.12  # of a step's time: the foot is lifted before it moves and lowered after it
LIFT = 0.25  # how high a foot is lifted for a short step, as a share of its way
MOST_LIFT = 0.08  # metres: the limit that no foot reaches
FAR = 0.25  # of the height: no foot steps that much farther
TOO_FAR = 0.1
QUICK = 0.65  # of the height, a second: above, feet step less and glide more
TOO_QUICK = 0.2  # as much quicker, they only glide


@dataclass(frozen=True, slots=True)
class FootTrack:
    """Where a clip's feet are.

    `rows` has a row for each tenth of a second, with the left foot and then the right: whether it stands (0
    to 1), its joint's position and rotation in the character's space; in units of `FOOT_UNIT`.
    """

    rows: Sequence[Sequence[float]]


def foot_goals(
    project: Project,
    tracks: Mapping[str, FootTrack],
    height: float,
    plan: LayerPlan,
    cue: Cue | None,
    place: int,
    time: float,
) -> list[FootGoal]:
    """Return where both feet should be at a time; an empty list if nothing blends or it is unknown.

    `tracks` are by action. `height` is the figure's. `plan` is the body's layer. `cue` is the one that plays,
    if it has motion, and `place` the index of the rest in force, -1 for none.
    """
    if place < 0:
        return []
    if cue is None:
        if not _changes(project, plan, place, time):
            return []
        return _stance(project, tracks, height, plan, place, time)
    track = tracks.get(cue.action.id)
    masked = len(cue.action.joints) > 0 or len(cue.action.joint_weights) > 0
    if track is None or len(track.rows) == 0 or masked:
        return []
    came = cue.start + _entering(track, cue)
    goes = cue.end - _leaving(track, cue)
    if time >= came and time < goes:
        return []
    here = foot_row(track, cue_seconds(cue, time))
    if time < came:
        at = min(time, cue.start + cue.blend_in)
        before = _stance(project, tracks, height, plan, place, at)
        first = _stance(project, tracks, height, plan, place, cue.start)
        last = foot_row(track, cue_seconds(cue, came))
        return stepped(height, before, here, first, last, time - cue.start, came - cue.start)
    at = max(time, cue.end - cue.blend_out)
    after = _stance(project, tracks, height, plan, place, at)
    first = foot_row(track, cue_seconds(cue, goes))
    last = _stance(project, tracks, height, plan, place, cue.end)
    return stepped(height, here, after, first, last, time - goes, cue.end - goes)


def _entering(track: FootTrack, cue: Cue) -> float:
    """Return how long the feet take to enter a cue: its blend, and longer while it stands."""
    return _lasting(track, cue, cue.blend_in, cue.start, 1.0)


def _leaving(track: FootTrack, cue: Cue) -> float:
    """Return how long the feet take to leave a cue."""
    return _lasting(track, cue, cue.blend_out, cue.end, -1.0)


def _lasting(track: FootTrack, cue: Cue, blend: float, edge: float, way: float) -> float:
    if blend <= 0.0:
        return 0.0
    spare = max(0.0, cue.end - cue.start - cue.blend_in - cue.blend_out)
    most = min(STEPPING, blend + 0.5 * spare)
    out = blend
    step = 1.0 / FOOT_RATE
    while out < most and _stands(track, cue_seconds(cue, edge + way * min(out + step, most))):
        out = min(out + step, most)
    return out


def _stands(track: FootTrack, seconds: float) -> bool:
    goals = foot_row(track, seconds)
    return goals[0].planted >= 1.0 and goals[1].planted >= 1.0


def stepped(
    height: float,
    before: Sequence[FootGoal],
    after: Sequence[FootGoal],
    first: Sequence[FootGoal],
    last: Sequence[FootGoal],
    passed: float,
    seconds: float,
) -> list[FootGoal]:
    """Return both feet during a step, after `passed` of its `seconds`. `first` and `last` are their places
    when it begins and ends, which decide the order and size of the steps.
    """
    if len(before) == 0 or len(after) == 0 or len(first) == 0 or len(last) == 0:
        return []
    ways: list[float] = []
    for side in range(2):  # a foot that does not stand before or after needs no time for a step
        stands = first[side].planted * last[side].planted
        ways.append(stands * foot_way(first[side], last[side]))
    part = 0.5
    if ways[0] + ways[1] > 0.0:
        part = min(max(ways[0] / (ways[0] + ways[1]), LEAST_PART), 1.0 - LEAST_PART)
    # To the left, the left foot goes first: the right foot would have to pass it.
    moved = plus(minus(last[0].at, first[0].at), minus(last[1].at, first[1].at))
    left_first = dot(moved, minus(first[0].at, first[1].at)) >= -1e-9
    longer = max(ways[0], ways[1])
    far = 1.0 - ease((longer / height - FAR) / TOO_FAR)
    apart = ease(longer / NEARBY)
    shares = [1.0 - apart * (1.0 - part), 1.0 - apart * part]
    quickest = max(ways[0] / shares[0], ways[1] / shares[1])
    far *= 1.0 - ease((quickest / (height * max(seconds, 0.001)) - QUICK) / TOO_QUICK)
    u = passed / seconds if seconds > 0.0 else 1.0
    out: list[FootGoal] = []
    for side in range(2):
        share = shares[side]
        begin = 0.0 if left_first == (side == 0) else 1.0 - share
        x = min(max((u - begin) / share, 0.0), 1.0)
        go = ease((x - WAITS) / (1.0 - 2.0 * WAITS))
        rise = LIFT * ways[side]
        air = 16.0 * x * x * (1.0 - x) * (1.0 - x) * rise / (1.0 + rise / MOST_LIFT)
        out.append(_mixed(before[side], after[side], go, air, far))
    return out


def _mixed(a: FootGoal, b: FootGoal, x: float, air: float, share: float) -> FootGoal:
    """Return a foot between two places."""
    ax, ay, az, aw = a.turn
    bx, by, bz, bw = b.turn
    k = -x if ax * bx + ay * by + az * bz + aw * bw < 0.0 else x
    rest = 1.0 - x
    turn = unit_turn((ax * rest + bx * k, ay * rest + by * k, az * rest + bz * k, aw * rest + bw * k))
    at = plus(a.at, scaled(minus(b.at, a.at), x))
    return FootGoal(at, turn, share * a.planted * b.planted, a.lift * rest + b.lift * x + air)


def _resting(plan: LayerPlan, place: int, time: float) -> int:
    """Return the index of the rest in force at a time, searching from another."""
    while place > 0 and plan.rests[place].fade_start > time:
        place -= 1
    while place + 1 < len(plan.rests) and plan.rests[place + 1].fade_start <= time:
        place += 1
    return place


def _fades(plan: LayerPlan, place: int, time: float) -> bool:
    rest = plan.rests[place]
    return place > 0 and rest.fade_start + rest.fade > time


def _changes(project: Project, plan: LayerPlan, place: int, time: float) -> bool:
    """Return whether a stance blends: between two rests, or at a loop's seam."""
    rest = plan.rests[place]
    if _fades(plan, place, time):
        return True
    return loop_spot(project, rest, time).over < 1.0


def _stance(
    project: Project, tracks: Mapping[str, FootTrack], height: float, plan: LayerPlan, place: int, time: float
) -> list[FootGoal]:
    """Return where the feet of the stance under the cues are at a time."""
    place = _resting(plan, place, time)
    rest = plan.rests[place]
    goals = _loop(project, tracks, height, rest, time)
    if not _fades(plan, place, time):
        return goals
    old = plan.rests[place - 1]
    ends = rest.fade_start + rest.fade
    return stepped(
        height,
        _loop(project, tracks, height, old, time),
        goals,
        _loop(project, tracks, height, old, rest.fade_start),
        _loop(project, tracks, height, rest, ends),
        time - rest.fade_start,
        rest.fade,
    )


def _loop(
    project: Project, tracks: Mapping[str, FootTrack], height: float, rest: Rest, time: float
) -> list[FootGoal]:
    """Return where the feet of a loop are. They also go from its end to its beginning in steps."""
    track = tracks.get(rest.action.id)
    if track is None or len(track.rows) == 0:
        return []
    spot = loop_spot(project, rest, time)
    here = foot_row(track, spot.seconds)
    if spot.over >= 1.0:
        return here
    seam = spot.meets - project.span(rest.action)[0]
    before, leaves, meets = (
        foot_row(track, spot.other),
        foot_row(track, spot.leaves),
        foot_row(track, spot.meets),
    )
    return stepped(height, before, here, leaves, meets, spot.over * seam, seam)


def foot_row(track: FootTrack, seconds: float) -> list[FootGoal]:
    """Return where a clip's feet are at a second of the clip, interpolated linearly."""
    last = len(track.rows) - 1
    at = min(max(seconds * FOOT_RATE, 0.0), float(last))
    low = min(floor(at), max(0, last - 1))
    part = at - low
    a = track.rows[low]
    b = track.rows[min(low + 1, last)]
    v = [FOOT_UNIT * (a[n] + (b[n] - a[n]) * part) for n in range(2 * FOOT_NUMBERS)]
    out: list[FootGoal] = []
    for side in range(2):
        n = FOOT_NUMBERS * side
        turn = unit_turn((v[n + 4], v[n + 5], v[n + 6], v[n + 7]))
        out.append(FootGoal((v[n + 1], v[n + 2], v[n + 3]), turn, v[n], 0.0))
    return out
