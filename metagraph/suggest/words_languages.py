"""The languages other than English that names are read in, each told in words of English: what a word of
German means is what the English word it stands for means.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import permutations
from types import MappingProxyType
from typing import Final

from metagraph.suggest.words_folded import is_run_together, plain, spellings

# What stands for no word of English: nothing; what joins two stances only beside one ("a" of Spanish); and
# what follows the stance it is about (Japanese, Korean).
NOTHING, MAYBE_TO, MAYBE_FROM, AFTER_TO, AFTER_FROM = "-", "?to", "?from", "@to", "@from"
MARKS: Final = (NOTHING, MAYBE_TO, MAYBE_FROM, AFTER_TO, AFTER_FROM)
# Words of English that other languages have too, with another meaning.
_ENGLISH_TOO = frozenset(
    [
        "balancer",
        "comparer",
        "confusion",
        "designer",
        "enumeration",
        "gross",
        "human",
        "installer",
        "joint",
        "joints",
        "linker",
        "negation",
        "nose",
        "observer",
        "pointer",
        "regard",
        "replacer",
        "replies",
        "responder",
        "salutation",
        "telephone",
        "main",
        "front",
        "sale",
        "chat",
        "pain",
        "coin",
    ]
)
_SURE = 4  # Latin letters of a word from which on it may tell a language
_ROOT = 4  # letters that are left where an ending goes


@dataclass(frozen=True)
class Source:
    """What a module of words holds. words: lines "English = phrase, phrase". doubtful: words that say nothing
    of the language they are in. endings: of words, blanks between. links: letters between the parts of a
    compound.
    """

    name: str
    words: str
    doubtful: str = ""
    endings: str = ""
    links: str = ""
    swaps: str = ""  # letters and what else they may be written as: simplified and traditional hanzi

    @cached_property
    def phrases(self) -> Mapping[str, str]:
        """Phrase -> English, as people write it."""
        out: dict[str, str] = {}
        for line in self.words.strip().splitlines():
            meaning, _, phrases = line.partition("=")
            for phrase in phrases.split(","):
                if phrase.strip():
                    out.setdefault(" ".join(phrase.split()), " ".join(meaning.split()))
        return MappingProxyType(out)


@dataclass(frozen=True, eq=False)
class Language:
    """Words of a language as they are looked up. exact: letters of a phrase -> English. stemmed: the same of
    words without endings, joined by blanks. doubtful: those of `exact` that tell no language.
    """

    name: str
    exact: Mapping[str, str]
    stemmed: Mapping[str, str]
    doubtful: frozenset[str]
    endings: tuple[str, ...]
    links: tuple[str, ...]

    def stem(self, word: str) -> str:
        """Return a word without its ending."""
        for ending in self.endings:
            if word.endswith(ending) and len(word) - len(ending) >= _ROOT:
                return word[: -len(ending)]
        return word

    def sure(self, key: str) -> bool:
        """Whether letters that are in `exact` tell that this language is spoken."""
        return (
            key not in self.doubtful
            and self.exact[key] not in MARKS
            and (len(key) >= _SURE or not key.isascii())
        )

    @cached_property
    def longest(self) -> int:
        """How many letters the longest phrase of a writing without blanks has."""
        return max((len(k) for k in self.exact if is_run_together(k[0])), default=0)


def _language(source: Source) -> Language:
    endings = tuple(sorted(set(map(plain, source.endings.split())), key=lambda e: (-len(e), e)))
    bare = Language(source.name, {}, {}, frozenset(), endings, tuple(source.links.split()))
    swaps = {pair[0]: pair[1] for pair in source.swaps.split()}
    exact: dict[str, str] = {}
    turned: dict[str, str] = {}
    stemmed: dict[str, str] = {}
    for phrase, meaning in source.phrases.items():
        for key in spellings(phrase) | (spellings(phrase.replace("を", "")) if "を" in phrase[1:] else set()):
            exact.setdefault(key, meaning)
            if swaps and (other := "".join(swaps.get(c, c) for c in key)) != key:
                exact.setdefault(other, meaning)
        parts = phrase.split()
        if (not phrase[0].isascii() and is_run_together(phrase[0])) or len(parts) > 3:
            continue
        for order in permutations(parts) if len(parts) < 4 and meaning not in MARKS else (tuple(parts),):
            for key in spellings("".join(order)) if len(parts) == 2 else ():
                turned.setdefault(key, meaning)
            for forms in zip(*(sorted(spellings(p)) for p in order), strict=False):
                text = " ".join(map(bare.stem, forms))
                if len(text) >= _ROOT:
                    stemmed.setdefault(text, meaning)
    for key, meaning in turned.items():
        exact.setdefault(key, meaning)
    doubtful = frozenset(s for w in source.doubtful.split(",") if w.strip() for s in spellings(w))
    return Language(source.name, exact, stemmed, doubtful | _ENGLISH_TOO, endings, bare.links)


@lru_cache(maxsize=1)
def sources() -> tuple[Source, ...]:
    """Return the words of every language, read when they are first asked for."""
    from metagraph.suggest import (
        words_chinese,
        words_dutch,
        words_french,
        words_german,
        words_italian,
        words_japanese,
        words_korean,
        words_polish,
        words_portuguese,
        words_russian,
        words_spanish,
    )

    modules = (
        words_german, words_french, words_spanish, words_italian, words_portuguese, words_japanese,
        words_chinese, words_dutch, words_polish, words_russian, words_korean,
    )  # fmt: skip
    return tuple(module.SOURCE for module in modules)


@lru_cache(maxsize=1)
def languages() -> tuple[Language, ...]:
    """Return every language, ready to look words up in."""
    return tuple(map(_language, sources()))


@lru_cache(maxsize=1)
def synonyms() -> Mapping[str, str]:
    """Return every phrase of every language -> what it is called in English, for who looks at or changes
    them.
    """
    out: dict[str, str] = {}
    for source in sources():
        for phrase, meaning in source.phrases.items():
            out.setdefault(phrase.lower(), meaning)
    return MappingProxyType(out)
