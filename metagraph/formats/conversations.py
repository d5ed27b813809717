"""Conversations from files: the sound of two, and what they say, in segments a body can answer to."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.budgets import CONVERSATION_SECONDS as LONGEST
from metagraph.errors import FileError
from metagraph.formats.conversation_languages import Lists, Speaking, languages_of
from metagraph.formats.conversation_words import Told, Voice, sides_of, tell_unheard, within
from metagraph.formats.store import kept_path
from metagraph.formats.transcript_words import count
from metagraph.formats.transcripts import read_transcript
from metagraph.graph.conversation import SHORTEST, UNKNOWN, Conversation, Segment, Side
from metagraph.speech.activity import HUSH, LEAST, activity
from metagraph.speech.clauses import by_sound, peak_of, segments
from metagraph.speech.language_packs import Language
from metagraph.speech.pitch import pitch, smooth
from metagraph.speech.sound import hear, read_recording

Array = NDArray[Any]

SOUNDS = (".wav", ".flac", ".ogg", ".mp3")
RATE = 16000  # samples a second that are kept; speech has nothing above half of that
CLIPPED = 1e-4  # share of samples cut off at full scale that is worth a word
SAME = 1e-4  # of full scale: two channels that differ by less are one
UNLIKE = 0.5  # seconds two files may differ in length without a word
_SIDES = ("left", "right")


@dataclass(frozen=True)
class Read:
    """A conversation, and what there is to say about how it was read."""

    conversation: Conversation
    notes: tuple[str, ...]


@dataclass
class _Reading:
    notes: list[str] = field(default_factory=list)
    cancelled: Callable[[], bool] | None = None

    def go_on(self) -> None:
        if self.cancelled is not None and self.cancelled():
            raise CancelledError


def read_conversation(
    audio: Sequence[Path],
    transcripts: Sequence[Path] = (),
    folder: Path | None = None,
    name: str | None = None,
    cancelled: Callable[[], bool] | None = None,
    speaking: Speaking | None = None,
) -> Read:
    """Read a conversation of two.

    audio: one file with two channels, the left one side 0's; or two files, one a side; or one with both
    mixed, when a transcript names the speakers. transcripts: one for both sides, or one a side, in the sides'
    order; without any, what is loud tells clauses and pauses. folder: what paths are kept relative to, None
    for absolute ones. name: the conversation's, else the first file's. speaking: which language, and which
    words make a segment a response or a hesitation; None for what the words tell. Where a transcript holds
    segments, as our exports do, those are kept.

    Raises FileError, and CancelledError once `cancelled` says so.
    """
    if not 1 <= len(audio) <= 2:
        raise ValueError("a conversation has one or two sound files")
    if len(transcripts) > 2:
        raise ValueError("a conversation has one transcript, or one for each of the two")
    reading = _Reading(cancelled=cancelled)
    told = [(path, read_transcript(path)) for path in transcripts]
    for path, transcript in told:
        reading.notes += [f"{path.name}: {note}." for note in transcript.notes]
    voices = _voices(reading, list(audio), bool(told))
    length = max(_length(v) for v in voices)
    sides = sides_of(reading.notes, voices, told)
    speaking = speaking if speaking is not None else Speaking()
    spoken = languages_of(
        reading.notes, [_called(v, s) for v, s in zip(voices, sides, strict=True)], sides, speaking
    )
    lists = tuple(speaking.lists_for(n, spoken[n]) for n in (0, 1))
    shared = (
        0 if spoken[0] is not None or spoken[1] is None else 1
    )  # the side whose lists are the conversation's
    made = tuple(
        _side(reading, n, voices, sides[n], folder, spoken[n], lists[n], lists[n] != lists[shared])
        for n in (0, 1)
    )
    title = name or Path(audio[0]).stem
    made_of = Conversation(
        name=title[:200],
        length=max(length, SHORTEST),
        sides=made,
        responses=lists[shared][0],
        hesitations=lists[shared][1],
    )
    return Read(made_of, tuple(dict.fromkeys(reading.notes)))


# --- the sound


def _length(voice: Voice) -> float:
    """Return how long a sound is in whole milliseconds: nothing that is written down ends after it."""
    return math.floor(voice.heard.duration * 1000 + 1e-6) / 1000


def _voices(reading: _Reading, audio: list[Path], worded: bool) -> tuple[Voice, Voice]:
    """Return both sides' sound; twice the same where they share it."""
    if len(audio) == 2:
        return _two_files(reading, audio)
    path = audio[0]
    reading.go_on()
    read = read_recording(path, LONGEST, RATE)
    _tell_kind(reading, path, read.really)
    channels = len(read.samples)
    if channels > 2:
        raise FileError(
            path,
            f"has {channels} channels, a conversation of two has one for each",
            remedy="Save the two speakers' channels as one file, or as two.",
        )
    if channels == 2 and (one := _one_sounds(read.samples)) is None:
        out = []
        for n, samples in enumerate(read.samples):
            called = f"{path.name}, {_SIDES[n]} channel"
            _tell_clipped(reading, called, read.clipped[n])
            out.append(_voice(reading, path, n, called, samples, read.rate))
        return out[0], out[1]
    if channels == 2 and one is not None and one >= 0:
        silent = _SIDES[1 - one]
        reading.notes.append(
            f"{path.name}: the {silent} channel is silent. If both speak in the {_SIDES[one]} one, save that "
            "alone and add a transcript "
            "that names the speakers; else check the microphone."
        )
        pair = [
            _voice(reading, path, n, f"{path.name}, {_SIDES[n]} channel", read.samples[n], read.rate)
            for n in (0, 1)
        ]
        _tell_clipped(reading, pair[one].called, read.clipped[one])
        return pair[0], pair[1]
    hushed = float(np.abs(read.samples).max()) <= 10 ** (HUSH / 20)
    if hushed and not worded:
        raise FileError(
            path, "is silent", remedy="Check the microphone, or what was exported, and save the sound anew."
        )
    why = (
        "is silent"
        if hushed
        else "has one channel"
        if channels == 1
        else "has the same sound in both channels"
    )
    if not worded:
        raise FileError(
            path,
            f"{why}, so that nobody can tell who speaks",
            remedy="Give two channels, two files, or a transcript that names the speakers.",
        )
    _tell_clipped(reading, path.name, max(read.clipped))
    reading.notes.append(f"{path.name} {why}: both sides share it, and only the transcript tells who speaks.")
    shared = _voice(reading, path, None, path.name, read.samples.mean(0), read.rate)
    return shared, shared


