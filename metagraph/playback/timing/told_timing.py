"""The words and visemes of a line as synthesisers tell them: pairs and triples, Amazon Polly's speech marks,
Azure's events.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.graph.requests import RequestError, Say
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.line_timing import (
    LineTiming,
    SpokenWord,
    VisemeMark,
    join_letters,
    timing_of,
    wrong_in,
)

THOUSAND, TICKS = 1e3, 1e7  # of a second, in which Polly and Azure count
LARGEST = 1e15


def read_given_timing(ask: Say) -> LineTiming | None:
    """Return when a line's words and shapes come; None if that is not told. Raises RequestError naming the
    entry.
    """
    if ask.audio is not None:
        raise RequestError(
            "audio: is heard in live sessions alone; tell words or visemes, say a line, or use say_sound"
        )
    words: list[SpokenWord] = []
    marks: list[VisemeMark] = []
    for n, entry in enumerate(ask.words):
        if not _word(entry, words):
            raise RequestError(f"words[{n}]: should be [word, start, end], seconds from the line's start")
    letters: list[SpokenWord] = []
    for n, entry in enumerate(ask.characters):
        if not _word(entry, letters):
            raise RequestError(
                f"characters[{n}]: should be [letter, start, end], seconds from the line's start"
            )
    if not words:
        words = join_letters(ALPHABET, letters)
    for n, entry in enumerate(ask.visemes):
        if not (_mark(entry, marks) or _word(entry, words, named=True)):
            raise RequestError(f"visemes[{n}]: should be [seconds, viseme], or with its weight from 0 to 1")
    if not words and not marks:
        return None
    name = ask.set or ""
    why = wrong_in(words, marks, name, ask.duration)
    if why:
        raise RequestError(why)
    return timing_of(ALPHABET, words, marks, name)


def _number(value: Any) -> bool:
    """Whether a value is a number that times and names can be; JSON may have whole ones of any length."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST


def _word(entry: Any, out: list[SpokenWord], named: bool = False) -> bool:
    """Add the word an entry tells; return whether it is one. named: only where it says so itself."""
    if isinstance(entry, Mapping):
        kind = entry.get("type", "")
        if kind in ("sentence", "ssml"):  # marks of Polly's that no mouth needs
            return True
        if named and kind != "word":
            return False
        if kind == "word":
            entry = [entry.get("value"), _seconds(entry.get("time"), THOUSAND)]
        elif "audioOffset" in entry:
            start, length = entry["audioOffset"], entry.get("duration")
            end = (start + length) / TICKS if _number(start) and _number(length) else None
            entry = [entry.get("text"), _seconds(start, TICKS), end]
        else:
            text = entry.get("word", entry.get("text", entry.get("character")))
            entry = [text, entry.get("start"), entry.get("end")]
    elif named:
        return False
    if not isinstance(entry, Sequence) or not 2 <= len(entry) <= 3 or not isinstance(entry[0], str):
        return False
    end = entry[2] if len(entry) == 3 else None
    if not _number(entry[1]) or not (end is None or _number(end)):
        return False
    out.append(SpokenWord(entry[0], float(entry[1]), None if end is None else float(end)))
    return True


def _mark(entry: Any, out: list[VisemeMark]) -> bool:
    """Add the visemes an entry tells; return whether it tells any."""
    if isinstance(entry, Mapping):
        if entry.get("type", "viseme") != "viseme":
            return False
        if "type" in entry:
            entry = [_seconds(entry.get("time"), THOUSAND), entry.get("value")]
        elif "audioOffset" in entry:
            entry = [_seconds(entry["audioOffset"], TICKS), entry.get("visemeId")]
        elif isinstance(entry.get("weights"), Mapping):
            pairs = entry["weights"].items()
            return all(_mark([entry.get("time"), name, weight], out) for name, weight in pairs)
        else:
            entry = [entry.get("time"), entry.get("viseme", entry.get("id")), entry.get("weight", 1.0)]
    if not isinstance(entry, Sequence) or not 2 <= len(entry) <= 3 or not _number(entry[0]):
        return False
    name, weight = entry[1], entry[2] if len(entry) == 3 else 1.0
    if _number(name) and name == int(name):
        name = str(int(name))
    if not isinstance(name, str) or not _number(weight):
        return False
    out.append(VisemeMark(float(entry[0]), name, float(weight)))
    return True


def _seconds(value: Any, of: float) -> Any:
    return value / of if _number(value) else value
