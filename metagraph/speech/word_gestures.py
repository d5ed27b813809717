"""Gestures that go with words, from the words alone: greetings, denial, doubt, contrast, lists, persons and
places, emphasis, and a beat where there is none of these.

After the idea of BEAT (Cassell, Vilhjalmsson and Bickmore, 2001): a text's words propose gestures by rules
and a lexicon that anybody can edit, and the weaker ones of those that would collide are left out. A gesture
with a meaning precedes its word by more than a beat does (ter Bekke et al. 2024: its stroke by some 0.2 s).
All other numbers are ours. Times are seconds from where the text begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.graphemes import read_aloud
from metagraph.playback.planning.choice import uniform
from metagraph.playback.planning.hashing import Bits

APART: dict[str, float] = {"arms": 2.4, "head": 1.8}  # seconds between two strokes of a layer, at least
AGAIN = 1.6  # and so many times as far where both are of the same tag
LATE = 0.35  # seconds that a stroke may come after its word; later than that none is made
FIRST = 1.4  # seconds into a text up to which a stroke may come late: a hand needs as long to get there
PLAIN = 0.55  # of the clauses that propose nothing, how many get a beat
LEAD = 0.1  # seconds that a stroke comes before the middle of its word's vowels
MEANING_LEAD = 0.2  # the same of a gesture that means something
BEATS: tuple[str, ...] = ("beat", "emphasis", "explain", "open")  # tags of gestures that go with any word
NOD = 0.3  # seconds from where a nod begins to its first stroke
CLAUSE = 3  # words of a clause that gets a beat, at least
LONGEST = 20_000  # letters of a text
ENDS = ".?!…。？！"
PAUSES = ",;:–—、，"
INSIDE = "'’-"  # what a word may have in the middle
CLOSING = "\"')”»"  # what may stand between a word and the mark behind it


@dataclass(frozen=True, slots=True)
class GestureRule:
    """A gesture that some words propose. words: small letters; several in a row for a phrase. tags: of a
    gesture of the arms, the best first; the first one that the character has counts. head: its movement at
    the same time: "nod", "shake" or nothing. strength: the stronger of two rules wins.
    """

    words: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    head: str = ""
    strength: float = 1.0


@dataclass(frozen=True, slots=True)
class GestureWords:
    """A lexicon. question, exclamation: proposed at the end of a sentence, for its last content word. clause:
    proposed for a clause without other proposals.
    """

    rules: tuple[GestureRule, ...]
    language: str = "en"
    question: GestureRule = GestureRule()
    exclamation: GestureRule = GestureRule()
    clause: GestureRule = GestureRule()


@dataclass(frozen=True, slots=True)
class TextWord:
    """A word of a text. plain: in small letters. mark: the punctuation after it."""

    text: str
    plain: str
    start: float
    end: float
    mark: str = ""


@dataclass(frozen=True, slots=True)
class ToldWord:
    """A word with the times at which a synthesiser says it."""

    start: float
    end: float


@dataclass(frozen=True, slots=True)
class ProposedGesture:
    """A gesture that goes with a word. do: "gesture", "nod" or "shake". at: time of its stroke. tags: empty
    for gestures of the head.
    """

    layer: str
    at: float
    tags: tuple[str, ...]
    strength: float
    word: str
    do: str = "gesture"


@dataclass(frozen=True, slots=True)
class GestureAsk:
    """The request for a gesture. at: the earliest second of the session at which it may begin. stroke: the
    time of its stroke, None for the head. late: by how many seconds it may come late.
    """

    do: str
    layer: str
    tags: tuple[str, ...]
    at: float
    stroke: float | None
    late: float


@dataclass(frozen=True, slots=True)
class SplitWord:
    """A word, the number of letters of the text up to its end, and the mark after it."""

    text: str
    end: int
    mark: str


def words_of(
    alphabet: Alphabet, text: str, told: Sequence[ToldWord] = (), seconds: float | None = None
) -> list[TextWord]:
    """Return a text's words with their times: those of a synthesiser, else as long as lips would take.

    told: the times of the words in order; words without times are left out. seconds: how long all of it
    takes, if only that is known.
    """
    letters = alphabet.letters(text)
    pace = 1.0
    if seconds is not None and len(told) == 0:
        pace = seconds / max(1e-3, read_aloud(alphabet, text))
    out: list[TextWord] = []
    for split in _split(alphabet, letters[:LONGEST]):
        small = alphabet.letters(split.text.lower())
        plain = "".join(["'" if letter == "’" else letter for letter in small])
        if len(told) > 0:
            if len(out) == len(told):
                break
            times = told[len(out)]
            out.append(TextWord(split.text, plain, times.start, times.end, split.mark))
        else:
            stop = pace * read_aloud(alphabet, "".join(letters[: split.end]))
            before = out[len(out) - 1].end if len(out) > 0 else 0.0
            start = max(before, stop - pace * read_aloud(alphabet, split.text))
            out.append(TextWord(split.text, plain, start, stop, split.mark))
    return out


def _is_letter(alphabet: Alphabet, letter: str) -> bool:
    kind = alphabet.kind(letter)
    return kind == "syllable" or kind == "letter"


def telling(alphabet: Alphabet, letters: Sequence[str]) -> bool:
    """Return whether letters contain words, so that there is something to say."""
    return any(_is_letter(alphabet, letter) for letter in letters)


def _split(alphabet: Alphabet, letters: Sequence[str]) -> list[SplitWord]:
    out: list[SplitWord] = []
    at, count = 0, len(letters)
    while at < count:
        if not _is_letter(alphabet, letters[at]):
            at += 1
            continue
        first = at
        while at < count:
            goes_on = _is_letter(alphabet, letters[at])
            if not goes_on and letters[at] in INSIDE and at + 1 < count:
                goes_on = _is_letter(alphabet, letters[at + 1])
            if not goes_on:
                break
            at += 1
        behind = at
        while behind < count and letters[behind] in CLOSING:
            behind += 1
        mark = ""
        if behind < count and (letters[behind] in ENDS or letters[behind] in PAUSES):
            mark = letters[behind]
        out.append(SplitWord("".join(letters[first:at]), at, mark))
    return out


def proposed_for(
    words: Sequence[TextWord],
    arms: AbstractSet[str],
    head: bool,
    lexicon: GestureWords,
    small: AbstractSet[str],
    seed: Bits,
) -> list[ProposedGesture]:
    """Return the gestures that go with words, in order and without collisions.

    arms: tags of the character's gestures of the arms; others are not proposed. head: whether the head moves.
    small: words that say little by themselves.
    """
    every: list[ProposedGesture] = []
    clause: list[TextWord] = []
    proposes = False
    for n, word in enumerate(words):
        clause.append(word)
        rule, length = _fitting(lexicon, words, n)
        if length > 0:
            every.extend(_of(rule, words[n + length - 1], arms, head))
            proposes = True
        if word.mark == "" and n + 1 < len(words):
            continue
        large = [w for w in clause if w.plain not in small]
        last = large[len(large) - 1] if len(large) > 0 else clause[len(clause) - 1]
        if word.mark == "?" or word.mark == "？":
            every.extend(_of(lexicon.question, last, arms, head))
        elif word.mark == "!" or word.mark == "！":
            every.extend(_of(lexicon.exclamation, last, arms, head))
        elif not proposes and len(clause) >= CLAUSE and uniform(seed, f"{n}/{last.plain}", "beat") < PLAIN:
            every.extend(_of(lexicon.clause, last, arms, head))
        clause = []
        proposes = False
    kept = _spaced(every)
    return sorted(kept, key=lambda one: one.at)


def _fitting(lexicon: GestureWords, words: Sequence[TextWord], n: int) -> tuple[GestureRule, int]:
    """Return the rule with the longest phrase that begins at a word, and the number of its words; 0 if there
    is none.
    """
    best, longest = lexicon.clause, 0
    for rule in lexicon.rules:
        for phrase in rule.words:
            parts = phrase.split()
            if len(parts) > longest and _says(words, n, parts):
                best, longest = rule, len(parts)
    return best, longest


def _says(words: Sequence[TextWord], first: int, parts: Sequence[str]) -> bool:
    """Return whether a phrase begins at a word, without a pause inside it."""
    if first + len(parts) > len(words):
        return False
    for k, part in enumerate(parts):
        if words[first + k].plain != part or (k + 1 < len(parts) and words[first + k].mark != ""):
            return False
    return True


def _of(rule: GestureRule, word: TextWord, arms: AbstractSet[str], head: bool) -> list[ProposedGesture]:
    at = max(0.0, (word.start + word.end) / 2 - LEAD)
    out: list[ProposedGesture] = []
    for tag in rule.tags:
        if tag in arms:
            early = 0.0 if tag in BEATS else MEANING_LEAD - LEAD
            out.append(ProposedGesture("arms", max(0.0, at - early), (tag,), rule.strength, word.text))
            break
    if rule.head != "" and head:
        out.append(ProposedGesture("head", at, (), rule.strength, word.text, rule.head))
    return out


def _spaced(every: Sequence[ProposedGesture]) -> list[ProposedGesture]:
    """Leave out gestures that are too near to a stronger one of their layer; of two equal ones the earlier
    stays. The same tag twice in a row needs more room.
    """
    kept: list[ProposedGesture] = []
    for one in sorted(every, key=lambda one: (-one.strength, one.at)):
        if not any(_in_the_way(one, other) for other in kept):
            kept.append(one)
    return kept


def _in_the_way(one: ProposedGesture, other: ProposedGesture) -> bool:
    if one.layer != other.layer:
        return False
    room = APART[one.layer]
    if len(one.tags) == 0 or (len(other.tags) > 0 and one.tags[0] == other.tags[0]):
        room *= AGAIN
    return abs(one.at - other.at) < room


def gesture_asks(every: Sequence[ProposedGesture], at: float) -> list[GestureAsk]:
    """Return the requests for the gestures of a text that begins at `at` seconds of the session. Gestures
    that cannot be in time are refused, not made late.
    """
    out: list[GestureAsk] = []
    for one in every:
        late = max(LATE, FIRST - one.at)
        if one.do == "gesture":
            out.append(GestureAsk(one.do, one.layer, one.tags, at, at + one.at, late))
        else:
            out.append(GestureAsk(one.do, one.layer, (), at + max(0.0, one.at - NOD), None, late))
    return out


def sentence_end(alphabet: Alphabet, letters: Sequence[str], over: bool) -> int:
    """Return the number of letters after which the first sentence of a text ends, 0 if it goes on. over:
    whether the text is complete.
    """
    some = False
    for n, letter in enumerate(letters):
        blank = alphabet.stripped(letter) == ""
        if letter == "\n" and some:
            return n + 1
        # An end is one once something else follows: "3." may become "3.5".
        if (
            letter in ENDS
            and n + 1 < len(letters)
            and (letter in "。？！" or alphabet.stripped(letters[n + 1]) == "")
        ):
            return n + 1
        some = some or not blank
    return len(letters) if over and some else 0
