"""Whose words a transcript's are: its speakers brought to the two sides of a conversation, by what each
side's sound tells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import msgspec
import numpy as np

from metagraph.errors import FileError
from metagraph.formats.transcript_words import Transcript, count
from metagraph.graph.conversation import SHORTEST, Segment, Word
from metagraph.speech.activity import HUSH, activity
from metagraph.speech.pitch import Pitch
from metagraph.speech.sound import HeardSound


@dataclass(frozen=True, eq=False)
class Voice:
    """One side's sound: where it is from, as it is called in notes, and what is heard there."""

    path: Path
    channel: int | None
    called: str
    heard: HeardSound
    pitch: Pitch

    @cached_property
    def top(self) -> float:
        """How loud it is at its loudest, dB."""
        return max(float(np.percentile(self.heard.level, 99)), HUSH)


@dataclass(frozen=True)
class Told:
    """What a transcript says of one side. segments: None where it says nothing of them. path: the
    transcript's, None without one.
    """

    name: str = ""
    words: tuple[Word, ...] = ()
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None


def sides_of(
    notes: list[str], voices: Sequence[Voice], told: list[tuple[Path, Transcript]]
) -> tuple[Told, Told]:
    """Return what the transcripts say of each side."""
    if not told:
        return Told(), Told()
    if len(told) == 2:
        return _one_a_side(notes, voices, told)
    path, transcript = told[0]
    speakers = _speakers(notes, path, transcript, 2)
    if not speakers:
        return Told(), Told()
    if len(speakers) == 1:
        return _one_speaker(notes, voices, path, speakers[0])
    if voices[0] is voices[1]:
        return speakers[0], speakers[1]
    here, crossed = (
        sum(_loudness(voices, s.words, n ^ swap) for n, s in enumerate(speakers)) for swap in (0, 1)
    )
    if crossed > here:
        speakers.reverse()
    return speakers[0], speakers[1]


def _speakers(notes: list[str], path: Path, transcript: Transcript, most: int) -> list[Told]:
    """Return those who speak, in the file's order; of more than two, the two who say most."""
    found = [
        Told(name, words, transcript.segments.get(name), path) for name, words in transcript.speakers.items()
    ]
    speaking = [s for s in found if s.words or s.segments]
    if len(found) > most and len(speaking) >= most:
        found = speaking
    if len(found) > most:
        kept = sorted(found, key=lambda s: -(len(s.words) or len(s.segments or ())))[:most]
        gone = ", ".join(f"'{s.name}'" if s.name else "one without a name" for s in found if s not in kept)
        notes.append(
            f"{path.name}: it has {len(found)} speakers; left out of a conversation of two: {gone[:300]}."
        )
        found = [s for s in found if s in kept]
    return found


def _one_a_side(
    notes: list[str], voices: Sequence[Voice], told: list[tuple[Path, Transcript]]
) -> tuple[Told, Told]:
    out = []
    for path, transcript in told:
        found = _speakers(notes, path, transcript, 1)
        one = found[0] if found else Told()
        out.append(one if one.name else replace(one, name=path.stem[:200]))
    if voices[0] is not voices[1]:
        here, crossed = (
            sum(_loudness(voices, s.words, n ^ swap) for n, s in enumerate(out)) for swap in (0, 1)
        )
        if crossed > here + 3 * sum(bool(s.words) for s in out):
            names = [v.called for v in voices]
            notes.append(
                f"{told[0][0].name} fits {names[1]} and {told[1][0].name} {names[0]} better than the other "
                "way round; they were not "
                "swapped. Give them in the order of the sides."
            )
    return out[0], out[1]


def _one_speaker(notes: list[str], voices: Sequence[Voice], path: Path, one: Told) -> tuple[Told, Told]:
    """Return what one speaker's words are to two sides: each word is whose channel is louder then."""
    if voices[0] is voices[1]:
        notes.append(
            f"{path.name} names no two speakers, and the sound is one: all is taken for the first's. Name "
            "the speakers in the transcript."
        )
        return one, Told()
    if one.segments is not None or not one.words:
        first = int(_loudness(voices, one.words, 1) > _loudness(voices, one.words, 0))
    else:
        sides = _louder(voices, one.words)
        share = float(np.mean(sides))
        if 0.1 < share < 0.9:
            notes.append(
                f"{path.name} names no two speakers; each word is given to the side whose channel is louder "
                "then."
            )
            parts = [tuple(w for w, s in zip(one.words, sides, strict=True) if s == n) for n in (0, 1)]
            return Told(words=parts[0], path=path), Told(words=parts[1], path=path)
        first = int(share > 0.5)
    notes.append(
        f"{path.name} has the words of one speaker, of {voices[first].called}; the other side has none, so "
        "its loudness tells what it says."
    )
    return (one, Told()) if first == 0 else (Told(), one)


def _louder(voices: Sequence[Voice], words: Sequence[Word]) -> list[int]:
    """Return the side of each word; words said without a pause between them belong together."""
    apart = [_level(voices[1], w.start, w.end) - _level(voices[0], w.start, w.end) for w in words]
    out: list[int] = []
    first = 0
    for n in range(1, len(words) + 1):
        if (
            n < len(words)
            and words[n].start - words[n - 1].end < 0.15
            and (apart[n] > 0) == (apart[n - 1] > 0)
        ):
            continue
        out += [int(float(np.mean(apart[first:n])) > 0)] * (n - first)
        first = n
    return out


def _loudness(voices: Sequence[Voice], words: Sequence[Word], side: int) -> float:
    """Return how loud a side is on average while words are said, dB under its loudest; 0 without words."""
    return float(np.mean([_level(voices[side], w.start, w.end) for w in words])) if words else 0.0


def _level(voice: Voice, start: float, end: float) -> float:
    heard = voice.heard
    part = heard.level[
        int(np.searchsorted(heard.times, start)) : int(np.searchsorted(heard.times, end, "right"))
    ]
    return max(float(part.mean()) - voice.top, -60.0) if len(part) else -60.0


def within(notes: list[str], called: str, told: Told, length: float) -> list[Word]:
    """Return the words as far as the sound goes, seconds. Raises FileError where it has gone before the
    first.
    """
    words = told.words
    out = [
        w if w.end <= length else msgspec.structs.replace(w, end=round(length, 4))
        for w in words
        if w.start < length - SHORTEST / 2
    ]
    gone = len(words) - len(out)
    cut = sum(w.end > length + 0.05 for w in words[: len(out)])
    if gone and not out and told.path is not None:
        cause = f"all its {count(gone, 'word')} lie past the end of the sound, which lasts {length:.1f} s"
        raise FileError(told.path, cause, told.name, "Choose this sound's own transcript.")
    if gone or cut:
        does = " and ".join(
            f"{count(n, 'word')} {what}" for n, what in ((gone, "left out"), (cut, "cut")) if n
        )
        notes.append(
            f"{called}: {does}, past the end of the sound at {length:.1f} s. Check that the transcript is of "
            "this sound."
        )
    return out


def tell_unheard(notes: list[str], called: str, words: Sequence[Word], voice: Voice, other: Voice) -> None:
    """Tell of words where nothing is to be heard: the transcript of another recording, or shifted."""
    spoken = activity(voice.heard, None, None)
    heard = sum(any(s.start - 0.2 < (w.start + w.end) / 2 < s.end + 0.2 for s in spoken) for w in words)
    if len(words) >= 5 and heard < 0.5 * len(words):
        notes.append(
            f"{called}: {len(words) - heard} of {count(len(words), 'word')} lie where nothing is heard. "
            "Check that transcript and sound "
            "belong together and begin at the same moment."
        )
