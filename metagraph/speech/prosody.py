"""How loud and how fast each segment of somebody's speech is said."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import Segment, Sound, Word
from metagraph.speech.loudness import measure_loudness_within
from metagraph.speech.sound import analyse_sound, find_syllables

Array = NDArray[Any]

OWN: tuple[Sound, ...] = ("clause", "response")  # what a side says itself, of what it moves with


@dataclass(frozen=True, eq=False)
class Prosody:
    """Of each segment `[n]`, NaN where it is not known and for what is not one's own speech. loudness: LUFS.
    rate: letters a second, or syllables heard; which of them does not matter once it is compared with the
    speaker's own (`standardise_prosody`).
    """

    loudness: Array
    rate: Array


def measure_prosody(
    segments: Sequence[Segment], words: Sequence[Word] = (), samples: Array | None = None, rate: int = 0
) -> Prosody:
    """Return how the segments of a recording are said. words: of the same speaker, with their times. samples,
    rate: the sound `[N]`, None if there is none; then loudness is not known.

    The rate is given by the letters of the words that lie in a segment, from the first one's start to the
    last one's end; where no words have times by the segments' own texts; if there are no texts by the
    syllables that are heard. Letters, as they are counted alike in every language that writes them; in
    Chinese they are syllables.
    """
    own = [s.kind in OWN for s in segments]
    loud = np.full(len(segments), np.nan)
    if samples is not None and any(own):
        loud = measure_loudness_within(samples, rate, [(s.start, s.end) for s in segments])
    found = _by_words(segments, words)
    if np.isnan(found).all():
        found = np.array([_of(count_letters(s.text), s.end - s.start) for s in segments])
    if np.isnan(found).all() and samples is not None and any(own):
        peaks = find_syllables(analyse_sound(samples, rate))[0]
        count = [np.searchsorted(peaks, s.end) - np.searchsorted(peaks, s.start) for s in segments]
        found = np.array([_of(int(n), s.end - s.start) for n, s in zip(count, segments, strict=True)])
    return Prosody(np.where(own, loud, np.nan), np.where(own, found, np.nan))


def count_letters(text: str) -> int:
    """Return how many letters and digits a text has; marks on letters are of the letter."""
    return sum(unicodedata.category(c)[0] in "LN" for c in text)


def _of(count: int, seconds: float) -> float:
    return count / seconds if count and seconds > 0 else np.nan


def _by_words(segments: Sequence[Segment], words: Sequence[Word]) -> Array:
    ordered = sorted(words, key=lambda w: w.start + w.end)
    middles = np.array([(w.start + w.end) / 2 for w in ordered])
    out = np.full(len(segments), np.nan)
    for n, s in enumerate(segments):
        a, b = np.searchsorted(middles, (s.start, s.end))
        inside = ordered[a:b]
        if inside:
            out[n] = _of(sum(count_letters(w.text) for w in inside), inside[-1].end - inside[0].start)
    return out