def _one_sounds(samples: Array) -> int | None:
    """Return which of two channels has all the sound, -1 where both have the same, None where each has its
    own.
    """
    loud = np.abs(samples).max(1)
    if np.abs(samples[0] - samples[1]).max() < SAME * max(float(loud.max()), 1e-9):
        return -1
    least = 10 ** (HUSH / 20)
    return None if loud.min() > least or loud.max() <= least else int(loud.argmax())


def _tell_kind(reading: _Reading, path: Path, really: str) -> None:
    if really:
        reading.notes.append(
            f"{path.name} is {really} in spite of its ending; it was read as that. Other programs may refuse "
            "it: rename it."
        )


def _two_files(reading: _Reading, audio: list[Path]) -> tuple[Voice, Voice]:
    out, rates = [], []
    for path in audio:
        reading.go_on()
        read = read_recording(path, LONGEST, RATE)
        _tell_kind(reading, path, read.really)
        channels = len(read.samples)
        if channels > 1:
            reading.notes.append(
                f"{path.name} has {channels} channels; as it is one of two files, they are mixed."
            )
        _tell_clipped(reading, path.name, max(read.clipped))
        out.append(
            _voice(reading, path, None if channels > 1 else 0, path.name, read.samples.mean(0), read.rate)
        )
        rates.append(read.original)
    if rates[0] != rates[1]:
        reading.notes.append(
            f"{audio[0].name} has {rates[0]} samples a second and {audio[1].name} {rates[1]}; each is read "
            "at its own. If one runs "
            "away from the other, record both at the same rate."
        )
    lengths = [v.heard.duration for v in out]
    if abs(lengths[0] - lengths[1]) > UNLIKE:
        longer = int(lengths[1] > lengths[0])
        reading.notes.append(
            f"{audio[longer].name} lasts {lengths[longer]:.1f} s and {audio[1 - longer].name} "
            f"{lengths[1 - longer]:.1f} s; the "
            "shorter one is silent then. Check that both begin at the same moment."
        )
    return out[0], out[1]


