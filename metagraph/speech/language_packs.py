"""Language packs: which words of a language answer, hesitate, and are small, as data
(`languages/*.json`; a pack of one's own has the same form).

A pack says itself what it rests on and how sure that is.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from metagraph.graph.vocabulary import Vocabulary, is_unspaced, make_token_key, split_tokens

FOLDER = Path(__file__).parent / "languages"
ENGLISH = "en"
MOST = 5000  # words of a list
_Line = Annotated[str, Meta(max_length=10_000)]
_Words = _Line | tuple[_Line, ...]
_Text = Annotated[str, Meta(max_length=2000)]


class PackFile(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A pack as it is written. Lists: texts with commas between the words, or one such text.

    code: of ISO 639, small letters ("de", "pt-br"). name, own: in English, and what it calls itself.
    rests_on: sources. sure: how sure the lists are. spaced: whether blanks part its words; letters_a_word:
    how many letters a word has, where not. letters: those beyond a-z that its Latin spelling has. borrows:
    codes of languages that are answered with, too. responses, hesitations: words and phrases. lexical: those
    that mean something, too, and hesitate only where speech stops. small: words hardly ever stressed, which
    clauses begin with; joining: a new thought begins with them; trailing: they rather end what is before;
    inside: they go on with it; closing: a clause ends well behind them; elided: what loses its vowel before
    an apostrophe.
    """

    code: Annotated[str, Meta(pattern=r"^[a-z]{2,3}(-[a-z0-9]{2,8})*$")]
    name: Annotated[str, Meta(min_length=1, max_length=100)]
    own: Annotated[str, Meta(max_length=100)] = ""
    rests_on: tuple[_Text, ...] = ()
    sure: _Text = ""
    spaced: bool = True
    letters: Annotated[str, Meta(max_length=500)] = ""
    letters_a_word: Annotated[float, Meta(ge=1, le=20)] = 1.0
    borrows: tuple[Annotated[str, Meta(max_length=40)], ...] = ()
    elided: _Words = ()
    responses: _Words = ()
    hesitations: _Words = ()
    lexical: _Words = ()
    small: _Words = ()
    joining: _Words = ()
    trailing: _Words = ()
    inside: _Words = ()
    closing: _Words = ()


class PackError(ValueError):
    """A pack says what cannot be. where: the field."""

    def __init__(self, where: str, message: str) -> None:
        self.where = where
        super().__init__(message)


@dataclass(frozen=True, eq=False)
class LanguagePack:
    """A pack as it is used. responses, hesitations: as written, in order. lexical: phrases. small, joining,
    trailing, inside, closing, elided: tokens. known: every token that tells this language.
    """

    code: str
    name: str
    own: str
    rests_on: tuple[str, ...]
    sure: str
    spaced: bool
    letters: frozenset[str]
    letters_a_word: float
    responses: tuple[str, ...]
    hesitations: tuple[str, ...]
    lexical: Vocabulary
    small: frozenset[str]
    joining: frozenset[str]
    trailing: frozenset[str]
    inside: frozenset[str]
    closing: frozenset[str]
    elided: frozenset[str]
    known: frozenset[str]

    @property
    def called(self) -> str:
        """The name, and the code: "German (de)"."""
        return f"{self.name} ({self.code})"

    def parted(self, said: tuple[str, ...]) -> tuple[str, ...]:
        """Return tokens, with what lost its vowel before an apostrophe as one of its own: l'eau -> l, eau."""
        if not self.elided or not any("'" in t for t in said):
            return said
        out: list[str] = []
        for token in said:
            head, mark, rest = token.partition("'")
            while mark and rest and head in self.elided:
                out.append(head)
                token = rest
                head, mark, rest = token.partition("'")
            out.append(token)
        return tuple(out)

    def is_small(self, token: str) -> bool:
        """Whether a token is hardly ever stressed; where writing has no blanks, also one made of such
        words.
        """
        if self.spaced or token in self.small:
            return token in self.small
        return _made_of(token, self.small)

    def size(self, said: tuple[str, ...]) -> float:
        """Return how many words a transcript's word counts as: one, or by its letters without blanks."""
        if self.spaced:
            return 1.0
        letters = sum(is_unspaced(c) for t in said for c in t)
        others = sum(not any(map(is_unspaced, t)) for t in said)
        return letters / self.letters_a_word + others or 1.0


