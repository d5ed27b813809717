"""Which words are stressed, and how a run of words is parted so that each part has one that is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation import Word
from metagraph.speech.sound import HeardSound

Array = NDArray[Any]

USUAL, SPREAD = 4.0, 1.9  # words of a clause: the paper's speakers have 4.29 +- 2.16 and 3.86 +- 1.36
MOST = 9  # words of a clause
EACH = 0.5  # what a clause costs by itself: rather fewer than more


def _set(text: str) -> frozenset[str]:
    return frozenset(text.split())


# Words that are hardly ever stressed; clauses begin with them, and do not end with them.
SMALL = _set("""
    a an the i you he she it we they me him her us them my your his its our their this that these those there here who which what
    and or but so if as than then because when while where though until since before after of in on at to for from with by about into
    over up out off down through is am are was were be been being do does did have has had can could will would shall should may might
    must not just it's i'm you're he's she's we're they're that's i've you've we've they've i'll you'll he'll she'll we'll they'll i'd
    don't doesn't didn't isn't wasn't can't couldn't won't
""")
# What a new thought begins with.
_JOINING = _set("""
    and or but so because when while where though although unless whether until since before after if that which who i he she we they it
    there from for
""")
# Small words that rather end what is before them than begin what follows.
_TRAILING = _set("me him her us them there here up out off down not")
_INSIDE = _set(
    "of than is was are were be been do does did have has had can could will would"
)  # of what is under way already
STRONG = 1.6  # how stressed a word is that stands out
_CONTENT = (
    1.2  # how much a word that means something outweighs a small one, in deviations of loudness or pitch
)


def stresses(
    words: Sequence[Word], said: Sequence[tuple[str, ...]], tones: Array, heard: HeardSound
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
    meant = np.array([any(t not in SMALL for t in s) for s in said], float)
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


def parted(
    words: Sequence[Word], said: Sequence[tuple[str, ...]], stress: Array, first: int, last: int
) -> list[tuple[int, int]]:
    """Return the words from `first` to before `last` in clauses (from, to before): the cheapest way to part
    them so that each has one stressed word and about `USUAL` words, found exactly.
    """
    count = last - first
    best = [0.0] + [np.inf] * count  # cost of the words up to here
    came = [0] * (count + 1)
    for end in range(1, count + 1):
        for begin in range(max(0, end - MOST), end):
            cost = (
                best[begin]
                + _cost(stress[first + begin : first + end])
                - (_break(words, said, first + begin) if begin else 0.0)
            )
            if cost < best[end]:
                best[end], came[end] = cost, begin
    out = []
    end = count
    while end > 0:
        out.append((first + came[end], first + end))
        end = came[end]
    return out[::-1]


def _cost(stress: Array) -> float:
    """Return what a clause costs: an unusual length, a second stress as strong as the first, no stress at
    all.
    """
    ordered = np.sort(stress)[::-1]
    second = float(np.maximum(ordered[1:4] - max(STRONG, ordered[0] - 1.0), 0).sum())
    none = max(0.0, 1.0 - float(ordered[0]))
    return float(EACH + ((len(stress) - USUAL) / SPREAD) ** 2 + 0.5 * second + 0.8 * none)


def _break(words: Sequence[Word], said: Sequence[tuple[str, ...]], n: int) -> float:
    """Return how well a clause begins at word n; below 0, rather not."""
    before, gap = words[n - 1], words[n].start - words[n - 1].end
    out = min(gap / 0.12, 2.0)
    if (text := before.text.rstrip("\"')”»")).endswith((".", "?", "!", ";", ":", "…", "—")):
        return out + 3.0
    if text.endswith((",", "–", "-")):
        return out + 1.8
    last, first = said[n - 1][-1:], said[n][:1]
    if not last or not first:
        return out
    if last[0] in SMALL and last[0] not in _TRAILING:
        return out - (1.0 if first[0] in _JOINING else 2.0)  # "of | the house"
    if first[0] in _TRAILING:
        return out - 1.5  # "told | him"
    if first[0] in _INSIDE:
        return out - 0.4
    return out + (1.3 if first[0] in _JOINING else 0.5 if first[0] in SMALL else -0.9)
