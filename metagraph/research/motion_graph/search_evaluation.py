"""How often speech finds motion, and how soon: each take's speech against the graph of all the others (Yang
et al., sections 8.1, 8.3).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from statistics import fmean, median
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import SOUNDS, Segment, Sound
from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import (
    TOLERANCE,
    HeardStates,
    find_change_states,
    find_heard_at,
    list_wanted,
)
from metagraph.synthesis.cooccurrence import compute_wilson_interval
from metagraph.synthesis.graph import MotionGraph, build_graph, find_threshold
from metagraph.synthesis.prosody_costs import SpokenTake
from metagraph.synthesis.search.path_quality import measure_quality
from metagraph.synthesis.search.relaxing import Constraints, Searching, answer_speech
from metagraph.synthesis.search.ruled_search import FREE, JUMP_RULES, JumpRules, Search, find_path
from metagraph.synthesis.soft_constraints import (
    NO_WISH,
    SoftConstraints,
    SoftMaterial,
    SoftWish,
    make_soft_report,
)
from metagraph.synthesis.states import (
    KEYS,
    LEVEL,
    STEP,
    States,
    SynthesisError,
    key_states,
    read_states,
    with_velocity,
)

Array = NDArray[Any]

WINDOW = 15.0  # seconds of speech a case
EVERY = 14.0  # seconds from one case to the next
LEAST = 1.0  # seconds of a take that make a case


@dataclass(frozen=True)
class Setting:
    """What constrains a search: segments of these kinds, where clauses' stresses are (peaks), where segments
    begin and end (edges), and how exactly, seconds; and how it may jump.
    """

    name: str
    use: tuple[Sound, ...] = SOUNDS
    peaks: bool = True
    tolerance: float = TOLERANCE
    edges: bool = True
    rules: JumpRules = JUMP_RULES


def _without(kind: Sound) -> Setting:
    return Setting(f"without {kind}", tuple(k for k in SOUNDS if k != kind))


SETTINGS: tuple[Setting, ...] = (
    Setting("all constraints"),
    *(_without(kind) for kind in ("clause", "response", "hesitation", "idle")),
    Setting("without peaks", peaks=False),
    Setting("without edges", edges=False),
    Setting("free jumps", rules=FREE),
    Setting("no constraints", ()),
    Setting("tolerance 0.05 s", tolerance=0.05),
    Setting("tolerance 0.2 s", tolerance=0.2),
)


@dataclass(frozen=True)
class HeldOutCase:
    """One window of a take that was held out. start, length, seconds of the search: seconds. found: whether
    there is motion that does not stand still (`PathQuality`). transitions, cost, repeated, rest: of what was
    found, 0 if nothing was; `why` says why nothing was found, or not counted. loudness, pace: spreads that
    what was found is off of how it is said; words: share of the words that are met; off, was: seconds that
    starts, ends and stresses are off, after retiming and before; None if nobody asked, or nobody knows.
    """

    take: str
    start: float
    length: float
    setting: str
    search: Search
    found: bool
    seconds: float
    transitions: int
    cost: float
    why: str = ""
    repeated: float = 0.0
    rest: float = 0.0
    loudness: float | None = None
    pace: float | None = None
    words: float | None = None
    off: float | None = None
    was: float | None = None


@dataclass(frozen=True)
class Graph:
    """What was built without a take. states: how many are kept of how many; transitions; limit: metres;
    seconds: of the building.
    """

    without: str
    kept: int
    states: int
    transitions: int
    limit: float
    seconds: float


@dataclass(frozen=True)
class EvaluationRow:
    """All cases of a setting and a search. success: the share that found motion, 0..1, low, high: its 95 %
    interval (Wilson). seconds: median of the searches, whether they found something or not. per_second, cost:
    of those found, transitions a second, and the mean. repeated: mean share of their frames that were shown
    within 3 s before. rest: seconds of the longest rest in any. loudness, pace, words, off, was: means of
    `Case`, None if no case has any.
    """

    setting: str
    search: Search
    found: int
    cases: int
    success: float
    low: float
    high: float
    seconds: float
    per_second: float
    cost: float
    repeated: float
    rest: float
    loudness: float | None = None
    pace: float | None = None
    words: float | None = None
    off: float | None = None
    was: float | None = None


@dataclass(frozen=True)
class Evaluation:
    """whole: whether it came to its end, and was not cancelled."""

    cases: tuple[HeldOutCase, ...]
    graphs: tuple[Graph, ...]
    whole: bool

    @property
    def rows(self) -> list[EvaluationRow]:
        """A row for each setting and search, in the order they were tried."""
        groups: dict[tuple[str, Search], list[HeldOutCase]] = {}
        for case in self.cases:
            groups.setdefault((case.setting, case.search), []).append(case)
        return [_row(setting, search, cases) for (setting, search), cases in groups.items()]


def _row(setting: str, search: Search, cases: Sequence[HeldOutCase]) -> EvaluationRow:
    found = [c for c in cases if c.found]
    low, high = compute_wilson_interval(len(found), len(cases))
    moved = sum(c.length for c in found)
    return EvaluationRow(
        setting,
        search,
        len(found),
        len(cases),
        len(found) / len(cases),
        low,
        high,
        median(c.seconds for c in cases),
        sum(c.transitions for c in found) / moved if moved else 0.0,
        fmean(c.cost for c in found) if found else 0.0,
        fmean(c.repeated for c in found) if found else 0.0,
        max((c.rest for c in found), default=0.0),
        *(_mean(getattr(c, name) for c in found) for name in ("loudness", "pace", "words", "off", "was")),
    )


def _mean(values: Iterable[float | None]) -> float | None:
    known = [v for v in values if v is not None]
    return fmean(known) if known else None


def list_case_windows(
    length: float, window: float = WINDOW, every: float = EVERY
) -> list[tuple[float, float]]:
    """Return where a take's cases begin, and how long they are, seconds. A take shorter than a window makes
    one case as long as it is, one shorter than LEAST none.
    """
    if length < window:
        return [(0.0, length)] if length >= LEAST else []
    return [(n * every, window) for n in range(int((length - window + 1e-6) // every) + 1)]


def cut_segments(segments: Sequence[Segment], start: float, length: float) -> list[Segment]:
    """Return what of segments is in a window, in its own time; stresses outside of it are forgotten."""
    out = []
    for s in segments:
        a, b = max(s.start, start) - start, min(s.end, start + length) - start
        if round(b * RATE) > round(a * RATE):
            peak = None if s.peak is None or not start <= s.peak < start + length else s.peak - start
            out.append(Segment(s.kind, a, b, peak, s.text))
    return out


@dataclass(frozen=True)
class GraphMaking:
    """How a graph is made of takes, as `build` and `find_threshold` take it. keys: share of states that are
    key states.
    """

    k: int = STEP
    level: float = LEVEL
    keys: float = KEYS
    most: int | None = None


@dataclass(frozen=True)
class Trials:
    """How held-out speech is cut, see `windows`, and searched for. seed: of the greedy search."""

    searches: Collection[Search] = ("greedy", "exact")
    window: float = WINDOW
    every: float = EVERY
    seed: int = 1


@dataclass(frozen=True)
class Beside:
    """What motion should have beside a setting's constraints. spoken: what is known of each take's speech,
    no more than its segments where None.
    """

    wish: SoftWish = NO_WISH
    spoken: Sequence[SpokenTake] | None = None


ALL_TRIALS, USUAL_GRAPH, NOTHING_BESIDE = Trials(), GraphMaking(), Beside()


def evaluate_search(
    takes: Sequence[Clip],
    speech: Sequence[Sequence[Segment]],
    settings: Sequence[Setting] = SETTINGS,
    trials: Trials = ALL_TRIALS,
    making: GraphMaking = USUAL_GRAPH,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    beside: Beside = NOTHING_BESIDE,
) -> Evaluation:
    """Hold out one take after another, build the graph of the rest as `build` does, and search it for what
    was said in the one held out.

    speech: what each take goes with, `list_segments_heard_by`. A take without which there is no graph makes
    cases that find nothing. Cancelled, it returns what there is. Raises SynthesisError when there are fewer
    than two takes, not as many speeches, or no case at all.
    """
    searches = trials.searches
    known = [SpokenTake(tuple(s)) for s in speech] if beside.spoken is None else beside.spoken
    takes, speech, spoken = _checked(takes, speech, known)
    every_state = read_states(takes)
    _warm(searches)
    lengths = np.diff(every_state.starts) / RATE
    cases = [list_case_windows(float(length), trials.window, trials.every) for length in lengths]
    total = sum(map(len, cases)) * len(settings) * len(searches)
    if not total:
        raise SynthesisError(f"no take is longer than {LEAST:g} s, so there is no case: give longer takes")
    done: list[HeldOutCase] = []
    graphs: list[Graph] = []
    for n, take in enumerate(takes):
        if not cases[n]:
            continue
        made = _graph(every_state, speech, n, making, cancelled)
        if not isinstance(made, str):
            graph, sound, seconds = made
            kept, edges = graph.size
            graphs.append(Graph(take.name, kept, len(graph.states), edges, graph.threshold.limit, seconds))
            rest, theirs = [*takes[:n], *takes[n + 1 :]], [*spoken[:n], *spoken[n + 1 :]]
            material = SoftMaterial(beside.wish, graph.states, rest, theirs, graph.threshold.limit)
        for start, length in cases[n]:
            said = cut_segments(speech[n], start, length)
            for setting, search in ((s, x) for s in settings for x in searches):
                if cancelled is not None and cancelled():
                    return Evaluation(tuple(done), tuple(graphs), False)
                case = HeldOutCase(
                    take.name,
                    start,
                    length,
                    setting.name,
                    search,
                    False,
                    0.0,
                    0,
                    0.0,
                    made if isinstance(made, str) else "",
                )
                if not isinstance(made, str):
                    soft = material.constraints(spoken[n], start, length, setting.tolerance)
                    case = _tried(case, graph, sound, said, setting, trials.seed, soft)
                done.append(case)
                if progress is not None:
                    progress(len(done), total)
    return Evaluation(tuple(done), tuple(graphs), True)


def _checked(
    takes: Sequence[Clip], speech: Sequence[Sequence[Segment]], spoken: Sequence[SpokenTake]
) -> tuple[list[Clip], list[Sequence[Segment]], list[SpokenTake]]:
    if not len(takes) == len(speech) == len(spoken):
        raise SynthesisError(f"{len(takes)} takes, but speech for {min(len(speech), len(spoken))}")
    pairs = [
        some for some in zip(takes, speech, spoken, strict=True) if some[0].frames >= 2
    ]  # one frame is no state of a graph
    if len(pairs) < 2:
        raise SynthesisError(
            "holding one take out needs at least two takes of more than one frame: give more"
        )
    return [t for t, _, _ in pairs], [s for _, s, _ in pairs], [s for _, _, s in pairs]


def _warm(searches: Collection[Search]) -> None:
    """Compile what is timed."""
    tiny = States(
        np.zeros((4, 1, 3), np.float32),
        np.zeros((4, 1, 3), np.float32),
        np.ones(1, np.float32),
        np.array([0, 4]),
        1.0,
    )
    graph = build_graph(tiny, find_threshold(tiny, 2), np.arange(4))
    for search in searches:
        find_path(
            graph, HeardStates(np.ones(4, np.uint8), np.zeros(4, bool)), list_wanted([], 0.1), search, FREE
        )


def _graph(
    states: States,
    speech: Sequence[Sequence[Segment]],
    out: int,
    making: GraphMaking,
    cancelled: Callable[[], bool] | None,
) -> tuple[MotionGraph, HeardStates, float] | str:
    """Return the graph without a take, what is heard at its states, and how long it took; or why there is
    none.
    """
    begun = perf_counter()
    rest = hold_out_states(states, out)
    said = [s for n, s in enumerate(speech) if n != out]
    try:
        keys = key_states(rest, making.keys, find_change_states(rest, said))
        limit = find_threshold(rest, making.k, making.level)
        graph = build_graph(rest, limit, keys, making.most, cancelled=cancelled)
        return graph, find_heard_at(rest, said), perf_counter() - begun
    except SynthesisError as error:
        return str(error)  # also where it was cancelled: then no case is tried


def hold_out_states(states: States, take: int) -> States:
    """Return the states of all takes but one, w_v worked out again."""
    a, b = int(states.starts[take]), int(states.starts[take + 1])
    places, velocities = np.delete(states.places, np.s_[a:b], 0), np.delete(states.velocities, np.s_[a:b], 0)
    starts = np.concatenate([states.starts[: take + 1], states.starts[take + 2 :] - (b - a)])
    return with_velocity(replace(states, places=places, velocities=velocities, starts=starts), None)


def _tried(
    case: HeldOutCase,
    graph: MotionGraph,
    sound: HeardStates,
    said: Sequence[Segment],
    setting: Setting,
    seed: int,
    soft: SoftConstraints,
) -> HeldOutCase:
    asked = Constraints(setting.tolerance, setting.use, setting.peaks, setting.edges, setting.rules)
    searching = Searching(case.search, seed, strict=True)
    begun = perf_counter()
    try:
        found = answer_speech(graph, sound, said, case.length, asked, searching, soft=soft)
    except SynthesisError as error:
        return replace(case, seconds=perf_counter() - begun, why=str(error))
    took, path = perf_counter() - begun, found.path
    looks, told = (
        measure_quality(graph.states, path),
        make_soft_report(soft, graph.states, path, found.retiming),
    )
    off = {m.measure: m.off for m in told.matches}
    return replace(
        case,
        found=not looks.stands_still,
        seconds=took,
        transitions=len(path.jumps),
        cost=path.cost,
        why=f"it {looks.rest_words()}" if looks.stands_still else "",
        repeated=looks.repeated,
        rest=looks.frozen,
        loudness=off.get("loudness"),
        pace=off.get("rate"),
        words=fmean(w.met for w in told.words) if told.words else None,
        off=told.off,
        was=told.was,
    )
