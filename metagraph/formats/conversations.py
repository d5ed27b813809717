"""Conversations from files: the sound of two or more, and what they say, in segments a body can answer to."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, field, replace
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
from metagraph.graph.conversation import (
    EVERYBODY,
    MOST_SPEAKERS,
    SHORTEST,
    UNKNOWN,
    Conversation,
    Segment,
    Side,
)
from metagraph.playback.choice import key32
from metagraph.speech.activity import HUSH, LEAST, activity
from metagraph.speech.clauses import by_sound, peak_of, segments
from metagraph.speech.language_packs import Language
from metagraph.speech.pitch import pitch, smooth
from metagraph.speech.sound import HeardSound, hear, read_recording

Array = NDArray[Any]

SOUNDS = (".wav", ".flac", ".ogg", ".mp3")
RATE = 16000  # samples a second that are kept; speech has nothing above half of that
CLIPPED = 1e-4  # share of samples cut off at full scale that is worth a word
SAME = 1e-4  # of full scale: two channels that differ by less are one
UNLIKE = 0.5  # seconds two files may differ in length without a word
_SIDES = ("left", "right")
_NUMBERS = {2: "two", 3: "three", 4: "four"}


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
    most: int = MOST_SPEAKERS,
) -> Read:
    """Read a conversation of two or more.

    audio: one file with a channel for each side, the first one side 0's; or a file for each; or one with all
    mixed, when a transcript names the speakers. transcripts: one for all sides, or one a side, in the sides'
    order; without any, what is loud tells clauses and pauses. most: sides at most; of more who are named in a
    transcript those are left out who say least. folder: what paths are kept relative to, None
    for absolute ones. name: the conversation's, else the first file's. speaking: which language, and which
    words make a segment a response or a hesitation; None for what the words tell. Where a transcript holds
    segments, as our exports do, those are kept.

    Raises FileError, and CancelledError once `cancelled` says so.
    """
    if not 1 <= len(audio) <= most:
        raise ValueError(f"a conversation has up to {most} sound files, one for each who speaks")
    if len(transcripts) > 1 and len(audio) > 1 and len(transcripts) != len(audio):
        raise ValueError(
            f"there are {len(audio)} sounds and {len(transcripts)} transcripts: give one transcript, or one "
            "for each sound"
        )
    if len(transcripts) > most:
        raise ValueError(f"a conversation has one transcript, or one for each of up to {most} who speak")
    reading = _Reading(cancelled=cancelled)
    told = [(path, read_transcript(path)) for path in transcripts]
    for path, transcript in told:
        reading.notes += [f"{path.name}: {note}." for note in transcript.notes]
    voices = _voices(reading, list(audio), bool(told), most)
    if len(voices) > 1 and 1 < len(told) != len(voices):
        raise FileError(
            audio[0],
            f"has {len(voices)} channels, and there are {len(told)} transcripts",
            remedy="Give one transcript that names the speakers, or one for each channel.",
        )
    found = sides_of(reading.notes, voices, told, most)
    length = max(_length(v) for v, _ in found)
    sides = [one for _, one in found]
    speaking = speaking if speaking is not None else Speaking()
    spoken = languages_of(reading.notes, [_called(v, one) for v, one in found], sides, speaking)
    lists = tuple(speaking.lists_for(n, language) for n, language in enumerate(spoken))
    # the side whose lists are the conversation's
    shared = next((n for n, language in enumerate(spoken) if language is not None), 0)
    made = tuple(
        _side(reading, n, found, folder, spoken[n], lists[n], lists[n] != lists[shared])
        for n in range(len(found))
    )
    title = name or Path(audio[0]).stem
    made_of = Conversation(
        name=title[:200],
        length=max(length, SHORTEST),
        # Its own: with one seed for all, all would fidget at the same places.
        seed=key32(1, "conversation", title, f"{length:.3f}") % 1_000_000,
        sides=made,
        responses=lists[shared][0],
        hesitations=lists[shared][1],
    )
    return Read(made_of, tuple(dict.fromkeys(reading.notes)))


# --- the sound


def _length(voice: Voice) -> float:
    """Return how long a sound is in whole milliseconds: nothing that is written down ends after it."""
    return math.floor(voice.heard.duration * 1000 + 1e-6) / 1000


def _voices(reading: _Reading, audio: list[Path], worded: bool, most: int) -> tuple[Voice, ...]:
    """Return the sound of each side; a single one if all share it."""
    if len(audio) > 1:
        return _files(reading, audio)
    path = audio[0]
    reading.go_on()
    read = read_recording(path, LONGEST, RATE)
    _tell_kind(reading, path, read.really)
    channels = len(read.samples)
    if channels > most:
        asks = "a conversation of two has one for each" if most == 2 else f"a conversation has up to {most}"
        raise FileError(
            path,
            f"has {channels} channels, {asks}",
            remedy="Save the speakers' channels as one file, or as one for each.",
        )
    called = [f"{path.name}, {_channel(n, channels)}" for n in range(channels)]
    sounding = _sounding(read.samples) if channels > 1 else []
    if len(sounding) > 1 or (channels == 2 and len(sounding) == 1):
        if channels == 2 and len(sounding) == 1:
            here, silent = (_SIDES[n] for n in (sounding[0], 1 - sounding[0]))
            reading.notes.append(
                f"{path.name}: the {silent} channel is silent. If both speak in the {here} one, save that "
                "alone and add a transcript "
                "that names the speakers; else check the microphone."
            )
        elif len(sounding) < channels:
            gone = ", ".join(_channel(n, channels) for n in range(channels) if n not in sounding)
            reading.notes.append(f"{path.name}: {gone} left out, which nothing is heard in.")
        kept = range(channels) if channels == 2 else sounding
        for n in kept:
            _tell_clipped(reading, called[n], read.clipped[n])
        return tuple(_voice(reading, path, n, called[n], read.samples[n], read.rate) for n in kept)
    hushed = float(np.abs(read.samples).max()) <= 10 ** (HUSH / 20)
    if hushed and not worded:
        raise FileError(
            path, "is silent", remedy="Check the microphone, or what was exported, and save the sound anew."
        )
    same = "has the same sound in both channels" if channels == 2 else "has one sound in all its channels"
    why = "is silent" if hushed else "has one channel" if channels == 1 else same
    if not worded:
        raise FileError(
            path,
            f"{why}, so that nobody can tell who speaks",
            remedy="Give a channel or a file for each, or a transcript that names the speakers.",
        )
    _tell_clipped(reading, path.name, max(read.clipped))
    reading.notes.append(f"{path.name} {why}: all sides share it, and only the transcript tells who speaks.")
    return (_voice(reading, path, None, path.name, read.samples.mean(0), read.rate),)


def _channel(n: int, channels: int) -> str:
    return f"{_SIDES[n]} channel" if channels == 2 else f"channel {n + 1}"


def _sounding(samples: Array) -> list[int]:
    """Return which channels `[C, N]` have a sound of their own, all where nobody has; none where all have the
    same.
    """
    loud = np.abs(samples).max(1)
    if np.abs(samples - samples[:1]).max() < SAME * max(float(loud.max()), 1e-9):
        return []
    least = 10 ** (HUSH / 20)
    if loud.max() <= least:
        return list(range(len(samples)))
    return [n for n in range(len(samples)) if loud[n] > least]


def _tell_kind(reading: _Reading, path: Path, really: str) -> None:
    if really:
        reading.notes.append(
            f"{path.name} is {really} in spite of its ending; it was read as that. Other programs may refuse "
            "it: rename it."
        )


def _files(reading: _Reading, audio: list[Path]) -> tuple[Voice, ...]:
    out, rates = [], []
    count = _NUMBERS.get(len(audio), len(audio))
    for path in audio:
        reading.go_on()
        read = read_recording(path, LONGEST, RATE)
        _tell_kind(reading, path, read.really)
        channels = len(read.samples)
        if channels > 1:
            reading.notes.append(
                f"{path.name} has {channels} channels; as it is one of {count} files, they are mixed."
            )
        _tell_clipped(reading, path.name, max(read.clipped))
        out.append(
            _voice(reading, path, None if channels > 1 else 0, path.name, read.samples.mean(0), read.rate)
        )
        rates.append(read.original)
    if len(set(rates)) > 1:
        other = next(n for n, rate in enumerate(rates) if rate != rates[0])
        reading.notes.append(
            f"{audio[0].name} has {rates[0]} samples a second and {audio[other].name} {rates[other]}; each "
            "is read at its own. If one runs away from the other, record both at the same rate."
        )
    lengths = [v.heard.duration for v in out]
    longest, shortest = (lengths.index(f(lengths)) for f in (max, min))
    if lengths[longest] - lengths[shortest] > UNLIKE:
        reading.notes.append(
            f"{audio[longest].name} lasts {lengths[longest]:.1f} s and {audio[shortest].name} "
            f"{lengths[shortest]:.1f} s; the "
            "shorter one is silent then. Check that both begin at the same moment."
        )
    return tuple(out)


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
    found: Sequence[tuple[Voice, Told]],
    folder: Path | None,
    language: Language | None,
    lists: Lists,
    own: bool,
) -> Side:
    """own: whether the lists are not those of the conversation."""
    reading.go_on()
    voice, told = found[n]
    shared = any(v is voice for m, (v, _) in enumerate(found) if m != n)
    partner = _all_of([v.heard for v in dict.fromkeys(v for v, _ in found) if v is not voice])
    called = _called(voice, told)
    words = within(reading.notes, called, told, _length(voice))
    if told.segments is not None:
        segmented = _kept(reading, called, told, voice, [one.name for _, one in found])
    elif words or not shared:
        if language is not None:
            segmented = segments(words, voice.pitch, voice.heard, *lists, partner, language)
        else:
            segmented = by_sound(words, voice.pitch, voice.heard, None if shared else partner)
    else:
        segmented = ()
    if not words and told.segments is None:
        _tell_wordless(reading, called, voice, shared, segmented, len(found))
    elif words and not shared and told.segments is None:
        tell_unheard(reading.notes, called, words, voice)
    path = kept_path(voice.path, folder)
    return Side(
        name=told.name,
        audio=path,
        channel=voice.channel,
        language="" if not (words or told.segments) else language.code if language is not None else UNKNOWN,
        responses=lists[0] if own else None,
        hesitations=lists[1] if own else None,
        words=tuple(words),
        segments=segmented,
    )


def _all_of(heard: Sequence[HeardSound]) -> HeardSound | None:
    """Return what is heard of several as of one: whoever is loudest at each moment. None of nobody."""
    if len(heard) < 2:
        return heard[0] if heard else None
    longest = max(heard, key=lambda h: len(h.level))
    level = np.array(longest.level)
    for one in heard:
        level[: len(one.level)] = np.maximum(level[: len(one.level)], one.level)
    return replace(longest, level=level)


def _called(voice: Voice, told: Told) -> str:
    return f"{told.name} ({voice.called})" if told.name else voice.called


def _kept(
    reading: _Reading, called: str, told: Told, voice: Voice, names: Sequence[str]
) -> tuple[Segment, ...]:
    """Return segments a file holds, as far as the sound goes; clauses that have no peak get theirs. names: of
    the sides.
    """
    given = told.segments or ()
    sides = {n: names.index(name) for n, name in enumerate(told.names) if name in names}
    length, tones = _length(voice), smooth(voice.pitch)
    out = []
    for s in given:
        end = min(s.end, length)
        if end - s.start < SHORTEST / 2:
            continue
        peak = s.peak
        if s.kind == "clause":
            peak = peak_of(voice.pitch, tones, voice.heard, s.start, end) if peak is None else min(peak, end)
        to = s.to if s.to in (None, EVERYBODY) else sides.get(s.to)
        out.append(Segment(s.kind, s.start, end, peak, s.text, to))
    if len(out) < len(given):
        reading.notes.append(
            f"{called}: {count(len(given) - len(out), 'segment')} left out, past the end of the sound at "
            f"{length:.1f} s."
        )
    return tuple(out)


def _tell_wordless(
    reading: _Reading, called: str, voice: Voice, shared: bool, found: Sequence[Segment], sides: int
) -> None:
    if shared:
        reading.notes.append(
            f"{called}: no words are known of this side, so it says nothing. Add a transcript that names "
            f"{'both' if sides == 2 else 'all'} speakers."
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
