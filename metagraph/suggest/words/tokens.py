"""Names taken apart: words, sides and numbers at separators and capitals, without what exporters and
character names add.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from metagraph.suggest.words.cut import EnglishWord, Token, as_written, cut_tokens
from metagraph.suggest.words.defaults import Meanings
from metagraph.suggest.words.heard import find_spoken_languages
from metagraph.suggest.words.patterns import Patterns
from metagraph.suggest.words.spoken import SpokenLanguages, find_english_words

_EXTENSION = re.compile(r"\.(?:fbx|bvh|glb|gltf|anim|dae|c3d|ma|mb|blend|uasset)$", re.IGNORECASE)
_LONGEST = 4  # words in a phrase
SEVERAL = 8  # names, from which on what nearly all of them begin with says nothing
FEW = 3  # names at most that may share a word of the list because they are of one kind
_GLUED = range(6, 25)  # letters of a word that may be several written as one


@dataclass(frozen=True, slots=True)
class TakenName:
    """words: lower case, numbers without leading zeros. splits: how many words stand before each double
    underscore.
    """

    words: tuple[str, ...]
    splits: tuple[int, ...] = ()

    @property
    def split(self) -> int:
        """How many words stand before the first double underscore, 0 without one."""
        return self.splits[0] if self.splits else 0

    def without(self, count: int) -> TakenName:
        """Return what is left without the first words."""
        return TakenName(self.words[count:], tuple(n - count for n in self.splits if n > count))


@dataclass(frozen=True, slots=True)
class FoundPhrase:
    """A phrase found at words[start:end]."""

    start: int
    end: int
    text: str
    meaning: str


def split_clip_name(name: str, patterns: Patterns, speech: SpokenLanguages | None = None) -> TakenName:
    """Split a name into words, leaving out file endings and what exporters add ("Armature|mixamo.com|Layer0",
    "Take 001"). speech: the languages its batch speaks, None for English alone.
    """
    segments = [_segment(part, patterns, speech, at) for part, at in _parts(name)]
    words: list[str] = []
    splits: list[int] = []
    for segment in [s for s in segments if any(not w.isdecimal() for w in s.words)] or segments:
        splits += (len(words) + n for n in segment.splits)
        words += segment.words
    return TakenName(tuple(words), tuple(splits))


def _parts(name: str) -> list[tuple[str, int]]:
    """Return what stands between a name's colons and bars, and from where on."""
    bare = _EXTENSION.sub("", name)
    return [(found[0], found.start()) for found in re.finditer(r"[^|:]+", bare)] or [(bare, 0)]


def find_name_languages(names: Sequence[str], patterns: Patterns) -> SpokenLanguages | None:
    """Return what languages names speak beside English, None if they are English alone."""
    return find_spoken_languages(
        [
            [t for part, at in _parts(name) for t in cut_tokens(part, at) if isinstance(t, Token)]
            for name in names
        ],
        patterns,
    )


def _number(piece: str) -> str:
    """Return digits without leading zeros: a stance called 1 here and 01 there is one. "2H" stays."""
    return str(int(piece)) if piece.isdecimal() and len(piece) < 10 else piece


def _segment(
    text: str, patterns: Patterns, speech: SpokenLanguages | None = None, offset: int = 0
) -> TakenName:
    words: list[str] = []
    splits: list[int] = []
    said: list[Token] = []

    def english(word: str) -> tuple[str, ...]:
        return (_number(word),) if word.isdecimal() else _known(word, patterns.vocabulary)

    def read() -> None:
        if speech is None:
            for token in said:
                words.extend(find_english_words(token, english))
        else:
            words.extend(speech.read(said, english, patterns.meanings))
        said.clear()

    for piece in cut_tokens(text, offset):
        if isinstance(piece, Token):
            said.append(piece)
        elif "__" in piece.text:
            read()
            if words:
                splits.append(len(words))
    read()
    junk, kinds = patterns.meanings["junk"], patterns.meanings["kinds"]
    while words and (n := _junk_at(words, junk, front=False)):
        del words[-n:]
    if len(words) > 1 and words[-1].isdecimal() and words[-2] in junk and " ".join(words[-3:-1]) not in kinds:
        if len(words) == 2 and words[0] != "take":
            return TakenName(())  # "Layer0" counts nothing
        del words[-2]  # "Shrug_Take2": the number stays
    return _without_junk(TakenName(tuple(words), tuple(n for n in splits if n < len(words))), patterns)


def _without_junk(taken: TakenName, patterns: Patterns) -> TakenName:
    """Leave out what exporters write before a name, unless it is part of a phrase ("take item")."""
    junk = patterns.meanings["junk"]
    while (n := _junk_at(taken.words, junk, front=True)) and (
        n > 1 or " ".join(taken.words[:2]) not in patterns.meanings["kinds"]
    ):
        taken = taken.without(n)
    return taken


def _junk_at(words: Sequence[str], junk: Meanings, *, front: bool) -> int:
    for n in (2, 1):
        if len(words) >= n and " ".join(words[:n] if front else words[-n:]) in junk:
            return n
    return 0


def _known(word: str, vocabulary: frozenset[str]) -> tuple[str, ...]:
    """Return a word as the vocabulary has it: "shrugging" as "shrug", "crossarms" as two; as it is where it
    is not known.
    """
    if word in vocabulary or not word.isascii():
        return (word,)
    for ending in ("ing", "ed", "s"):
        base = word.removesuffix(ending)
        if base != word and len(base) > 2:
            for form in (base, base + "e", base[:-1] if base[-1] == base[-2] else base):
                if form in vocabulary:
                    return (form,)
    return _unglued(word, vocabulary) if len(word) in _GLUED else (word,)


