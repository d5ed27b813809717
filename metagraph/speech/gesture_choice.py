"""Which gestures go with the clauses of a turn, chosen together: one by one most would come while the one
before still plays.

A gesture's stroke is on its clause's peak. What there is too little time for is shortened as people do
(Kendon; McNeill, Hand and Mind, 1992, chapter 3): the preparation is cut, the hold hurried; or a hold is kept
over the next clause, which then needs no stroke of its own. The best choice of all is found exactly, by
dynamic programming over the clauses.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from math import inf, log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Action, Project
from metagraph.playback.planning.choice import uniform
from metagraph.playback.planning.cue_shapes import HURRY
from metagraph.playback.planning.director import beat_interval, repeat_interval
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.timing.phases import find_phases

Array = NDArray[Any]

STROKE, HELD = 1.0, 0.6  # what a stroke on a clause's peak is worth, and a hold over it
# Of that where none was drawn for the clause: more where too few have room, and most in a stance that has so
# few gestures that each repeats.
UNASKED = (-0.5, -0.2, 0.1, 0.4, 0.7, 1.0)
APART = 5.0  # seconds between the peaks of two clauses that do not hinder each other
CUT, HURRIED, KEPT = (
    0.15,
    0.1,
    0.1,
)  # what a cut preparation and a hurried hold cost, and a second of longer hold
AGAIN = 0.6  # what the same gesture twice in a row costs; less the longer ago it was
ECHOED = 0.4  # what a gesture costs that somebody else makes at that time
RETRIES = 4  # how often a turn is chosen again to repeat less
CHANCE = 0.06  # how much chance, and by it likelihoods, weigh
LONGEST_HOLD = 1.6  # seconds a hold is kept up at most
AFTER = 0.1  # seconds a hold goes on after a peak it is kept for
CHOICES = 10  # gestures tried for a clause, beside the shortest
SHORT = 2  # of the shortest
_PARTS = re.compile(r"[\W_\d]+")  # between words of a name
_ARMS = frozenset(("l", "r", "lf", "rt", "bt", "left", "right", "both"))
BACK = 12  # clauses that a gesture may reach over, at most


@dataclass(frozen=True, slots=True)
class GestureClause:
    """A clause that may get a gesture. key: of its draws. peak: seconds. wanted: whether one was drawn for
    it. actions: those that go with its words. echoes: by family of gestures that others make about then, how
    near that is, 0..1.
    """

    key: str
    peak: float
    wanted: bool
    actions: Sequence[Action]
    echoes: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ChosenGesture:
    """clause, last: the number of the clause its stroke is in, and of the last its hold is over. hold:
    seconds, None for as it was made. start, end: seconds it plays, as late and as early as can be. free:
    whether every gesture of the clause, as it was made, would have fitted as well.
    """

    clause: int
    last: int
    action: Action
    hold: float | None
    start: float
    end: float
    free: bool = False


@dataclass(frozen=True, slots=True)
class _Lengths:
    """Seconds of a gesture: before its stroke, as made and at least; from the stroke to the hold's beginning,
    its hold, and what comes after it.
    """

    lead: float
    least: float
    telling: float
    hold: float
    back: float

    def end(self, hold: float | None) -> float:
        """Return how long after the stroke it ends."""
        return self.telling + (self.hold if hold is None else hold) + self.back

    @property
    def shortest(self) -> float:
        return self.least + self.end(self.hold / HURRY)


def choose_gestures(
    project: Project, clauses: Sequence[GestureClause], seed: int, length: float = inf
) -> list[ChosenGesture]:
    """Return the gestures of one who says these clauses, by time; peaks ascend. length: seconds that there
    are. The arms stay in one stance.
    """
    known: dict[str, _Lengths] = {}
    used = _UsedGestures(project)
    out: list[ChosenGesture] = []
    first, owed = 0, 0
    for n in range(1, len(clauses) + 1):
        if n == len(clauses) or clauses[n].peak - clauses[n - 1].peak >= APART:
            begun = out[-1].end + project.settings.rest if out else 0.0
            turn = clauses[first:n]
            found = _of_turn(project, turn, seed, (begun, length), known, used, owed)
            # What had no room in one turn is made up for in the next ones, as in a stance with more gestures.
            owed = max(0, owed + sum(c.wanted for c in turn) - _count_clauses(found))
            out += [replace(o, clause=o.clause + first, last=o.last + first) for o in found]
            for one in found:
                used.note(one.action, clauses[one.clause + first].peak)
            first = n
    return _freed(project, clauses, out, known)


@cache
def find_gesture_family(name: str) -> str:
    """Return a gesture's name without its number and the arm that makes it: what viewers see as one gesture.
    The name itself if nothing else is left.
    """
    words = [word for word in _PARTS.split(name.casefold()) if word and word not in _ARMS]
    return " ".join(words) or name


class _UsedGestures:
    """What it costs to make gestures again, by when one of each family was made last."""

    def __init__(self, project: Project) -> None:
        self._project, self._last, self._needed = project, dict[str, float](), dict[str, float]()
        gestures = [a for a in project.graphs["arms"].actions.values() if a.kind == "gesture"]
        self._beats = beat_interval("arms", len(gestures))

    def note(self, action: Action, at: float) -> None:
        """Note that a gesture's stroke is at a time."""
        self._last[find_gesture_family(action.name)] = at

    def cost(self, action: Action, at: float, last: float | None = None) -> float:
        """Return what a gesture costs whose stroke is at a time. last: when it was made before; None for
        when it was noted.
        """
        before = self._last.get(find_gesture_family(action.name)) if last is None else last
        if before is None or self._project.settings.variety <= 0:
            return 0.0
        if action.id not in self._needed:
            shows = measure_prominence(self._project, action)
            needed = repeat_interval("gesture", shows, self._beats)
            self._needed[action.id] = needed * self._project.settings.variety
        return AGAIN * max(0.0, 1.0 - (at - before) / self._needed[action.id])


