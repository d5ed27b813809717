"""Sounds that are streamed, and what runtimes hear in them: what vectors have beside characters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi, sin
from typing import Any

from metagraph.playback.life.streamed_voice import StreamedVoice

FULL = 128.0  # what stands for 1 in a sample of vectors
# A made-up voice: seconds, and hertz and loudness of what sounds then. An open mouth, one in front and one
# rounded, half open ones, a nose, a hiss, pauses; last a shape that grows.
_SAID: tuple[tuple[float, tuple[tuple[float, float], ...]], ...] = (
    (0.03, ()),
    (0.07, ((300.0, 0.2), (800.0, 0.5))),
    (0.05, ((300.0, 0.5), (800.0, 0.1), (2200.0, 0.2))),
    (0.05, ((300.0, 0.6), (800.0, 0.1))),
    (0.04, ((300.0, 0.05),)),
    (0.05, ((300.0, 0.3), (800.0, 0.22), (2200.0, 0.25))),
    (0.05, ((300.0, 0.3), (800.0, 0.22))),
    (0.05, ((4700.0, 0.3),)),
    (0.02, ()),
    (0.04, ()),
    (0.07, ((800.0, 0.12),)),
    (0.08, ((800.0, 0.6),)),
)


def list_streams() -> list[dict[str, Any]]:
    """Return sounds: `rate`, samples a second; `pieces` of 8-bit samples as they come in, some of them empty;
    `said`, the seconds of the line that are over when each comes, one of them too late; and what is heard.
    """
    out: list[dict[str, Any]] = []
    for rate, said, lengths, over in (
        (8000, _SAID[:4], (700, 0, 37), (0.0, 0.3375, 0.3376, 0.0)),
        (12000, _SAID, (4800, 1, 2400), (0.0, 0.5, 1.0, 1.4)),
        (8000, _list_shades(), (4000,), (0.0, 0.0)),
        (12000, _list_hisses(), (), (0.0,)),
    ):
        samples = _samples(rate, said)
        pieces, at = [], 0
        for length in (*lengths, len(samples)):
            pieces.append(samples[at : at + length])
            at += length
        sound = {"rate": rate, "pieces": pieces, "said": list(over)}
        out.append({**sound, **find_heard(sound)})
    return out


def _samples(rate: int, said: Sequence[tuple[float, tuple[tuple[float, float], ...]]]) -> list[int]:
    out: list[int] = []
    for seconds, tones in said:
        for n in range(round(seconds * rate)):
            made = sum(loud * sin(2 * pi * hertz * n / rate) for hertz, loud in tones)
            out.append(max(-128, min(127, round(made * FULL))))
    return out


Shades = list[tuple[float, tuple[tuple[float, float], ...]]]


def _list_shades() -> Shades:
    """Return shapes that go over into each other, and into silence, a part of a decibel at a time."""
    out: Shades = [(0.04, ())]
    for first, step in ((0.44, 0.98), (0.24, 0.97)):
        out += [(0.04, ((300.0, 0.5), (800.0, first * step**n))) for n in range(14)]
    out += [(0.04, ((300.0, 0.4), (800.0, 0.25), (2200.0, 0.16 * 0.95**n))) for n in range(12)]
    out += [(0.04, ((300.0, 0.5), (2200.0, 0.09 * 0.93**n))) for n in range(12)]
    out += [(0.04, ((800.0, 0.07 * 0.92**n),)) for n in range(12)]
    return out


def _list_hisses() -> Shades:
    """Return hisses that get softer: beside a voice, and by themselves."""
    out: Shades = [(0.05, ((300.0, 0.6),))]
    out += [(0.04, ((2200.0, 0.03), (4700.0, 0.1 * 0.93**n))) for n in range(10)]
    out += [(0.04, ((4700.0, 0.03 * 0.9**n),)) for n in range(8)]
    return out


def find_heard(sound: Mapping[str, Any]) -> dict[str, Any]:
    """Return for each piece of a sound the `marks` it brings (seconds, viseme, weight), and how many
    `seconds` were heard then.
    """
    voice = StreamedVoice(float(sound["rate"]))
    marks, seconds = [], []
    for piece, said in zip(sound["pieces"], sound["said"], strict=True):
        voice.follow(said)
        marks.append([[m.at, m.viseme, m.weight] for m in voice.hear([x / FULL for x in piece])])
        seconds.append(voice.seconds)
    return {"marks": marks, "seconds": seconds}
