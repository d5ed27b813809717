"""Where actions of a project would jump visibly - as they begin, end or loop - and when they would not:
`compatibility`, applied.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.checks import end_gaps
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import REACH, Action, Layer, Project
from metagraph.graph.repeating import cycle_of
from metagraph.motion.clip import Clip
from metagraph.playback.timing.phases import find_phases
from metagraph.suggest.jumps import compatibility as c
from metagraph.suggest.tracks import RATE

Array = NDArray[Any]
Edge = Literal["begins", "ends", "loops"]

FEWEST_CLIPS = 5  # on a layer: of fewer, what is usual cannot be told
FEWEST_COSTS = 300  # between frames: ten seconds of motion
NEAR = 0.5  # seconds: a better moment farther away would change the action; a longer blend is preferred to it
SLACK = 0.005  # seconds a blend is longer than it must be, so that it hides as much once it is rounded
ROOM = 0.8  # of the threshold: what a better moment may cost, so that it stays better


@dataclass(frozen=True)
class Jump:
    """An action that would jump. edge: where. at: seconds of its clip now. cost: of what shows as a jump, its
    blend taken off; > 1. stance: beside which, by id. change: the Timing fields that mend it; better: the
    moment among them. fits: the stance it looks like at that moment, if another.
    """

    action: str
    edge: Edge
    at: float
    cost: float
    stance: str
    change: Mapping[str, Any] = field(default_factory=dict)
    better: float | None = None
    fits: str | None = None


@dataclass(frozen=True, eq=False)
class Curves:
    """An action's clip beside its stances. times `[F]`: seconds, tracks.RATE a second. enter, leave `[F]`:
    what entering and leaving at each would cost, of what shows as a jump, without a blend (see
    `compatibility.shown`); for a loop both are what its seam would cost if it ended there. proposed: a timing
    in which nothing shows. gaps: metres `[F]` from the stance it leaves and the one it enters, height: of the
    skeleton, metres: for what a long blend covers (see `end_gaps`); None for loops.
    """

    times: Array
    enter: Array
    leave: Array
    proposed: c.ProposedTimes
    gaps: tuple[Array, Array] | None = None
    height: float = 0.0


class Measured:
    """A layer's statistics beside its stances, with what has been compared. Made of another of the same
    layer, what still holds is kept.

    reliable: whether they rest on enough motion. stats, frames (stance -> its frames): as `compatibility` has
    them.
    """

    def __init__(self, project: Project, layer: Layer, before: Measured | None = None) -> None:
        graph = project.graphs[layer]
        self.layer, self.roles, self.parts = layer, anatomy.project_roles(project), project.parts
        own = {
            i: e.motion
            for i, e in project.clips.items()
            if e.motion is not None and e.motion.skeleton == project.skeleton
        }
        used = [own[i] for i in sorted(graph.uses) if i in own]
        self.motions = tuple(used or own.values())
        self.labelled = len(used)
        self.weights: dict[str, float] = {part: graph.weight(part) for part in REACH[layer]}
        self.loops = c.list_stance_loops(project, layer)
        old = before if before is not None and before.rests_on(self) else None
        self.stats: c.Statistics = (
            old.stats
            if old is not None
            else c.compute_statistics(self.motions, layer, self.roles, self.weights)
        )
        same: Mapping[str, tuple[Array, Array]] = old.frames if old is not None else {}
        self.frames: dict[str, tuple[Array, Array]] = {
            stance: same[stance]
            if old is not None and old.loops.get(stance) == loops
            else c.find_stance_frames(self.stats, loops, self.roles)
            for stance, loops in self.loops.items()
        }
        kept = old._costs if old is not None else {}
        self._costs: dict[Any, Array] = {
            k: v for k, v in kept.items() if same.get(k[1]) is self.frames.get(k[1])
        }

    def rests_on(self, other: Measured) -> bool:
        """Whether the statistics are of the same motion as another's."""
        mine, theirs = self.motions, other.motions
        alike = len(mine) == len(theirs) and all(a is b for a, b in zip(mine, theirs, strict=True))
        return (
            alike
            and self.weights == other.weights
            and self.roles == other.roles
            and self.parts == other.parts
        )

    def same_as(self, other: Measured) -> bool:
        """Whether everything that is measured would come out as another's."""
        return self.stats is other.stats and self.loops == other.loops

    @property
    def reliable(self) -> bool:
        return self.labelled >= FEWEST_CLIPS and self.stats.count >= FEWEST_COSTS

    def costs(self, project: Project, action: Action, stance: str | None) -> Array | None:
        """Return `[F]` what changing between each frame of an action's clip and a stance costs; None if
        nothing can be compared.
        """
        entry = project.clips.get(action.clip)
        motion = entry.motion if entry is not None else None
        frames = self.frames.get(stance or "")
        if motion is None or frames is None or not len(frames[0]) or motion.skeleton != project.skeleton:
            return None
        moved = anatomy.make_action_mask(project, action)
        key = id(motion), stance, None if moved is None else moved.tobytes()
        if key not in self._costs:
            self._costs[key] = c.measure_transition_costs(
                c.mask_statistics(self.stats, motion, moved, self.roles), motion, frames, self.roles
            )
        return self._costs[key]


