"""What is known of a spoken line's sound: how long it is, where it is loudest, and which mouth shapes it goes
through.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import read_aloud, spelled
from metagraph.playback.life.items import Speech, measure_line
from metagraph.playback.life.line_timing import LineTiming, timed_sounds
from metagraph.playback.life.mouth import MouthPiece, accents_of, mouth_track

__all__ = ["VISEMES", "Voice", "choose_voice", "guess_voice", "make_silent_voice"]

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Voice:
    """One line, analysed. duration: seconds. peaks: times of its loudness peaks, a syllable each `[P]`. times
    `[K]`, weights `[K, 15]`: how much of each of `VISEMES` the mouth shows, 0..1, linear between the times.
    strengths: how loud the peaks are `[P]`, 0..1; empty if that is not known. stresses: times of the stressed
    syllables `[S]`, ascending, where they are known: the peaks of pitch of a conversation's clauses.
    """

    duration: float
    peaks: Array
    times: Array
    weights: Array
    strengths: Array = field(default_factory=lambda: np.zeros(0))
    stresses: Array | None = None

    @cached_property
    def accents(self) -> Array:
        """Times of the stressed syllables `[A]`: those that are known, else as `accents_of` finds them."""
        if self.stresses is not None:
            return self.stresses
        count = len(self.peaks)
        loud = self.strengths.tolist() if len(self.strengths) == count else [1.0] * count
        return np.array(accents_of(self.peaks.tolist(), loud))


def make_silent_voice(duration: float) -> Voice:
    """Return a voice that says nothing for `duration` seconds."""
    rest = np.zeros((2, len(VISEMES)), np.float32)
    rest[:, 0] = 1
    return Voice(duration, np.zeros(0), np.array([0.0, duration]), rest)


@lru_cache(maxsize=256)
def guess_voice(text: str, duration: float | None = None) -> Voice:
    """Return a voice guessed from letters alone. duration: seconds, None for about 14 characters a second."""
    length = read_aloud(ALPHABET, text) if duration is None else max(duration, 0.0)
    said = spelled(ALPHABET, text, length)
    if not said.pieces:
        return make_silent_voice(length)
    return make_voice(said.pieces, length, np.array(said.peaks), np.array(said.strengths))


@lru_cache(maxsize=256)
def make_voice_from_timing(timing: LineTiming, duration: float) -> Voice:
    """Return the voice of a line whose words and shapes are given with their times."""
    said = timed_sounds(ALPHABET, timing)
    return make_voice(said.pieces, duration, np.array(said.peaks), np.array(said.strengths))


def choose_voice(voices: Mapping[str, Voice], speech: Speech) -> Voice:
    """Return the voice of something said: as its words and shapes were reported, as its line's was read from
    the sound, else one guessed from its text.
    """
    if speech.timing is not None:
        return make_voice_from_timing(speech.timing, measure_line(speech))
    known = voices.get(speech.line) if speech.line is not None else None
    if isinstance(known, Voice):
        return known
    return guess_voice(speech.text, max(0.0, measure_line(speech)))


def stressed(voices: Mapping[str, Voice], speech: Speech) -> list[float]:
    """Return the times of the stressed syllables of something said, ascending, seconds from its start."""
    found: list[float] = choose_voice(voices, speech).accents.tolist()
    return found


def are_same_voices(one: Mapping[str, Voice] | None, other: Mapping[str, Voice]) -> bool:
    """Return whether lines sound the same."""
    return one is other or one == other


def make_voice(pieces: Sequence[MouthPiece], duration: float, peaks: Array, strengths: Array) -> Voice:
    """Return a voice of mouth shapes in time and loudness peaks."""
    weights = np.array(mouth_track(pieces, duration), np.float32)
    return Voice(duration, peaks, np.linspace(0.0, max(duration, 1e-3), len(weights)), weights, strengths)
