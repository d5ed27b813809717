"""Conversations from files: the sound of two or more, and what they say, in segments a body can answer to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.conversations.languages import Lists, Speaking, choose_languages
from metagraph.formats.conversations.sounds import ConversationReading, measure_sound_length, read_side_voices
from metagraph.formats.conversations.words import (
    SideVoice,
    TranscribedSide,
    cut_words_to_sound,
    match_sides,
    tell_unheard,
)
from metagraph.formats.project.paths import make_path_for_project
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.formats.transcripts.source import TranscriptSound
from metagraph.formats.transcripts.words import count
from metagraph.graph.conversation.model import (
    EVERYBODY,
    MOST_SPEAKERS,
    SHORTEST,
    UNKNOWN,
    Conversation,
    Segment,
    Side,
)
from metagraph.playback.planning.choice import key32
from metagraph.speech.activity import HUSH, LEAST, find_activity
from metagraph.speech.clauses import find_segments, find_segments_by_sound, find_stress_time
from metagraph.speech.language_packs import LanguagePack
from metagraph.speech.pitch import smooth
from metagraph.speech.sound import HeardSound, read_head

Array = NDArray[Any]

SOUNDS = (".wav", ".flac", ".ogg", ".mp3")


@dataclass(frozen=True)
class Read:
    """A conversation, and what there is to say about how it was read."""

    conversation: Conversation
    notes: tuple[str, ...]


def read_conversation(
    audio: Sequence[Path],
    transcripts: Sequence[Path] = (),
    folder: Path | None = None,
    name: str | None = None,
    cancelled: Callable[[], bool] | None = None,
    speaking: Speaking | None = None,
    most: int = MOST_SPEAKERS,
) -> Read:
    """Read a conversation of two or more, or one who speaks while another listens.

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
        raise ValueError(
            phrase("a conversation has up to {most} sound files, one for each speaker", most=most)
        )
    if len(transcripts) > 1 and len(audio) > 1 and len(transcripts) != len(audio):
        raise ValueError(
            phrase(
                "there are {count} sounds and {count2} transcripts: add one transcript, or "
                "one for each sound",
                count=len(audio),
                count2=len(transcripts),
            )
        )
    if len(transcripts) > most:
        raise ValueError(
            phrase("a conversation has one transcript, or one for each of up to {most} speakers", most=most)
        )
    reading = ConversationReading(cancelled=cancelled)
    said = [
        (path, read_transcript(path, _sound_of(audio, n, len(transcripts))))
        for n, path in enumerate(transcripts)
    ]
    for path, transcript in said:
        reading.notes += [phrase("{name}: {note}.", name=path.name, note=note) for note in transcript.notes]
    voices = read_side_voices(reading, list(audio), bool(said), most)
    if len(voices) > 1 and 1 < len(said) != len(voices):
        raise FileError(
            audio[0],
            phrase(
                "has {count} channels, and there are {count2} transcripts",
                count=len(voices),
                count2=len(said),
            ),
            remedy=phrase("Add one transcript that names the speakers, or one for each channel."),
        )
    found = match_sides(reading.notes, voices, said, most)
    length = max(measure_sound_length(v) for v, _ in found)
    sides = [one for _, one in found]
    speaking = speaking if speaking is not None else Speaking()
    spoken = choose_languages(reading.notes, [_called(v, one) for v, one in found], sides, speaking)
    lists = tuple(speaking.lists_for(n, language) for n, language in enumerate(spoken))
    # the side whose lists are the conversation's
    shared = next((n for n, language in enumerate(spoken) if language is not None), 0)
    made = tuple(
        _side(reading, n, found, folder, spoken[n], lists[n], lists[n] != lists[shared])
        for n in range(len(found))
    )
    if len(made) == 1:
        made += (Side(),)  # who listens
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


def _sound_of(audio: Sequence[Path], n: int, transcripts: int) -> TranscriptSound:
    """Return what is known of the sound that a transcript is of, before it is read: of its own file where
    each has one, else of the longest.
    """
    own = [audio[n]] if len(audio) == transcripts else list(audio)
    lengths = []
    for path in own:
        with suppress(FileError):  # who reads the sound tells that
            rate, _, samples = read_head(path)
            lengths.append(samples / rate)
    return TranscriptSound(max(lengths, default=None), tuple(p.name for p in own))