def _of_turn(
    project: Project, turn: Sequence[GestureClause], seed: int, span: tuple[float, float],
    known: dict[str, _Lengths], used: _UsedGestures, owed: int,
) -> list[ChosenGesture]:  # fmt: skip
    """Return the gestures of clauses that nothing parts: chosen again with what repeats made dearer, as long
    as that repeats less and serves as many clauses. span: seconds before and after which none may play. owed:
    how many clauses more than were drawn are to get one.
    """
    tried = [_tried(project, clause, seed, known, used) for clause in turn]
    costs = {
        (n, action.id): used.cost(action, clause.peak)
        + ECHOED * clause.echoes.get(find_gesture_family(action.name), 0.0)
        for n, (clause, actions) in enumerate(zip(turn, tried, strict=True))
        for action in actions
    }
    best = _best_of_turn(project, turn, tried, costs, seed, span, known, owed)
    repeated = _repeated(turn, best, used)
    for _ in range(RETRIES):
        if not repeated:
            break
        for key, cost in repeated.items():
            costs[key] = costs[key] + cost
        found = _best_of_turn(project, turn, tried, costs, seed, span, known, owed)
        again = _repeated(turn, found, used)
        if _count_clauses(found) < _count_clauses(best) or sum(again.values()) >= sum(repeated.values()):
            break
        best, repeated = found, again
    return best


def _repeated(
    turn: Sequence[GestureClause], found: Sequence[ChosenGesture], used: _UsedGestures
) -> dict[tuple[int, str], float]:
    """Return what repeats within a turn cost, by clause and action."""
    out: dict[tuple[int, str], float] = {}
    made: dict[str, float] = {}
    for one in found:
        at, family = turn[one.clause].peak, find_gesture_family(one.action.name)
        if family in made:
            cost = used.cost(one.action, at, made[family])
            if cost > 0:
                out[one.clause, one.action.id] = cost
        made[family] = at
    return out


