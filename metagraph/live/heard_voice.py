"""What a voice tells while it is heard: when somebody begins to speak and ends, and where they are stressed.

A stress is a local maximum of F0, as in `speech.pitch.find_pitch_peaks`; it is known when the voice has
fallen again, a tenth of a second later. So what answers to it comes later than the stress: only a caller that
announces it can be in time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.live.voice_detector import GOES_ON, VoiceDetector
from metagraph.speech.pitch import HIGHEST, JUMP, LOWEST, REPEATS
from metagraph.speech.yin import measure_f0_by_yin
from metagraph.synthesis.extending.speech_so_far import SpeechNews

Array = NDArray[Any]

RATE = 16_000  # samples a second, as `hear` brings them
SIZE = RATE // 25  # samples of a frame
EVERY = 2  # of the samples tell the pitch: YIN finds periods between them
PIECE = 512  # of those: two of the longest periods, and some
HOP = 0.01  # seconds between two looks at the pitch
FALLS = 1.0  # semitones by which the voice has to fall, and to have risen, about a stress
APART = 0.45  # seconds between two stresses
GAP = 0.08  # seconds without a tone after which a rise begins again
TONELESS = 0.5  # seconds of sound without a tone that are no voice any more
NEAR = 15  # tones that tell how high the voice is


class HeardVoice:
    """One voice, sample by sample. start: seconds at which its first sample is heard. speaks: now."""

    def __init__(self, start: float) -> None:
        self.start, self.heard, self.speaks = start, 0, False
        self._voice = VoiceDetector()
        self._sound = np.zeros(PIECE * EVERY, np.float32)  # what the next look at the pitch is taken of
        self._tones: list[float] = []  # semitones over 1 Hz, the last few
        self._top, self._at, self._low = (
            -np.inf,
            0.0,
            -np.inf,
        )  # the highest since the last trough, the trough
        self._last, self._toned = -np.inf, -np.inf  # when the last stress was, and the last tone
        self._loud, self._since = False, start  # whether there is sound, and since when

    @property
    def now(self) -> float:
        """Seconds up to which it was heard."""
        return self.start + self.heard / RATE

    def hear(self, samples: Array) -> list[SpeechNews]:
        """Take in a frame; return what it tells. samples: `[SIZE]`, -1..1."""
        begun, out = self.now, []
        loud = self._voice.hear(samples)
        self.heard += len(samples)
        if loud and not self._loud:
            self._since = begun
            self._top, self._low = -np.inf, -np.inf
        stresses = self._stresses(samples, begun) if loud else self._stressed(begun)
        if not loud:
            self._sound = np.concatenate([self._sound, samples])[-PIECE * EVERY :]
        # What is loud is a voice where it has a pitch: noise has none.
        voiced = loud and self._toned >= self._since - HOP and self.now - self._toned < TONELESS
        if voiced and not self.speaks:
            out.append(SpeechNews("begins", self._since))
        if self.speaks or voiced:
            out += stresses
        if self.speaks and not voiced:
            ended = self._toned if loud else self.now - GOES_ON * SIZE / RATE
            out.append(SpeechNews("ends", max(self.start, ended)))
            self._since = self.now
        self.speaks, self._loud = voiced, loud
        return out

    def _stresses(self, samples: Array, begun: float) -> list[SpeechNews]:
        """Follow the pitch through a frame that begins at a time; return the stresses that it tells."""
        sound = np.concatenate([self._sound, samples])
        self._sound = sound[-PIECE * EVERY :]
        hop = round(HOP * RATE)
        ends = np.arange(PIECE * EVERY + hop, len(sound) + 1, hop)
        if not len(ends):
            return []
        pieces = np.stack([sound[end - PIECE * EVERY : end] for end in ends]).astype(np.float64)
        frames = pieces.reshape(len(ends), PIECE, EVERY).mean(-1)
        frames -= frames.mean(1, keepdims=True)
        out: list[SpeechNews] = []
        own = RATE / EVERY
        hertz = measure_f0_by_yin(frames, own, LOWEST, HIGHEST)
        for n, end in enumerate(ends.tolist()):
            at = begun + (end - PIECE * EVERY - PIECE * EVERY / 2) / RATE
            if self._repeats(frames[n], own / hertz[n]) and hertz[n] < 0.98 * HIGHEST:
                out += self._tone(at, float(12 * np.log2(hertz[n])))
            elif at - self._toned > GAP:
                out += self._stressed(at)
        return out

    def _repeats(self, frame: Array, period: float) -> bool:
        """Return whether a frame does repeat after a period of samples."""
        shift = min(max(2, round(period)), PIECE // 2)
        one, two = frame[: PIECE - shift], frame[shift:]
        power = float(one @ one) * float(two @ two)
        return power > 1e-12 and float(one @ two) > REPEATS * power**0.5

    def _tone(self, at: float, tone: float) -> list[SpeechNews]:
        """Take in how high the voice is at a moment; return the stress that it has fallen from."""
        self._tones = [*self._tones, tone][-NEAR:]
        if abs(tone - float(np.median(self._tones))) > JUMP:  # an octave off
            return []
        self._toned = at
        if tone > self._top:
            self._top, self._at = tone, at
        fallen = self._top - tone >= FALLS
        found = self._stressed(at, tone) if fallen else []
        self._low = min(self._low, tone)
        return found

    def _stressed(self, at: float, low: float = -np.inf) -> list[SpeechNews]:
        """Return the highest moment since the last trough as a stress, where it stands out, and begin again.
        low: what the next has to rise from; after a pause it need not.
        """
        top, when, rises = self._top, self._at, self._top - self._low
        self._top, self._low = -np.inf, low
        if top == -np.inf or rises < FALLS or when - self._last < APART:
            return []
        self._last = when
        return [SpeechNews("stress", when)]
