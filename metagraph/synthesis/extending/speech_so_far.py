"""What is known of speech while it goes on: what was announced, what was heard, and what is likely to come.

Somebody who speaks is taken to go on speaking, somebody silent to stay silent; the farther off, the less that
counts. What is announced counts entirely, until it is taken back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from numpy.typing import NDArray

from metagraph.graph.conversation.model import SOUNDS, Segment, Sound
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import EDGE, STRESS, TOLERANCE

Array = NDArray[Any]
What = Literal["begins", "ends", "stress", "comes", "hush"]

LATE = 0.5  # seconds by which an event that was heard too late may still be answered
SURE = 0.5  # seconds after which a guess counts half
RHYTHM = (0.6, 1.6)  # seconds after a stress to the next: clauses have about four words, spoken in 1.3 s
USUAL = 0.4  # what it counts that it does not come
DELAYED, TOO_LATE = 0.2, 0.3  # of a missed event: for not coming at once, for not even coming late
LEAST = 0.2  # what a guess counts at the least
MOST = 200  # announced segments that are kept


class SpeechNews(Struct, frozen=True, array_like=True, omit_defaults=True):
    """Something that became known of speech. what: somebody "begins" to speak or "ends", at `at`; there is a
    "stress"; a segment "comes" from `at` to `end`, stressed at `peak`; from `at` on "hush": nothing that was
    announced. kind: of what is spoken. Seconds from the beginning of the motion.
    """

    what: What
    at: float
    end: float = 0.0
    peak: float | None = None
    kind: Sound = "clause"


@dataclass(frozen=True, eq=False)
class ExpectedSpeech:
    """What is to be shown in the next frames `[n]`. allowed uint8: bits of SOUNDS. sure: how much that
    counts, 0..1. window int32: which event is waited for, -1 for none; waits uint8: STRESS or EDGE. unmet:
    how much it counts that it has not come in a frame, 1 in all where it never does. barred uint8: bits of
    the events that should not come.
    """

    allowed: Array
    sure: Array
    window: Array
    waits: Array
    unmet: Array
    barred: Array


class SpeechSoFar:
    """tolerance: seconds by which an event may be off, as `constraints.wanted` has it."""

    def __init__(self, tolerance: float = TOLERANCE) -> None:
        self.slack = round(tolerance * RATE)
        self.segments: list[Segment] = []
        self.spoken: list[tuple[float, float | None, Sound]] = []  # heard: from, to (None: it goes on), kind
        self.stresses: list[float] = []
        self.changed = False

    def tell(self, news: SpeechNews) -> None:
        """Take in what became known."""
        self.changed = True
        going = self.spoken and self.spoken[-1][1] is None
        if news.what == "begins" and not going:
            self.spoken.append((news.at, None, news.kind))
        elif news.what == "ends" and going:
            begun, _, kind = self.spoken.pop()
            if news.at > begun:
                self.spoken.append((begun, news.at, kind))
        elif news.what == "stress":
            self.stresses.append(news.at)
        elif news.what == "comes" and news.end > news.at:
            self.segments = [s for s in self.segments if s.end <= news.at or s.start >= news.end]
            self.segments = [*self.segments, Segment(news.kind, news.at, news.end, news.peak)][-MOST:]
            self.segments.sort(key=lambda s: s.start)
        elif news.what == "hush":
            kept = [s for s in self.segments if s.start < news.at]
            cut = [s if s.end <= news.at else _until(s, news.at) for s in kept]
            self.segments = [s for s in cut if s.end > s.start]

    def forget(self, before: float) -> None:
        """Drop what was over before a time, seconds."""
        self.segments = [s for s in self.segments if s.end > before]
        self.spoken = [s for s in self.spoken if s[1] is None or s[1] > before]
        self.stresses = [s for s in self.stresses if s > before]

    def expected(self, first: int, frames: int, shown: Sequence[int], now: int) -> ExpectedSpeech:
        """Return what is to be shown from frame `first` on. shown: events at the frames before it, the last
        of them the one before, so that what has come is not waited for again. now: the frame up to which
        speech was heard.
        """
        kinds, known, anywhere = np.zeros(frames, np.uint8), np.zeros(frames, bool), np.zeros(frames, bool)
        events: dict[int, int] = {}

        def put(kind: Sound, start: float, end: float | None) -> slice:
            a = round(start * RATE) - first
            b = frames if end is None else round(end * RATE) - first
            span = slice(max(0, min(a, frames)), max(0, min(b, frames)))
            kinds[span] = SOUNDS.index(kind)
            events[a] = EDGE
            if end is not None:
                events[b] = EDGE
            return span

        for start, end, kind in self.spoken:
            span = put(kind, start, end)
            anywhere[span] = True
        for s in self.segments:
            span = put(s.kind, s.start, s.end)
            known[: span.stop] = True
            anywhere[span] = s.kind == "clause" and s.peak is None
            if s.kind == "clause" and s.peak is not None:
                events[round(s.peak * RATE) - first] = STRESS
        for at in self.stresses:
            if not any(s.start <= at <= s.end and s.peak is not None for s in self.segments):
                events[round(at * RATE) - first] = STRESS
        allowed = np.left_shift(np.uint8(1), kinds).astype(np.uint8)
        bits = allowed.copy()
        for edge in np.flatnonzero(np.diff(kinds)) + 1:  # at a boundary either side's will do
            allowed[max(0, edge - self.slack) : edge + self.slack] |= bits[edge - 1] | bits[edge]
        off = np.maximum(0, np.arange(frames) + first - now) / RATE
        sure = np.where(known, 1.0, np.maximum(LEAST, 0.5 ** (off / SURE))).astype(np.float32)
        window, waits, unmet = self._windows(events, frames, shown)
        if self.spoken and self.spoken[-1][1] is None and self.spoken[-1][2] == "clause":
            self._rhythm(round(self.spoken[-1][0] * RATE) - first, shown, window, waits, unmet)
        barred = np.where(window >= 0, 0, np.where(anywhere, 0, STRESS)).astype(np.uint8)
        return ExpectedSpeech(allowed, sure, window, waits, unmet, barred)

    def _rhythm(self, begun: int, shown: Sequence[int], window: Array, waits: Array, unmet: Array) -> None:
        """Wait for a stress where somebody goes on speaking and none is known: there will be one, nobody can
        say when.
        """
        strokes = [n - len(shown) for n, what in enumerate(shown) if what & STRESS]
        strokes += np.flatnonzero((window >= 0) & (waits == STRESS)).tolist()
        last = max([begun, *strokes])
        a, b = last + round(RHYTHM[0] * RATE), last + round(RHYTHM[1] * RATE)
        free = np.flatnonzero(window[max(0, a) : max(0, b)] < 0) + max(0, a)
        if not len(free):
            return
        free = _together(free, b)
        window[free], waits[free] = int(window.max()) + 1, STRESS
        unmet[free[-1]] += USUAL

    def _windows(
        self, events: dict[int, int], frames: int, shown: Sequence[int]
    ) -> tuple[Array, Array, Array]:
        """Return window, waits and unmet of ExpectedSpeech. events: kinds by the frames, counted from the
        first that is free, at which they are wanted.
        """
        window, waits = np.full(frames, -1, np.int32), np.full(frames, STRESS, np.uint8)
        unmet, late = np.zeros(frames, np.float32), round(LATE * RATE)
        closes: dict[int, tuple[int, int]] = {}
        # What is wanted when nothing can be done about it any more is not waited for; a stress goes first.
        for number, (at, what) in enumerate(sorted(events.items(), key=lambda e: (-e[1], e[0]))):
            if at < -late or at - self.slack >= frames:
                continue
            before = shown[max(0, len(shown) + at - self.slack) :]
            if any(x & what for x in before):
                continue
            overdue = at + self.slack < 0
            if overdue and what == EDGE:
                continue
            a, b = max(0, at - self.slack), min(frames, (at + late if overdue else at + self.slack) + 1)
            free = _together(np.flatnonzero(window[a:b] < 0) + a, at)
            if not len(free):
                continue
            window[free], waits[free] = number, what
            # The later the worse: part of it for each frame, the rest where the window closes.
            after = free[free > at] if (free > at).any() else free[-1:]
            unmet[after] += DELAYED / len(after)
            closes[number] = int(free[-1]), at + late
        for number, (close, latest) in closes.items():
            last = close
            while waits[close] == STRESS and last < min(frames - 1, latest) and window[last + 1] < 0:
                last += 1
                window[last], waits[last] = number, STRESS
            unmet[close] += 1 - DELAYED - TOO_LATE
            unmet[last] += TOO_LATE  # late is better than never
        return window, waits, unmet


def _together(frames: Array, at: int) -> Array:
    """Return those of ascending frames that follow each other without a gap, nearest to a place."""
    parts = np.split(frames, np.flatnonzero(np.diff(frames) > 1) + 1)
    return min(parts, key=lambda part: np.abs(part - at).min(initial=10**6))


def _until(segment: Segment, end: float) -> Segment:
    peak = segment.peak if segment.peak is not None and segment.peak < end else None
    return replace(segment, end=end, peak=peak)
