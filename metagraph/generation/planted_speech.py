"""Two who talk, made by number: voices of our own, with what they say known to the sample. Each clause has
one stressed word, louder, higher and longer than the others; there are responses, and hesitations ("um").
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.features import RATE
from metagraph.graph.conversation import Conversation, Segment, Side, Word

Array = NDArray[Any]

SHORTEST = 10.0  # seconds of a conversation
PITCH = (112.0, 205.0)  # Hz of the voices
TRACT = (1.0, 1.17)  # how much higher the resonances of the second voice are
LOUD, SOFT, MUMBLED = 0.30, 0.09, 0.06  # of full scale: a stressed syllable, others, "um" and responses
NOISE = 2e-4
_VOWELS = {
    "a": (730.0, 1090.0, 2440.0),
    "e": (530.0, 1840.0, 2480.0),
    "i": (280.0, 2290.0, 3010.0),
    "o": (480.0, 850.0, 2400.0),
    "u": (310.0, 870.0, 2240.0),
}
_NASAL = (270.0, 1000.0, 2200.0)
_CONSONANTS = "bdfgklmnprstvz"
_RESPONSES = ("yeah", "mhm", "okay", "right")


@dataclass(frozen=True, eq=False)
class Spoken:
    """A conversation and its sound: samples `[2, N]`, float32, at `features.RATE`, a side each."""

    conversation: Conversation
    samples: Array


class _Speaker:
    """What one side has said so far, and its sound."""

    def __init__(self, side: int, count: int, chance: np.random.Generator) -> None:
        self.side, self.chance = side, chance
        self.samples = np.zeros(count)
        self.words: list[Word] = []
        self.segments: list[Segment] = []
        self.end = 0.0  # seconds

    def _syllable(self, at: float, length: float, vowel: str, loud: float, pitch: float) -> None:
        first, count = round(at * RATE), round(length * RATE)
        count = min(count, len(self.samples) - first)
        if count <= 0:
            return
        t = np.arange(count) / max(1, count)
        hertz = PITCH[self.side] * pitch * (1.06 - 0.12 * t)
        source = 1 - 2 * (np.cumsum(hertz) / RATE % 1)
        source += 0.05 * self.chance.standard_normal(count)
        frequencies = np.fft.rfftfreq(count, 1 / RATE)
        shape = np.zeros(len(frequencies))
        formants = _VOWELS.get(vowel, _NASAL)
        for n, (formant, width) in enumerate(zip(formants, (90.0, 110.0, 170.0), strict=True)):
            away = (frequencies - formant * TRACT[self.side]) / width
            shape += 0.6**n / (1 + away**2)
        voiced = np.fft.irfft(np.fft.rfft(source) * (shape + 0.01), count)
        voiced *= np.sin(np.pi * t) ** 0.7
        self.samples[first : first + count] += loud * voiced / max(float(np.abs(voiced).max()), 1e-9)

    def _say(self, at: float, text: str, length: float, loud: float, pitch: float) -> float:
        """Say a word, and return when it ends."""
        vowels = [c for c in text if c in _VOWELS] or ["m"]
        each = length / len(vowels)
        for n, vowel in enumerate(vowels):
            self._syllable(at + n * each, each, vowel, loud, pitch)
        end = at + length
        self.words.append(Word(text=text, start=round(at, 3), end=round(end, 3)))
        return end

    def clause(self, at: float) -> float:
        """Say a clause of which one word is stressed, and return when it ends."""
        count = int(self.chance.integers(4, 9))
        stressed = int(self.chance.integers(2, count))
        start, peak = at, at
        for n in range(count):
            text = str(self.chance.choice(list(_CONSONANTS))) + str(self.chance.choice(list(_VOWELS)))
            if n == stressed:
                length = float(self.chance.uniform(0.28, 0.4))
                peak = at + length / 2
                at = self._say(at, text, length, LOUD, 1.35)
            else:
                length = float(self.chance.uniform(0.13, 0.22))
                loud = SOFT * float(self.chance.uniform(0.7, 1.2))
                at = self._say(at, text, length, loud, float(self.chance.uniform(0.92, 1.05)))
        self._keep("clause", start, at, peak, " ".join(w.text for w in self.words[-count:]))
        return at

    def short(self, at: float, kind: str) -> float:
        """Respond or hesitate, and return when it ends."""
        text = "um" if kind == "hesitation" else str(self.chance.choice(list(_RESPONSES)))
        length = float(self.chance.uniform(0.4, 0.65) if text == "um" else self.chance.uniform(0.25, 0.4))
        start = at
        at = self._say(at, text, length, MUMBLED, 0.85)
        self._keep(kind, start, at, None, text)
        return at

    def _keep(self, kind: Any, start: float, end: float, peak: float | None, text: str) -> None:
        at = None if peak is None else round(peak, 3)
        self.segments.append(Segment(kind, round(start, 3), round(end, 3), at, text))
        self.end = end


def converse(seconds: float, seed: int, moves: int, name: str) -> Spoken:
    """Return a conversation of so many seconds. seed: of what is said; moves: of what is done with it, the
    conversation's own seed. Raises ValueError for one that is too short.
    """
    if not seconds >= SHORTEST:
        raise ValueError(f"a planted conversation lasts at least {SHORTEST:g} s, not {seconds:g}")
    chance = np.random.default_rng(seed)
    count = round(seconds * RATE)
    pair = tuple(_Speaker(n, count, chance) for n in (0, 1))
    at, side = 0.6, int(chance.integers(0, 2))
    longest = 8 * 0.22 + 0.4 + 1.5  # a clause, an "um" before it and a pause
    while at + longest < seconds:
        own, other = pair[side], pair[1 - side]
        for _ in range(int(chance.integers(1, 5))):
            if at + longest >= seconds:
                break
            if chance.random() < 0.3:
                at = own.short(at, "hesitation") + float(chance.uniform(0.5, 1.0))
            at = own.clause(at)
            if chance.random() < 0.35 and at + 0.6 < seconds:
                other.short(max(at - float(chance.uniform(0.0, 0.3)), other.end + 0.05), "response")
            at += float(chance.uniform(0.15, 0.6))
        at = max(at, other.end + 0.1) + float(chance.choice([0.2, 0.5, 1.0, 3.0], p=[0.4, 0.3, 0.2, 0.1]))
        side = 1 - side
    samples = np.stack([s.samples for s in pair]) + NOISE * chance.standard_normal((2, count))
    sides = tuple(
        Side(name=f"Speaker {n + 1}", channel=n, words=tuple(s.words), segments=tuple(s.segments))
        for n, s in enumerate(pair)
    )
    conversation = Conversation(name=name, length=seconds, sides=sides, seed=moves)
    return Spoken(conversation, samples.astype(np.float32))