def _count_clauses(found: Sequence[ChosenGesture]) -> int:
    return sum(one.last - one.clause + 1 for one in found)


def _best_of_turn(
    project: Project, turn: Sequence[GestureClause], tried: Sequence[Sequence[Action]],
    costs: Mapping[tuple[int, str], float], seed: int, span: tuple[float, float],
    known: dict[str, _Lengths], owed: int,
) -> list[ChosenGesture]:  # fmt: skip
    """Return the gestures that are worth most together: where too few of those that were drawn have room,
    others make up for them. costs: of each action for each clause.
    """
    drawn = sum(c.wanted for c in turn) + owed
    best: list[ChosenGesture] = []
    for unasked in UNASKED:
        options: list[ChosenGesture] = []
        worth: list[float] = []
        firsts = [0]
        for n, actions in enumerate(tried):
            for action in actions:
                for option, value in _options(turn, n, action, known[action.id], seed, span[1], unasked):
                    options.append(option)
                    worth.append(value - costs[n, action.id])
            firsts.append(len(options))
        if not options:
            break
        places = _best(options, np.array(worth), firsts, known, turn, project.settings.rest, span[0])
        found = [options[o] for o in places]
        if _count_clauses(found) > _count_clauses(best):
            best = found
        if _count_clauses(best) >= drawn:
            break
    return best


def _lengths(project: Project, action: Action) -> _Lengths:
    found = find_phases(project, action)
    return _Lengths(
        found.stroke - found.start,
        found.stroke - found.skip(action.timing.blend_in),
        found.stroke_end - found.stroke,
        found.relax - found.stroke_end,
        found.end - found.relax,
    )


def _tried(
    project: Project, clause: GestureClause, seed: int, known: dict[str, _Lengths], used: _UsedGestures
) -> list[Action]:
    """Return the actions to try for a clause: drawn by likelihood and by when they were made last, and the
    shortest.
    """
    for action in clause.actions:
        if action.id not in known:
            known[action.id] = _lengths(project, action)
    usable = [a for a in clause.actions if a.likelihood > 0]
    drawn = sorted(
        usable,
        key=lambda a: (
            log(uniform(seed, clause.key, "gesture", a.id)) / a.likelihood - used.cost(a, clause.peak)
        ),
    )[::-1]
    short = sorted(usable, key=lambda a: known[a.id].shortest)[:SHORT]
    return list({a.id: a for a in (*drawn[:CHOICES], *short)}.values())


def _options(
    clauses: Sequence[GestureClause],
    n: int,
    action: Action,
    lengths: _Lengths,
    seed: int,
    length: float,
    unasked: float = UNASKED[0],
) -> Iterable[tuple[ChosenGesture, float]]:
    """Yield the ways to play an action with its stroke on a clause, and what each is worth by itself."""
    clause = clauses[n]
    holds: list[float | None] = [None]
    if lengths.hold > 0:
        holds.append(lengths.hold / HURRY)
    if n + 1 < len(clauses):
        kept = clauses[n + 1].peak + AFTER - clause.peak - lengths.telling
        if lengths.hold < kept <= max(LONGEST_HOLD, lengths.hold):
            holds.append(round(kept, 3))
    chance = CHANCE * (log(action.likelihood) - log(-log(uniform(seed, clause.key, "chance", action.id))))
    for hold in holds:
        until = clause.peak + lengths.telling + (lengths.hold if hold is None else hold)
        end = clause.peak + lengths.end(hold)
        last = n
        while last + 1 < len(clauses) and clauses[last + 1].peak <= until + AFTER / 2:
            last += 1
        late = n + BACK < len(clauses) and end > clauses[n + BACK].peak
        if late or end > length or clause.peak - lengths.least < 0:
            continue
        value = STROKE * (1 if clause.wanted else unasked) + chance
        value += sum(HELD * (1 if c.wanted else unasked) for c in clauses[n + 1 : last + 1])
        if hold is not None:
            value -= HURRIED if hold < lengths.hold else KEPT * (hold - lengths.hold)
        yield ChosenGesture(n, last, action, hold, clause.peak - lengths.lead, end), value


