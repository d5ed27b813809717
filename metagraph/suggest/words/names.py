"""What clips' names say of their labels. The names of a batch are read together: what several share tells the
stances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, TypeVar, cast

from metagraph.common.wording import change_quoted, phrase, plural_phrase
from metagraph.graph.words import Kind, Layer, Limb
from metagraph.suggest.estimate import Belief
from metagraph.suggest.words.cut import as_written
from metagraph.suggest.words.defaults import Field
from metagraph.suggest.words.patterns import (
    Patterns,
    PatternsError,
    count_correction,
    forget_learned,
    merge_patterns,
    recall_correction,
)
from metagraph.suggest.words.stances import FoundStance, Stances, Words, is_low, label
from metagraph.suggest.words.tokens import (
    SEVERAL,
    FoundPhrase,
    TakenName,
    count_variant_words,
    drop_numbers,
    drop_shared_words,
    find_name_languages,
    find_phrases,
    is_number_word,
    quote_words,
    split_clip_name,
)

__all__ = [
    "NameGuess",
    "Patterns",
    "PatternsError",
    "forget_learned",
    "learn_correction",
    "merge_patterns",
    "read_names",
]

T = TypeVar("T")
# Words for what somebody who talks never does, who would stand otherwise: each is "other" in `english.json`.
NEVER: Final = frozenset(
    ("walk", "walking", "run", "running", "jog", "jogging", "sprint", "sprinting", "strafe", "jump", "climb")
    + ("climbing", "swim", "swimming", "crawl", "crawling", "fly", "flying", "fall", "falling", "float")
    + ("floating", "hanging", "death", "die", "dying", "dead", "t pose", "a pose", "tpose", "apose")
    + ("bind pose", "locomotion", "side step", "sidestep")
)
EXPLICIT: Final = 0.98  # how often a word for what is done, after its stance, says the kind rightly
ALL_ALIKE: Final = 0.6  # the same for a word that all names of a batch have, which tells none from another
_UP: Final = frozenset(("up", "stand", "rise", "get"))


@dataclass(frozen=True, slots=True)
class NameGuess:
    """What one name says; None if it says nothing. stance, end_stance: words for stances, "arms crossed".

    number: which of several like it, as the name counts them. other: the word that says that it is none of
    the four kinds.
    """

    kind: Belief[Kind] | None = None
    stance: Belief[str] | None = None
    end_stance: Belief[str] | None = None
    layer: Belief[Layer] | None = None
    limb: Belief[Limb] | None = None
    tags: Belief[tuple[str, ...]] | None = None
    number: Belief[int] | None = None
    other: Belief[str] | None = None


@dataclass(frozen=True, slots=True)
class _Parse:
    """A name taken apart. stance: where it begins; act: the words of what is done, numbers left out.

    own: how many words are its stance's, 0 for a stance that only follows from what is done; at: from which
    on they stand. joined: the words that make it a transition, "" if none do; end, end_words: the stance it
    ends in, or words for one, with their confidence. sure: that it is a transition.
    """

    words: Words
    stance: FoundStance | None
    own: int
    act: Words
    joined: str = ""
    end: FoundStance | None = None
    end_words: Words = ()
    end_confidence: float = 0.0
    sure: float = 0.9
    at: int = 0


def read_names(names: Sequence[str], patterns: Patterns | None = None) -> dict[str, NameGuess]:
    """Return what each distinct name says, with the others of the batch in mind. Never raises; the order does
    not matter.
    """
    reader = _Reader(names, patterns or Patterns())
    return {name: reader.guess(name) for name in dict.fromkeys(names)}


def learn_correction(
    patterns: Patterns, name: str, field: str, value: str | Sequence[str], names: Sequence[str] = ()
) -> Patterns:
    """Remember a correction: the words of `name` mean `value`. names: the batch it stands in, which tells its
    stance from its act.
    """
    reader = _Reader([*names, name], patterns)
    said = " ".join(value.split()) if isinstance(value, str) else " ".join(value)
    return count_correction(patterns, field, reader.key(reader.parse(name), field), said)


@lru_cache(maxsize=4)  # a correction stands in the batch that was read just before
def _batch(
    names: tuple[str, ...], changes: tuple[tuple[Field, tuple[tuple[str, str | None], ...]], ...]
) -> tuple[dict[str, TakenName], Stances]:
    """Return the distinct names taken apart, and the stances they have together."""
    patterns = Patterns({field: dict(mine) for field, mine in changes})
    speech = find_name_languages(names, patterns)
    taken = drop_shared_words([split_clip_name(name, patterns, speech) for name in names], patterns)
    return dict(zip(names, taken, strict=True)), Stances(taken, patterns)


class _Reader:
    def __init__(self, names: Sequence[str], patterns: Patterns) -> None:
        changes = tuple((field, tuple(mine.items())) for field, mine in patterns.changes.items())
        self._taken, self._stances = _batch(tuple(sorted(set(names))), changes)
        self._patterns = patterns
        self._kinds = patterns.meanings["kinds"]
        self._joins = patterns.meanings["joins"]
        each = [set(taken.words) for taken in self._taken.values()]
        self._everywhere = frozenset(set.intersection(*each)) if len(each) >= SEVERAL else frozenset()

    # -- taking apart

    def parse(self, name: str) -> _Parse:
        taken = self._taken[name]
        words = taken.words
        begun = self._stances.of(words, taken.split)
        stance, used = begun or (None, 0)
        rest = words[used:]
        while rest and is_number_word(rest[0]) and not self._two(rest):
            rest = rest[1:]
        if len(rest) > 2 and rest[0] in ("trans", "transition") and rest[1] in self._joins:
            rest = rest[1:]
        passing = self._passing(words, stance, rest)
        if passing is None and stance is None and (told := self._stances.within(words)) is not None:
            found, start, end = told
            return _Parse(words, found, end - start, self._act((*words[:start], *words[end:])), at=start)
        return passing or _Parse(words, stance, used, self._act(rest))

    def _two(self, rest: Words) -> bool:
        return rest[0] == "2" and len(rest) > 1 and self._stances.named(rest[1:]) is not None

    def _act(self, rest: Words) -> Words:
        return drop_numbers(rest[: len(rest) - count_variant_words(rest)] or rest)

    def _passing(self, words: Words, stance: FoundStance | None, rest: Words) -> _Parse | None:
        """Read a transition: from one stance to another, down into one, up out of one."""
        if (
            rest
            and self._joins.get(rest[0]) == "to"
            and (stance is not None or self._stances.named(rest[1:]) is not None)
        ):
            return self._to(words, stance, rest[0], rest[1:], 0.97 if stance else 0.85)
        if rest and self._joins.get(rest[0]) == "from" and len(rest) > 1:
            at = next((i for i, w in enumerate(rest) if i and self._joins.get(w) == "to"), len(rest))
            start = self._stances.named(rest[1:at])
            if start and at == len(rest):  # "crossed from sides"
                return _Parse(
                    words, start[0], 0, (), rest[0], stance, stance.words if stance else (), 0.9, 0.85
                )
            if at < len(rest) - 1:
                return self._to(
                    words, start[0] if start else None, rest[at], rest[at + 1 :], 0.95 if start else 0.8
                )
        if stance is None or not stance.prefixes & {words, words[: len(words) - count_variant_words(words)]}:
            for at in range(1, len(words) - 1):
                if self._joins.get(words[at]) == "to" and at >= len(words) - len(rest):
                    left, right = self._stances.named(words[:at]), self._stances.named(words[at + 1 :])
                    telling = self._stances.postural(words[:at]) and self._stances.postural(words[at + 1 :])
                    if telling or (right and right[1] > 0.9 and (left or words[at] != "2")):
                        return self._to(
                            words,
                            left[0] if left else None,
                            words[at],
                            words[at + 1 :],
                            0.9 if left else 0.75,
                        )
        return self._moving(words, stance, rest)

    def _to(self, words: Words, stance: FoundStance | None, joined: str, end: Words, sure: float) -> _Parse:
        found = self._stances.named(end, stance.words if stance else ())
        if found is None or found[0].words != end:
            end = end[: len(end) - count_variant_words(end)] or end
            found = self._stances.named(end, stance.words if stance else ()) or found
        shown = f"{label((joined,))} {label(end)}".strip()
        if found:
            return _Parse(words, stance, int(stance is not None), (), shown, found[0], end, found[1], sure)
        return _Parse(words, stance, int(stance is not None), (), shown, None, end, 0.6 if end else 0.0, sure)

    def _moving(self, words: Words, stance: FoundStance | None, rest: Words) -> _Parse | None:
        told = next((p for p in find_phrases(words, self._kinds) if p.meaning == "transition"), None)
        text = drop_numbers(rest)
        if (
            stance is not None
            and len(text) == 1
            and (text[0] in ("in", "enter") or (text[0] == "down" and is_low(stance.words)))
        ):
            return _Parse(words, self._stances.standing(), 0, (), text[0], stance, stance.words, 0.95, 0.95)
        if stance is not None and text:
            rising = is_low(stance.words) and all(w in _UP for w in text)
            if rising or text in (("out",), ("exit",)):
                return _Parse(
                    words,
                    stance,
                    1,
                    (),
                    " ".join(text),
                    *self._end(self._stances.standing(), ("stand",)),
                    0.95,
                )
        if told is None:
            return None
        if told.text.endswith("down"):
            low = self._stances.low(words)
            verb = told.text.split()[:1]
            return _Parse(
                words, self._stances.standing(), 0, (), told.text, *self._end(low, tuple(verb)), 0.9
            )
        if told.text in ("stand up", "get up", "rise"):
            low = self._stances.low([w for w in words if w not in _UP])
            return _Parse(words, low, 0, (), told.text, *self._end(self._stances.standing(), ("stand",)), 0.9)
        if (pair := self._pair(words[told.end :])) is not None:  # "trans sit stand"
            return _Parse(words, pair[0], 0, (), told.text, pair[1], pair[1].words, 0.85, 0.9)
        others = drop_numbers((*words[: told.start], *words[told.end :]))
        about = self._stances.named(others) if others else None
        if told.text == "exit":
            return _Parse(words, about[0] if about else stance, 0, (), told.text, None, (), 0.0, 0.85)
        start = stance if told.start else None
        after = self._stances.named(drop_numbers(words[told.end :]), start.words if start else ())
        return _Parse(
            words,
            start,
            int(start is not None),
            (),
            told.text,
            after[0] if after else None,
            (),
            after[1] if after else 0.0,
            0.85,
        )

    def _pair(self, words: Words) -> tuple[FoundStance, FoundStance] | None:
        """Return two stances that words name one after the other."""
        for at in range(1, len(words)):
            start, end = self._stances.known(words[:at]), self._stances.known(words[at:])
            if start is not None and end is not None and start is not end:
                return start, end
        return None

    def _end(self, found: FoundStance | None, otherwise: Words) -> tuple[FoundStance | None, Words, float]:
        return (found, found.words, 0.9) if found else (None, otherwise, 0.5)

    # -- what it says

    def _spelled(self, name: str, belief: Belief[T] | None) -> Belief[T] | None:
        """Return the belief with what its reason quotes as the name writes it: 'ToCrossed'."""
        if belief is None or "'" not in belief.reason:
            return belief
        taken = self._taken[name]
        reason = change_quoted(belief.reason, lambda words: quote_words(name, words.split(), taken)[1:-1])
        return Belief(belief.value, belief.confidence, reason)

    def key(self, parse: _Parse, field: str) -> Words:
        """Return the words a correction of a field is remembered by, as the name has them."""
        return as_written(self._key(parse, field))

    def _key(self, parse: _Parse, field: str) -> Words:
        limbs = self._patterns.meanings["limbs"]
        if field == "stance" and parse.stance and parse.own:
            return drop_numbers(parse.stance.words)
        if field == "end_stance" and parse.joined:
            return drop_numbers(parse.end_words)
        words = parse.act or drop_numbers(parse.words)
        return words if field == "limb" else tuple(w for w in words if w not in limbs or len(w) > 5) or words

    def guess(self, name: str) -> NameGuess:
        parse = self.parse(name)
        words = parse.words
        if not any(not is_number_word(w) for w in words):
            return NameGuess(number=self._number(words))
        kind = self._kind(parse)
        return NameGuess(
            kind=self._spelled(name, kind),
            stance=self._spelled(name, self._stance(parse, kind)),
            end_stance=self._spelled(name, self._end_stance(parse)),
            layer=self._spelled(name, self._layer(parse, kind)),
            limb=self._spelled(name, self._limb(parse)),
            tags=self._spelled(name, self._tags(parse)),
            number=self._number(words),
            other=self._spelled(name, self._other(words)) if kind is None else None,
        )

    def _other(self, words: Words) -> Belief[str] | None:
        said = next((p for p in find_phrases(words, self._kinds) if p.meaning == "other"), None)
        return Belief(said.text, 0.85, _says(said.text)) if said is not None else None

    def _recalled(self, parse: _Parse, field: str) -> Belief[str] | None:
        found = recall_correction(self._patterns, field, self.key(parse, field))
        if found is None:
            return None
        value, words, count = found
        said = plural_phrase(
            "'{words}' was corrected to {value} {count:,} time",
            "'{words}' was corrected to {value} {count:,} times",
            count,
            words=words,
            value=value,
        )
        return Belief(value, 1 - 0.2 / (count + 1), said)

    def _kind(self, parse: _Parse) -> Belief[Kind] | None:
        learned = self._recalled(parse, "kind")
        if learned is not None:
            return cast("Belief[Kind]", learned)
        if self._nobody_goes_there(parse):
            return None  # "idle to walk", "falling idle": none of the four
        if parse.joined:
            return Belief("transition", parse.sure, _says(parse.joined))
        stance = parse.stance
        if stance and parse.own and all(self._kinds.get(w) == "stance" for w in parse.act):
            return Belief(
                "stance",
                stance.confidence,
                _says(stance.why) if " names " not in stance.why else stance.why,
            )
        if any(p.meaning == "other" for p in find_phrases(parse.words, self._kinds)):
            return None  # walking, fighting: none of the four
        said = [p for p in find_phrases(parse.act, self._kinds) if p.meaning in ("gesture", "fidget")]
        if said:
            best = max(said, key=lambda p: (p.end - p.start, -p.start))
            if any(p.meaning != best.meaning and p.end - p.start == best.end - best.start for p in said):
                return Belief(cast("Kind", best.meaning), 0.55, _says(*(p.text for p in said)))
            sure = EXPLICIT if parse.own else 0.93
            if self._everywhere.issuperset(best.text.split()):
                sure = ALL_ALIKE
            return Belief(cast("Kind", best.meaning), sure, _says(best.text))
        if (
            stance and parse.own and any(len(w) > 2 for w in parse.act)
        ):  # shorter ones are directions: "head_dl"
            idle = "idle" in (stance.words[0] if len(stance.words) == 1 else "", self._before(parse))
            idle = idle and not self._stances.common(stance)
            reason = phrase(
                "name adds '{words}' to the stance \"{stance}\"",
                words=" ".join(parse.act),
                stance=stance.text,
            )
            return Belief("fidget" if idle else "gesture", 0.55, reason)
        return None

    def _nobody_goes_there(self, parse: _Parse) -> bool:
        """Whether a name's stance, or the one its transition ends in, is none that a talker is ever in. A
        stance of fighting may be one: "sword idle".
        """
        own = parse.stance.words if parse.stance is not None and parse.own else ()
        end = (*parse.end_words, *(parse.end.words if parse.end is not None else ())) if parse.joined else ()
        return any(p.text in NEVER for words in (own, end) for p in find_phrases(words, self._kinds))

    def _before(self, parse: _Parse) -> str:
        """Return the word before what is done: acts of an "idle" are fidgets."""
        at = parse.words.index(parse.act[0])
        return parse.words[at - 1] if at else ""

    def _stance(self, parse: _Parse, kind: Belief[Kind] | None) -> Belief[str] | None:
        learned = self._recalled(parse, "stance")
        if learned is not None:
            return learned
        if parse.stance and parse.own:
            words = " ".join(parse.words[parse.at : parse.at + parse.own])
            begins = (
                phrase('name says that it comes from "{stance}"', stance=parse.stance.text)
                if parse.joined
                else phrase("name has '{words}'", words=words)
                if parse.at
                else phrase("name begins with '{words}'", words=words)
            )
            sure = min(0.85 if parse.at else 0.97, parse.stance.confidence + 0.05)
            return Belief(parse.stance.text, sure, begins)
        if parse.stance:
            joins = phrase("name says '{words}', which starts from this stance", words=parse.joined)
            return Belief(self._called(parse.stance), 0.8, joins)
        usual = self._stances.usual()
        if kind is None or kind.value in ("stance", "transition") or usual is None:
            return None
        return Belief(
            self._called(usual[0]),
            usual[1],
            phrase("name mentions no other stance, and '{words}' is the default one", words=usual[0].text),
        )

    def _end_stance(self, parse: _Parse) -> Belief[str] | None:
        if not parse.joined:
            return None
        learned = self._recalled(parse, "end_stance")
        if learned is not None:
            return learned
        reason = _says(parse.joined)
        if parse.end is not None:
            return Belief(self._called(parse.end), parse.end_confidence, reason)
        return Belief(label(parse.end_words), parse.end_confidence, reason) if parse.end_words else None

    def _called(self, stance: FoundStance) -> str:
        """Return a stance's name, as the user corrected it where that happened."""
        found = recall_correction(self._patterns, "stance", as_written(drop_numbers(stance.words)))
        return found[0] if found else stance.text

    def _layer(self, parse: _Parse, kind: Belief[Kind] | None) -> Belief[Layer] | None:
        learned = self._recalled(parse, "layer")
        if learned is not None:
            return cast("Belief[Layer]", learned)
        layers = self._patterns.meanings["layers"]
        stood = parse.stance.words if parse.stance and parse.own else ()
        from_stance = next(iter(find_phrases(stood, layers)), None)
        from_act = self._told(parse.act, layers)
        if from_stance and (from_stance.meaning != "body" or from_stance.text == "body"):
            return _layer(from_stance, 0.95 if len(stood) > 1 else 0.85)
        if from_act:
            if from_stance and from_act.meaning != "body":
                return _layer(from_act, 0.65)
            return _layer(from_act, 0.85)
        side = next(iter(find_phrases(parse.act, self._patterns.meanings["limbs"])), None)
        if side and not (kind and kind.value == "stance"):
            return Belief("arms", 0.8, phrase("name says '{words}', which is a hand", words=side.text))
        if from_stance:  # what is done there may well be another layer's
            still = parse.joined or (kind and kind.value == "stance")
            return _layer(from_stance, (0.95 if len(stood) > 1 else 0.85) if still else 0.45)
        about = parse.end.words if parse.end else parse.end_words
        from_words = self._told((*about, *parse.words), layers)
        return _layer(from_words, 0.8 if about else 0.7) if from_words else None

    def _told(self, words: Words, table: Mapping[str, str]) -> FoundPhrase | None:
        """Return the longest phrase of a table in the words, the first of equal ones."""
        return max(find_phrases(words, table), key=lambda p: (p.end - p.start, -p.start), default=None)

    def _limb(self, parse: _Parse) -> Belief[Limb] | None:
        if parse.joined:
            return None
        limbs = self._patterns.meanings["limbs"]
        said = find_phrases(parse.act, limbs)
        sides = [p for p in said if len(p.text) <= 5 or " " in p.text]
        learned = self._recalled(parse, "limb")
        if learned is not None and (
            not sides
            or learned.reason.startswith((f"'{' '.join(parse.act)}'", *(f"'{p.text}'" for p in sides)))
        ):
            return cast("Belief[Limb]", learned)
        if not said:
            return None
        explicit = [p for p in said if p.text not in ("hands", "arms", "palms", "shrug", "clap")]
        chosen = (explicit or said)[-1]
        other = {p.meaning for p in explicit} - {chosen.meaning}
        if other == {"left"} or other == {"right"}:
            short = [p for p in explicit if len(p.text) < 4]  # "PointRight_L": the hand, not where it points
            if len(short) == 1:
                return Belief(cast("Limb", short[0].meaning), 0.75, _says(short[0].text))
            return Belief("both", 0.5, _says(*(p.text for p in explicit)))
        sure = 0.75 if chosen not in explicit else 0.85 if len(chosen.text) == 1 else 0.95
        return Belief(cast("Limb", chosen.meaning), sure, _says(chosen.text))

    def _tags(self, parse: _Parse) -> Belief[tuple[str, ...]] | None:
        learned = self._recalled(parse, "tags")
        if learned is not None:
            return Belief(tuple(learned.value.split()), learned.confidence, learned.reason)
        said = find_phrases(parse.act, self._patterns.meanings["tags"]) if not parse.joined else []
        if not said:
            return None
        tags = tuple(dict.fromkeys(t for p in said for t in p.meaning.split()))
        return Belief(tags, 0.8, _says(*(p.text for p in said)))

    def _number(self, words: Words) -> Belief[int] | None:
        if not words or not is_number_word(words[-1]) or len(words[-1]) > 9:
            return None
        return Belief(int(words[-1]), 0.95, phrase("name ends in '{words}'", words=str(words[-1])))


def _layer(said: FoundPhrase, confidence: float) -> Belief[Layer]:
    return Belief(cast("Layer", said.meaning), confidence, _says(said.text))


def _says(*texts: str) -> str:
    """Return that a name says some words."""
    first, *more = (phrase("'{words}'", words=str(text)) for text in dict.fromkeys(texts))
    for other in more:
        first = phrase("{one} and {other}", one=first, other=other)
    return phrase("name says {quoted}", quoted=first)
