"""Read the lines that a character says: their sound files and phones become voices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CONVERSATION_SECONDS, LINE_SECONDS
from metagraph.common.files import make_unforeseen_error
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.graph.conversation.model import Word
from metagraph.graph.model import Project
from metagraph.graph.requests import Line
from metagraph.playback.life.mouth import MouthPiece
from metagraph.playback.life.voice import Voice, make_silent_voice, make_voice
from metagraph.speech.mouth_files.model import MouthShapes
from metagraph.speech.mouth_files.registry import read_mouth_file
from metagraph.speech.phones import list_mouth_pieces
from metagraph.speech.sound import analyse_sound, find_syllables, guess_mouth_shapes, read_sound
from metagraph.speech.textgrid import GridInterval, GridTier, TextGrid

Array = NDArray[Any]

FINE = 24000  # samples a second from which the mouth is read
_VOWELS = ("aa", "E", "I", "O", "U", "RR")


def read_line_voice(
    audio: str | Path,
    phones: str | Path | None = None,
    channel: int | None = None,
    notes: list[str] | None = None,
) -> Voice:
    """Read a line's sound and, if there are any, its phones, words or mouth shapes from a file beside it.
    `channel` is the line's channel in the sound, from 0; None mixes all. notes: gets what was inferred from
    that file. Raises FileError.
    """
    samples, rate = read_sound(audio, channel)
    if phones is None:
        return _voice(samples, rate, None)
    told = read_mouth_file(phones, len(samples) / rate)
    _tell(notes, phones, told)
    if told.weights is None or told.times is None:
        return _voice(samples, rate, list(told.pieces))
    heard = analyse_sound(samples, rate)
    return Voice(heard.duration, *_track(told, heard.duration, *find_syllables(heard)))


def _tell(notes: list[str] | None, path: str | Path, told: MouthShapes) -> None:
    if notes is not None:
        notes += [phrase("{name}: {note}", name=Path(path).name, note=note) for note in told.notes]


def _track(told: MouthShapes, duration: float, peaks: Array, strengths: Array) -> tuple[Array, ...]:
    """Return peaks, times, weights and strengths of a voice whose mouth is given frame by frame; shut at both
    ends.
    """
    assert told.times is not None and told.weights is not None
    kept = told.times < duration
    times, weights = told.times[kept], told.weights[kept]
    rest = np.eye(1, weights.shape[1], dtype=np.float32)
    times = np.concatenate(
        [[-1e-3], times, [max(duration, float(times[-1]) + 1e-3) if len(times) else duration]]
    )
    return peaks, np.maximum(times, 0.0), np.concatenate([rest, weights, rest]), strengths


def read_spoken_voice(audio: str | Path, channel: int | None = None, words: Sequence[Word] = ()) -> Voice:
    """Read a voice from its sound and, if there are any, its transcribed words. Raises FileError."""
    samples, rate = read_sound(audio, channel, CONVERSATION_SECONDS, FINE)
    if not words:
        return _voice(samples, rate, None)
    tier = GridTier("words", tuple(GridInterval(w.start, w.end, w.text) for w in words))
    return _voice(samples, rate, list_mouth_pieces(TextGrid(0.0, len(samples) / rate, (tier,))))


def _voice(samples: Array, rate: int, told: list[MouthPiece] | None) -> Voice:
    """Return the voice of a sound. `told` has the mouth's shapes; None finds them in the sound."""
    heard = analyse_sound(samples, rate)
    peaks, strengths = find_syllables(heard)
    pieces = guess_mouth_shapes(heard) if told is None else told
    pieces = [replace(p, end=min(p.end, heard.duration)) for p in pieces if p.start < heard.duration]
    if told is not None:  # a vowel's loudness shows how open it is
        loud = [float(np.interp(0.5 * (p.start + p.end), heard.times, heard.loud)) for p in pieces]
        pieces = [
            replace(p, strength=p.strength * (0.6 + 0.4 * x)) if p.viseme in _VOWELS else p
            for p, x in zip(pieces, loud, strict=True)
        ]
    if not pieces:
        return make_silent_voice(heard.duration)
    return make_voice(pieces, heard.duration, peaks, strengths)


def make_voice_from_phones(phones: str | Path) -> Voice:
    """Read a line without sound from its phones or mouth shapes alone; every vowel is a syllable. Raises
    FileError.
    """
    told = read_mouth_file(phones)
    pieces = [p for p in told.pieces if p.start >= 0]
    duration = max([told.end, *(p.end for p in pieces)])
    if duration > LINE_SECONDS:
        why = phrase(
            "lasts {duration:.0f} s, but a line can last at most {most:.0f} s",
            duration=duration,
            most=LINE_SECONDS,
        )
        raise FileError(phones, why, phrase("its end"), phrase("Cut it into shorter lines."))
    if told.weights is not None:
        return Voice(max(duration, 0.0), *_track(told, duration, np.zeros(0), np.zeros(0)))
    if not pieces:
        return make_silent_voice(max(duration, 0.0))
    vowels = [
        p
        for n, p in enumerate(pieces)
        if p.viseme in _VOWELS and (n == 0 or pieces[n - 1].viseme not in _VOWELS)
    ]
    peaks = np.array([0.5 * (p.start + p.end) for p in vowels])
    long = np.array(
        [p.strength * min(1.0, 0.3 + 4 * (p.end - p.start)) for p in vowels]
    )  # stressed vowels are long
    return make_voice(pieces, duration, peaks, long)


def read_line(line: Line, folder: Path, notes: list[str] | None = None) -> Voice | None:
    """Return the voice of a line with sound or phones, with paths relative to `folder`; None for other lines.
    notes: gets what was inferred from its phones. Raises FileError.
    """
    if line.audio:
        phones = folder / line.phones if line.phones else None
        return read_line_voice(folder / line.audio, phones, line.channel, notes)
    return make_voice_from_phones(folder / line.phones) if line.phones else None


def load_voices(project: Project, folder: str | Path) -> tuple[Project, tuple[str, ...]]:
    """Read the sound of every line that has one; return the project with its voices, and what could not be
    read, in words.

    A line with broken phones is read only from its sound; one with a broken sound speaks by its letters.
    """
    folder = Path(folder)
    voices: dict[str, Voice] = {}
    notes: list[str] = []
    for ident, line in project.lines.items():
        tries = (
            [line]
            if not (line.audio and line.phones)
            else [line, Line(audio=line.audio, channel=line.channel)]
        )
        for attempt in tries:
            try:
                voice = read_line(attempt, folder, notes)
            except Exception as error:  # a bad sound must not stop a project
                why = make_unforeseen_error(folder / (line.audio or line.phones or ""), error)
                note = phrase("line '{ident}': {why}", ident=ident, why=why.words)
                if note not in notes:
                    notes.append(note)
                continue
            if voice is not None:
                voices[ident] = voice
            break
    return replace(project, voices=voices), tuple(notes)
