"""Gestures that go with words, from the words alone: greetings, denial, doubt, contrast, lists, who and where
is meant, emphasis, and a beat where nothing of that is said.

After the idea of BEAT (Cassell, Vilhjalmsson and Bickmore, 2001): a text's words propose gestures by rules
and a lexicon that anybody can edit, and of those that would get in each other's way the weaker are left out.
The lexicon's words and all numbers are ours.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from metagraph.errors import FileError
from metagraph.files import read_file
from metagraph.graph.model import Layer
from metagraph.playback.choice import uniform
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import read_aloud
from metagraph.speech.language_packs import languages

APART: Mapping[Layer, float] = {"arms": 2.4, "head": 1.8}  # seconds between two strokes of a layer, at least
LATE = 0.35  # seconds that a stroke may come after its word; later than that none is made
FIRST = 1.4  # seconds into a text up to which a stroke may come late: a hand needs as long to get there
PLAIN = 0.55  # of the clauses that propose nothing, how many get a beat
LEAD = 0.1  # seconds that a stroke comes before the middle of its word's vowels
START = 0.35  # seconds before a sentence begins, so that a hand can be where its first stroke needs it
BETWEEN = 0.25  # seconds between two sentences
ENDS, PAUSES = ".?!…。？！", ",;:–—、，"
LONGEST = 20_000  # letters of a text
LARGEST_FILE = 1 << 20  # bytes of a lexicon


class GestureRule(Struct, frozen=True, forbid_unknown_fields=True):
    """What some words propose. words: small letters; several in a row for a phrase. tags: of a gesture of the
    arms, the best first; of those a character has the first counts. head: what it does at the same time.
    strength: which of two wins.
    """

    words: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    head: Literal["nod", "shake"] | None = None
    strength: float = 1.0


class GestureWords(Struct, frozen=True, forbid_unknown_fields=True):
    """A lexicon. question, exclamation: what a sentence's end proposes for its last word that is not small.
    clause: what one proposes in which no word does.
    """

    rules: tuple[GestureRule, ...]
    language: str = "en"
    question: GestureRule = GestureRule()
    exclamation: GestureRule = GestureRule()
    clause: GestureRule = GestureRule()


@dataclass(frozen=True, slots=True)
class TextWord:
    """A word of a text. start, end: seconds from where the text begins. mark: what stands behind it."""

    text: str
    start: float
    end: float
    mark: str = ""

    @property
    def plain(self) -> str:
        return self.text.lower().replace("’", "'")


@dataclass(frozen=True, slots=True)
class ProposedGesture:
    """A gesture that goes with a word. at: seconds from where the text begins, of its stroke."""

    layer: Layer
    at: float
    tags: tuple[str, ...]
    strength: float
    word: str
    do: Literal["gesture", "nod", "shake"] = "gesture"


def read_gesture_words(path: str | Path) -> GestureWords:
    """Read a lexicon. Raises FileError."""
    try:
        return msgspec.json.decode(read_file(path, LARGEST_FILE), type=GestureWords)
    except msgspec.MsgspecError as error:
        raise FileError(
            path,
            f"it is no lexicon of gestures ({error})",
            "its content",
            "See docs/live.md, 'Words to gestures'.",
        ) from None


@cache
def gesture_words(language: str = "en") -> GestureWords:
    """Return the lexicon that comes along for a language, English where there is none."""
    place = resources.files("metagraph.speech") / "gesture_words"
    file = place / f"{language}.json"
    data = (file if file.is_file() else place / "en.json").read_bytes()
    return msgspec.json.decode(data, type=GestureWords)


def words_of(
    text: str, told: Sequence[tuple[str, float, float]] = (), seconds: float | None = None
) -> list[TextWord]:
    """Return a text's words with their times: as a synthesiser told them, else as long as lips would take.

    told: word, start and end, seconds; they are matched to the text in order. seconds: how long all of it
    takes, where that alone is known.
    """
    pace = 1.0 if seconds is None or told else seconds / max(1e-3, float(read_aloud(ALPHABET, text)))
    out: list[TextWord] = []
    left = list(told)
    for word, end, mark in _split(text[:LONGEST]):
        if told:
            if not left:
                break
            _, start, stop = left.pop(0)
        else:
            stop = pace * read_aloud(ALPHABET, text[:end])
            start = max(out[-1].end if out else 0.0, stop - pace * read_aloud(ALPHABET, word))
        out.append(TextWord(word, float(start), float(stop), mark))
    return out


def _split(text: str) -> Iterator[tuple[str, int, str]]:
    """Yield words, where each ends, and the mark of an end or a pause behind it."""
    at = 0
    while at < len(text):
        if not text[at].isalnum():
            at += 1
            continue
        first = at
        while at < len(text) and (
            text[at].isalnum() or (text[at] in "'’-" and text[at + 1 : at + 2].isalnum())
        ):
            at += 1
        rest = text[at:].lstrip("\"')”»")
        yield text[first:at], at, rest[:1] if rest[:1] in ENDS + PAUSES else ""


def proposed(
    words: Sequence[TextWord],
    tags: Mapping[Layer, Collection[str]],
    lexicon: GestureWords | None = None,
    seed: int = 0,
) -> list[ProposedGesture]:
    """Return the gestures that go with words, in order, none in another's way.

    tags: which a character's gestures have, by layer; what it has none for is not proposed.
    """
    known = lexicon or gesture_words()
    small = languages().get(known.language)
    every: list[ProposedGesture] = []
    clause: list[TextWord] = []
    proposes = False
    for n, word in enumerate(words):
        clause.append(word)
        for rule, length in _fitting(known, words, n):
            last = words[n + length - 1]
            every += _of(rule, last, tags)
            proposes = True
        if not word.mark and n + 1 < len(words):
            continue
        telling = [w for w in clause if small is None or not small.is_small(w.plain)] or clause
        end = {
            "?": known.question,
            "？": known.question,
            "!": known.exclamation,
            "！": known.exclamation,
        }.get(word.mark)
        if end is not None:
            every += _of(end, telling[-1], tags)
        elif not proposes and len(clause) > 2 and uniform(seed, f"{n}/{telling[-1].plain}", "beat") < PLAIN:
            every += _of(known.clause, telling[-1], tags)
        clause, proposes = [], False
    return sorted(_apart(every), key=lambda one: one.at)


def _fitting(lexicon: GestureWords, words: Sequence[TextWord], n: int) -> Iterator[tuple[GestureRule, int]]:
    """Yield the rule with the longest phrase that begins at a word."""
    best: tuple[GestureRule, int] | None = None
    for rule in lexicon.rules:
        for phrase in rule.words:
            parts = phrase.split()
            if [w.plain for w in words[n : n + len(parts)]] != parts or (
                best is not None and len(parts) <= best[1]
            ):
                continue
            if any(w.mark for w in words[n : n + len(parts) - 1]):
                continue  # a phrase is not said over a pause
            best = rule, len(parts)
    if best is not None:
        yield best


def _of(
    rule: GestureRule, word: TextWord, tags: Mapping[Layer, Collection[str]]
) -> Iterator[ProposedGesture]:
    at = max(0.0, (word.start + word.end) / 2 - LEAD)
    fitting = next((tag for tag in rule.tags if tag in tags.get("arms", ())), None)
    if fitting is not None:
        yield ProposedGesture("arms", at, (fitting,), rule.strength, word.text)
    if rule.head is not None and tags.get("head"):
        yield ProposedGesture("head", at, (), rule.strength, word.text, rule.head)


def _apart(every: Sequence[ProposedGesture]) -> list[ProposedGesture]:
    """Leave out what is too near to something stronger of its layer; of equals the earlier stays. The same
    tag twice in a row needs more room.
    """
    kept: list[ProposedGesture] = []
    for one in sorted(every, key=lambda one: (-one.strength, one.at)):
        beside = [x for x in kept if x.layer == one.layer]
        if all(abs(x.at - one.at) >= APART[one.layer] * (1.6 if x.tags == one.tags else 1.0) for x in beside):
            kept.append(one)
    return kept


def gesture_requests(every: Sequence[ProposedGesture], at: float, ident: str) -> list[dict[str, Any]]:
    """Return gestures as requests for a text that begins at `at` seconds of the session. Those that could not
    be in time are refused rather than made late. ident: what their ids begin with.
    """
    out: list[dict[str, Any]] = []
    for n, one in enumerate(every):
        late = max(LATE, round(FIRST - one.at, 3))
        request: dict[str, Any] = {"do": one.do, "id": f"{ident}/{n}", "late": late}
        if one.do == "gesture":
            request |= {"layer": one.layer, "tags": list(one.tags), "at": at, "stroke": round(at + one.at, 3)}
        else:
            request |= {"at": round(at + max(0.0, one.at - 0.3), 3)}  # a nod's first stroke takes as long
        out.append(request)
    return out


class TextStream:
    """Text as it comes in, piece by piece, turned into requests a sentence at a time: what is said and the
    gestures that go with it, each sentence after the one before.
    """

    def __init__(
        self,
        tags: Mapping[Layer, Collection[str]],
        lexicon: GestureWords | None = None,
        seed: int = 0,
        name: str = "text",
    ) -> None:
        """tags, lexicon, seed: as for `proposed`. name: what ids begin with."""
        self.tags, self.lexicon, self.seed, self.name = tags, lexicon, seed, name
        self.free = 0.0  # seconds of the session, from which on nothing is said yet
        self._text = ""
        self._count = 0

    def take(self, piece: str, now: float, over: bool = False) -> list[dict[str, Any]]:
        """Take in what comes next at `now` seconds of the session; return requests for the sentences that are
        whole. over: whether the text ends here.
        """
        self._text += piece
        out: list[dict[str, Any]] = []
        while (end := _sentence(self._text, over)) > 0:
            said, self._text = self._text[:end].strip(), self._text[end:]
            if any(letter.isalnum() for letter in said):
                out += self._said(said, now)
        return out

    def _said(self, text: str, now: float) -> list[dict[str, Any]]:
        self._count += 1
        ident, start = f"{self.name}{self._count}", max(self.free, now + START)
        words = words_of(text)
        self.free = start + float(read_aloud(ALPHABET, text)) + BETWEEN
        made = proposed(words, self.tags, self.lexicon, self.seed + self._count)
        return [
            {"do": "say", "id": ident, "text": text, "at": round(start, 3)},
            *gesture_requests(made, start, ident),
        ]


def _sentence(text: str, over: bool) -> int:
    """Return where the first sentence of a text ends, 0 where it goes on."""
    for n, letter in enumerate(text):
        if letter == "\n" and text[:n].strip():
            return n + 1
        # An end is one once something else follows: "3." may become "3.5".
        if letter in ENDS and n + 1 < len(text) and (text[n + 1].isspace() or letter in "。？！"):
            return n + 1
    return len(text) if over and text.strip() else 0
