"""What of something said was spoken until a moment, for the history that a language model goes on from."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.playback.life.track import Speech
from metagraph.speech.text_gestures import timed_words

TOGETHER = 1e-3  # seconds between two pieces of one utterance, at most


def split_spoken_text(said: Sequence[Speech], speech: Speech, seconds: float) -> tuple[str, str]:
    """Return what of an utterance was spoken until `seconds` of the session, up to the word that was begun,
    and that word. said: everything; speech: its last piece that has begun.
    """
    pieces = [speech]
    for other in reversed([s for s in said if s.id == speech.id and s.start < speech.start]):
        if other.length is None and abs(other.end - pieces[0].start) < TOGETHER:
            pieces.insert(0, other)
    texts: list[str] = []
    last = ""
    for piece in pieces:
        text, word = _spoken_of(piece, seconds - piece.start)
        texts, last = [*texts, text], word or last
    return " ".join(filter(None, texts)), last


def _spoken_of(speech: Speech, seconds: float) -> tuple[str, str]:
    """Return what of one piece was spoken in its first `seconds`, and the last word of that."""
    told = () if speech.timing is None else speech.timing.words
    times = [(w.text, w.start, w.start if w.end is None else w.end) for w in told]
    length = speech.end - speech.start if speech.length is None else speech.length
    words = timed_words(speech.text, times, length)
    if told and len(words) != len(told):
        begun = [w.text for w in told if w.start < seconds]
        return " ".join(begun), begun[-1] if begun else ""
    end, last = 0, ""
    for word in words:
        if word.start >= seconds:
            break
        end, last = speech.text.index(word.text, end) + len(word.text), word.text
    return speech.text[: end + len(_mark(speech.text[end:]))] if last else "", last


def _mark(rest: str) -> str:
    """Return what stands directly behind a word: a mark, not the next word."""
    return rest[
        : next((n for n, letter in enumerate(rest) if letter.isspace() or letter.isalnum()), len(rest))
    ]
