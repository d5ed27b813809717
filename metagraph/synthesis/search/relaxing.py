"""Find motion for speech that no path fits exactly: constraints are dropped one by one, and what the motion
misses is reported with its time.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import join_phrases, phrase
from metagraph.graph.conversation.model import SOUNDS, Segment, Sound
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import EDGE, STRESS, TOLERANCE, HeardStates, WantedSegment, list_wanted
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.iconic_words import find_states_of_words
from metagraph.synthesis.retiming import FARTHER, NEARER, Retiming, keeps_constraints, make_timing_cost
from metagraph.synthesis.search.frame_costs import join_costs
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.ruled_search import FREE, JUMP_RULES, JumpRules, Search, find_path
from metagraph.synthesis.soft_constraints import NOTHING, SoftConstraints
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

WIDER = 2.0  # times the tolerance: what is tried first
PARTS = (1.0, 0.5, 0.25)  # of the speed that may be changed: less is tried where more would lose something
FAR = 1.0  # seconds: an event farther off than that is none
_EVENTS = {"start": phrase("start"), "end": phrase("end"), "stress": phrase("stress")}
_KINDS: dict[Sound, str] = {
    "clause": phrase("clause"),
    "response": phrase("response"),
    "hesitation": phrase("hesitation"),
    "idle": phrase("silence"),
}
_ALL: dict[Sound, str] = {
    "clause": phrase("clauses"),
    "response": phrase("responses"),
    "hesitation": phrase("hesitations"),
}
_MET = phrase("all starts, ends and stresses are met")


@dataclass(frozen=True)
class Constraints:
    """What motion has to keep to: as `constraints.wanted` and `ruled_search.find_path` take it. words:
    whether words that want motion have to be met.
    """

    tolerance: float = TOLERANCE
    use: tuple[Sound, ...] = SOUNDS
    peaks: bool = True
    edges: bool = True
    rules: JumpRules = JUMP_RULES
    words: bool = False

    def wanted(self, segments: Sequence[Segment], seconds: float, soft: SoftConstraints) -> WantedSegment:
        """Return what is wanted frame by frame by that."""
        want = list_wanted(segments, seconds, self.tolerance, self.use, self.peaks, self.edges)
        return replace(want, only=find_states_of_words(soft.places)) if self.words else want


@dataclass(frozen=True)
class Miss:
    """Something of speech that the motion was not made with. what: "start", "end" or "stress" of a kind of
    segment. at: when, seconds. off: how far the nearest such event of the motion is, seconds; None if there
    is none within FAR.
    """

    what: str
    kind: Sound
    at: float
    off: float | None

    def words(self) -> str:
        """Return a phrase such as "start of the clause at 2.5 s: 0.50 s off"."""
        event = phrase(
            "{what} of the {kind} at {at:.1f} s", what=_EVENTS[self.what], kind=_KINDS[self.kind], at=self.at
        )
        if self.off is None:
            return phrase("{event}: not met", event=event)
        return phrase("{event}: {off:.2f} s off", event=event, off=self.off)


@dataclass(frozen=True, eq=False)
class RelaxedAnswer:
    """path: what was found. kept: the constraints it keeps to. given_up: the others, in words. misses: what
    is off by more than the tolerance that was asked for. retiming: how it is played faster and slower, None
    if it is not.
    """

    path: Path
    kept: Constraints
    given_up: tuple[str, ...] = ()
    misses: tuple[Miss, ...] = ()
    retiming: Retiming | None = None

    def words(self) -> str:
        """Return what was dropped and missed, or "" if all constraints are met."""
        if not self.given_up:
            return ""
        missed = join_phrases([m.words() for m in self.misses[:3]], ", ") if self.misses else _MET
        dropped, more = join_phrases(self.given_up, ", "), len(self.misses) - 3
        if more > 0:
            return phrase(
                "dropped: {dropped}; {missed} and {more} more", dropped=dropped, missed=missed, more=more
            )
        return phrase("dropped: {dropped}; {missed}", dropped=dropped, missed=missed)


def list_relaxations(asked: Constraints) -> Iterator[Constraints]:
    """Yield the constraints that are tried one after another, those asked for first: what is seen least is
    given up first. The last constrain nothing.
    """
    now = asked
    yield now
    spoken = tuple(k for k in asked.use if k in ("clause", "response"))
    changes: tuple[dict[str, Any], ...] = (
        {"tolerance": WIDER * asked.tolerance},
        {"edges": False},
        {"rules": FREE},
        {"peaks": False},
        {"use": spoken},
        {"use": tuple(k for k in spoken if k == "clause")},
        {"words": False},
        {"use": ()},
    )
    for change in changes:
        changed = replace(now, **change)
        if changed != now:
            now = changed
            yield now


def _taken_back(kept: Constraints, asked: Constraints) -> Iterator[Constraints]:
    """Yield constraints with one more of those that were asked for."""
    for kind in asked.use:
        if kind not in kept.use:
            yield replace(kept, use=tuple(k for k in asked.use if k in kept.use or k == kind))
    for field in ("words", "peaks", "rules", "edges", "tolerance"):
        changed = replace(kept, **{field: getattr(asked, field)})
        if changed != kept:
            yield changed


def describe_given_up(asked: Constraints, kept: Constraints) -> tuple[str, ...]:
    """Return the names of the dropped constraints."""
    out = [_ALL[kind] for kind in asked.use if kind not in kept.use and kind != "idle"]
    out += [phrase("silence")] if "idle" in asked.use and "idle" not in kept.use else []
    if asked.peaks and not kept.peaks:
        out.append(phrase("stresses"))
    if asked.edges and not kept.edges:
        out.append(phrase("starts and ends of segments"))
    if asked.tolerance != kept.tolerance:
        out.append(phrase("exact timing ({tolerance:g} s allowed)", tolerance=kept.tolerance))
    if asked.rules != kept.rules:
        out.append(phrase("the limit on jumps"))
    if asked.words and not kept.words:
        out.append(phrase("required words"))
    return tuple(out)


@dataclass(frozen=True)
class Searching:
    """How motion is looked for. seed: of the greedy search. strict: nothing is given up."""

    search: Search = "exact"
    seed: int = 1
    strict: bool = False


EXACTLY = Searching()


def answer_speech(
    graph: MotionGraph,
    heard: HeardStates,
    segments: Sequence[Segment],
    seconds: float,
    asked: Constraints | None = None,
    searching: Searching = EXACTLY,
    cancelled: Callable[[], bool] | None = None,
    soft: SoftConstraints = NOTHING,
) -> RelaxedAnswer:
    """Return motion for speech, with as many of the constraints as there is any for: they are given up until
    there is some, and then taken back one by one. soft: what it should have beside them. Raises
    SynthesisError if the takes cannot even go on so long, or with nothing given up, or when it was cancelled.

    What may be retimed is looked for with WIDER the tolerance too if there is nothing within it: where speed
    brings all of it within the tolerance that was asked for, nothing was given up.
    """
    asked = Constraints() if asked is None else asked
    asked = replace(asked, words=soft.hard and bool(soft.places))
    task = _Task(graph, heard, segments, seconds, asked, searching, cancelled, soft)
    return task.strictly() if searching.strict else task.relaxed()


@dataclass(frozen=True, eq=False)
class _Task:
    """What `answer` is asked for."""

    graph: MotionGraph
    heard: HeardStates
    segments: Sequence[Segment]
    seconds: float
    asked: Constraints
    searching: Searching
    cancelled: Callable[[], bool] | None
    soft: SoftConstraints

    def relaxed(self) -> RelaxedAnswer:
        """Return motion that keeps to what it can."""
        path, kept = self._first()
        failed: set[Constraints] = set()
        while more := next((c for c in _taken_back(kept, self.asked) if c not in failed), None):
            found = self._path_or_none(more)
            if found is None:
                failed.add(more)
            else:
                kept, path = more, found
        retiming, kept = self._retimed(path, kept)
        words = describe_given_up(self.asked, kept)
        missed = find_misses(self.heard, path, self.segments, self.asked, retiming) if words else ()
        return RelaxedAnswer(path, kept, words, missed, retiming)

    def strictly(self) -> RelaxedAnswer:
        """Return motion that keeps to all that is asked, retimed where that helps. Raises SynthesisError."""
        asked = self.asked
        try:
            path = self._path(asked)
        except SynthesisError:
            wider = replace(asked, tolerance=WIDER * asked.tolerance)
            if self.soft.free is None or wider == asked:
                raise
            with suppress(SynthesisError):
                path = self._path(wider)
                retiming, kept = self._retimed(path, wider)
                if kept == asked:
                    return RelaxedAnswer(path, kept, retiming=retiming)
            raise
        return RelaxedAnswer(path, asked, retiming=self._retimed(path, asked)[0])

    def _first(self) -> tuple[Path, Constraints]:
        """Return a path that keeps to as much as the first for which there is one. Raises SynthesisError."""
        for kept in list_relaxations(self.asked):
            path = self._path_or_none(kept)
            if path is not None:
                return path, kept
        raise SynthesisError(
            f"these takes cannot go on for {self.seconds:g} s without a jump: choose more takes, raise k or "
            "the level, or ask for less"
        )

    def _path(self, kept: Constraints) -> Path:
        """Return a path that keeps to constraints. Raises SynthesisError if there is none."""
        soft, how = self.soft, self.searching
        want = self._wanted(kept)
        charged = soft.charged
        if soft.free is not None:
            kinds = charged.kinds if charged is not None else ()
            price = NEARER if kept.tolerance <= self.asked.tolerance else FARTHER
            charged = join_costs(
                [*kinds, make_timing_cost(self.heard, want, self.graph.threshold.limit, price)]
            )
        return find_path(
            self.graph, self.heard, want, how.search, kept.rules, how.seed, self.cancelled, charged
        )

    def _path_or_none(self, kept: Constraints) -> Path | None:
        """Return a path that keeps to constraints, None if there is none. Raises SynthesisError when it was
        cancelled.
        """
        try:
            return self._path(kept)
        except SynthesisError:
            if self.cancelled is not None and self.cancelled():
                raise
            return None

    def _wanted(self, kept: Constraints) -> WantedSegment:
        return kept.wanted(self.segments, self.seconds, self.soft)

    def _retimed(self, path: Path, kept: Constraints) -> tuple[Retiming | None, Constraints]:
        """Return how a path is retimed, and the constraints it then keeps to: the tolerance that was asked
        for, where it does. What it kept to before it does not lose: else it is not retimed.
        """
        reach = float(round(kept.tolerance * RATE))
        held = self._wanted(kept)
        exactly = replace(kept, tolerance=self.asked.tolerance)
        nearer = self._wanted(exactly)
        for part in PARTS:
            retiming = self.soft.retimed(path, self.heard, held, reach, part)
            if retiming is None:
                break
            if keeps_constraints(path.states, retiming.moments, self.heard, nearer):
                return retiming, exactly
            if keeps_constraints(path.states, retiming.moments, self.heard, held):
                return retiming, kept
        return None, kept


def find_misses(
    heard: HeardStates,
    path: Path,
    segments: Collection[Segment],
    asked: Constraints,
    retiming: Retiming | None = None,
) -> tuple[Miss, ...]:
    """Return what of speech the motion was not made with, as it is retimed, in the order of time."""
    frames, out = len(path.states), []
    shown = np.arange(frames) if retiming is None else retiming.shown
    stresses = shown[heard.happens(STRESS)[path.states]]
    edges = shown[heard.happens(EDGE)[path.states]]
    for s in sorted(segments, key=lambda s: s.start):
        if s.kind not in asked.use:
            continue
        events: list[tuple[str, float | None, Array]] = []
        if asked.edges:
            events += [("start", s.start, edges), ("end", s.end, edges)]
        if asked.peaks and s.kind == "clause":
            events.append(("stress", s.peak, stresses))
        for what, at, near in events:
            if at is None or not 0 < round(at * RATE) < frames:
                continue
            off = float(np.abs(near - round(at * RATE)).min(initial=10**6)) / RATE
            if off > asked.tolerance + 0.5 / RATE:
                out.append(Miss(what, s.kind, at, off if off <= FAR else None))
    return tuple(sorted(out, key=lambda m: m.at))
