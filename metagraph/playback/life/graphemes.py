"""From letters to mouth shapes: what a mouth may do when neither sound nor phones of a line are there.

English spelling is read by a few rules; other alphabets by their vowels, what is unknown by turns of open and
shut.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from zlib import crc32

from metagraph.playback.life.mouth import MouthPiece

PACE = 14.0  # characters a second: about 150 words a minute
SHORTEST = 0.4  # seconds

# Longest first. Values: shapes in turn.
_SPELLINGS: dict[str, tuple[str, ...]] = {
    "tion": ("CH", "nn"),
    "sch": ("CH",),
    "tch": ("CH",),
    "igh": ("aa", "I"),
    "eau": ("O",),
    "ough": ("O",),
    "th": ("TH",),
    "sh": ("CH",),
    "ch": ("CH",),
    "ph": ("FF",),
    "ck": ("kk",),
    "ng": ("nn",),
    "qu": ("kk", "U"),
    "wh": ("U",),
    "oo": ("U",),
    "ou": ("aa", "U"),
    "ow": ("O", "U"),
    "ee": ("I",),
    "ea": ("I",),
    "ai": ("E", "I"),
    "ay": ("E", "I"),
    "oi": ("O", "I"),
    "oy": ("O", "I"),
    "au": ("O",),
    "aw": ("O",),
    "ie": ("I",),
    "ei": ("E", "I"),
    "ue": ("U",),
    "oa": ("O",),
    "a": ("aa",),
    "e": ("E",),
    "i": ("I",),
    "o": ("O",),
    "u": ("U",),
    "y": ("I",),
    "ø": ("U",),
    "œ": ("U",),
    "æ": ("E",),
    "ı": ("I",),
    "b": ("PP",),
    "p": ("PP",),
    "m": ("PP",),
    "f": ("FF",),
    "v": ("FF",),
    "d": ("DD",),
    "t": ("DD",),
    "l": ("nn",),
    "n": ("nn",),
    "k": ("kk",),
    "g": ("kk",),
    "c": ("kk",),
    "q": ("kk",),
    "x": ("kk", "SS"),
    "h": ("kk",),
    "j": ("CH",),
    "s": ("SS",),
    "z": ("SS",),
    "r": ("RR",),
    "w": ("U",),
    "ß": ("SS",),
    "ð": ("TH",),
    "þ": ("TH",),
    "ł": ("nn",),
    "đ": ("DD",),
}
# Greek and Cyrillic letters that stand for the Latin ones.
_ALIKE = dict(zip("αεηιουωβπμφδτλνκγχξσςζρθабвгдеёжзийклмнопрстуфхцчшщыэюяієї",
                  "aeeioyobpmfdtlnkghxsszrþabvgdeejzijklmnoprstufhccssieuaiei", strict=False))  # fmt: skip
_ALIKE.update({"е": "e", "ж": "j", "ч": "j", "ш": "j", "щ": "j", "ц": "s", "х": "h", "θ": "þ"})
VOWELS = frozenset(("aa", "E", "I", "O", "U"))
_LENGTH = {"vowel": 1.25, "consonant": 0.8}  # of one character's time
_STOPS = {
    ",": 1.5,
    ";": 2.0,
    ":": 2.0,
    ".": 3.0,
    "!": 3.0,
    "?": 3.0,
    "…": 3.0,
    "-": 0.3,
    "–": 1.5,
    "—": 1.5,
    "(": 1.0,
    ")": 1.0,
}


def shapes(word: str) -> list[str]:
    """Return the mouth shapes of a word's letters, in turn."""
    out: list[str] = []
    letters = "".join(_ALIKE.get(c, c) for c in _plain(word))
    at = 0
    while at < len(letters):
        for size in (4, 3, 2, 1):
            found = _SPELLINGS.get(letters[at : at + size])
            if found is not None and len(letters[at : at + size]) == size:
                break
        else:
            size, found = 1, _unknown(letters[at], out)
        final_e = (
            letters[at] == "e"
            and size == 1
            and at == len(letters) - 1
            and len(out) > 1
            and any(s in VOWELS for s in out)
        )
        if (
            found
            and not final_e
            and not (at and letters[at] == letters[at - 1] and size == 1 and found[0] not in VOWELS)
        ):
            out += found
        at += size
    return out


def _plain(word: str) -> str:
    """Small letters without accents."""
    return "".join(c for c in unicodedata.normalize("NFD", word.casefold()) if not unicodedata.combining(c))


def _unknown(letter: str, before: list[str]) -> tuple[str, ...]:
    if not letter.isalnum():
        return ()
    if letter.isdigit() or unicodedata.category(letter) == "Lo":  # a syllable each
        return (
            ("DD", "nn", "SS", "kk", "PP")[ord(letter) % 5],
            ("aa", "E", "I", "O", "U")[ord(letter) // 5 % 5],
        )
    return ("aa",) if before and before[-1] not in VOWELS else ("DD",)


def _words(text: str) -> Iterator[tuple[str, float]]:
    """Yield each word and how many characters' time of pause follows it."""
    word, pause = "", 0.0
    for c in text:
        if c.isalnum() or c in "'’" or unicodedata.combining(c):
            if pause:
                yield word, pause
                word, pause = "", 0.0
            word += c
        else:
            pause += _STOPS.get(c, 0.35)
    if word or pause:
        yield word, pause


def spelled(
    text: str, duration: float | None = None
) -> tuple[list[MouthPiece], list[float], list[float], float]:
    """Return a text's pieces, the times and strengths (0..1) of its syllables, and its length in seconds.

    duration: how long it takes, None for `PACE` characters a second, at least `SHORTEST`.
    """
    stripped = text.strip()
    length = max(SHORTEST, len(stripped) / PACE) if duration is None else max(duration, 0.0)
    plan: list[
        tuple[str | None, float, float]
    ] = []  # shape or pause, characters' time, strength of a syllable
    for word, pause in _words(stripped):
        found = shapes(word)
        # Content words are longer than the words between them; the first vowel bears the stress more often
        # than not.
        weight = min(1.0, 0.35 + 0.09 * len(word)) - 0.1 * (crc32(word.encode()) % 100) / 100
        first = True
        for n, mouth in enumerate(found):
            syllable = mouth in VOWELS and (n == 0 or found[n - 1] not in VOWELS)
            strength = (weight if first else 0.6 * weight) if syllable else 0.0
            first = first and not syllable
            plan.append((mouth, _LENGTH["vowel" if mouth in VOWELS else "consonant"], strength))
        if pause:
            plan.append((None, pause, 0.0))
    total = sum(size for _, size, _ in plan)
    if not any(shape for shape, _, _ in plan) or length < 1e-3:
        return [], [], [], length
    edge = min(0.06, 0.1 * length)
    scale, at = (length - 2 * edge) / total, edge
    pieces: list[MouthPiece] = []
    peaks: list[float] = []
    strengths: list[float] = []
    for shape, size, strength in plan:
        end = at + size * scale
        if shape is not None:
            pieces.append(
                MouthPiece(at, end, shape, min(1.0, 0.7 + 0.4 * strength) if shape in VOWELS else 1.0)
            )
        if strength > 0:
            peaks.append(0.5 * (at + end))
            strengths.append(strength)
        at = end
    return pieces, peaks, strengths, length
