"""Which words are stressed, and how a run of words is parted so that each part has one that is. What a
language's small words are, its pack says; of an unknown one, all are alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import Word
from metagraph.speech.language_packs import LanguagePack
from metagraph.speech.sound import HeardSound

Array = NDArray[Any]

USUAL, SPREAD = 4.0, 1.9  # words of a clause: the paper's speakers have 4.29 +- 2.16 and 3.86 +- 1.36
MOST = 9  # words of a clause
EACH = 0.5  # what a clause costs by itself: rather fewer than more


ENDS = (".", "?", "!", ";", ":", "…", "—", "。", "？", "！", "；", "：", "।", "؟", "．")  # of a sentence
PAUSED = (",", "–", "-", "、", "，", "،")
CLOSED = "\"')”»’」』）"  # what may stand behind them
STRONG = 1.6  # how stressed a word is that stands out
_CONTENT = (
    1.2  # how much a word that means something outweighs a small one, in deviations of loudness or pitch
)


def measure_stresses(
    words: Sequence[Word],
    said: Sequence[tuple[str, ...]],
    tones: Array,
    heard: HeardSound,
    language: LanguagePack | None,
) -> Array:
    """Return how strongly each word is stressed `[W]`, about -3..5: its F0 peak and loudness, each compared
    with the side's other words, how long it lasts, and whether it is one that usually is. tones: semitones
    `[K]` at `heard.times`, nan where voiceless.
    """
    highest, loudest = np.full(len(words), np.nan), np.full(len(words), np.nan)
    for n, word in enumerate(words):
        part = slice(
            int(np.searchsorted(heard.times, word.start)), int(np.searchsorted(heard.times, word.end))
        )
        if np.isfinite(tones[part]).any():
            highest[n] = np.nanmax(tones[part])
        if len(heard.level[part]):
            loudest[n] = heard.level[part].max()
    length = np.log([max(w.end - w.start, 0.02) for w in words])
    meant = np.array(
        [language is None or any(not language.is_small(t) for t in language.parted(s)) for s in said], float
    )
    return np.asarray(
        0.8 * _standing(highest) + 0.6 * _standing(loudest) + 0.5 * _standing(length) + _CONTENT * meant
    )


def _standing(values: Array) -> Array:
    """Return values in deviations from their middle, -2..2; 0 for those unknown."""
    known = values[np.isfinite(values)]
    if len(known) < 2:
        return np.zeros(len(values))
    low, middle, high = np.percentile(known, (16, 50, 84))
    spread = max(float(high - low) / 2, 1e-3)
    return np.asarray(np.nan_to_num(np.clip((values - middle) / spread, -2, 2)))


def split_into_clauses(
    words: Sequence[Word],
    said: Sequence[tuple[str, ...]],
    stress: Array,
    first: int,
    last: int,
    language: LanguagePack | None,
) -> list[tuple[int, int]]:
    """Return the words from `first` to before `last` in clauses (from, to before): the cheapest way to part
    them so that each has one stressed word and about `USUAL` words, found exactly.
    """
    count = last - first
    parts = [language.parted(s) if language is not None else s for s in said[first:last]]
    sizes = [language.size(s) if language is not None else 1.0 for s in parts]
    best = [0.0] + [np.inf] * count  # cost of the words up to here
    came = [0] * (count + 1)
    low = 0
    for end in range(1, count + 1):
        while low < end - 1 and sum(sizes[low:end]) > MOST:
            low += 1
        for begin in range(low, end):
            cost = (
                best[begin]
                + _cost(stress[first + begin : first + end], sum(sizes[begin:end]))
                - (_break(words, parts, first, begin, language) if begin else 0.0)
            )
            if cost < best[end]:
                best[end], came[end] = cost, begin
    out = []
    end = count
    while end > 0:
        out.append((first + came[end], first + end))
        end = came[end]
    return out[::-1]


def _cost(stress: Array, size: float) -> float:
    """Return what a clause costs: an unusual length, a second stress as strong as the first, no stress at
    all.
    """
    ordered = np.sort(stress)[::-1]
    second = float(np.maximum(ordered[1:4] - max(STRONG, ordered[0] - 1.0), 0).sum())
    none = max(0.0, 1.0 - float(ordered[0]))
    return float(EACH + ((size - USUAL) / SPREAD) ** 2 + 0.5 * second + 0.8 * none)


def _break(
    words: Sequence[Word],
    parts: Sequence[tuple[str, ...]],
    first: int,
    n: int,
    language: LanguagePack | None,
) -> float:
    """Return how well a clause begins at the n-th of the parts, words from `first` on; below 0, rather not."""
    before, gap = words[first + n - 1], words[first + n].start - words[first + n - 1].end
    out = min(gap / 0.12, 2.0)
    if (text := before.text.rstrip(CLOSED)).endswith(ENDS):
        return out + 3.0
    if text.endswith(PAUSED):
        return out + 1.8
    if language is None or not parts[n - 1] or not parts[n]:
        return out
    last, now = parts[n - 1][-1], parts[n][0]
    if last in language.closing:
        out += 1.0
    if last in language.small and last not in language.trailing:
        return out - (1.0 if now in language.joining else 2.0)  # "of | the house"
    if now in language.trailing:
        return out - 1.5  # "told | him"
    if now in language.inside:
        return out - 0.4
    return out + (1.3 if now in language.joining else 0.5 if now in language.small else -0.9)