def _best(
    options: Sequence[ChosenGesture],
    worth: Array,
    firsts: Sequence[int],
    known: Mapping[str, _Lengths],
    clauses: Sequence[GestureClause],
    rest: float,
    begun: float,
) -> list[int]:
    """Return the options that are worth most together, by time; none may play while another does, nor before
    begun seconds.
    """
    peaks = np.array([clauses[o.clause].peak for o in options])
    lead = np.array([known[o.action.id].lead for o in options])
    least = np.array([known[o.action.id].least for o in options])
    ready = np.array([o.end + rest for o in options])
    last = np.array([o.last for o in options])
    names = {a: n for n, a in enumerate(dict.fromkeys(o.action.id for o in options))}
    name = np.array([names[o.action.id] for o in options])
    total, before = worth.copy(), np.full(len(options), -1)
    long_ago: tuple[float, int] = (0.0, -1)  # the best of what ended before what is looked back on
    for n in range(len(clauses)):
        here = slice(firsts[n], firsts[n + 1])
        if here.start == here.stop:
            continue
        begin = firsts[max(0, n - BACK)]
        if n - BACK > 0:
            old = slice(firsts[n - BACK - 1], begin)
            if old.stop > old.start and total[old].max() > long_ago[0]:
                long_ago = float(total[old].max()), old.start + int(total[old].argmax())
        gain, chosen = (
            np.full(here.stop - here.start, long_ago[0]),
            np.full(here.stop - here.start, long_ago[1]),
        )
        if begin < here.start:
            back = slice(begin, here.start)
            room = peaks[here, None] - ready[None, back]  # seconds for what comes before the stroke
            spare = np.maximum(lead[here] - least[here], 1e-9)[:, None]
            cut = np.clip((lead[here, None] - room) / spare, 0, 1)
            value = total[back] - CUT * cut - AGAIN * (name[here, None] == name[None, back])
            value[(room < least[here, None]) | (last[None, back] >= n)] = -inf
            place = value.argmax(1)
            best = value[np.arange(len(place)), place]
            better = best > gain
            gain[better], chosen[better] = best[better], begin + place[better]
        room = peaks[here] - begun
        cut = np.clip((lead[here] - room) / np.maximum(lead[here] - least[here], 1e-9), 0, 1)
        alone = np.where(room < least[here], -inf, gain - CUT * cut)
        total[here] += np.where(chosen < 0, alone, gain)
        before[here] = chosen
    out: list[int] = []
    at = int(total.argmax()) if total.max() > 0 else -1
    while at >= 0:
        out.append(at)
        at = int(before[at])
    return out[::-1]


def _freed(
    project: Project, clauses: Sequence[GestureClause], found: list[ChosenGesture], known: dict[str, _Lengths]
) -> list[ChosenGesture]:
    """Report each gesture whether any other of its clause would have done."""
    rest, out = project.settings.rest, []
    ends = [-inf]
    for n, one in enumerate(found):
        clause = clauses[one.clause]
        every = [known[a.id] for a in clause.actions if a.likelihood > 0]
        starts = clause.peak - max(x.lead for x in every)
        after = found[n + 1] if n + 1 < len(found) else None
        end = clause.peak + max(x.end(None) for x in every)
        until = inf if after is None else clauses[after.clause].peak - known[after.action.id].lead - rest
        free = (
            one.hold is None
            and one.last == one.clause
            and starts >= max(0.0, ends[-1] + rest)
            and end <= until
        )
        ends.append(end if free else one.end)
        out.append(ChosenGesture(one.clause, one.last, one.action, one.hold, one.start, one.end, free))
    return out
