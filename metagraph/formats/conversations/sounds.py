"""The sound of a conversation's sides: channels of a file or files, and what there is to say of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CONVERSATION_SECONDS as LONGEST
from metagraph.common.wording import join_phrases, phrase
from metagraph.errors import FileError
from metagraph.formats.conversations.words import SideVoice
from metagraph.speech.activity import HUSH
from metagraph.speech.pitch import measure_pitch
from metagraph.speech.sound import analyse_sound, read_recording

Array = NDArray[Any]

RATE = 16000  # samples a second that are kept; speech has nothing above half of that
CLIPPED = 1e-4  # share of samples cut off at full scale that is worth a word
SAME = 1e-4  # of full scale: two channels that differ by less are one
UNLIKE = 0.5  # seconds two files may differ in length without a word
_SIDES = (phrase("left"), phrase("right"))
_NUMBERS = {2: phrase("two"), 3: phrase("three"), 4: phrase("four")}


@dataclass
class ConversationReading:
    """What is to be said so far, and whether somebody gave up."""

    notes: list[str] = field(default_factory=list)
    cancelled: Callable[[], bool] | None = None

    def go_on(self) -> None:
        if self.cancelled is not None and self.cancelled():
            raise CancelledError


def measure_sound_length(voice: SideVoice) -> float:
    """Return how long a sound is in whole milliseconds: nothing that is written down ends after it."""
    return math.floor(voice.heard.duration * 1000 + 1e-6) / 1000


def read_side_voices(
    reading: ConversationReading, audio: list[Path], worded: bool, most: int
) -> tuple[SideVoice, ...]:
    """Return the sound of each side; a single one if all share it, or if one speaks alone."""
    if len(audio) > 1:
        return _files(reading, audio)
    path = audio[0]
    reading.go_on()
    read = read_recording(path, LONGEST, RATE)
    _tell_kind(reading, path, read.really)
    channels = len(read.samples)
    if channels > most:
        asks = phrase("a conversation of two has one for each speaker")
        if most != 2:
            asks = phrase("a conversation has up to {most}", most=most)
        raise FileError(
            path,
            phrase("has {channels} channels, {asks}", channels=channels, asks=asks),
            remedy=phrase("Save the speakers' channels as one file, or each as its own."),
        )
    called = [
        phrase("{name}, {channel}", name=path.name, channel=_channel(n, channels)) for n in range(channels)
    ]
    sounding = _sounding(read.samples) if channels > 1 else []
    if len(sounding) > 1 or (channels == 2 and len(sounding) == 1):
        if channels == 2 and len(sounding) == 1:
            here, silent = (_SIDES[n] for n in (sounding[0], 1 - sounding[0]))
            reading.notes.append(
                phrase(
                    "{name}: the {silent} channel is silent. If both speak in the {here} one, "
                    "save only that channel and add a transcript that names the speakers. "
                    "Otherwise check the microphone.",
                    name=path.name,
                    silent=silent,
                    here=here,
                )
            )
        elif len(sounding) < channels:
            gone = join_phrases([_channel(n, channels) for n in range(channels) if n not in sounding], ", ")
            reading.notes.append(
                phrase("{name}: {gone} skipped, because nothing is heard in it.", name=path.name, gone=gone)
            )
        kept = range(channels) if channels == 2 else sounding
        for n in kept:
            _tell_clipped(reading, called[n], read.clipped[n])
        return tuple(_voice(reading, path, n, called[n], read.samples[n], read.rate) for n in kept)
    hushed = float(np.abs(read.samples).max()) <= 10 ** (HUSH / 20)
    if hushed and not worded:
        raise FileError(
            path,
            phrase("is silent"),
            remedy=phrase("Check the microphone or the export, and save the sound again."),
        )
    why = phrase(
        "has the same sound in both channels" if channels == 2 else "has one sound in all its channels"
    )
    if hushed or channels == 1:
        why = phrase("is silent" if hushed else "has one channel")
    _tell_clipped(reading, path.name, max(read.clipped))
    reading.notes.append(
        phrase(
            "{name} {why}: all sides share it, and only the transcript shows who speaks.",
            name=path.name,
            why=why,
        )
        if worded
        else phrase(
            "{name} {why}: one person speaks, and another one listens. If several speak, add a channel or a "
            "file for each, or a transcript that names them.",
            name=path.name,
            why=why,
        )
    )
    return (_voice(reading, path, None, path.name, read.samples.mean(0), read.rate),)


def _channel(n: int, channels: int) -> str:
    if channels == 2:
        return phrase("{side} channel", side=_SIDES[n])
    return phrase("channel {number}", number=n + 1)


def _sounding(samples: Array) -> list[int]:
    """Return which channels `[C, N]` have a sound of their own, all if nobody has; none where all have the
    same.
    """
    loud = np.abs(samples).max(1)
    if np.abs(samples - samples[:1]).max() < SAME * max(float(loud.max()), 1e-9):
        return []
    least = 10 ** (HUSH / 20)
    if loud.max() <= least:
        return list(range(len(samples)))
    return [n for n in range(len(samples)) if loud[n] > least]


def _tell_kind(reading: ConversationReading, path: Path, really: str) -> None:
    if really:
        reading.notes.append(
            phrase(
                "{name} is {really} despite its extension, and was read as such. Rename "
                "it: other programs may refuse it.",
                name=path.name,
                really=really,
            )
        )


def _files(reading: ConversationReading, audio: list[Path]) -> tuple[SideVoice, ...]:
    out, rates = [], []
    count = _NUMBERS.get(len(audio), len(audio))
    for path in audio:
        reading.go_on()
        read = read_recording(path, LONGEST, RATE)
        _tell_kind(reading, path, read.really)
        channels = len(read.samples)
        if channels > 1:
            reading.notes.append(
                phrase(
                    "{name} has {channels} channels. They are mixed, because it is one of {count} files.",
                    name=path.name,
                    channels=channels,
                    count=count,
                )
            )
        _tell_clipped(reading, path.name, max(read.clipped))
        out.append(
            _voice(reading, path, None if channels > 1 else 0, path.name, read.samples.mean(0), read.rate)
        )
        rates.append(read.original)
    if len(set(rates)) > 1:
        other = next(n for n, rate in enumerate(rates) if rate != rates[0])
        reading.notes.append(
            phrase(
                "{name} has {rates} samples per second and {name2} {rates2}; each is read "
                "at its own rate. If they drift apart, record both at the same rate.",
                name=audio[0].name,
                rates=rates[0],
                name2=audio[other].name,
                rates2=rates[other],
            )
        )
    lengths = [v.heard.duration for v in out]
    longest, shortest = (lengths.index(f(lengths)) for f in (max, min))
    if lengths[longest] - lengths[shortest] > UNLIKE:
        reading.notes.append(
            phrase(
                "{name} lasts {lengths:.1f} s and {name2} {lengths2:.1f} s, so the shorter "
                "one is silent at the end. Check that both begin at the same moment.",
                name=audio[longest].name,
                lengths=lengths[longest],
                name2=audio[shortest].name,
                lengths2=lengths[shortest],
            )
        )
    return tuple(out)


def _voice(
    reading: ConversationReading, path: Path, channel: int | None, called: str, samples: Array, rate: int
) -> SideVoice:
    reading.go_on()
    heard = analyse_sound(samples, rate)
    reading.go_on()
    return SideVoice(path, channel, called, heard, measure_pitch(samples, rate))


def _tell_clipped(reading: ConversationReading, called: str, clipped: float) -> None:
    if clipped > CLIPPED:
        reading.notes.append(
            phrase(
                "{called}: {value:.2g} % of the samples clip at full scale, so loudness "
                "and pitch are less reliable. Record at a lower level.",
                called=called,
                value=100 * clipped,
            )
        )
