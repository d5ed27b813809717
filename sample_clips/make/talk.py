"""Speaks conversations with eSpeak NG: a channel for each who talks, and when which word is said, as the
synthesiser itself tells.

    python -m sample_clips.make.talk

What is written is known, too: which words make a phonemic clause and which of them is stressed, which are
responses and hesitations. Writes `conversation/talk.ogg` and its words, `conversation/talk.json`; tests speak
others. Needs eSpeak NG (apt-get install espeak-ng).
"""

from __future__ import annotations

import ctypes
import ctypes.util
import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

FOLDER = Path(__file__).resolve().parents[1] / "conversation"
RATE = 22050
_LOUD = r'<prosody pitch="+35%" volume="loud">\1</prosody>'


class MissingError(RuntimeError):
    """The synthesiser is not here; the message says how to get it."""


@dataclass(frozen=True)
class Turn:
    """What one says without a pause. side: who, from 0. after: seconds from the end of the turn before, less
    than 0 to talk into it. clauses: each with its stressed word in *stars*; one of a kind other than clause
    says so before a colon: "response: uh-huh".
    """

    side: int
    after: float
    clauses: tuple[str, ...]


@dataclass(frozen=True)
class Said:
    """kind, start, end (seconds) and words of what was said; stress: from when to when its stressed word
    lasts, for a clause.
    """

    side: int
    kind: str
    start: float
    end: float
    text: str
    stress: tuple[float, float] | None = None


@dataclass(frozen=True)
class Talk:
    """samples `[C, N]`, a channel a side, `rate` a second. words: side -> (text, start, end). said: what was
    written, by side and start.
    """

    samples: Array
    rate: int
    words: tuple[tuple[tuple[str, float, float], ...], ...]
    said: tuple[Said, ...]


DIALOGUE = (
    Turn(0, 0.6, ("have you *seen* the new office", "on the *corner* of the market")),
    Turn(1, 0.3, ("hesitation: um",)),
    Turn(1, 0.4, ("you mean the *big* one", "with the *glass* roof")),
    Turn(0, 0.1, ("response: yes",)),
    Turn(0, 0.4, ("I went there *yesterday*", "and *nobody* was at the door")),
    Turn(1, -0.5, ("response: really",)),
    Turn(0, 0.5, ("hesitation: uh",)),
    Turn(0, 0.5, ("so I just *walked* in", "and *all* of the lights came on", "as if they *knew* me")),
    Turn(1, 0.2, ("response: wow",)),
    Turn(1, 0.6, ("they did the *same* to my sister", "she *danced* in the hall", "until somebody *came*")),
    Turn(0, -0.3, ("response: no way",)),
    Turn(0, 0.7, ("what did she *tell* them",)),
    Turn(1, 0.5, ("hesitation: er",)),
    Turn(1, 0.5, ("that *she* was the new boss", "and they *believed* her")),
    Turn(0, 0.2, ("response: I see",)),
    Turn(0, 0.6, ("then *you* should try it", "some *day* next week")),
    Turn(1, 0.3, ("response: absolutely",)),
)
SpeakingVoice = tuple[str, int, int]  # name, pitch 0..100, words a minute
VOICES: tuple[SpeakingVoice, ...] = (("en-us", 38, 165), ("en-us+f3", 58, 175))


def write_sound(path: Path, samples: Array, rate: int) -> None:
    import soundfile

    soundfile.write(str(path), samples.T, rate)


def write_words(path: Path, talk: Talk) -> None:
    """Write the words as WhisperX does."""
    rows = [
        {
            "start": a,
            "end": b,
            "text": text,
            "words": [{"word": text, "start": a, "end": b, "score": 0.9, "speaker": f"SPEAKER_0{side}"}],
            "speaker": f"SPEAKER_0{side}",
        }
        for side, words in enumerate(talk.words)
        for text, a, b in words
    ]
    path.write_text(json.dumps({"segments": sorted(rows, key=lambda r: r["start"]), "language": "en"}))


@cache
def speak(
    turns: Sequence[Turn],
    noise: float = 0.0006,
    crosstalk: float | None = None,
    voices: Sequence[SpeakingVoice] = VOICES,
) -> Talk:
    """Return turns as they sound, of as many who talk as there are voices. crosstalk: dB of the others in
    each microphone. Raises MissingError if eSpeak NG is not there.
    """
    pieces: list[tuple[int, float, Array, list[tuple[str, float, float]], list[Said]]] = []
    at = 0.0
    for turn in turns:
        start = round(at + turn.after, 3)
        samples, own, parts = _turn(turn, start, voices[turn.side])
        pieces.append((turn.side, start, samples, own, parts))
        at = start + len(samples) / RATE
    count = round((max(start + len(samples) / RATE for _, start, samples, *_ in pieces) + 0.8) * RATE)
    out = np.zeros((len(voices), count))
    words: list[list[tuple[str, float, float]]] = [[] for _ in voices]
    said: list[Said] = []
    for side, start, samples, own, parts in pieces:
        first = round(start * RATE)
        out[side, first : first + len(samples)] += 0.6 * samples
        words[side] += own
        said += parts
    if crosstalk is not None:
        out = out + 10 ** (crosstalk / 20) * np.roll(out.sum(0) - out, 40, 1)
    out += noise * np.random.default_rng(7).standard_normal(out.shape)
    by_start = tuple(tuple(sorted(w, key=lambda x: x[1])) for w in words)
    return Talk(out, RATE, by_start, tuple(sorted(said, key=lambda s: (s.side, s.start))))


