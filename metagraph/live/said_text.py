"""Keep of the texts of `say`, whole or token by token, what is to be said."""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Sequence

import msgspec

from metagraph.common.wording import Phrase
from metagraph.graph.requests import Say
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.line_timing import measure_text, pace_text, timed_seconds
from metagraph.speech.spoken_text import SpokenPart, SpokenText, join_spoken, read_spoken

TEXTS = 1000  # utterances whose last token is remembered
PAUSE = 0.25  # seconds from which on a break is a pause, not a comma
_BLANKS = re.compile(r"\s+")


class SaidTexts:
    """What of the tokens of utterances is still to be read, by their keys."""

    def __init__(self) -> None:
        self._open: OrderedDict[str, tuple[SpokenText, str]] = OrderedDict()

    def take(self, key: str, token: str, more: bool) -> tuple[str, list[Phrase]]:
        """Return what is certain of an utterance with its next token, with the blanks around it, and what was
        left out of that. more: whether more tokens come. Marks that may go on wait for the next token.
        """
        reader, blank = self._open.pop(key, (SpokenText(words=False), ""))
        reader.left_out = []
        text = blank + "".join(
            part.text + (", " if part.pause > 0 and part.text[-1:].isalnum() else "")
            for part in reader.take(token, over=not more)
        )
        text = _BLANKS.sub(" ", text)
        if more:
            blank = text if not text.strip() else ""
            self._open[key] = reader, blank
            while len(self._open) > TEXTS:
                self._open.popitem(last=False)
            text = "" if blank else text
        return text, reader.left_out

    def read(self, key: str, ask: Say, opened: bool) -> tuple[Say, list[Phrase]]:
        """Return an ask to say a text with what of it is to be said, and what was left out. opened: whether
        more of its utterance was promised, or that is paused.
        """
        told = is_told(ask)
        if not told and (ask.more or opened or self.is_open(key)):
            text, left_out = self.take(key, ask.text, ask.more)
            return msgspec.structs.replace(ask, text=text), left_out
        self.close(key)
        parts, left_out = read_spoken(ask.text)
        pauses = not told and any(part.pause >= PAUSE for part in parts[:-1])
        words = place_words(parts) if pauses else ask.words
        return msgspec.structs.replace(ask, text=join_spoken(parts), words=words), left_out

    def is_open(self, key: str) -> bool:
        """Return whether the last token of an utterance said that more come."""
        return key in self._open

    def close(self, key: str, every: bool = False) -> str:
        """Forget the tokens of an utterance that is over; return what still waited for the next one. every:
        those of all keys that begin so.
        """
        left = []
        for known in [x for x in self._open if x == key or (every and x.startswith(key))]:
            reader, _ = self._open.pop(known)
            left += [part.text for part in reader.take("", over=True)]
        return " ".join(left).strip()


def is_told(ask: Say) -> bool:
    """Return whether a request says by more than its text what is said, or for how long."""
    return bool(ask.words or ask.characters or ask.visemes or ask.audio or ask.line or ask.duration)


def place_words(parts: Sequence[SpokenPart]) -> list[list[object]]:
    """Return the words `[text, start, end]` of a text with pauses, in seconds of its line, paced by its
    letters.
    """
    words: list[list[object]] = []
    at = 0.0
    for part in parts:
        text = part.text.strip()
        timing = pace_text(ALPHABET, text, None)
        words += [[w.text, at + w.start, at + (w.start if w.end is None else w.end)] for w in timing.words]
        at += (timed_seconds(timing, measure_text(ALPHABET, text)) if text else 0.0) + part.pause
    return words
