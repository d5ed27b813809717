"""The languages other than English that names are read in, each told in words of English: what a word of
German means is what the English word it stands for means. Their words are data (`words/files`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import permutations
from types import MappingProxyType
from typing import Final

from metagraph.suggest.words.files import LanguageFile, list_phrases, load_language_files
from metagraph.suggest.words.folded import is_run_together, list_spellings, strip_to_letters

# What stands for no word of English: nothing; what joins two stances only beside one ("a" of Spanish); and
# what follows the stance it is about (Japanese, Korean).
NOTHING, MAYBE_TO, MAYBE_FROM, AFTER_TO, AFTER_FROM = "-", "?to", "?from", "@to", "@from"
MARKS: Final = (NOTHING, MAYBE_TO, MAYBE_FROM, AFTER_TO, AFTER_FROM)
# Words of English that other languages have too, with another meaning.
_ENGLISH_TOO = frozenset((
    "balancer", "comparer", "confusion", "designer", "enumeration", "gross", "human", "installer",
    "joint", "joints", "linker", "negation", "nose", "observer", "pointer", "regard", "replacer",
    "replies", "responder", "salutation", "telephone", "main", "front", "sale", "chat", "pain",
    "coin",
))  # fmt: skip
_SURE = 4  # Latin letters of a word from which on it may tell a language
_ROOT = 4  # letters that are left where an ending goes


@dataclass(frozen=True, eq=False)
class WordLanguage:
    """Words of a language as they are looked up. exact: letters of a phrase -> English. stemmed: the same of
    words without endings, joined by blanks. doubtful: those of `exact` that tell no language.
    """

    name: str
    exact: Mapping[str, str]
    stemmed: Mapping[str, str]
    doubtful: frozenset[str]
    endings: tuple[str, ...]
    links: tuple[str, ...]
    sides: tuple[str, ...] = ()

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


def _language(name: str, source: LanguageFile) -> WordLanguage:
    endings = tuple(sorted(set(map(strip_to_letters, source.endings.split())), key=lambda e: (-len(e), e)))
    bare = WordLanguage(name, {}, {}, frozenset(), endings, tuple(source.links.split()))
    exact: dict[str, str] = {}
    turned: dict[str, str] = {}
    stemmed: dict[str, str] = {}
    marks = {s for p, m in source.phrases.items() if m in MARKS for s in list_spellings(p)}
    for phrase, meaning in source.phrases.items():
        for key in list_spellings(phrase) | (
            list_spellings(phrase.replace("を", "")) if "を" in phrase[1:] else set()
        ):
            exact.setdefault(key, meaning)
            if (other := "".join(source.swaps.get(c, c) for c in key)) != key:
                exact.setdefault(other, meaning)
        parts = phrase.split()
        if (not phrase[0].isascii() and is_run_together(phrase[0])) or len(parts) > 4:
            continue
        fixed = len(parts) > 3 or meaning in MARKS or any(list_spellings(p) & marks for p in parts)
        for order in (tuple(parts),) if fixed else permutations(parts):  # "a sinistra", never "sinistra a"
            for key in list_spellings("".join(order)) if len(parts) == 2 else ():
                turned.setdefault(key, meaning)
            for forms in zip(*(sorted(list_spellings(p)) for p in order), strict=False):
                text = " ".join(map(bare.stem, forms))
                if len(text) >= _ROOT:
                    stemmed.setdefault(text, meaning)
    for key, meaning in turned.items():
        exact.setdefault(key, meaning)
    doubtful = frozenset(s for w in list_phrases(source.doubtful) for s in list_spellings(w))
    return WordLanguage(
        name, exact, stemmed, doubtful | _ENGLISH_TOO, endings, bare.links, tuple(source.sides.split())
    )


@lru_cache(maxsize=1)
def list_word_languages() -> tuple[WordLanguage, ...]:
    """Return every language, ready to look words up in."""
    return tuple(_language(name, source) for name, source in load_language_files().items())


@lru_cache(maxsize=1)
def list_synonyms() -> Mapping[str, str]:
    """Return every phrase of every language -> what it is called in English, for who looks at or changes
    them.
    """
    out: dict[str, str] = {}
    for source in load_language_files().values():
        for phrase, meaning in source.phrases.items():
            out.setdefault(phrase.lower(), meaning)
    return MappingProxyType(out)