def _voice(
    reading: _Reading, path: Path, channel: int | None, called: str, samples: Array, rate: int
) -> Voice:
    reading.go_on()
    heard = hear(samples, rate)
    reading.go_on()
    return Voice(path, channel, called, heard, pitch(samples, rate))


def _tell_clipped(reading: _Reading, called: str, clipped: float) -> None:
    if clipped > CLIPPED:
        reading.notes.append(
            f"{called}: {100 * clipped:.2g} % of the samples are cut off at full scale; loudness and pitch "
            "are less sure. Record softer."
        )


# --- one side


def _side(
    reading: _Reading,
    n: int,
    voices: Sequence[Voice],
    told: Told,
    folder: Path | None,
    language: Language | None,
    lists: Lists,
    own: bool,
) -> Side:
    """own: whether the lists are not those of the conversation."""
    reading.go_on()
    voice, other = voices[n], voices[1 - n]
    mixed = voice is other
    called = _called(voice, told)
    words = within(reading.notes, called, told, _length(voice))
    if told.segments is not None:
        found = _kept(reading, called, told.segments, voice)
    elif words or not mixed:
        partner = None if mixed else other.heard
        if language is not None:
            found = segments(words, voice.pitch, voice.heard, *lists, partner, language)
        else:
            found = by_sound(words, voice.pitch, voice.heard, partner)
    else:
        found = ()
    if not words and told.segments is None:
        _tell_wordless(reading, called, voice, None if mixed else other, found)
    elif words and not mixed and told.segments is None:
        tell_unheard(reading.notes, called, words, voice, other)
    path = kept_path(voice.path, folder)
    return Side(
        name=told.name,
        audio=path,
        channel=voice.channel,
        language="" if not (words or told.segments) else language.code if language is not None else UNKNOWN,
        responses=lists[0] if own else None,
        hesitations=lists[1] if own else None,
        words=tuple(words),
        segments=found,
    )


def _called(voice: Voice, told: Told) -> str:
    return f"{told.name} ({voice.called})" if told.name else voice.called


def _kept(reading: _Reading, called: str, given: Sequence[Segment], voice: Voice) -> tuple[Segment, ...]:
    """Return segments a file holds, as far as the sound goes; clauses that have no peak get theirs."""
    length, tones = _length(voice), smooth(voice.pitch)
    out = []
    for s in given:
        end = min(s.end, length)
        if end - s.start < SHORTEST / 2:
            continue
        peak = s.peak
        if s.kind == "clause":
            peak = peak_of(voice.pitch, tones, voice.heard, s.start, end) if peak is None else min(peak, end)
        out.append(Segment(s.kind, s.start, end, peak, s.text))
    if len(out) < len(given):
        reading.notes.append(
            f"{called}: {count(len(given) - len(out), 'segment')} left out, past the end of the sound at "
            f"{length:.1f} s."
        )
    return tuple(out)


def _tell_wordless(
    reading: _Reading, called: str, voice: Voice, other: Voice | None, found: Sequence[Segment]
) -> None:
    if other is None:
        reading.notes.append(
            f"{called}: no words are known of this side, so it says nothing. Add a transcript that names "
            "both speakers."
        )
        return
    if found:
        reading.notes.append(
            f"{called}: no words, so loudness tells: {count(len(found), 'segment')} between pauses; short "
            "sounds while the partner talks "
            "count as responses, and hesitations are not found. Add a transcript to tell them apart."
        )
        return
    level = voice.heard.level
    top, floor = float(np.percentile(level, 99.5)), float(np.percentile(level, 10))
    if top < HUSH:
        why = "it is silent. Check the microphone, or choose another channel"
    elif top - floor < LEAST:
        why = "nothing stands out of a steady noise. Check the microphone, or record closer to the speaker"
    elif activity(voice.heard, None, None):
        why = "what is heard there is the partner, or no voice. Add a transcript if somebody speaks"
    else:
        why = "no speech was found. Add a transcript if somebody speaks"
    reading.notes.append(f"{called}: {why}.")
