"""The sound of a line as it comes in, and the mouth shapes it tells, if nothing better is reported."""

from __future__ import annotations

import binascii
from collections import OrderedDict
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.graph.requests import RequestError, Say
from metagraph.playback.life.line_timing import extended, place_told
from metagraph.playback.timing.told_timing import read_given_timing

Array = NDArray[Any]

RECALL = 3.0  # seconds of sound that tell how loud the voice is
QUIET = 0.5  # seconds
LATE = 0.25  # seconds by which a piece may come after its time; one that is later is heard as it comes
LINES = 16  # of which sound is remembered


class SaidSound:
    """One line's sound. rate: samples a second. seconds: up to which it was heard."""

    def __init__(self, rate: int) -> None:
        self.rate, self.seconds = rate, 0.0
        self._samples = np.zeros(0)

    def hear(self, samples: Array, said: float) -> list[list[Any]]:
        """Take in the next samples `[N]`, -1..1; return the visemes they tell. said: seconds of the line that
        are over.
        """
        from metagraph.speech.sound import (  # what nobody streams to need not be loaded
            analyse_sound,
            guess_mouth_shapes,
        )

        if self.seconds < said - LATE:
            self.seconds = said
        start, end = self.seconds, self.seconds + len(samples) / self.rate
        self._samples = np.concatenate([self._samples, samples])[-round(RECALL * self.rate) :]
        quiet = np.zeros(round(QUIET * self.rate))  # what the voice is louder than, where it never pauses
        heard = analyse_sound(np.concatenate([quiet, self._samples]), self.rate)
        offset = end - heard.duration
        self.seconds = end
        marks: list[list[Any]] = []
        over = start
        for piece in guess_mouth_shapes(heard):
            begins, ends = max(start, piece.start + offset), min(end, piece.end + offset)
            if ends <= begins:
                continue
            if begins > over:
                marks.append([over, "sil"])
            marks.append([begins, piece.viseme, piece.strength])
            over = ends
        return [*marks, [max(over, start), "sil"]]


def join_asks(before: Say, ask: Say) -> Say | None:
    """Return an ask with what another one of the same tick said before it under its id; None if it is in the
    place of that.
    """
    if before.line is not None or ask.line is not None or ask.at is not None:
        return None
    try:
        old, new = read_given_timing(before), read_given_timing(ask)
    except RequestError:
        return None
    if old is None and new is None:
        seconds = None
        if before.duration is not None and ask.duration is not None:
            seconds = before.duration + ask.duration
        pieces = before.more  # of words, which have their blanks
        text = before.text + ask.text if pieces else f"{before.text} {ask.text}"
        return msgspec.structs.replace(ask, text=text, duration=seconds, at=before.at)
    if old is None or new is None:
        return None
    both = extended(old, place_told(old, new, 0.0), 0.0)
    texts = [x.text for x in (before, ask) if x.text]
    return msgspec.structs.replace(
        ask,
        text=" ".join(texts) if len(texts) == 2 else "",
        words=tuple([w.text, w.start, w.start if w.end is None else w.end] for w in both.words),
        characters=(),
        visemes=tuple([m.at, m.viseme, m.weight] for m in both.marks),
        set="oculus" if both.marks else None,
        at=before.at,
    )


class SaidSounds:
    """The sounds of the lines that were said last, by their keys."""

    def __init__(self) -> None:
        self._lines: OrderedDict[str, SaidSound] = OrderedDict()

    def told(self, key: str, ask: Say, goes_on: bool, said: float) -> Say:
        """Return an ask with what its sound tells instead of the sound. goes_on: whether it is added to a
        line, of which `said` seconds are over. Raises RequestError for what is no sound.
        """
        try:
            data = binascii.a2b_base64(ask.audio or "", strict_mode=True)
        except binascii.Error:
            raise RequestError("audio: give base64 of 16-bit numbers") from None
        if not data or len(data) % 2:
            raise RequestError("audio: give base64 of 16-bit numbers, an even number of bytes")
        line = self._lines.get(key)
        if line is None or not goes_on or line.rate != ask.rate:
            line = self._lines[key] = SaidSound(ask.rate)
        self._lines.move_to_end(key)
        while len(self._lines) > LINES:
            self._lines.popitem(last=False)
        marks = line.hear(np.frombuffer(data, "<i2") / 32768.0, said)
        if ask.words or ask.characters or ask.visemes:  # which tell more
            return msgspec.structs.replace(ask, audio=None)
        return msgspec.structs.replace(ask, audio=None, visemes=tuple(map(tuple, marks)), set="oculus")
