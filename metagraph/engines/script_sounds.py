"""Sounds that are streamed, and what runtimes hear in them: what vectors have beside characters."""

from __future__ import annotations

from collections.abc import Sequence
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


def list_streams() -> list[tuple[int, list[list[int]]]]:
    """Return sounds: samples a second, and pieces of 8-bit samples as they come in, some of them empty."""
    out = []
    for rate, parts, lengths in ((8000, 4, (700, 0, 37)), (12000, len(_SAID), (4800, 1, 2400))):
        samples = _samples(rate, _SAID[:parts])
        pieces, at = [], 0
        for length in (*lengths, len(samples)):
            pieces.append(samples[at : at + length])
            at += length
        out.append((rate, pieces))
    return out


def _samples(rate: int, said: Sequence[tuple[float, tuple[tuple[float, float], ...]]]) -> list[int]:
    out: list[int] = []
    for seconds, tones in said:
        for n in range(round(seconds * rate)):
            made = sum(loud * sin(2 * pi * hertz * n / rate) for hertz, loud in tones)
            out.append(max(-128, min(127, round(made * FULL))))
    return out


def list_heard_marks(rate: int, pieces: Sequence[Sequence[int]]) -> list[list[list[Any]]]:
    """Return for each piece the marks it brings: seconds, viseme, weight."""
    voice = StreamedVoice(float(rate))
    return [
        [[mark.at, mark.viseme, mark.weight] for mark in voice.hear([x / FULL for x in piece])]
        for piece in pieces
    ]
