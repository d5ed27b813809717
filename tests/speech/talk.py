"""A conversation of two for tests, spoken by eSpeak NG (see `sample_clips.make.talk`); tests skip where it is
not installed.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from sample_clips.make import talk as maker
from sample_clips.make.talk import RATE, MissingError, Said, Talk, Turn, write_sound, write_words

__all__ = [
    "RATE",
    "TURNS",
    "Said",
    "Talk",
    "Turn",
    "make_conversation",
    "speak",
    "synthesise",
    "write_sound",
    "write_textgrid",
    "write_words",
]

TURNS = (
    Turn(
        0,
        0.6,
        ("so I was *walking* home", "from the *station* last night", "and there was this *enormous* dog"),
    ),
    Turn(1, -1.2, ("response: uh-huh",)),
    Turn(0, 1.2, ("hesitation: uh",)),
    Turn(0, 0.5, ("it just *stood* there", "in the *middle* of the road")),
    Turn(1, 0.2, ("response: wow",)),
    Turn(0, 0.3, ("and it *looked* at me",)),
    Turn(1, 0.4, ("did you *run* away",)),
    Turn(0, 0.5, ("no I *waited*", "for the *owner* to come")),
    Turn(1, -0.1, ("response: yeah",)),
    Turn(0, 0.3, ("hesitation: um",)),
    Turn(0, 0.6, ("she was really *friendly*", "and we *talked* for an hour")),
    Turn(1, 0.1, ("response: I see",)),
    Turn(1, 0.7, ("my *sister* has a dog", "that is *bigger* than a horse")),
    Turn(0, 0.1, ("response: really",)),
    Turn(1, 0.5, ("hesitation: er",)),
    Turn(1, 0.5, ("she takes it to the *beach*", "on every *Sunday* morning")),
    Turn(0, 0.1, ("response: mm-hmm",)),
    Turn(1, 0.4, ("and it *swims* better than I do",)),
)


def speak(
    turns: Sequence[Turn] = TURNS,
    noise: float = 0.0006,
    crosstalk: float | None = None,
    voices: Sequence[maker.SpeakingVoice] = maker.VOICES,
) -> Talk:
    """Return turns as they sound. Skips the test where eSpeak NG is not there."""
    try:
        return maker.speak(turns, noise, crosstalk, voices)
    except MissingError as error:
        pytest.skip(str(error))


def synthesise(text: str, voice: str, pitch: int, rate: int) -> tuple[maker.Array, list[float], float]:
    """Return SSML spoken, as `maker.synthesise`. Skips the test where eSpeak NG is not there."""
    try:
        return maker.synthesise(text, voice, pitch, rate)
    except MissingError as error:
        pytest.skip(str(error))


def make_conversation(
    folder: Path, noise: float = 0.0006, crosstalk: float | None = None
) -> tuple[Path, Path]:
    """Write a conversation of two, half a minute long: a WAV with one channel a side, and its words as
    Whisper-style JSON with speakers. Skips the test where eSpeak NG is not there. noise: how loud both rooms
    are; crosstalk: dB of the partner in each microphone.
    """
    talk = speak(TURNS, noise, crosstalk)
    audio, words = folder / "talk.wav", folder / "talk.json"
    write_sound(audio, talk.samples, talk.rate)
    write_words(words, talk)
    return audio, words


def write_textgrid(path: Path, talk: Talk) -> None:
    """Write the words as a TextGrid, a tier a side."""
    end = talk.samples.shape[1] / talk.rate
    lines = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "0", str(end), "<exists>", "2"]
    for name, words in zip(("Ann", "Ben"), talk.words, strict=True):
        rows: list[tuple[float, float, str]] = []
        at = 0.0
        for text, a, b in words:
            rows += [(at, a, ""), (a, b, text)] if a > at else [(a, b, text)]
            at = b
        rows.append((at, end, ""))
        lines += ['"IntervalTier"', f'"{name}"', "0", str(end), str(len(rows))]
        lines += [x for a, b, text in rows for x in (str(a), str(b), f'"{text}"')]
    path.write_text("\n".join(lines) + "\n")
