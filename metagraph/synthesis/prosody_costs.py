"""Loudness and speaking rate as soft constraints: frames of a take that was said louder, slower than what is
said now cost something, where both speak (the future work of Yang et al., section 9).

Voices and microphones differ: each recording is compared by its own mean, and by how far the speaker's
segments spread. So a quiet take is not a quiet voice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.graph.conversation.model import Segment, Word
from metagraph.speech.prosody import OWN, Prosody
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.search.frame_costs import FrameCost
from metagraph.synthesis.states import States, SynthesisError

Array = NDArray[Any]
Measure = Literal["loudness", "rate"]
MEASURES: tuple[Measure, ...] = ("loudness", "rate")
_MEASURES: dict[Measure, str] = {"loudness": phrase("loudness"), "rate": phrase("rate")}

FEW = 3  # segments of a kind: of fewer no mean is made
FARTHEST = 3.0  # spreads: farther apart is not worse
UNKNOWN = 1.0  # spreads that what nobody knows is held to be off; two of one speaker's are 1.1 on average


@dataclass(frozen=True, eq=False)
class SpokenTake:
    """What is known of the speech a take was recorded with, or new motion is for. segments: as
    `list_segments_heard_by` has them. words: its own, with times. prosody: of the segments, None if it was
    not looked for.
    """

    segments: tuple[Segment, ...]
    words: tuple[Word, ...] = ()
    prosody: Prosody | None = None

    def values(self, measure: Measure) -> Array:
        """Return how its segments are said `[n]`, NaN if that is not known."""
        if self.prosody is None:
            return np.full(len(self.segments), np.nan)
        return np.asarray(getattr(self.prosody, measure), float)


def standardise_prosody(recordings: Sequence[SpokenTake], measure: Measure) -> list[Array]:
    """Return of each recording how far each segment is from its speaker's usual, in spreads; NaN if that is
    not known.

    Clauses and responses each by themselves. The mean is the recording's own where it has FEW of them, else
    that of all; the spread (root mean square about the means) is that of all, which are taken to be of one
    speaker.
    """
    values = [r.values(measure) for r in recordings]
    out = [np.full(len(v), np.nan) for v in values]
    for kind in OWN:
        some = [
            np.array([s.kind == kind for s in r.segments], bool) & np.isfinite(v)
            for r, v in zip(recordings, values, strict=True)
        ]
        every = np.concatenate([v[m] for v, m in zip(values, some, strict=True)] or [np.zeros(0)])
        if not len(every):
            continue
        away = [
            v[m] - (v[m].mean() if m.sum() >= FEW else every.mean())
            for v, m in zip(values, some, strict=True)
        ]
        spread = float(np.sqrt(np.mean(np.concatenate(away) ** 2)))
        for made, m, far in zip(out, some, away, strict=True):
            made[m] = far / spread if spread > 1e-9 else 0.0
    return out


def measure_state_prosody(states: States, takes: Sequence[SpokenTake], measure: Measure) -> Array:
    """Return `[F]` how the segment a state is in is said, in spreads of its speaker; NaN outside of one's own
    speech. Raises SynthesisError if there are not as many takes.
    """
    if len(takes) != len(states.starts) - 1:
        raise SynthesisError(f"{len(states.starts) - 1} takes have states, but {len(takes)} have speech")
    out = np.full(len(states), np.nan)
    for number, (take, values) in enumerate(zip(takes, standardise_prosody(takes, measure), strict=True)):
        first, after = int(states.starts[number]), int(states.starts[number + 1])
        for s, value in zip(take.segments, values, strict=True):
            a, b = first + round(s.start * RATE), first + round(s.end * RATE)
            out[max(first, a) : min(after, b)] = value
    return out


def measure_speech_prosody(new: SpokenTake, start: float, seconds: float, measure: Measure) -> Array:
    """Return `[T]` how what is said at each frame is said, from a second of the speech on, in spreads; the
    mean is that of all of the speech. NaN outside of its speaker's own speech.
    """
    frames = max(1, round(seconds * RATE))
    out = np.full(frames, np.nan)
    for s, value in zip(new.segments, standardise_prosody([new], measure)[0], strict=True):
        a, b = round((s.start - start) * RATE), round((s.end - start) * RATE)
        out[max(0, a) : max(0, min(frames, b))] = value
    return out


def measure_prosody_cost(
    measure: Measure, weight: float, of_state: Array, of_frame: Array, limit: float
) -> FrameCost:
    """Return what frames cost by how they are said. weight: what a second costs that is off by one spread, of
    the graph's threshold (limit, metres). of_state, of_frame: as `measure_state_prosody` and
    `measure_speech_prosody` have them.
    """
    changes = np.flatnonzero(np.append(True, of_frame[1:] != of_frame[:-1]))  # NaN differs from itself
    known = [t for t in changes.tolist() if np.isfinite(of_frame[t])]
    values = np.unique(of_frame[known])
    at = np.full(len(of_frame), -1, np.int32)
    spoken = np.isfinite(of_frame)
    at[spoken] = np.searchsorted(values, of_frame[spoken])
    off = np.minimum(np.abs(values[:, None] - of_state), FARTHEST)
    rows = weight * limit / RATE * np.where(np.isfinite(off), off, UNKNOWN)
    return FrameCost(measure, at, rows.astype(np.float32))


@dataclass(frozen=True)
class ProsodyMatch:
    """How well a path is said as what is heard, over frames where both are known. off: the mean difference,
    in spreads. correlation: of both, -1..1; None if there is none. known: share of the spoken frames.
    """

    measure: Measure
    off: float
    correlation: float | None
    known: float

    def words(self) -> str:
        """Return a phrase such as "loudness differs by 0.42 standard deviations, correlation 0.71"."""
        measure = _MEASURES[self.measure]
        if self.correlation is None:
            return phrase("{measure} differs by {off:.2f} standard deviations", measure=measure, off=self.off)
        return phrase(
            "{measure} differs by {off:.2f} standard deviations, correlation {correlation:.2f}",
            correlation=self.correlation,
            measure=measure,
            off=self.off,
        )


def measure_prosody_match(
    measure: Measure, of_state: Array, of_frame: Array, way: Array
) -> ProsodyMatch | None:
    """Return how well the states `[T]` of a path go with speech, None if nothing can be compared."""
    shown = of_state[np.asarray(way)]
    both = np.isfinite(shown) & np.isfinite(of_frame[: len(shown)])
    if not both.any():
        return None
    a, b = shown[both], of_frame[: len(shown)][both]
    told = float(np.corrcoef(a, b)[0, 1]) if min(a.std(), b.std()) > 1e-9 else None
    spoken = max(1, int(np.isfinite(of_frame).sum()))
    return ProsodyMatch(measure, float(np.abs(a - b).mean()), told, float(both.sum()) / spoken)
