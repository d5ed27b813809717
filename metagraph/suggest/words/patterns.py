"""What words in clips' names mean: defaults, a user's changes to them, and what was learned from
corrections.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, Final, get_args

from metagraph.graph.words import KINDS, LAYERS, LIMBS
from metagraph.suggest.words.defaults import DEFAULTS, Field, Meanings

VERSION: Final = 1
FIELDS: tuple[Field, ...] = get_args(Field)
LEARNABLE: Final = ("kind", "layer", "limb", "tags", "stance", "end_stance")
_ALLOWED: Final[Mapping[Field, tuple[str, ...] | None]] = {
    "kinds": (*KINDS, "other"), "layers": LAYERS, "limbs": LIMBS, "tags": None,
    "postures": ("stance",), "joins": ("to", "from"), "junk": ("junk",), "synonyms": None,
}  # fmt: skip
_OF_FIELD: Final[Mapping[str, tuple[str, ...] | None]] = {
    "kind": KINDS, "layer": LAYERS, "limb": LIMBS, "tags": None, "stance": None, "end_stance": None,
}  # fmt: skip

# field -> words of a name -> what it was corrected to -> how often. A phrase is stored with its words joined
# by blanks.
Learned = Mapping[str, Mapping[str, Mapping[str, int]]]


class PatternsError(ValueError):
    """Patterns cannot be read or changed; the message says what, where and what would do."""


@dataclass(frozen=True)
class Patterns:
    """Which words mean what. changes: field -> phrase -> meaning, on top of the defaults; None takes a
    default away.

    A phrase is lower-case words joined by blanks, as names are taken apart: "check watch". Fields: `kinds`
    (phrase -> kind, or "other" for what is no conversation), `layers`, `limbs`, `tags` (blanks between
    several), `postures` (words that stances are called by), `joins` (words between the two stances of a
    transition), `junk` (words exporters leave), `synonyms` (words of other languages or of a house -> the
    English words they stand for; "-" for none at all).
    """

    changes: Mapping[Field, Mapping[str, str | None]] = field(default_factory=dict)
    learned: Learned = field(default_factory=dict)

    @cached_property
    def meanings(self) -> Mapping[Field, Meanings]:
        """Field -> phrase -> meaning, defaults and changes together."""
        if not self.changes and self is not _PLAIN:
            return _PLAIN.meanings  # thousands of words are put together once
        out: dict[Field, Meanings] = {}
        for name in FIELDS:
            mixed = {**DEFAULTS[name], **self.changes.get(name, {})}
            if name != "synonyms":  # of which one meaning was changed, the others stay
                mixed = {**self._stood_for(name, mixed), **mixed}
            out[name] = MappingProxyType({k: v for k, v in mixed.items() if v is not None})
        return MappingProxyType(out)

    def _stood_for(self, name: Field, mixed: Mapping[str, str | None]) -> dict[str, str | None]:
        """Return what a field says of words of other languages that a user gave a meaning of their own."""
        if not self.changes:
            return {}
        known = {**DEFAULTS["synonyms"], **self.changes.get("synonyms", {})}
        own = {p for field_, mine in self.changes.items() if field_ != "synonyms" for p in mine}
        return {p: mixed[meaning] for p in own if (meaning := known.get(p)) and meaning in mixed}

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """Every single word that means something."""
        if not self.changes and self is not _PLAIN:
            return _PLAIN.vocabulary
        return frozenset(
            w
            for name in FIELDS
            if name not in ("junk", "synonyms")
            for phrase in self.meanings[name]
            for w in phrase.split()
        )

    def with_pattern(self, name: Field, phrase: str, meaning: str | None) -> Patterns:
        """Return patterns in which a phrase means something (else), or nothing for None."""
        phrase = " ".join(phrase.lower().split())
        _check(name, phrase, meaning, "the pattern")
        mine = dict(self.changes.get(name, {}))
        if meaning == DEFAULTS[name].get(phrase):
            mine.pop(phrase, None)  # back to the default: nothing to remember
        else:
            mine[phrase] = meaning
        return replace(self, changes={**self.changes, name: mine})

    def to_json(self) -> dict[str, Any]:
        """Return plain values for a file: only what differs from the defaults, so that better defaults arrive
        with updates.
        """
        out: dict[str, Any] = {"patterns": VERSION}
        out |= {name: dict(sorted(mine.items())) for name, mine in self.changes.items() if mine}
        if self.learned:
            out["learned"] = {
                f: {w: dict(v) for w, v in sorted(words.items())}
                for f, words in sorted(self.learned.items())
                if words
            }
        return out

    @staticmethod
    def from_json(data: Any) -> Patterns:
        """Read what `to_json` gave; raise PatternsError naming the place of the first thing wrong."""
        if not isinstance(data, Mapping):
            raise PatternsError(
                f"name patterns are {_kind_of(data)}, expected an object; delete the file to begin anew"
            )
        version = data.get("patterns")
        if version != VERSION:
            raise PatternsError(
                f"name patterns have version {version!r}, this program reads {VERSION}; update it, or delete "
                "the file"
            )
        for key in data:
            if key not in (*FIELDS, "patterns", "learned"):
                raise PatternsError(
                    f"name patterns hold an unknown part '{key}'; known are {', '.join((*FIELDS, 'learned'))}"
                )
        changes: dict[Field, dict[str, str | None]] = {}
        for name in FIELDS:
            for phrase, meaning in _object(data.get(name, {}), f"'{name}'").items():
                _check(name, phrase, meaning, f"'{name}', '{phrase}'")
                changes.setdefault(name, {})[phrase] = meaning
        return Patterns(changes, _learned(data.get("learned", {})))


_PLAIN: Final = Patterns()  # what words mean if nobody has changed a thing


def _learned(data: Any) -> Learned:
    out: dict[str, dict[str, dict[str, int]]] = {}
    for name, words in _object(data, "'learned'").items():
        if name not in LEARNABLE:
            raise PatternsError(
                f"'learned' holds an unknown field '{name}'; known are {', '.join(LEARNABLE)}"
            )
        for word, counts in _object(words, f"'learned', '{name}'").items():
            for value, count in _object(counts, f"'learned', '{name}', '{word}'").items():
                where = f"'learned', '{name}', '{word}', '{value}'"
                if type(count) is not int or not 0 < count < 2**31:
                    raise PatternsError(f"{where} is {count!r}, expected a count of 1 or more")
                allowed = _OF_FIELD[name]
                if allowed is not None and value not in allowed:
                    raise PatternsError(f"{where}: '{value}' is none of {', '.join(allowed)}")
                out.setdefault(name, {}).setdefault(word, {})[value] = count
    return out


def _check(name: str, phrase: Any, meaning: Any, where: str) -> None:
    if name not in FIELDS:
        raise PatternsError(f"there are no patterns called '{name}'; there are {', '.join(FIELDS)}")
    if not isinstance(phrase, str) or not phrase.strip():
        raise PatternsError(f"{where} has no words; write lower-case words with blanks between them")
    if meaning is None:
        return
    allowed = _ALLOWED[name]
    if (
        not isinstance(meaning, str)
        or not meaning.strip()
        or (allowed is not None and meaning not in allowed)
    ):
        wanted = "words" if allowed is None else "one of " + ", ".join(allowed)
        raise PatternsError(f"{where} means {meaning!r}, expected {wanted}, or null to take it away")


def _object(data: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(data, Mapping) or not all(isinstance(k, str) for k in data):
        raise PatternsError(f"{where} is {_kind_of(data)}, expected an object")
    return data


def _kind_of(data: Any) -> str:
    return "nothing" if data is None else f"a {type(data).__name__}"


# --- learning


def count_correction(patterns: Patterns, name: str, words: Sequence[str], value: str) -> Patterns:
    """Count a correction for the whole phrase and, where there are several, for each of its words."""
    if name not in LEARNABLE:
        raise PatternsError(f"nothing is learned about '{name}'; it is about {', '.join(LEARNABLE)}")
    allowed = _OF_FIELD[name]
    if allowed is not None and value not in allowed:
        raise PatternsError(f"a {name} cannot be '{value}'; it is one of {', '.join(allowed)}")
    if not words or not value:
        return patterns
    mine = {word: dict(counts) for word, counts in patterns.learned.get(name, {}).items()}
    for key in {" ".join(words), *(words if name not in ("stance", "end_stance") else ())}:
        counts = mine.setdefault(key, {})
        counts[value] = counts.get(value, 0) + 1
    return replace(patterns, learned={**patterns.learned, name: mine})


def recall_correction(patterns: Patterns, name: str, words: Sequence[str]) -> tuple[str, str, int] | None:
    """Return (meaning, the words it comes from, how often) of what was corrected before; None if that is
    unknown or disputed.

    The whole phrase counts from the first time; a single word only when two corrections agree and none
    disagrees, so that one correction does not change clips that merely share a word.
    """
    known = patterns.learned.get(name)
    if not known or not words:
        return None
    phrase = " ".join(words)
    if found := _agreed(known.get(phrase, {}), 1, 0.75):
        return found[0], phrase, found[1]
    if len(words) > 1:
        for word in words:
            if found := _agreed(known.get(word, {}), 2, 1.0):
                return found[0], word, found[1]
    return None


def _agreed(counts: Mapping[str, int], least: int, share: float) -> tuple[str, int] | None:
    if not counts:
        return None
    value = min(counts, key=lambda v: (-counts[v], v))
    return (
        (value, counts[value])
        if counts[value] >= least and counts[value] >= share * sum(counts.values())
        else None
    )


def forget_learned(patterns: Patterns, name: str | None = None, phrase: str | None = None) -> Patterns:
    """Return patterns without what was learned: all, of one field, or of one phrase in it (or in every
    field).
    """
    kept = {}
    for known, words in patterns.learned.items():
        if name not in (None, known):
            kept[known] = words
        elif phrase is not None:
            kept[known] = {word: counts for word, counts in words.items() if word != phrase}
    return replace(patterns, learned={known: words for known, words in kept.items() if words})


def merge_patterns(mine: Patterns, theirs: Patterns) -> Patterns:
    """Return patterns with another's on top: its meanings win, its corrections count as often as they counted
    there, or here if more.
    """
    changes = {name: {**mine.changes.get(name, {}), **theirs.changes.get(name, {})} for name in FIELDS}
    learned: dict[str, dict[str, dict[str, int]]] = {
        f: {w: dict(c) for w, c in words.items()} for f, words in mine.learned.items()
    }
    for known, words in theirs.learned.items():
        for word, counts in words.items():
            there = learned.setdefault(known, {}).setdefault(word, {})
            for value, count in counts.items():
                there[value] = max(count, there.get(value, 0))
    return Patterns({name: found for name, found in changes.items() if found}, learned)
