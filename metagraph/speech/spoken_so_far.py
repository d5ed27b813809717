"""The part of an utterance that was spoken until a moment, for the history from which a language model
continues.
"""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.items import Speech, find_line_start, measure_line
from metagraph.playback.life.line_timing import SpokenWord
from metagraph.playback.life.utterances import is_paused
from metagraph.speech.word_gestures import telling, words_of


def spoken_until(alphabet: Alphabet, said: Sequence[Speech], ident: str, seconds: float) -> tuple[str, str]:
    """Return the part of an utterance that was spoken until `seconds`, up to the word that was begun, and
    that word; "" if nothing was spoken. said: all speeches, by start.
    """
    text, last = "", ""
    paced = False
    pieces = _pieces(said, ident, seconds)
    for n, piece in enumerate(pieces):
        words, word = _spoken_of(alphabet, piece, min(seconds, piece.end) - find_line_start(piece))
        joins = paced and piece.timing is not None and piece.timing.paced
        if n > 0 and text != "" and words != "" and not joins:
            text += " "
        text += words
        last = last if word == "" else word
        paced = piece.timing is not None and piece.timing.paced
    return alphabet.stripped(text), last


def _pieces(said: Sequence[Speech], ident: str, seconds: float) -> list[Speech]:
    """Return the pieces of the last utterance with an id; one that continues after a pause is one
    utterance.
    """
    out: list[Speech] = []
    for piece in said:
        if piece.id != ident or piece.start >= seconds or is_paused(piece.start):
            continue
        if len(out) > 0 and out[-1].asked != piece.asked:
            out = []
        elif len(out) > 0 and piece.skip > 0:
            out.pop()
        out.append(piece)
    return out


def _spoken_of(alphabet: Alphabet, piece: Speech, seconds: float) -> tuple[str, str]:
    """Return the part of one piece that was spoken in its first `seconds`, and its last word."""
    letters = alphabet.letters(piece.text)
    words: list[SpokenWord] = []
    if piece.timing is not None and len(piece.timing.words) > 0:
        words = list(piece.timing.words)
    elif piece.timing is None or not piece.timing.paced:
        words = [SpokenWord(w.text, w.start) for w in words_of(alphabet, piece.text, [], measure_line(piece))]
    begun = [word.text for word in words if word.start < seconds]
    if len(begun) == 0:
        silent = piece.timing is not None and piece.timing.paced and len(words) == 0
        return (piece.text if silent else "", "")
    end = 0
    for word in begun:
        end = _end_of_letters(letters, alphabet.letters(word), end)
        if end < 0:  # the text says it otherwise
            return " ".join(begun), begun[-1]
    stop = end
    while stop < len(letters) and not _parts(alphabet, letters[stop]):
        stop += 1
    first = end
    while first > 0 and alphabet.stripped(letters[first - 1]) != "":
        first -= 1
    if len(begun) == len(words) and piece.timing is not None and piece.timing.paced:
        stop = len(letters)
    whole = words_of(alphabet, "".join(letters[first:end]))
    return "".join(letters[:stop]), whole[-1].text if len(whole) > 0 else begun[-1]


def _parts(alphabet: Alphabet, letter: str) -> bool:
    """Return whether a letter after a word is not a mark that belongs to it."""
    return alphabet.stripped(letter) == "" or telling(alphabet, [letter])


def _end_of_letters(letters: Sequence[str], word: Sequence[str], first: int) -> int:
    """Return the index after a word in a text, searching from `first`; -1 if it is not there."""
    for start in range(first, len(letters) - len(word) + 1):
        if all(letters[start + n] == letter for n, letter in enumerate(word)):
            return start + len(word)
    return -1
