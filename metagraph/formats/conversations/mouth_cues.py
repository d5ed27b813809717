"""What one speaker's mouth does, as the cues of Rhubarb Lip Sync, which many programs of animators read."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.line_timing import LineTiming, SpokenWord
from metagraph.playback.life.voice import Voice, make_voice_from_timing

# Viseme -> Rhubarb's shape, by the sounds for which its manual says that shape is.
SHAPES = {
    "sil": "X", "PP": "A", "FF": "G", "TH": "B", "DD": "B", "kk": "B", "CH": "B", "SS": "B", "nn": "H",
    "RR": "E", "aa": "D", "E": "C", "I": "B", "O": "E", "U": "F",
}  # fmt: skip
REST = "X"
RATE = 100  # looks a second: Rhubarb's own times are in hundredths
SHORTEST = 0.05  # seconds that a shape lasts at least


def write_rhubarb(conversation: Conversation, path: str | Path) -> None:
    """Write the mouth shapes of the only speaker with words, as Rhubarb's TSV. Raises FileError."""
    sides = [side for side in conversation.sides if side.words]
    if len(sides) != 1:
        raise FileError(
            Path(path),
            phrase("mouth shapes are of one speaker; {count} have words", count=len(sides)),
            "",
            phrase("Choose one with --speakers, or add a transcript with --words."),
        )
    words = tuple(SpokenWord(w.text, w.start, w.end) for w in sides[0].words)
    voice = make_voice_from_timing(
        LineTiming(words), max(conversation.length, *(word.end for word in sides[0].words))
    )
    rows = [f"{time:.2f}\t{shape}" for time, shape in find_rhubarb_cues(voice)]
    write_atomically(Path(path), ("\n".join(rows) + "\n").encode())


def find_rhubarb_cues(voice: Voice) -> list[tuple[float, str]]:
    """Return when each shape begins, seconds, and which it is; the last is at rest, at the voice's end."""
    times = np.arange(round(voice.duration * RATE) + 1) / RATE
    shown = np.stack([np.interp(times, voice.times, column) for column in voice.weights.T], -1)
    shapes = [SHAPES[VISEMES[n]] for n in shown.argmax(-1).tolist()]
    out: list[tuple[float, str]] = [(0.0, shapes[0])]
    for time, shape in zip(times.tolist(), shapes, strict=True):
        if shape == out[-1][1]:
            continue
        if time - out[-1][0] < SHORTEST and len(out) > 1:
            out.pop()
        if shape != out[-1][1]:
            out.append((time, shape))
    return out if out[-1][1] == REST else [*out, (voice.duration, REST)]
