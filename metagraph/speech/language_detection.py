"""Which language somebody speaks, by their words: by small words, answers and hesitations, and by letters
that a language does not have.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from metagraph.graph.vocabulary import is_unspaced, split_tokens
from metagraph.speech.language_packs import LanguagePack

FEWEST = 3.0  # words of one language alone that tell it
ENOUGH = 15  # different words from which on a language that is not known can be told
COVERED = 0.35  # share of what is said that a language's own words make at least
APART = 1.5  # deviations by which one stands out from the next


@dataclass(frozen=True)
class SpokenLanguage:
    """language: what is spoken; None if that is not known. how: sure; undecided, as there are too few words
    or they fit several; unknown, as they are of none of the languages. words: how many were read. known: how
    many of them are the language's, or the likeliest one's. likeliest: the next best, to name.
    """

    language: LanguagePack | None
    how: Literal["sure", "undecided", "unknown"]
    words: int
    known: int
    likeliest: LanguagePack | None = None


def detect_language(words: Iterable[str], languages: Collection[LanguagePack]) -> SpokenLanguage:
    """Return the language of words as transcribed. Names and words of another language among them are borne
    as long as they are the fewer.
    """
    said = [t for w in words for t in split_tokens(w) if any(c.isalpha() for c in t)]
    units = sum(_units(t) for t in said)
    unspaced = sum(_units(t) for t in said if is_unspaced(t[0]))
    if not units or not languages:
        return SpokenLanguage(None, "undecided", units, 0)
    found = {one: _hits(one, said) for one in languages}
    sharing: dict[str, int] = {}
    for hits in found.values():
        for token, _ in set(hits):
            sharing[token] = sharing.get(token, 0) + 1
    # A word that several languages have tells each of them less.
    alone = {one: sum(size / sharing[t] for t, size in hits) for one, hits in found.items()}
    for one in alone:
        alone[one] -= sum(_strange(t, one) for t in said)
    order = sorted(languages, key=lambda one: -alone[one])
    best, score = order[0], alone[order[0]]
    second = alone[order[1]] if len(order) > 1 else 0.0
    known = sum(size for _, size in found[best])
    # What is said in a writing it does not have may be another language's, as long as that is the less.
    scripts = {_script(t) for t, _ in found[best]}
    own = sum(_units(t) for t in said if _script(t) in scripts)
    covered = (known - sum(_strange(t, best) for t in said)) / max(own, units / 2)
    if covered < COVERED:
        read = {_script(t) for one in languages for t in one.known}
        foreign = sum(_units(t) for t in said if _script(t) not in read)  # in a writing of no language
        strange = len(set(said)) >= ENOUGH or unspaced >= 2 * ENOUGH or (units >= 3 and 2 * foreign > units)
        return SpokenLanguage(None, "unknown" if strange else "undecided", units, known, best)
    if score < FEWEST or score - second < APART * (score + max(second, 0.0)) ** 0.5 * 0.5:
        return SpokenLanguage(None, "undecided", units, known, best)
    return SpokenLanguage(best, "sure", units, known, best)


@lru_cache(maxsize=1 << 14)
def _script(token: str) -> str:
    """Return what a token is written in."""
    letter = next((c for c in token if c.isalpha()), token[0])
    return "unspaced" if is_unspaced(letter) else unicodedata.name(letter, "").split(" ")[0]


def _units(token: str) -> int:
    """Return how many words a token counts as: a letter each where writing has no blanks."""
    return sum(map(is_unspaced, token)) or 1


def _hits(language: LanguagePack, said: Sequence[str]) -> list[tuple[str, int]]:
    """Return which words of a language are said, with what they count."""
    if language.spaced:
        return [(t, 1) for token in said for t in language.parted((token,)) if t in language.known]
    out: list[tuple[str, int]] = []
    for token in said:
        if not is_unspaced(token[0]):
            out += [(token, 1)] if token in language.known else []
            continue
        out += _within(token, language)
    return out


def _within(token: str, language: LanguagePack) -> list[tuple[str, int]]:
    """Return the words of a language in writing without blanks, the longest first from the left."""
    out, at = [], 0
    while at < len(token):
        sizes = range(min(6, len(token) - at), 0, -1)
        size = next((n for n in sizes if token[at : at + n] in language.known), 0)
        if size:
            out.append((token[at : at + size], size))
        at += size or 1
    return out


def _strange(token: str, language: LanguagePack) -> bool:
    """Whether a word has Latin letters that a language does not spell with."""
    return bool(_beyond(token) - language.letters)


@lru_cache(maxsize=1 << 14)
def _beyond(token: str) -> frozenset[str]:
    """Return a token's Latin letters beyond a to z."""
    if token.isascii():
        return frozenset()
    return frozenset(c for c in token if not c.isascii() and "LATIN" in unicodedata.name(c, ""))
