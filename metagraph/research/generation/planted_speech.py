"""Two who talk, made by number: voices of our own, with what they say known to the sample. Each clause has
one stressed word, louder, higher and longer than the others; there are responses, and hesitations ("um").

No two conversations have the same voices: who learns from few follows no other. Voices differ in height, in
the size of their mouths, pace and breath, and in how they stress: some by little. Microphones differ in level
and noise, and some hear the other voice as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.features import RATE
from metagraph.graph.conversation.model import Conversation, Segment, Side, Word

Array = NDArray[Any]

SHORTEST = 10.0  # seconds of a conversation
PITCH = (85.0, 250.0)  # Hz, between which voices lie
TRACT = (0.9, 1.25)  # how much higher resonances are than a grown man's; higher voices have higher ones
PACE = (0.85, 1.2)  # how long syllables last, of what is written below
LOUDER = (1.3, 3.3)  # a stressed syllable's amplitude over the others'
HIGHER = (1.06, 1.4)  # its pitch
LONGER = (1.0, 1.9)  # its length
DRAWLED = (1.0, 1.6)  # the length of a clause's last word
LONG = 0.15  # share of other syllables that are half as long again
ACCENT = 0.85  # other words of a clause are at most this loud, a stressed one is 1
LOUD = (0.12, 0.3)  # of full scale: about the peak of a stressed syllable
CREST = 3.0  # about a peak over the root mean square
NOISE = (5e-5, 2e-3)  # of full scale, each microphone's
LEAK = (0.004, 0.08)  # of the other voice, in three of ten conversations
SYLLABLE = (0.11, 0.2)  # seconds
MOST = 12  # syllables of a clause
_VOWELS = {
    "a": (730.0, 1090.0, 2440.0),
    "e": (530.0, 1840.0, 2480.0),
    "i": (280.0, 2290.0, 3010.0),
    "o": (480.0, 850.0, 2400.0),
    "u": (310.0, 870.0, 2240.0),
}
_NASAL = (270.0, 1000.0, 2200.0)
_HISS = {"s": 6000.0, "z": 5500.0, "f": 4500.0, "v": 4000.0, "h": 1800.0}  # Hz: the middle of what hisses
_STOPS = {"b": 900.0, "p": 1000.0, "d": 3500.0, "t": 4200.0, "g": 1800.0, "k": 2000.0}  # and of what bursts
_SOFT = "lmnrw"  # what sounds on
_CONSONANTS = tuple(_HISS) + tuple(_STOPS) + tuple(_SOFT)
_RESPONSES = ("yeah", "mhm", "okay", "right", "no", "really", "wow")
_HESITATIONS = ("um", "uh", "er")


@dataclass(frozen=True, eq=False)
class PlantedSpeech:
    """A conversation and its sound: samples `[2, N]`, float32, at `features.RATE`, a side each."""

    conversation: Conversation
    samples: Array


class _Voice:
    """How somebody sounds, drawn by chance."""

    def __init__(self, chance: np.random.Generator) -> None:
        height = float(chance.uniform())
        self.chance = chance
        self.pitch = PITCH[0] * (PITCH[1] / PITCH[0]) ** height
        self.tract = float(np.interp(height + chance.uniform(-0.3, 0.3), (0, 1), TRACT))
        self.pace = float(chance.uniform(*PACE))
        self.loud = float(np.exp(chance.uniform(*np.log(LOUD))))
        self.soft = self.loud / float(chance.uniform(*LOUDER))
        self.higher = float(chance.uniform(*HIGHER))
        self.longer = float(chance.uniform(*LONGER))
        self.drawls = float(chance.uniform(*DRAWLED))
        self.falling = float(chance.uniform(0.0, 0.22))  # of the pitch, over a clause
        self.breath = float(np.exp(chance.uniform(np.log(0.01), np.log(0.2))))
        self.tilt = float(chance.uniform(-1.0, 0.6))  # of the source's spectrum, an octave: powers of two
        self.widths = np.array([90.0, 110.0, 170.0]) * float(chance.uniform(0.7, 1.6))
        self.weights = float(chance.uniform(0.4, 0.8)) ** np.arange(3)

    def voiced(self, count: int, formants: tuple[float, ...], pitch: float) -> Array:
        """Return so many samples of a vowel or of what sounds on, as loud as any other."""
        t = np.arange(count) / max(1, count)
        hertz = self.pitch * pitch * (1.05 - 0.1 * t) * (1 + 0.01 * self.chance.standard_normal())
        source = 1 - 2 * (np.cumsum(hertz) / RATE % 1)
        source += self.breath * self.chance.standard_normal(count)
        frequencies = np.fft.rfftfreq(count, 1 / RATE)
        away = (frequencies - np.array(formants)[:, None] * self.tract) / self.widths[:, None]
        shape = (self.weights[:, None] / (1 + away**2)).sum(0) + 0.01
        shape *= np.maximum(frequencies / 500, 0.1) ** self.tilt
        return _even(np.fft.irfft(np.fft.rfft(source) * shape, count))

    def hiss(self, count: int, middle: float) -> Array:
        """Return so many samples of a hiss or a burst, as loud as any other."""
        frequencies = np.fft.rfftfreq(count, 1 / RATE)
        shape = 1 / (1 + ((frequencies - middle * self.tract) / 1200) ** 2)
        return _even(np.fft.irfft(np.fft.rfft(self.chance.standard_normal(count)) * shape, count))


def _even(samples: Array) -> Array:
    """Return samples of one loudness, the peak about 1."""
    return samples / max(CREST * float(np.sqrt(np.mean(samples**2))) if len(samples) else 0.0, 1e-9)


class _Speaker:
    """What one side has said so far, and its sound."""

    def __init__(self, count: int, chance: np.random.Generator) -> None:
        self.chance = chance
        self.voice = _Voice(chance)
        self.samples = np.zeros(count)
        self.words: list[Word] = []
        self.segments: list[Segment] = []
        self.end = 0.0  # seconds

    def _add(self, at: float, samples: Array, loud: float, rise: float) -> None:
        first = round(at * RATE)
        count = min(len(samples), len(self.samples) - first)
        if count > 0:
            swell = np.sin(np.pi * (np.arange(len(samples)) + 0.5) / len(samples)) ** rise
            self.samples[first : first + count] += (loud * samples * swell)[:count]

    def _syllable(self, at: float, length: float, text: str, loud: float, pitch: float) -> None:
        """Say a consonant, if there is one, and a vowel."""
        consonant = text[0] if text[0] in _CONSONANTS else ""
        share = float(self.chance.uniform(0.2, 0.4)) if consonant else 0.0
        count = round(share * length * RATE)
        voice = self.voice
        if consonant in _HISS:
            self._add(at, voice.hiss(count, _HISS[consonant]), 0.3 * loud, 0.7)
        elif consonant in _STOPS:
            burst = count // 3
            self._add(at + (count - burst) / RATE, voice.hiss(burst, _STOPS[consonant]), 0.35 * loud, 0.5)
        elif consonant:
            self._add(at, voice.voiced(count, _NASAL, pitch), 0.5 * loud, 0.3)
        vowel = next((c for c in text if c in _VOWELS), "")
        formants = _VOWELS.get(vowel, _NASAL)
        self._add(at + count / RATE, voice.voiced(round(length * RATE) - count, formants, pitch), loud, 0.6)

    def _say(
        self, at: float, parts: list[str], lengths: list[float], loud: list[float], pitch: float
    ) -> float:
        """Say a word's syllables, and return when it ends."""
        start = at
        for text, length, amplitude in zip(parts, lengths, loud, strict=True):
            self._syllable(at, length, text, amplitude, pitch)
            at += length
        self.words.append(Word(text="".join(parts), start=round(start, 3), end=round(at, 3)))
        return at

    def clause(self, at: float) -> float:
        """Say a clause of which one word is stressed, and return when it ends."""
        chance, voice = self.chance, self.voice
        count = int(chance.integers(3, 9))
        stressed = int(chance.integers(1, count))
        start, peak = at, at
        left = MOST - count  # syllables beyond one a word
        for n in range(count):
            more = min(left, int(chance.choice(3, p=[0.6, 0.3, 0.1])))
            left -= more
            parts = [
                str(chance.choice(_CONSONANTS)) + str(chance.choice(list(_VOWELS))) for _ in range(1 + more)
            ]
            lengths = [voice.pace * float(chance.uniform(*SYLLABLE)) for _ in parts]
            loud = [min(ACCENT * voice.loud, voice.soft * float(chance.uniform(0.6, 1.25))) for _ in parts]
            pitch = 1 - voice.falling * n / count
            if n == stressed:
                strong = int(chance.integers(0, len(parts)))
                lengths[strong] = max(lengths[strong], 0.15 * voice.pace) * voice.longer
                loud[strong] = voice.loud
                peak = at + sum(lengths[:strong]) + 0.65 * lengths[strong]
                pitch *= voice.higher
            else:
                pitch *= float(chance.uniform(0.93, 1.06))
                longer = voice.drawls if n + 1 == count else 1.0
                lengths = [v * longer * (1.5 if chance.random() < LONG else 1.0) for v in lengths]
            at = self._say(at, parts, lengths, loud, pitch)
            if chance.random() < 0.08 and n + 1 < count:
                at += float(chance.uniform(0.03, 0.12))
        self._keep("clause", start, at, peak, " ".join(w.text for w in self.words[-count:]))
        return at

    def short(self, at: float, kind: str) -> float:
        """Respond or hesitate, and return when it ends."""
        chance = self.chance
        hesitation = kind == "hesitation"
        text = str(chance.choice(_HESITATIONS if hesitation else _RESPONSES))
        length = float(chance.uniform(0.35, 0.65) if hesitation else chance.uniform(0.22, 0.4))
        softest, loudest = 0.5 * self.voice.soft, 0.9 * self.voice.loud
        loud = float(np.exp(chance.uniform(np.log(softest), np.log(loudest))))
        start = at
        at = self._say(at, [text], [length], [loud], float(chance.uniform(0.8, 1.0)))
        self._keep(kind, start, at, None, text)
        return at

    def _keep(self, kind: Any, start: float, end: float, peak: float | None, text: str) -> None:
        at = None if peak is None else round(peak, 3)
        self.segments.append(Segment(kind, round(start, 3), round(end, 3), at, text))
        self.end = end