def _unglued(word: str, vocabulary: frozenset[str]) -> tuple[str, ...]:
    """Split a word where every part is known, into as few as possible; otherwise leave it whole."""
    best: dict[int, tuple[str, ...]] = {0: ()}
    for end in range(2, len(word) + 1):
        for start in sorted(best):
            part = word[start:end]
            fits = part in vocabulary and (len(part) > 2 or part in ("to", "up", "on"))
            if fits and (end not in best or len(best[start]) + 1 < len(best[end])):
                best[end] = (*best[start], part)
    return best.get(len(word), (word,))


def drop_shared_words(taken: Sequence[TakenName], patterns: Patterns) -> list[TakenName]:
    """Leave out the words names begin with (a character, a project) as far as they tell nothing apart: words
    nobody knows that nearly all begin with, and any but those of posture that all do. A name keeps one word
    at least.
    """
    out = list(taken)
    while (word := _shared_first(out, patterns)) is not None:
        out = [
            _without_junk(t.without(1), patterns) if len(t.words) > 1 and t.words[0] == word else t
            for t in out
        ]
    return out


def _shared_first(taken: Sequence[TakenName], patterns: Patterns) -> str | None:
    """Return the word that names begin with and that says nothing of any, None if there is none."""
    named = [t.words for t in taken if t.words and not _is_other(t.words, patterns)]
    if len(named) < 2:
        return None
    word, count = Counter(words[0] for words in named).most_common(1)[0]
    meanings = patterns.meanings
    if any(word in meanings[table] for table in ("postures", "joins", "limbs")) or meanings["kinds"].get(
        word
    ) in ("stance", "transition"):
        return None
    going_on = [words[1:] for words in named if words[0] == word and len(words) > 1]
    if len(going_on) < count or len(named) - count > (len(named) // 20 if len(named) >= SEVERAL else 0):
        return None
    if word not in patterns.vocabulary:
        return word
    # A word of the list that all share is a character's ("generic male ..."), unless it is what they all are.
    saying = sum(1 for words in going_on if find_phrases(words, meanings["kinds"]))
    return word if len(named) > FEW and 2 * saying >= len(going_on) else None


def _is_other(words: Sequence[str], patterns: Patterns) -> bool:
    found = find_phrases(words, patterns.meanings["kinds"])
    return bool(found) and all(p.meaning == "other" for p in found)


def find_phrases(words: Sequence[str], table: Meanings) -> list[FoundPhrase]:
    """Find the table's phrases, from the left, the longest first, none overlapping."""
    out: list[FoundPhrase] = []
    at = 0
    while at < len(words):
        for n in range(min(_LONGEST, len(words) - at), 0, -1):
            text = " ".join(words[at : at + n])
            if text in table:
                out.append(FoundPhrase(at, at + n, text, table[text]))
                at += n
                break
        else:
            at += 1
    return out


def quote_words(name: str, words: Sequence[str], taken: TakenName | None = None) -> str:
    """Return words in quotes as the name writes them, or plainly where they do not stand together in it.
    taken: the name taken apart, to find words of other languages by the English ones they stand for.
    """
    there = taken.words if taken is not None else ()
    n = len(words)
    for at in range(len(there) - n, -1, -1) if n else ():
        if tuple(words) != there[at : at + n]:
            continue
        some = [w for w in there[at : at + n] if isinstance(w, EnglishWord)]
        if len(some) == n:
            return f"'{name[min(w.start for w in some) : max(w.end for w in some)]}'"
        words = as_written(there[at : at + n])
        break
    parts = (f"0*{word}" if word.isdecimal() else re.escape(word) for word in words)
    found = list(re.finditer(r"[\W_]*".join(parts), name, re.IGNORECASE)) if words else []
    return f"'{found[-1][0]}'" if found else f"'{' '.join(words)}'"


def is_number_word(word: str) -> bool:
    return word.isdecimal()


def drop_numbers(words: Iterable[str]) -> tuple[str, ...]:
    return tuple(w for w in words if not w.isdecimal())


def is_designator(word: str) -> bool:
    """Whether a word may tell stances apart that are called alike: a number, or a letter that is no side."""
    return word.isdecimal() or word in ("a", "b", "c", "d", "e", "f", "g", "h")


def count_variant_words(words: Sequence[str]) -> int:
    """Return how many words at the end only tell variants apart: numbers, or one letter a to d."""
    n = 0
    while n < len(words) and (
        words[-1 - n].isdecimal() or (n == 0 and len(words) > 1 and words[-1] in ("a", "b", "c", "d"))
    ):
        n += 1
    return n


_STEMS = {
    "sitting": "sit",
    "seated": "sit",
    "sat": "sit",
    "seat": "sit",
    "standing": "stand",
    "stood": "stand",
    "crossed": "cross",
    "crossing": "cross",
    "lying": "lie",
    "lay": "lie",
    "laying": "lie",
    "kneeling": "kneel",
    "crouching": "crouch",
    "leaning": "lean",
    "clasped": "clasp",
    "folded": "fold",
    "tilted": "tilt",
    "idling": "idle",
    "feet": "foot",
}


def find_stem(word: str) -> str:
    """Return the word in the form in which stances are compared: "seated" and "sit" are the same."""
    known = _STEMS.get(word)
    if known:
        return known
    return word[:-1] if len(word) > 3 and word.endswith("s") and not word.endswith("ss") else word
