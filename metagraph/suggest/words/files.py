"""The words animators name clips with, read from `words/*.json` when they are first asked for: English ones
and what they mean, and those of other languages and which English ones they stand for.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TypeVar

import msgspec

from metagraph.errors import FileError

FOLDER = Path(__file__).parent
ENGLISH = "english"
# In this order languages are asked what a word means that several have; others follow by name.
_ORDER = (
    "german", "french", "spanish", "italian", "portuguese", "japanese", "chinese", "dutch", "polish",
    "russian", "korean",
)  # fmt: skip
Phrases = str | tuple[str, ...]  # phrases with commas between, or several such texts
T = TypeVar("T")


class EnglishFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What English phrases mean: for each field of `words_defaults.Field`, meaning -> phrases."""

    kinds: dict[str, Phrases]
    layers: dict[str, Phrases]
    limbs: dict[str, Phrases]
    tags: dict[str, Phrases]
    postures: dict[str, Phrases]
    joins: dict[str, Phrases]
    junk: dict[str, Phrases]


class LanguageFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """A language other than English. words: English, or a mark of `words/languages`, -> phrases for it.

    doubtful: phrases that do not tell that a name is in this language. endings: of words, blanks between.
    links: letters between the parts of a compound, blanks between. sides: the letters that stand for left and
    for right where names end. swaps: letter -> what else it may be written as: simplified and traditional
    hanzi.
    """

    words: dict[str, Phrases]
    doubtful: Phrases = ""
    endings: str = ""
    links: str = ""
    sides: str = ""
    swaps: dict[str, str] = {}

    def __post_init__(self) -> None:
        for meaning, said in self.words.items():
            if not meaning.strip() or not list_phrases(said):
                raise ValueError(f"'{meaning}' has no phrases")
        if len(self.sides.split()) not in (0, 2):
            raise ValueError(f"sides are two letters, for left and for right, not '{self.sides}'")

    @cached_property
    def phrases(self) -> Mapping[str, str]:
        """Phrase -> English, as people write it. Of two meanings the first counts."""
        out: dict[str, str] = {}
        for meaning, said in self.words.items():
            for phrase in list_phrases(said):
                out.setdefault(phrase, meaning)
        return MappingProxyType(out)


def list_phrases(said: Phrases) -> list[str]:
    """Return the phrases of a text, or of several."""
    texts = (said,) if isinstance(said, str) else said
    return [p for text in texts for part in text.split(",") if (p := " ".join(part.split()))]


@cache
def list_english_meanings() -> EnglishFile:
    """Return what English phrases mean."""
    return read_words(FOLDER / f"{ENGLISH}.json", EnglishFile)


@cache
def load_language_files() -> Mapping[str, LanguageFile]:
    """Return the words of every language other than English, by its name."""
    paths = [path for path in FOLDER.glob("*.json") if path.stem != ENGLISH]
    paths.sort(key=lambda p: (_ORDER.index(p.stem) if p.stem in _ORDER else len(_ORDER), p.stem))
    return {path.stem: read_words(path, LanguageFile) for path in paths}


def read_words(path: Path, kind: type[T]) -> T:
    """Read a file of words. Raises FileError naming what is wrong."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=kind)
    except (OSError, msgspec.MsgspecError, UnicodeError) as error:
        remedy = "Compare it with the other files of that folder."
        raise FileError(path, f"holds no words of clips' names: {error}", "", remedy) from None