def _turn(
    turn: Turn, at: float, voice: SpeakingVoice
) -> tuple[Array, list[tuple[str, float, float]], list[Said]]:
    """Return a turn's samples, its words and what they are, in seconds of the conversation."""
    parts = [
        (c.partition(": ")[0] if ": " in c else "clause", c.partition(": ")[2] or c) for c in turn.clauses
    ]
    plain = [
        (kind, text.replace("*", "").split(), next((n for n, w in enumerate(text.split()) if "*" in w), None))
        for kind, text in parts
    ]
    # A mark before each word: eSpeak runs small words together, and reports them as of one.
    text = " ".join(
        "<mark name='w'/>" + re.sub(r"\*(\w+)\*", _LOUD, word) for _, c in parts for word in c.split()
    )
    samples, starts, end = synthesise(text, *voice)
    count = sum(len(words) for _, words, _ in plain)
    if len(starts) != count:
        raise AssertionError(f"{len(starts)} words were spoken of the {count} of {text!r}")
    edges = [round(at + x, 3) for x in _apart(starts, end, [w for _, texts, _ in plain for w in texts])]
    words: list[tuple[str, float, float]] = []
    said: list[Said] = []
    for kind, texts, stressed in plain:
        first = len(words)
        words += [(w, edges[first + n], edges[first + n + 1]) for n, w in enumerate(texts)]
        stress = words[first + stressed][1:] if stressed is not None else None
        said.append(Said(turn.side, kind, words[first][1], words[-1][2], " ".join(texts), stress))
    return samples, words, said


def _apart(starts: Sequence[float], end: float, words: Sequence[str]) -> list[float]:
    """Return when each word begins, and the end; one that is reported only when the next begins shares
    the time of the one before it, by their letters.
    """
    edges = [*starts, end]
    n = 0
    while n < len(words):
        last = n + 1
        while last < len(words) and edges[last + 1] - edges[last] < 0.01:
            last += 1
        share = np.cumsum([len(w) for w in words[n:last]]) / sum(len(w) for w in words[n:last])
        begin, over = edges[n], edges[last] - edges[n]
        edges[n + 1 : last] = [float(begin + over * x) for x in share[:-1]]
        n = last
    return edges


class _Event(ctypes.Structure):
    _fields_ = (
        ("type", ctypes.c_int),
        ("unique", ctypes.c_uint),
        ("text_position", ctypes.c_int),
        ("length", ctypes.c_int),
        ("audio_position", ctypes.c_int),
        ("sample", ctypes.c_int),
        ("user_data", ctypes.c_void_p),
        ("ident", ctypes.c_int64),
    )


_CALLBACK = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(_Event)
)


@cache
def _library() -> Any:
    name = ctypes.util.find_library("espeak-ng")
    if name is None:
        raise MissingError("eSpeak NG is not installed (apt-get install espeak-ng)")
    library = ctypes.CDLL(name)
    if library.espeak_Initialize(2, 0, None, 0) != RATE:  # synchronous: samples go to a callback
        raise MissingError("eSpeak NG could not be started")
    return library


@cache  # as spoken again, it may come out a sample longer
def synthesise(text: str, voice: str, pitch: int, rate: int) -> tuple[Array, list[float], float]:
    """Return SSML spoken: samples `[N]`, when each word begins and when the last ends, seconds. Silence at
    both ends is cut.
    """
    library = _library()
    blocks: list[Array] = []
    starts: list[float] = []

    @_CALLBACK
    def take(samples: Any, count: int, events: Any) -> int:
        if samples and count:
            blocks.append(np.ctypeslib.as_array(samples, (count,)).astype(float) / 32768)
        n = 0
        while events[n].type != 0:
            if events[n].type == 3:  # a mark
                starts.append(events[n].audio_position / 1000)
            n += 1
        return 0

    library.espeak_SetSynthCallback(take)
    library.espeak_SetVoiceByName(voice.encode())
    library.espeak_SetParameter(1, rate, 0)
    library.espeak_SetParameter(3, pitch, 0)
    library.espeak_SetParameter(4, 60, 0)  # range of the pitch
    coded = f"<speak>{text}</speak>".encode()
    library.espeak_Synth(coded, ctypes.c_size_t(len(coded) + 1), 0, 0, 0, 1 | 0x10, None, None)  # UTF-8, SSML
    library.espeak_Synchronize()
    samples = np.concatenate(blocks)
    loud = np.flatnonzero(np.abs(samples) > 0.004)
    first, last = int(loud[0]), int(loud[-1]) + 1
    return samples[first:last], [max(0.0, s - first / RATE) for s in starts], (last - first) / RATE


def main() -> None:
    talk = speak(DIALOGUE, 0.00005)  # a quiet room: a small file
    FOLDER.mkdir(exist_ok=True)
    write_sound(FOLDER / "talk.ogg", talk.samples, talk.rate)
    write_words(FOLDER / "talk.json", talk)


if __name__ == "__main__":
    main()
