"""Gestures that go with words, from the words alone: lexicons as files, and text as it comes in.

Which gestures words propose is decided in `word_gestures`, which every runtime that has it shares. The words
of the lexicons are ours.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.graph.model import Layer
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import read_aloud
from metagraph.playback.planning.hashing import Bits
from metagraph.speech import word_gestures
from metagraph.speech.language_detection import detect_language
from metagraph.speech.language_packs import list_language_packs
from metagraph.speech.spoken_text import SpokenPart, SpokenText
from metagraph.speech.word_gestures import (
    GestureRule,
    GestureWords,
    ProposedGesture,
    TextWord,
    ToldWord,
    gesture_asks,
    proposed_for,
    sentence_end,
    telling,
)

START = 0.35  # seconds before a sentence begins, so that a hand can be where its first stroke needs it
BETWEEN = 0.25  # seconds between two sentences
HEARD = 2000  # letters of what was said last that tell the language
LARGEST_FILE = 1 << 20  # bytes of a lexicon


class _Rule(Struct, frozen=True, forbid_unknown_fields=True):
    """A `GestureRule` as files have it."""

    words: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    head: Literal["nod", "shake"] | None = None
    strength: float = 1.0

    def read(self) -> GestureRule:
        return GestureRule(self.words, self.tags, self.head or "", self.strength)


class _Words(Struct, frozen=True, forbid_unknown_fields=True):
    """`GestureWords` as files have them."""

    rules: tuple[_Rule, ...]
    language: str = "en"
    question: _Rule = _Rule()
    exclamation: _Rule = _Rule()
    clause: _Rule = _Rule()

    def read(self) -> GestureWords:
        rules = tuple(rule.read() for rule in self.rules)
        ends = self.question.read(), self.exclamation.read(), self.clause.read()
        return GestureWords(rules, self.language, *ends)


def read_gesture_words(path: str | Path) -> GestureWords:
    """Read a lexicon. Raises FileError."""
    try:
        return msgspec.json.decode(read_file(path, LARGEST_FILE), type=_Words).read()
    except msgspec.MsgspecError as error:
        raise FileError(
            path,
            f"it is no lexicon of gestures ({error})",
            "its content",
            "See docs/agents/text-to-gestures.md.",
        ) from None


@cache
def load_gesture_words(language: str = "en") -> GestureWords:
    """Return the lexicon that comes along for a language, English if there is none."""
    file = _files().get(language)
    return msgspec.json.decode((file or _files()["en"]).read_bytes(), type=_Words).read()


def find_gesture_words(text: str) -> GestureWords:
    """Return the lexicon of the language a text is in, as far as its words tell; else the English one."""
    packs = list_language_packs()
    spoken = detect_language(
        text.split(), [packs[code] for code in list_lexicon_languages() if code in packs]
    )
    return load_gesture_words(spoken.language.code if spoken.language is not None else "en")


def list_lexicon_languages() -> tuple[str, ...]:
    """Return the languages a lexicon comes along for."""
    return tuple(_files())


def _files() -> dict[str, Any]:
    place = resources.files("metagraph.speech") / "gesture_words"
    return {f.name.removesuffix(".json"): f for f in sorted(place.iterdir(), key=lambda f: f.name)}


def timed_words(
    text: str, told: Sequence[tuple[str, float, float]] = (), seconds: float | None = None
) -> list[TextWord]:
    """Return a text's words with their times: as a synthesiser told them, else as long as lips would take.

    told: word, start and end, seconds; they are matched to the text in order. seconds: how long all of it
    takes, where that alone is known.
    """
    times = [ToldWord(float(start), float(end)) for _, start, end in told]
    return word_gestures.words_of(ALPHABET, text, times, seconds)


def propose_gestures(
    words: Sequence[TextWord],
    tags: Mapping[Layer, Collection[str]],
    lexicon: GestureWords | None = None,
    seed: int = 0,
) -> list[ProposedGesture]:
    """Return the gestures that go with words, in order, none in another's way.

    tags: which a character's gestures have, by layer; what it has none for is not proposed.
    """
    known = lexicon or load_gesture_words()
    pack = list_language_packs().get(known.language)
    small = {word.plain for word in words if pack is not None and pack.is_small(word.plain)}
    return proposed_for(words, set(tags.get("arms", ())), bool(tags.get("head")), known, small, Bits(seed))


def make_gesture_requests(
    every: Sequence[ProposedGesture], at: float, ident: str, first: int = 0
) -> list[dict[str, Any]]:
    """Return gestures as requests for a text that begins at `at` seconds of the session. Those that could not
    be in time are refused rather than made late. ident: of the text, with which they are taken back, too.
    first: the number of the first of them.
    """
    out: list[dict[str, Any]] = []
    for n, ask in enumerate(gesture_asks(every, at), first):
        request: dict[str, Any] = {"do": ask.do, "id": f"{ident}/{n}", "late": round(ask.late, 3)}
        if ask.stroke is not None:
            stroke = round(ask.stroke, 3)
            request |= {"layer": ask.layer, "tags": list(ask.tags), "at": ask.at, "stroke": stroke}
        else:
            request |= {"at": round(ask.at, 3)}
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
        """tags, lexicon, seed: as for `proposed`, but without a lexicon that of the language is taken in
        which the text goes on. name: what ids begin with.
        """
        self.tags, self.lexicon, self.seed, self.name = tags, lexicon, seed, name
        self._heard = ""
        self.free = 0.0  # seconds of the session, from which on nothing is said yet
        self._spoken = SpokenText()
        self._text = ""
        self._count = 0

    def take(self, piece: str, now: float, over: bool = False) -> list[dict[str, Any]]:
        """Take in what comes next at `now` seconds of the session; return requests for the sentences that are
        whole. over: whether the text ends here.
        """
        out: list[dict[str, Any]] = []
        parts = self._spoken.take(piece, over)
        for n, part in enumerate(parts or [SpokenPart("")]):
            self._text += part.text
            ends = part.pause > 0 or (over and n >= len(parts) - 1)
            while (end := sentence_end(ALPHABET, self._text, ends)) > 0:
                said, self._text = self._text[:end].strip(), self._text[end:]
                if telling(ALPHABET, said):
                    out += self._said(said, now)
            if part.pause > 0:
                self.free = max(self.free, now + START) + part.pause
        return out

    def interrupt(self) -> dict[str, Any]:
        """Forget what came in and is not said yet; return the request that breaks off what is said. What is
        taken in next is said at once.
        """
        self._text, self._spoken, self.free = "", SpokenText(), 0.0
        return {"do": "interrupt"}

    @property
    def left_out(self) -> tuple[str, ...]:
        """What of the text so far was not said: thinking, code, addresses, pictures."""
        return tuple(self._spoken.left_out)

    def _said(self, text: str, now: float) -> list[dict[str, Any]]:
        self._count += 1
        ident, start = f"{self.name}{self._count}", max(self.free, now + START)
        words = timed_words(text)
        self.free = start + float(read_aloud(ALPHABET, text)) + BETWEEN
        self._heard = f"{self._heard} {text}"[-HEARD:]
        known = self.lexicon or find_gesture_words(self._heard)
        made = propose_gestures(words, self.tags, known, self.seed + self._count)
        return [
            {"do": "say", "id": ident, "text": text, "at": round(start, 3)},
            *make_gesture_requests(made, start, ident),
        ]
