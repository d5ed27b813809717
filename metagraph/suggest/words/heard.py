"""Which languages beside English a batch of names speaks: told by words that English does not have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

from metagraph.suggest.words.cut import Token
from metagraph.suggest.words.folded import list_spellings
from metagraph.suggest.words.languages import MARKS, WordLanguage, list_word_languages
from metagraph.suggest.words.spoken import (
    PARTS,
    SpokenLanguages,
    cut_run,
    has_english_meaning,
    is_english,
    split_compound,
)

_ALONE = 7  # letters of a word that tells its language though no other does


def list_own_words(changes: Mapping[Any, Mapping[str, str | None]]) -> dict[str, str | None]:
    """Return what a user says about words: letters -> English, themselves where they mean something of their
    own, None for nothing any more.
    """
    own: dict[str, str | None] = {}
    for name, mine in changes.items():
        for phrase, meaning in mine.items():
            for key in list_spellings(phrase):
                own[key] = meaning if name == "synonyms" else own.get(key, phrase)
    return own


def find_spoken_languages(batch: Sequence[Sequence[Token]], patterns: Any) -> SpokenLanguages | None:
    """Return what languages a batch of names speaks beside English, None if it is English alone."""
    meanings = patterns.meanings
    own = list_own_words(patterns.changes)
    distinct = list(dict.fromkeys(tuple(t for t in name if not t.text.isdecimal()) for name in batch))
    runs = [_phrases(name, meanings, own) for name in distinct]
    found = {
        tongue: [_told(name, some, tongue, meanings, own) for name, some in zip(distinct, runs, strict=True)]
        for tongue in list_word_languages()
    }
    tongues: list[WordLanguage] = []
    spent: list[set[int]] = [set() for _ in distinct]
    while True:
        best, most = None, (0, 0)
        for tongue, told in found.items():
            if tongue in tongues:
                continue
            rest = [
                {at: n for at, n in one.items() if at not in gone}
                for one, gone in zip(told, spent, strict=True)
            ]
            names = sum(1 for one in rest if one)
            weight = sum(sum(one.values()) for one in rest)
            words = {
                name[at].text: n for name, one in zip(distinct, rest, strict=True) for at, n in one.items()
            }
            strong = (
                len(words) > 1 or max(words.values(), default=0) >= _ALONE or 2 * names >= len(distinct) > 0
            )
            if names and strong and (weight, names) > most:
                best, most = tongue, (weight, names)
        if best is None:
            break
        tongues.append(best)
        for one, gone in zip(found[best], spent, strict=True):
            gone.update(one)
    mine = {k: v for k, v in own.items() if v != k}
    if not tongues:
        return SpokenLanguages((), False, own) if mine and "synonyms" in patterns.changes else None
    theirs = sum(1 for gone in spent if gone)
    english = sum(
        1
        for name, gone in zip(distinct, spent, strict=True)
        if any(
            at not in gone and is_english(t.text, meanings) and not _shared(t.text, tongues)
            for at, t in enumerate(name)
        )
    )
    ends = {name[-1].text for name in distinct if len(name) > 1}
    sides: dict[str, str] = {}
    if len(tongues[0].sides) == 2 and ends.issuperset(tongues[0].sides):
        # Both stand at ends, or it may be a letter that counts ("a", "b", "c", "d").
        sides = dict(zip(tongues[0].sides, ("left", "right"), strict=True)) if not {"a", "b"} <= ends else {}
    return SpokenLanguages(tuple(tongues), theirs >= english, own, sides)


def _shared(word: str, tongues: Sequence[WordLanguage]) -> bool:
    return any(word in tongue.exact for tongue in tongues)


@lru_cache(maxsize=1)
def _any_language() -> frozenset[str]:
    return frozenset(key for tongue in list_word_languages() for key in tongue.exact)


def _phrases(
    name: Sequence[Token], meanings: Any, own: Mapping[str, str | None]
) -> dict[int, list[tuple[int, str]]]:
    """Return which tokens together some language knows and English does not: where they begin -> how many,
    the most first, and their letters.
    """
    known = _any_language()
    out: dict[int, list[tuple[int, str]]] = {}
    for at in range(len(name)):
        for n in range(min(PARTS, len(name) - at), 0, -1):
            some = name[at : at + n]
            key = "".join(t.text for t in some)
            if key not in known or key in own or any(t.run or t.alone for t in some):
                continue
            if n == 1 and has_english_meaning(key, meanings):
                continue
            if n > 1 and len(key) < 2 * _ALONE and any(has_english_meaning(t.text, meanings) for t in some):
                continue  # "sit a" is no word of Japanese
            out.setdefault(at, []).append((n, key))
    return out


def _told(
    name: Sequence[Token],
    known: Mapping[int, Sequence[tuple[int, str]]],
    tongue: WordLanguage,
    meanings: Any,
    own: Mapping[str, str | None],
) -> dict[int, int]:
    """Return the tokens of a name that a language knows and English does not, with how many letters each."""
    out: dict[int, int] = {}

    def find(key: str) -> tuple[str, bool] | None:
        meaning = tongue.exact.get(key) if key not in own else None
        return (meaning, True) if meaning is not None else None

    for at, token in enumerate(name):
        if token.run:
            if tongue.longest:
                covered = sum(
                    b - a for m, a, b in cut_run(token.text, find, tongue.longest) if m and m not in MARKS
                )
                if 2 * covered >= len(token.text):
                    out[at] = 4 * covered
            continue
        for n, key in known.get(at, ()):
            if key in tongue.exact and tongue.sure(key):
                for k in range(at, at + n):
                    out[k] = max(out.get(k, 0), len(key) // n)
                break
        else:
            word = token.text
            passed = len(word) <= 5 or at in out or word in own or has_english_meaning(word, meanings)
            if not passed and (size := _resembles(word, tongue)):
                out[at] = size
    return out


def _resembles(word: str, tongue: WordLanguage) -> int:
    """Return how many letters of a word tell a language by its stem or its parts, 0 for none."""
    stem = tongue.stem(word)
    if len(stem) > 4 and stem in tongue.stemmed and tongue.stemmed[stem] not in MARKS:
        return len(stem) - 1
    if len(word) > 8 and word.isascii() and len(cut := split_compound(word, tongue)) > 1:
        return max(map(len, cut))
    return 0