def make_planted_speech(seconds: float, seed: int, moves: int, name: str) -> PlantedSpeech:
    """Return a conversation of so many seconds. seed: of what is said; moves: of what is done with it, the
    conversation's own seed. Raises ValueError for one that is too short.
    """
    if not seconds >= SHORTEST:
        raise ValueError(f"a planted conversation lasts at least {SHORTEST:g} s, not {seconds:g}")
    chance = np.random.default_rng(seed)
    count = round(seconds * RATE)
    pair = tuple(_Speaker(count, chance) for _ in (0, 1))
    at, side = 0.6, int(chance.integers(0, 2))
    longest = 7.0  # a clause, an "um" before it and a pause
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
            at += float(chance.uniform(0.15, 0.6) if chance.random() < 0.6 else chance.uniform(0.0, 0.05))
        at = max(at, other.end + 0.1) + float(chance.choice([0.2, 0.5, 1.0, 3.0], p=[0.4, 0.3, 0.2, 0.1]))
        side = 1 - side
    samples = np.stack([s.samples for s in pair])
    if chance.random() < 0.3:
        samples = samples + float(np.exp(chance.uniform(*np.log(LEAK)))) * samples[::-1]
    quiet, loud = np.log(NOISE)
    noise = np.exp(chance.uniform(quiet, loud, (2, 1)))
    samples += noise * chance.standard_normal((2, count))
    sides = tuple(
        Side(name=f"Speaker {n + 1}", channel=n, words=tuple(s.words), segments=tuple(s.segments))
        for n, s in enumerate(pair)
    )
    conversation = Conversation(name=name, length=seconds, sides=sides, seed=moves)
    return PlantedSpeech(conversation, samples.astype(np.float32))
