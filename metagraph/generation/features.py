"""What is heard, frame by frame: mels of both voices, and who speaks. Of a whole recording, or as it comes
in; both are the same to the bit, since every frame is computed by itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.loudness import compute_gain
from metagraph.generation.networks import ACTIVITY, FPS
from metagraph.generation.poses import Standardisation
from metagraph.graph.conversation.model import Conversation, list_other_sides
from metagraph.speech.activity import find_activity as spoken
from metagraph.speech.pitch import measure_pitch
from metagraph.speech.sound import analyse_sound
from metagraph.speech.soundtrack import resample_sound

Array = NDArray[Any]

RATE = 16000  # samples a second
HOP, WINDOW = 640, 1024  # samples: 40 ms, a frame; 64 ms
MELS = 27
FLOOR = 1e-5  # of a mel's power
AT_ONCE = 64  # windows: few enough to stay near at hand in memory
STRANGEST = 4.0  # standardised: sounds further from those learned from are heard as this far
CLOSED = 0.2  # seconds: shorter gaps in somebody's speech are none
SELF, PARTNER, BOTH, NONE = range(ACTIVITY)


class FeatureError(ValueError):
    """What cannot be heard; the message says why."""


def as_heard(features: Array, audio: Standardisation) -> Array:
    """Return features `[..., A + 4]` as networks hear them, float32: audio standardised and at most
    STRANGEST, so that a voice or a room that was never learned from is a strange one and not nonsense;
    activity as it is.
    """
    sound = np.clip(audio.apply(features[..., :-ACTIVITY]), -STRANGEST, STRANGEST)
    return np.concatenate([sound, features[..., -ACTIVITY:]], -1).astype(np.float32)


def count_sound_frames(samples: int) -> int:
    """Return how many frames so many samples at RATE have: one every HOP, the first at the first sample."""
    return samples // HOP + 1 if samples else 0


@lru_cache(maxsize=1)
def _bank() -> Array:
    """Return what each mel takes of each frequency `[MELS, WINDOW // 2 + 1]`: triangles, evenly wide in mels
    (Slaney's scale: even below 1 kHz, then logarithmic), each with the same area.
    """
    step = np.log(6.4) / 27

    def to_mel(hertz: float) -> float:
        return 3 * hertz / 200 if hertz < 1000 else 15 + float(np.log(hertz / 1000)) / step

    mels = np.linspace(to_mel(0.0), to_mel(RATE / 2), MELS + 2)
    edges = np.where(mels < 15, 200 * mels / 3, 1000 * np.exp(step * (mels - 15)))
    hertz = np.fft.rfftfreq(WINDOW, 1 / RATE)
    rising = (hertz - edges[:-2, None]) / np.diff(edges)[:-1, None]
    falling = (edges[2:, None] - hertz) / np.diff(edges)[1:, None]
    bank = np.maximum(0, np.minimum(rising, falling)) * (2 / (edges[2:] - edges[:-2]))[:, None]
    bank.setflags(write=False)
    return np.asarray(bank)


@lru_cache(maxsize=1)
def _hann() -> Array:
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(WINDOW) / WINDOW)
    window.setflags(write=False)
    return np.asarray(window)


def _mels(windows: Array) -> Array:
    """Return the mels `[n, MELS]` of windows of samples `[n, WINDOW]`, natural logarithms, float32."""
    heard = np.fft.rfft(windows * _hann())
    powers = heard.real**2 + heard.imag**2
    bank = _bank()  # frame by frame: a product of several may round otherwise than that of one
    return np.array([np.log(bank @ power + FLOOR) for power in powers], np.float32).reshape(-1, MELS)


def make_silence(audio: int = MELS) -> Array:
    """Return the frame `[audio + 4]` in which nobody is heard."""
    out = np.zeros(audio + ACTIVITY, np.float32)
    out[:audio] = np.log(FLOOR)
    out[audio + NONE] = 1
    return out


class AudioStream:
    """Mels of samples as they come in. tracks: 1 mixes the voices, 2 keeps both. gains: what brings each
    channel to the same loudness (`loudness.compute_gain`), 1 for each unless given.
    """

    def __init__(self, channels: int = 2, tracks: int = 1, gains: Sequence[float] | None = None) -> None:
        if tracks not in (1, 2) or channels < 1 or (tracks == 2 and channels != 2):
            raise FeatureError("two tracks need two channels, a voice each; else there is one track")
        self.channels, self.tracks = channels, tracks
        self.gains = np.ones(channels) if gains is None else np.asarray(gains, np.float64)
        if self.gains.shape != (channels,) or not np.isfinite(self.gains).all():
            raise FeatureError(f"{channels} channels need as many gains, finite numbers")
        self._kept = np.zeros((tracks, WINDOW // 2))  # the first frame's window begins before the sound
        self._heard = 0
        self._ended = False

    def push(self, samples: Array) -> Array:
        """Return the mels `[n, tracks * MELS]` that are ready. samples: `[C, N]` or `[N]` at RATE, about
        -1..1. Raises FeatureError.
        """
        if self._ended:
            raise FeatureError("the sound has ended already: begin a new one")
        samples = np.atleast_2d(np.asarray(samples, np.float64))
        if samples.shape[0] != self.channels:
            raise FeatureError(f"the sound has {samples.shape[0]} channels, expected {self.channels}")
        if not np.isfinite(samples).all():
            raise FeatureError("the sound holds a sample that is not a number")
        self._heard += samples.shape[1]
        self._kept = np.concatenate([self._kept, self._mixed(samples)], 1)
        return self._ready((self._kept.shape[1] - WINDOW) // HOP + 1)

    def finish(self) -> Array:
        """Return the mels `[n, tracks * MELS]` of what is left, silence after it."""
        self._ended = True
        if not self._heard:
            return np.zeros((0, self.tracks * MELS), np.float32)
        left = (self._kept.shape[1] - WINDOW // 2) // HOP + 1
        self._kept = np.pad(self._kept, ((0, 0), (0, WINDOW)))
        return self._ready(left)

    def _mixed(self, samples: Array) -> Array:
        # One channel after the other: a sum over channels at once may be ordered by their length.
        if self.tracks == 2:
            return np.stack([samples[c] * self.gains[c] for c in range(2)])
        out = samples[0] * self.gains[0]
        for c in range(1, self.channels):
            out = out + samples[c] * self.gains[c]
        return np.asarray(out)[None]

    def _ready(self, count: int) -> Array:
        out = np.empty((max(0, count), self.tracks * MELS), np.float32)
        for track in range(self.tracks if len(out) else 0):
            windows = np.lib.stride_tricks.sliding_window_view(self._kept[track], WINDOW)[::HOP]
            for n in range(0, len(out), AT_ONCE):
                some = windows[n : min(n + AT_ONCE, len(out))]
                out[n : n + len(some), track * MELS : (track + 1) * MELS] = _mels(some)
        self._kept = self._kept[:, len(out) * HOP :]
        return out


class FeatureStream:
    """Audio and activity as they come in: frames `[audio + 4]` of which both are known."""

    def __init__(self, channels: int = 2, tracks: int = 1, gains: Sequence[float] | None = None) -> None:
        self.audio = AudioStream(channels, tracks, gains)
        self._mels = np.zeros((0, tracks * MELS), np.float32)
        self._activity = np.zeros((0, ACTIVITY), np.float32)

    def push(self, samples: Array, activity: Array) -> Array:
        """Return the frames `[n, audio + 4]` that are ready. samples: as for `AudioStream.push`; activity: of
        the next frames `[m, 4]`. Either may be empty. Raises FeatureError.
        """
        told = np.asarray(activity, np.float32).reshape(-1, ACTIVITY)
        if not ((told == 0) | (told == 1)).all() or (told.sum(1) != 1).any():
            raise FeatureError("activity is one of four: each row has one 1 and three 0")
        self._mels = np.concatenate([self._mels, self.audio.push(samples)])
        self._activity = np.concatenate([self._activity, told])
        return self._ready(min(len(self._mels), len(self._activity)))

    def finish(self) -> Array:
        """Return what is left, as far as there is sound; where activity was not told, nobody speaks."""
        self._mels = np.concatenate([self._mels, self.audio.finish()])
        quiet = np.tile(encode_activity(np.zeros(1, bool), np.zeros(1, bool)), (len(self._mels), 1))
        self._activity = np.concatenate([self._activity, quiet])
        return self._ready(len(self._mels))

    def _ready(self, count: int) -> Array:
        out = np.concatenate([self._mels[:count], self._activity[:count]], 1)
        self._mels, self._activity = self._mels[count:], self._activity[count:]
        return out


def compute_features(
    samples: Array, activity: Array, tracks: int = 1, gains: Sequence[float] | None = None
) -> Array:
    """Return the frames `[T, audio + 4]` of a recording at RATE, `[C, N]`: what streaming it gives. gains:
    measured where None.
    """
    samples = np.atleast_2d(np.asarray(samples, np.float64))
    if gains is None:
        gains = [compute_gain(channel, RATE) for channel in samples]
    stream = FeatureStream(len(samples), tracks, gains)
    return np.concatenate([stream.push(samples, activity), stream.finish()])


def resample_for_features(samples: Array, rate: int) -> Array:
    """Return samples `[C, N]` at RATE, float32."""
    return np.stack([resample_sound(channel, rate, RATE) for channel in np.atleast_2d(samples)])


def encode_activity(own: Array, partner: Array) -> Array:
    """Return activity `[T, 4]` float32 of who speaks `[T]`."""
    own, partner = np.asarray(own, bool), np.asarray(partner, bool)
    kinds = [own & ~partner, partner & ~own, own & partner, ~own & ~partner]
    return np.stack(kinds, 1).astype(np.float32)


def find_speaking(stretches: Iterable[tuple[float, float]], frames: int) -> Array:
    """Return in which frames `[T]` somebody speaks. stretches: start and end, seconds; gaps shorter than
    CLOSED between them count.
    """
    out = np.zeros(frames, bool)
    times = np.arange(frames) / FPS
    before: float | None = None
    for start, end in sorted(stretches):
        if before is not None and start - before < CLOSED:
            start = min(start, before)
        out |= (times >= start - 1e-9) & (times < end - 1e-9)
        before = end if before is None else max(before, end)
    return out


def compute_conversation_activity(conversation: Conversation, side: int, frames: int) -> Array:
    """Return activity `[T, 4]` of a conversation as one side lives it: all of its segments are own speech."""
    found = [
        find_speaking([(s.start, s.end) for s in conversation.sides[n].segments], frames)
        for n in (side, *list_other_sides(conversation, side))
    ]
    return encode_activity(found[0], np.any(found[1:], axis=0))  # of several, whoever answers is the partner


def detect_voice_activity(own: Array, partner: Array | None, rate: int, frames: int) -> Array:
    """Return activity `[T, 4]` by loudness alone. own, partner: samples `[N]`; without a partner nobody
    answers.
    """
    heard = [analyse_sound(np.asarray(v, np.float64), rate) for v in (own, partner) if v is not None]
    tones = [measure_pitch(np.asarray(v, np.float64), rate) for v in (own, partner) if v is not None]
    found = []
    for n in range(2):
        other = heard[1 - n] if len(heard) == 2 else None
        told = spoken(heard[n], tones[n], other) if n < len(heard) else ()
        found.append(find_speaking([(s.start, s.end) for s in told], frames))
    return encode_activity(*found)


def with_edges(frames: Array, before: int, after: int) -> Array:
    """Return frames with silence before and after them, so that every one has a whole window."""
    quiet = make_silence(frames.shape[1] - ACTIVITY)
    return np.concatenate([np.tile(quiet, (before, 1)), frames, np.tile(quiet, (after, 1))])
