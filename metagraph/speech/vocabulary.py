"""Which words mean an answer or a hesitation, and how words are compared: without case, punctuation and
hyphens ("Uh-huh." = "uh huh").
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

# Said in the middle of a sentence these mean something; they hesitate only where the speech around them
# stops.
LEXICAL = (
    "well",
    "like",
    "you know",
    "i mean",
    "let me see",
    "let's see",
    "so",
    "okay",
    "right",
    "actually",
    "basically",
)
_APOSTROPHES = str.maketrans("’ʼ`´", "''''")
_BETWEEN = re.compile(r"[^\w'%]+")


def tokens(text: str) -> tuple[str, ...]:
    """Return what a text's words are compared by."""
    bare = _BETWEEN.sub(" ", text.casefold().translate(_APOSTROPHES).replace("_", " "))
    return tuple(t for t in (w.strip("'") for w in bare.split()) if t and t != "%")


class Vocabulary:
    """Phrases to find among words, the longest first."""

    def __init__(self, phrases: Iterable[str]) -> None:
        self._phrases = frozenset(t for p in phrases if (t := tokens(p)))

    @cached_property
    def _longest(self) -> Mapping[str, int]:
        """First token -> how many tokens the longest phrase has that begins with it."""
        out: dict[str, int] = {}
        for phrase in self._phrases:
            out[phrase[0]] = max(out.get(phrase[0], 0), len(phrase))
        return out

    def __contains__(self, phrase: tuple[str, ...]) -> bool:
        return phrase in self._phrases

    def at(self, words: Sequence[tuple[str, ...]], n: int) -> int:
        """Return how many of the words, each in its tokens, from the n-th on make the longest phrase that
        begins there; 0 for none.
        """
        most = self._longest.get(words[n][0], 0) if words[n] else 0
        found = 0
        phrase: tuple[str, ...] = ()
        for m in range(n, len(words)):
            phrase = (*phrase, *words[m])
            if len(phrase) > most:
                break
            if words[m] and phrase in self._phrases:
                found = m + 1 - n
        return found


LEXICAL_PHRASES = Vocabulary(LEXICAL)