@lru_cache(maxsize=1 << 14)
def _made_of(token: str, words: frozenset[str]) -> bool:
    reached = {0}
    for a in range(len(token)):
        if a in reached:
            reached |= {b for b in range(a + 1, min(a + 6, len(token)) + 1) if token[a:b] in words}
    return len(token) in reached


def list_pack_words(words: str | Collection[str]) -> tuple[str, ...]:
    """Return the words of a list as it is written, each once."""
    texts = (words,) if isinstance(words, str) else words
    each = (" ".join(part.split()) for text in texts for part in text.replace("、", ",").split(","))
    return tuple(dict.fromkeys(w for w in each if w))


def make_language(pack: PackFile, others: Mapping[str, LanguagePack]) -> LanguagePack:
    """Return a pack as it is used. others: those it may borrow from, by code. Raises PackError naming the
    field that is wrong.
    """
    lists = {name: list_pack_words(getattr(pack, name)) for name in _LISTS}
    for name, words in lists.items():
        if len(words) > MOST:
            raise PackError(name, f"has {len(words):,} words, {MOST:,} at most are read")
        for word in words:
            if len(word) > 200:
                raise PackError(name, f"'{word[:40]}...' is longer than 200 letters")
            if not (found := split_tokens(word)):
                raise PackError(name, f"'{word}' has no letters, so nothing said can be it")
            if name not in _PHRASES and len(found) > 1:
                raise PackError(name, f"'{word}' is more than one word")
    if not lists["responses"] and not lists["hesitations"]:
        raise PackError("responses", "has no words, and neither has 'hesitations'")
    sets = {
        name: frozenset(split_tokens(w)[0] for w in words)
        for name, words in lists.items()
        if name not in _PHRASES
    }
    own = {make_token_key(split_tokens(w)) for words in lists.values() for w in words}
    borrowed: list[str] = []
    for code in pack.borrows:
        if code not in others:
            raise PackError("borrows", f"there are no words of '{code}': known are {', '.join(others)}")
        borrowed += (w for w in others[code].responses if make_token_key(split_tokens(w)) not in own)
    said = {t for name in ("responses", "hesitations") for w in lists[name] for t in split_tokens(w)}
    return LanguagePack(
        pack.code,
        pack.name,
        pack.own or pack.name,
        pack.rests_on,
        pack.sure,
        pack.spaced,
        frozenset(normalize_letters(pack.letters)),
        pack.letters_a_word,
        tuple(dict.fromkeys((*lists["responses"], *borrowed))),
        lists["hesitations"],
        Vocabulary(lists["lexical"]),
        known=frozenset().union(said, *sets.values()),
        **sets,
    )


_PHRASES = ("responses", "hesitations", "lexical")
_LISTS = (*_PHRASES, "small", "joining", "trailing", "inside", "closing", "elided")


def normalize_letters(letters: str) -> str:
    """Return letters in the form tokens have."""
    return "".join(split_tokens(letters))


@cache
def list_language_packs() -> Mapping[str, LanguagePack]:
    """Return the packs that come with the program, by code, English first."""
    out: dict[str, LanguagePack] = {}
    for path in sorted(FOLDER.glob("*.json"), key=lambda p: (p.stem != ENGLISH, p.stem)):
        pack = make_language(msgspec.json.decode(path.read_bytes(), type=PackFile), out)
        out[pack.code] = pack
    return out


def read_english_pack() -> LanguagePack:
    return list_language_packs()[ENGLISH]
