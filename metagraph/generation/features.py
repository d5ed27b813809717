"""What is heard, frame by frame: mels of both voices, the pitch of the louder one, which moments stand out,
and who speaks. Of a whole recording, or as it comes in; both are the same to the bit, since every frame is
computed by itself, up to the speaker's usual pitch, which is that of what came before.

A frame is `[mels, pitch, marks, activity]`: `tracks` times MELS, PITCH, MARKS and ACTIVITY numbers.

    pitch     0 or 1, whether somebody's voice is heard; how far it is from that speaker's usual pitch, in
              steps of STEP semitones, 0 without a voice
    marks     the own stress, the partner's stress: 1 at it, less the REACH frames around it; whether one
              responds; whether the partner hesitates; whether all these are known
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.loudness import compute_gain
from metagraph.generation.networks import ACTIVITY, FPS, Kind
from metagraph.generation.poses import Standardisation
from metagraph.graph.conversation.model import (
    Conversation,
    Segment,
    list_other_sides,
    list_segments_heard_by,
)
from metagraph.speech.activity import find_activity as spoken
from metagraph.speech.clauses import find_segments_by_sound
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
PITCH, MARKS = 2, 5  # numbers of a frame
TOLD = MARKS + ACTIVITY  # numbers of a frame that are not of the sound
OWN_STRESS, PARTNER_STRESS, RESPONSE, HESITATION, KNOWN = range(MARKS)
REACH = 3  # frames on both sides of a stress over which its mark fades
STEP = 3.0  # semitones
LOWEST, HIGHEST = 60, 400  # hertz of a voice
REPEATED = 0.45  # how much a voice repeats itself after a period, 1 exactly
QUIETEST = 1e-3  # deviation of samples: -60 dB of full scale
ADAPTED = 250  # frames with a voice after which a speaker's usual pitch changes no faster


class FeatureError(ValueError):
    """What cannot be heard; the message says why."""


def as_heard(features: Array, audio: Standardisation) -> Array:
    """Return features as a network hears them, `[..., A + 4]`, float32: audio standardised and at most
    STRANGEST, so that a voice or a room that was never learned from is a strange one and not nonsense;
    activity as it is. audio: of as many numbers as the network hears; one that hears mels alone is not given
    pitch and marks, and where features lack them, they are not known.
    """
    wanted, there = len(audio.mean), features.shape[-1] - ACTIVITY
    sound = features[..., : min(wanted, there)]
    if there < wanted:
        lacking = np.zeros((*features.shape[:-1], wanted - there), features.dtype)
        sound = np.concatenate([sound, lacking], -1)
    sound = np.clip(audio.apply(sound), -STRANGEST, STRANGEST)
    return np.concatenate([sound, features[..., -ACTIVITY:]], -1).astype(np.float32)


def count_audio(kind: Kind, tracks: int = 1) -> int:
    """Return how many numbers a frame a network of that kind hears beside who speaks."""
    return tracks * MELS + (PITCH + MARKS if kind == "matching" else 0)


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


@lru_cache(maxsize=1)
def _overlap() -> Array:
    """Return how much of a window is still within it at each lag `[WINDOW]`: its autocorrelation."""
    spectrum = np.fft.rfft(_hann(), 2 * WINDOW)
    out = np.fft.irfft(spectrum.real**2 + spectrum.imag**2, 2 * WINDOW)[:WINDOW]
    out = out / out[0]
    out.setflags(write=False)
    return np.asarray(out)


def _tones(windows: Array) -> Array:
    """Return the octaves over 1 Hz of the voices in windows of samples `[n, WINDOW]`, NaN without a voice:
    the shortest period that repeats nearly as well as the best one.
    """
    out = np.full(len(windows), np.nan)
    first, last = RATE // HIGHEST, RATE // LOWEST
    heard = np.fft.rfft(windows * _hann(), 2 * WINDOW)
    repeats = np.fft.irfft(heard.real**2 + heard.imag**2, 2 * WINDOW)[:, : last + 2]
    for n, row in enumerate(repeats):
        if row[0] <= (QUIETEST**2) * WINDOW * 0.375:
            continue
        even = row / (row[0] * _overlap()[: last + 2])
        best = float(even[first:last].max())
        if best < REPEATED:
            continue
        tops = (even[first:last] >= even[first - 1 : last - 1]) & (
            even[first:last] >= even[first + 1 : last + 1]
        )
        fine = np.flatnonzero(tops & (even[first:last] >= 0.9 * best))
        if len(fine):
            out[n] = np.log2(RATE / (first + fine[0]))
    return out


def make_silence(tracks: int = 1) -> Array:
    """Return the frame in which nobody is heard, and no marks are known."""
    out = np.zeros(tracks * MELS + PITCH + TOLD, np.float32)
    out[: tracks * MELS] = np.log(FLOOR)
    out[-ACTIVITY + NONE] = 1
    return out


class AudioStream:
    """Mels and pitch of samples as they come in. tracks: 1 mixes the voices, 2 keeps both. gains: what brings
    each channel to the same loudness (`loudness.compute_gain`), 1 for each unless given.
    """

    def __init__(self, channels: int = 2, tracks: int = 1, gains: Sequence[float] | None = None) -> None:
        if tracks not in (1, 2) or channels < 1 or (tracks == 2 and channels != 2):
            raise FeatureError("two tracks need two channels, a voice each; else there is one track")
        self.channels, self.tracks = channels, tracks
        self.gains = np.ones(channels) if gains is None else np.asarray(gains, np.float64)
        if self.gains.shape != (channels,) or not np.isfinite(self.gains).all():
            raise FeatureError(f"{channels} channels need as many gains, finite numbers")
        # Tracks, then channels; the first frame's window begins before the sound.
        self._kept = np.zeros((tracks + channels, WINDOW // 2))
        self._usual = np.zeros(channels)  # pitch, octaves
        self._voiced = np.zeros(channels, int)  # frames
        self._heard = 0
        self._ended = False

    def push(self, samples: Array) -> Array:
        """Return the mels and pitch `[n, tracks * MELS + PITCH]` that are ready. samples: `[C, N]` or `[N]`
        at RATE, about -1..1. Raises FeatureError.
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
        """Return the mels and pitch of what is left, silence after it."""
        self._ended = True
        if not self._heard:
            return np.zeros((0, self.tracks * MELS + PITCH), np.float32)
        left = (self._kept.shape[1] - WINDOW // 2) // HOP + 1
        self._kept = np.pad(self._kept, ((0, 0), (0, WINDOW)))
        return self._ready(left)

    def _mixed(self, samples: Array) -> Array:
        # One channel after the other: a sum over channels at once may be ordered by their length.
        each = [samples[c] * self.gains[c] for c in range(self.channels)]
        if self.tracks == 2:
            return np.stack([*each, *each])
        out = each[0]
        for c in range(1, self.channels):
            out = out + each[c]
        return np.stack([out, *each])

    def _ready(self, count: int) -> Array:
        out = np.empty((max(0, count), self.tracks * MELS + PITCH), np.float32)
        for track in range(self.tracks if len(out) else 0):
            windows = np.lib.stride_tricks.sliding_window_view(self._kept[track], WINDOW)[::HOP]
            for n in range(0, len(out), AT_ONCE):
                some = windows[n : min(n + AT_ONCE, len(out))]
                out[n : n + len(some), track * MELS : (track + 1) * MELS] = _mels(some)
        if len(out):
            out[:, -PITCH:] = self._pitches(len(out))
        self._kept = self._kept[:, len(out) * HOP :]
        return out

    def _pitches(self, count: int) -> Array:
        """Return whether the louder channel has a voice, and how far from its usual pitch `[count, 2]`."""
        tones, powers = np.empty((self.channels, count)), np.empty((self.channels, count))
        for c in range(self.channels):
            rows = np.lib.stride_tricks.sliding_window_view(self._kept[self.tracks + c], WINDOW)[::HOP]
            for n in range(0, count, AT_ONCE):
                some = rows[n : min(n + AT_ONCE, count)]
                tones[c, n : n + len(some)] = _tones(some)
                powers[c, n : n + len(some)] = [float(row @ row) for row in np.ascontiguousarray(some)]
        out = np.zeros((count, PITCH), np.float32)
        for n in range(count):
            for c in np.flatnonzero(np.isfinite(tones[:, n])).tolist():
                self._voiced[c] += 1
                part = max(1.0 / self._voiced[c], 1.0 / ADAPTED)
                self._usual[c] += part * (tones[c, n] - self._usual[c])
            louder = int(powers[:, n].argmax())
            if np.isfinite(tones[louder, n]):
                out[n] = 1.0, 12.0 / STEP * (tones[louder, n] - self._usual[louder])
        return out


class FeatureStream:
    """What is heard and told as it comes in: frames of which both are known."""

    def __init__(self, channels: int = 2, tracks: int = 1, gains: Sequence[float] | None = None) -> None:
        self.audio = AudioStream(channels, tracks, gains)
        self._sound = np.zeros((0, tracks * MELS + PITCH), np.float32)
        self._told = np.zeros((0, TOLD), np.float32)

    def push(self, samples: Array, activity: Array) -> Array:
        """Return the frames that are ready. samples: as for `AudioStream.push`; activity: of the next frames
        `[m, 4]`, or with marks before it `[m, TOLD]`. Either may be empty. Raises FeatureError.
        """
        told = np.asarray(activity, np.float32)
        told = told.reshape(-1, TOLD if told.shape[-1:] == (TOLD,) else ACTIVITY)
        who = told[:, -ACTIVITY:]
        if not ((who == 0) | (who == 1)).all() or (who.sum(1) != 1).any():
            raise FeatureError("activity is one of four: each row has one 1 and three 0")
        if not ((told >= 0) & (told <= 1)).all():
            raise FeatureError("marks are numbers from 0 to 1")
        if told.shape[1] == ACTIVITY:
            told = np.concatenate([np.zeros((len(told), MARKS), np.float32), told], 1)
        self._sound = np.concatenate([self._sound, self.audio.push(samples)])
        self._told = np.concatenate([self._told, told])
        return self._ready(min(len(self._sound), len(self._told)))

    def finish(self) -> Array:
        """Return what is left, as far as there is sound; where activity was not told, nobody speaks."""
        self._sound = np.concatenate([self._sound, self.audio.finish()])
        quiet = np.tile(make_silence()[-TOLD:], (len(self._sound), 1))
        self._told = np.concatenate([self._told, quiet])
        return self._ready(len(self._sound))

    def _ready(self, count: int) -> Array:
        out = np.concatenate([self._sound[:count], self._told[:count]], 1)
        self._sound, self._told = self._sound[count:], self._told[count:]
        return out


def compute_features(
    samples: Array, activity: Array, tracks: int = 1, gains: Sequence[float] | None = None
) -> Array:
    """Return the frames of a recording at RATE, `[C, N]`: what streaming it gives. activity: as for
    `FeatureStream.push`; gains: measured where None.
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


def compute_conversation_marks(conversation: Conversation, side: int, frames: int) -> Array:
    """Return the marks of a conversation as one side lives it `[T, MARKS]`."""
    out = np.zeros((frames, MARKS), np.float32)
    out[:, KNOWN] = 1
    heard = list_segments_heard_by(conversation, side)
    out[:, OWN_STRESS] = _mark_stresses(conversation.sides[side].segments, frames)
    for n in list_other_sides(conversation, side):
        theirs = _mark_stresses(conversation.sides[n].segments, frames)
        out[:, PARTNER_STRESS] = np.maximum(out[:, PARTNER_STRESS], theirs)
    for kind, column in (("response", RESPONSE), ("hesitation", HESITATION)):
        out[:, column] = find_speaking([(s.start, s.end) for s in heard if s.kind == kind], frames)
    return out


def _mark_stresses(segments: Iterable[Segment], frames: int) -> Array:
    """Return 1 at the stress of each clause, less around it, else 0 `[T]`."""
    out = np.zeros(frames, np.float32)
    at = np.arange(frames)
    for s in segments:
        if s.kind == "clause" and s.peak is not None:
            out = np.maximum(out, 1 - np.abs(at - s.peak * FPS) / (REACH + 1))
    return np.asarray(out, np.float32)


def tell_conversation(conversation: Conversation, side: int, frames: int) -> Array:
    """Return marks and activity `[T, TOLD]` of a conversation as one side lives it."""
    marks = compute_conversation_marks(conversation, side, frames)
    return np.concatenate([marks, compute_conversation_activity(conversation, side, frames)], 1)


def tell_by_sound(own: Array, partner: Array | None, rate: int, frames: int) -> Array:
    """Return marks and activity `[T, TOLD]` by the sound alone, as `detect_voice_activity` has it: stresses
    of clauses and short responses are found; hesitations are not.
    """
    activity = detect_voice_activity(own, partner, rate, frames)
    marks = np.zeros((frames, MARKS), np.float32)
    marks[:, KNOWN] = 1
    voices = [np.asarray(v, np.float64) for v in (own, partner) if v is not None]
    heard, tones = [analyse_sound(v, rate) for v in voices], [measure_pitch(v, rate) for v in voices]
    for n in range(len(voices)):
        other = heard[1 - n] if len(heard) == 2 else None
        found = find_segments_by_sound((), tones[n], heard[n], other)
        marks[:, PARTNER_STRESS if n else OWN_STRESS] = _mark_stresses(found, frames)
        if not n:
            answers = [(s.start, s.end) for s in found if s.kind == "response"]
            marks[:, RESPONSE] = find_speaking(answers, frames)
    return np.concatenate([marks, activity], 1)


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
    quiet = make_silence((frames.shape[1] - ACTIVITY) // MELS)
    if frames.shape[1] < len(quiet):  # of a training that began before pitch and marks were heard
        quiet = np.delete(quiet, np.s_[-TOLD - PITCH : -ACTIVITY])
    return np.concatenate([np.tile(quiet, (before, 1)), frames, np.tile(quiet, (after, 1))])