def find_jumps(
    project: Project,
    measured: Measured,
    known: dict[Any, tuple[Jump, ...]] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> list[Jump]:
    """Return the jumps of a layer; none where its statistics are not reliable, nor where a long blend goes
    the way at an unhurried pace. known: filled with what was
    found, and looked up there again as long as the action and what it was measured beside stay the same.
    """
    found: list[Jump] = []
    if not measured.reliable:
        return found
    known = {} if known is None else known
    for action in project.graphs[measured.layer].actions.values():
        if cancelled is not None and cancelled():
            break
        if action not in known:
            known[action] = tuple(_of(project, measured, action))
        found += known[action]
    return found


def _of(project: Project, measured: Measured, action: Action) -> list[Jump]:
    if action.kind == "stance":
        return _loop(project, measured, action)
    start, end = project.span(action)
    t = action.timing
    into, left = (
        measured.costs(project, action, action.stance),
        measured.costs(project, action, find_end_stance(action)),
    )
    slow = {g.edge for g in end_gaps.find_end_gaps(project, project.graphs[action.layer], action) if g.slow}
    found = []
    middle = (
        t.stroke
        if t.stroke is not None
        else find_phases(project, action).stroke
        if action.kind == "gesture"
        else None
    )
    if into is not None:
        cost = c.compute_entry_costs(into)
        now = float(c.measure_visible_difference(_at(cost, start), t.blend_in))
        latest = (
            end - t.blend_in - t.blend_out if middle is None else min(middle, end - t.blend_in - t.blend_out)
        )
        if now > 1 and "begins" not in slow:
            better = _nearest(cost, start, 0.0, latest, t.blend_in)
            better, mend = _mend(
                "start", start, better, _blended("blend_in", _at(cost, start), end - start - t.blend_out)
            )
            fits = _fits(project, measured, action, start, action.stance, c.compute_entry_costs)
            found.append(Jump(action.id, "begins", start, now, action.stance, mend, better, fits))
    target = find_end_stance(action)
    if left is not None and target is not None:
        now = float(c.measure_visible_difference(_at(left, end), t.blend_out))
        if now > 1 and "ends" not in slow:
            length = project.clips[action.clip].duration
            soonest = (
                start + t.blend_in + t.blend_out
                if middle is None
                else max(middle, start + t.blend_in + t.blend_out)
            )
            better = _nearest(left, end, soonest, length, t.blend_out)
            better, mend = _mend(
                "end", end, better, _blended("blend_out", _at(left, end), end - start - t.blend_in)
            )
            if better is not None and t.earliest_exit is not None and t.earliest_exit > better:
                mend["earliest_exit"] = None
            found.append(
                Jump(
                    action.id,
                    "ends",
                    end,
                    now,
                    target,
                    mend,
                    better,
                    _fits(project, measured, action, end, target),
                )
            )
    return found


def _loop(project: Project, measured: Measured, action: Action) -> list[Jump]:
    entry = project.clips.get(action.clip)
    motion = entry.motion if entry is not None else None
    start, end = project.span(action)
    overlap = min(max(0.0, action.timing.blend_in), (end - start) / 2)
    if motion is None or motion.skeleton != project.skeleton or motion.frames < 2 or end <= start:
        return []
    raw = c.measure_seam_cost(measured.stats, motion, start, end, overlap, measured.roles)
    now = float(c.measure_visible_difference(raw, overlap))
    if now <= 1:
        return []
    return [Jump(action.id, "loops", end, now, action.stance, _blended("blend_in", raw, (end - start) / 2))]


def _at(cost: Array, seconds: float) -> float:
    return float(cost[min(max(round(seconds * RATE), 0), len(cost) - 1)])


def _nearest(cost: Array, now: float, first: float, last: float, blend: float) -> float | None:
    """Return the moment from first to last, nearest to now, at which no jump shows; None if there is none."""
    times = np.arange(len(cost)) / RATE
    inside = (times >= first - 1e-6) & (times <= last + 1e-6)
    for most in (ROOM, 1.0):
        good = np.flatnonzero(inside & (c.measure_visible_difference(cost, blend) <= most))
        if len(good):
            return round(float(times[good[int(np.argmin(np.abs(times[good] - now)))]]), 3)
    return None


def _mend(
    field: str, now: float, better: float | None, blended: dict[str, Any]
) -> tuple[float | None, dict[str, Any]]:
    """Return a better moment, if it is what mends, and the Timing fields that do."""
    if better is not None and blended and abs(better - now) > NEAR:
        better = None
    return (better, {field: better}) if better is not None else (None, blended)


def _blended(name: str, cost: float, room: float) -> dict[str, Any]:
    """Return the blend that hides a difference, nothing if it would take too long."""
    needed = 1.5 * (c.STEP - 1) / RATE * cost / ROOM
    return {name: round(needed + 0.005, 2)} if needed + 0.005 <= min(room, c.BLEND[1]) else {}


def _fits(
    project: Project,
    measured: Measured,
    action: Action,
    seconds: float,
    stance: str,
    seen: Callable[[Array], Array] | None = None,
) -> str | None:
    """Return the stance that an action looks like at a moment, if another than its own."""
    best: tuple[float, str] | None = None
    for other in measured.frames:
        cost = measured.costs(project, action, other) if other != stance else None
        if cost is not None:
            here = _at(cost if seen is None else seen(cost), seconds)
            best = min(best, (here, other)) if best is not None else (here, other)
    return best[1] if best is not None and best[0] <= 1 else None


def compute_stance_curves(project: Project, measured: Measured, action: Action) -> Curves | None:
    """Return an action's clip beside its stances; None if nothing can be compared."""
    entry = project.clips.get(action.clip)
    motion = entry.motion if entry is not None else None
    if motion is None or motion.frames < 2 or motion.skeleton != project.skeleton:
        return None
    roles = measured.roles
    if action.kind == "stance":
        start = project.span(action)[0]
        first = c.find_stance_frames(measured.stats, [(motion, start, start + 1e-6)], roles)
        cost = c.measure_transition_costs(measured.stats, motion, first, roles)
        return Curves(_times(motion, cost), cost, cost, c.find_loop_times(measured.stats, motion, roles))
    into, left = (
        measured.costs(project, action, action.stance),
        measured.costs(project, action, find_end_stance(action)),
    )
    if into is None or left is None:
        return None
    stats = c.mask_statistics(measured.stats, motion, anatomy.make_action_mask(project, action), roles)
    stroke = find_phases(project, action).stroke if action.kind == "gesture" else action.timing.stroke
    times = _times(motion, into)
    gaps = end_gaps.measure_distances_to_stance(project, action, times)
    if cycle_of(action.kind, action.timing, *project.span(action)) > 0:
        proposed = _cycle_times(project, action)
    else:
        proposed = c.propose_times(stats, motion, into, left, stroke, roles)
        proposed = _hidden(project, action, proposed, times, gaps)
    return Curves(times, c.compute_entry_costs(into), left, proposed, gaps, motion.skeleton.height)


def _cycle_times(project: Project, action: Action) -> c.ProposedTimes:
    """Return the times of an action that repeats: its part stays, or its cycles would not meet."""
    start, end = project.span(action)
    t = action.timing
    reason = phrase("repeats its part, so its start and end stay where they are")
    return c.ProposedTimes(start, end, t.blend_in, t.blend_out, t.earliest_exit, True, reason)


def _hidden(
    project: Project, action: Action, proposed: c.ProposedTimes, times: Array, gaps: tuple[Array, Array]
) -> c.ProposedTimes:
    """Return proposed times at whose ends no joint is farther from the stances than a blend hides.

    An end that is goes to the nearest moment that is near the stance, else its blend becomes as long as it
    takes. Where neither will do, and those the action has do, these stay.
    """
    motion = end_gaps.get_action_motion(project, action)
    if motion is None:
        return proposed
    height, t = motion.skeleton.height, action.timing

    def shows(edge: int, at: float, blend: float) -> bool:
        metres = float(np.interp(at, times, gaps[edge]))
        return np.isfinite(metres) and metres > end_gaps.measure_hidden_gap(height, blend) + 1e-4

    room = max(0.0, proposed.end - proposed.start) / 2
    ends = []
    for edge, at, blend in (0, proposed.start, proposed.blend_in), (1, proposed.end, proposed.blend_out):
        if shows(edge, at, blend):
            near = times[
                (gaps[edge] <= end_gaps.measure_hidden_gap(height, blend)) & (np.abs(times - at) <= room / 2)
            ]
            if len(near):
                at = float(near[np.argmin(np.abs(near - at))])
            else:
                metres = float(np.interp(at, times, gaps[edge]))
                blend = min(room, end_gaps.blend_for(height, metres) + SLACK)
        ends.append((at, blend))
    (start, into), (end, out) = ends
    longest = max(0.0, end - start) / 2
    into, out = min(into, longest), min(out, longest)
    now = project.span(action)
    if (shows(0, start, into) or shows(1, end, out)) and not (
        shows(0, now[0], t.blend_in) or shows(1, now[1], t.blend_out)
    ):
        start, end, into, out = *now, t.blend_in, t.blend_out
    leave = proposed.earliest_exit
    leave = None if leave is None or leave >= end - out else leave
    return replace(proposed, start=start, end=end, blend_in=into, blend_out=out, earliest_exit=leave)


def _times(motion: Clip, cost: Array) -> Array:
    return np.linspace(0, motion.duration, len(cost))
