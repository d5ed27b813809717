"""The mouth shapes of a voice, detected from its samples as they come in, from the levels of four bands
relative to the loudest so far. The only delay is the shortest length of a shape, so every engine can analyse
the sound that it plays.

Open vowels have more energy around 800 Hz, the first formant of an open mouth, than around 300 Hz. Front
vowels have more around 2200 Hz, their second formant. Sibilants have most above 3500 Hz. The bounds are ours,
chosen by comparison with the results of `speech.sound` on whole recordings.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from metagraph.playback.life.line_timing import VisemeMark

HOP = 0.01  # seconds that are judged together
HERTZ: tuple[float, ...] = (300.0, 800.0, 2200.0, 5000.0)  # middles of the bands
QUALITY: tuple[float, ...] = (0.7, 1.0, 1.0, 0.7)  # and how narrow they are
HIGHEST = 0.42  # of the rate: bands higher than this are left out
LOUDEST = -32.0  # dB of full scale: a voice is taken to be at least as loud as this
FORGET = 3.0  # dB a second by which the loudest is forgotten
SHUT = -25.0  # dB beside the loudest: softer than this the mouth is shut
SONOROUS = -16.0  # louder than this it is open
HISSING = -33.0  # softer than this nothing hisses
HISS = 3.0  # dB by which the highest band is above the lower ones where it does
OPEN = -1.7  # dB of the second band beside the first: an open mouth, and
HALF = -5.0  # half open
FRONT_HALF = -6.0  # dB of the third band beside the second: the tongue is in front, of half open mouths
FRONT = -8.5  # and of others
LEAST = 0.03  # seconds: anything shorter is not a shape
STEP = 0.06  # seconds after which a shape that gets stronger or weaker
GROWS = 0.15  # by this much is reported again
BEHIND = 0.25  # seconds by which a piece may come late; a later one is heard when it comes


@dataclass
class StreamedVoice:
    """The state of a voice that is analysed. rate: samples a second, 8000 or more. seconds: how much of it
    was heard. missed: seconds of the line in which no sound came. The other fields are memory.
    """

    rate: float
    seconds: float = 0.0
    missed: float = 0.0
    shape: str = "sil"
    told: float = 0.0
    weight: float = 1.0
    coming: str = "sil"
    since: float = 0.0
    loudest: float = -120.0
    judged: int = 0
    inside: int = 0
    filters: list[float] = field(default_factory=list)
    memory: list[float] = field(default_factory=list)
    energy: list[float] = field(default_factory=list)

    def hear(self, samples: Sequence[float]) -> list[VisemeMark]:
        """Analyse the next samples, -1..1; return the shapes that begin in them: visemes of the set "oculus",
        at seconds from the line's start.
        """
        out: list[VisemeMark] = []
        if len(self.filters) == 0:
            self._begin()
        size = max(1, int(HOP * self.rate))
        count = len(self.energy)
        for sample in samples:
            for band in range(count):
                # A band-pass of two poles, in the transposed direct form II.
                f, m = 3 * band, 2 * band
                y = self.filters[f] * sample + self.memory[m]
                self.memory[m] = self.memory[m + 1] - self.filters[f + 1] * y
                self.memory[m + 1] = -self.filters[f] * sample - self.filters[f + 2] * y
                self.energy[band] = self.energy[band] + y * y
            self.inside += 1
            if self.inside == size and self._judge(size):
                out.append(VisemeMark(self.told + self.missed, self.shape, self.weight))
        self.seconds = (self.judged * size + self.inside) / self.rate + self.missed
        return out

    def follow(self, said: float) -> None:
        """Skip to where the line is if its sound came too late. said: seconds of the line that are over."""
        if self.seconds < said - BEHIND:
            self.missed += said - self.seconds
            self.seconds = said

    def _begin(self) -> None:
        for hertz, quality in zip(HERTZ, QUALITY, strict=True):
            if hertz <= HIGHEST * self.rate:
                turn = 2.0 * math.pi * hertz / self.rate
                wide = math.sin(turn) / (2.0 * quality)
                self.filters.append(wide / (1.0 + wide))
                self.filters.append(-2.0 * math.cos(turn) / (1.0 + wide))
                self.filters.append((1.0 - wide) / (1.0 + wide))
                self.memory.append(0.0)
                self.memory.append(0.0)
                self.energy.append(0.0)

    def _judge(self, size: int) -> bool:
        """Classify the last moment; return whether a shape begins or changes, at `told`."""
        now = self.judged * size / self.rate
        levels = [10.0 / math.log(10.0) * math.log(energy / size + 1e-12) for energy in self.energy]
        for band in range(len(self.energy)):
            self.energy[band] = 0.0
        self.inside = 0
        self.judged += 1
        voiced = max(levels[0], levels[1], levels[2])
        self.loudest = max(voiced, LOUDEST, self.loudest - FORGET * size / self.rate)
        shape = self._shape_of(levels)
        if shape != self.coming:
            self.coming = shape
            self.since = now
        weight = 1.0
        if shape != "sil" and shape != "SS" and shape != "nn":
            weight = 0.35 + 0.65 * min(1.0, max(0.0, 1.0 + (voiced - self.loudest) / -SONOROUS))
        begins = shape != self.shape and now + size / self.rate - self.since >= LEAST
        if begins or (shape == self.shape and abs(weight - self.weight) >= GROWS and now - self.told >= STEP):
            self.shape = shape
            self.told = self.since if begins else now
            self.weight = weight
            return True
        return False

    def _shape_of(self, levels: Sequence[float]) -> str:
        """Return the shape of a moment. levels: dB of the bands, without the highest band at low rates."""
        low, middle, high = levels[0], levels[1], levels[2]
        if len(levels) > 3 and levels[3] > self.loudest + HISSING and levels[3] > max(low, middle) + HISS:
            return "SS"
        loud = max(low, middle, high) - self.loudest
        if loud < SHUT:
            return "sil"
        if loud < SONOROUS:
            return "nn"
        if middle - low > OPEN:
            return "aa"
        if middle - low > HALF:
            return "E" if high - middle > FRONT_HALF else "O"
        return "I" if high - middle > FRONT else "U"