def _side(
    reading: ConversationReading,
    n: int,
    found: Sequence[tuple[SideVoice, TranscribedSide]],
    folder: Path | None,
    language: LanguagePack | None,
    lists: Lists,
    own: bool,
) -> Side:
    """own: whether the lists are not those of the conversation."""
    reading.go_on()
    voice, said = found[n]
    shared = any(v is voice for m, (v, _) in enumerate(found) if m != n)
    partner = _all_of([v.heard for v in dict.fromkeys(v for v, _ in found) if v is not voice])
    called = _called(voice, said)
    words = cut_words_to_sound(reading.notes, called, said, measure_sound_length(voice))
    if said.segments is not None:
        segmented = _kept(reading, called, said, voice, [one.name for _, one in found])
    elif words or not shared:
        if language is not None:
            segmented = find_segments(words, voice.pitch, voice.heard, *lists, partner, language)
        else:
            segmented = find_segments_by_sound(words, voice.pitch, voice.heard, None if shared else partner)
    else:
        segmented = ()
    if not words and said.segments is None:
        _tell_wordless(reading, called, voice, shared, segmented, len(found))
    elif words and not shared and said.segments is None:
        tell_unheard(reading.notes, called, words, voice)
    path = make_path_for_project(voice.path, folder)
    return Side(
        name=said.name,
        audio=path,
        channel=voice.channel,
        language="" if not (words or said.segments) else language.code if language is not None else UNKNOWN,
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


def _called(voice: SideVoice, said: TranscribedSide) -> str:
    return phrase("{name} ({voice})", name=said.name, voice=voice.called) if said.name else voice.called


def _kept(
    reading: ConversationReading, called: str, said: TranscribedSide, voice: SideVoice, names: Sequence[str]
) -> tuple[Segment, ...]:
    """Return segments a file holds, as far as the sound goes; clauses that have no peak get theirs. names: of
    the sides.
    """
    given = said.segments or ()
    sides = {n: names.index(name) for n, name in enumerate(said.names) if name in names}
    length, tones = measure_sound_length(voice), smooth(voice.pitch)
    out = []
    for s in given:
        end = min(s.end, length)
        if end - s.start < SHORTEST / 2:
            continue
        peak = s.peak
        if s.kind == "clause":
            peak = (
                find_stress_time(voice.pitch, tones, voice.heard, s.start, end)
                if peak is None
                else min(peak, end)
            )
        to = s.to if s.to in (None, EVERYBODY) else sides.get(s.to)
        out.append(Segment(s.kind, s.start, end, peak, s.text, to))
    if len(out) < len(given):
        reading.notes.append(
            phrase(
                "{called}: {count} skipped, past the end of the sound at {length:.1f} s.",
                called=called,
                count=count(len(given) - len(out), "segment"),
                length=length,
            )
        )
    return tuple(out)


def _tell_wordless(
    reading: ConversationReading,
    called: str,
    voice: SideVoice,
    shared: bool,
    found: Sequence[Segment],
    sides: int,
) -> None:
    if shared:
        reading.notes.append(
            phrase(
                "{called}: this side has no words, so it says nothing. Add a transcript "
                "that names {value} speakers.",
                called=called,
                value=phrase("both" if sides == 2 else "all"),
            )
        )
        return
    if found:
        reading.notes.append(
            phrase(
                "{called}: no words, so the loudness was used: {count} between pauses. "
                "Short sounds while the partner talks count as responses, and hesitations "
                "are not found. Add a transcript to tell them apart.",
                called=called,
                count=count(len(found), "segment"),
            )
        )
        return
    level = voice.heard.level
    top, floor = float(np.percentile(level, 99.5)), float(np.percentile(level, 10))
    if top < HUSH:
        why = phrase("it is silent. Check the microphone, or choose another channel")
    elif top - floor < LEAST:
        why = phrase("the recording is a steady noise. Check the microphone, or record closer to the speaker")
    elif find_activity(voice.heard, None, None):
        why = phrase("it contains the partner, or no voice. Add a transcript if someone speaks")
    else:
        why = phrase("no speech was found. Add a transcript if someone speaks")
    reading.notes.append(phrase("{called}: {why}.", called=called, why=why))
