"""From letters to mouth shapes: what a mouth does if a line has neither sound nor phones.

A few rules read English spelling. Other alphabets are read by their vowels. Unknown letters open and shut the
mouth in turn.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.mouth import VOWELS, MouthPiece

PACE = 14.0  # characters a second: about 150 words a minute
SHORTEST = 0.4  # seconds

# Values: shapes in turn. The longest spelling that fits is taken.
_SPELLINGS: dict[str, list[str]] = {
    "tion": ["CH", "nn"], "sch": ["CH"], "tch": ["CH"], "igh": ["aa", "I"], "eau": ["O"], "ough": ["O"],
    "th": ["TH"], "sh": ["CH"], "ch": ["CH"], "ph": ["FF"], "ck": ["kk"], "ng": ["nn"], "qu": ["kk", "U"],
    "wh": ["U"], "oo": ["U"], "ou": ["aa", "U"], "ow": ["O", "U"], "ee": ["I"], "ea": ["I"],
    "ai": ["E", "I"], "ay": ["E", "I"], "oi": ["O", "I"], "oy": ["O", "I"], "au": ["O"], "aw": ["O"],
    "ie": ["I"], "ei": ["E", "I"], "ue": ["U"], "oa": ["O"], "a": ["aa"], "e": ["E"], "i": ["I"],
    "o": ["O"], "u": ["U"], "y": ["I"], "ø": ["U"], "œ": ["U"], "æ": ["E"], "ı": ["I"], "b": ["PP"],
    "p": ["PP"], "m": ["PP"], "f": ["FF"], "v": ["FF"], "d": ["DD"], "t": ["DD"], "l": ["nn"], "n": ["nn"],
    "k": ["kk"], "g": ["kk"], "c": ["kk"], "q": ["kk"], "x": ["kk", "SS"], "h": ["kk"], "j": ["CH"],
    "s": ["SS"], "z": ["SS"], "r": ["RR"], "w": ["U"], "ß": ["SS"], "ð": ["TH"], "þ": ["TH"], "ł": ["nn"],
    "đ": ["DD"],
}  # fmt: skip
# Greek and Cyrillic letters, and the Latin ones they stand for.
_ALIKE: dict[str, str] = {
    "α": "a", "ε": "e", "η": "e", "ι": "i", "ο": "o", "υ": "y", "ω": "o", "β": "b", "π": "p", "μ": "m",
    "φ": "f", "δ": "d", "τ": "t", "λ": "l", "ν": "n", "κ": "k", "γ": "g", "χ": "h", "ξ": "x", "σ": "s",
    "ς": "s", "ζ": "z", "ρ": "r", "θ": "þ", "а": "a", "б": "b", "в": "v", "г": "g", "д": "d", "е": "e",
    "ё": "e", "ж": "j", "з": "z", "и": "i", "й": "j", "к": "k", "л": "l", "м": "m", "н": "n", "о": "o",
    "п": "p", "р": "r", "с": "s", "т": "t", "у": "u", "ф": "f", "х": "h", "ц": "s", "ч": "j", "ш": "j",
    "щ": "j", "ы": "i", "э": "e", "ю": "u", "я": "a", "і": "i", "є": "e", "ї": "i",
}  # fmt: skip
_CONSONANTS: tuple[str, ...] = ("DD", "nn", "SS", "kk", "PP")  # of syllables nobody knows
_VOWEL_LENGTH = 1.25  # of one character's time
_CONSONANT_LENGTH = 0.8
_STOPS: dict[str, float] = {
    ",": 1.5, ";": 2.0, ":": 2.0, ".": 3.0, "!": 3.0, "?": 3.0, "…": 3.0, "-": 0.3, "–": 1.5, "—": 1.5,
    "(": 1.0, ")": 1.0, "，": 1.5, "、": 1.5, "。": 3.0, "！": 3.0, "？": 3.0,
}  # fmt: skip
_BLANK = 0.35  # characters' time of anything else between words


@dataclass(frozen=True, slots=True)
class Syllabary:
    """Letters that are syllables, by their code points. size: characters' time of one."""

    first: int
    last: int
    size: float


_SYLLABARIES: tuple[Syllabary, ...] = (
    Syllabary(0x3041, 0x30FF, 2.0),  # kana
    Syllabary(0xFF66, 0xFF9D, 2.0),  # kana of half the width
    Syllabary(0x3400, 0x9FFF, 3.0),  # Han characters
    Syllabary(0xF900, 0xFAFF, 3.0),
    Syllabary(0x20000, 0x323AF, 3.0),
    Syllabary(0xAC00, 0xD7A3, 3.0),  # Hangul
)


def shapes(alphabet: Alphabet, word: str) -> list[str]:
    """Return the mouth shapes of a word's letters, in turn."""
    out: list[str] = []
    letters = [_ALIKE.get(c, c) for c in alphabet.plain(word)]
    at = 0
    while at < len(letters):
        size = min(4, len(letters) - at)
        while size > 1 and "".join(letters[at : at + size]) not in _SPELLINGS:
            size -= 1
        spelling = "".join(letters[at : at + size])
        found = _SPELLINGS[spelling] if spelling in _SPELLINGS else _unknown(alphabet, spelling, out)
        last = at == len(letters) - 1
        final_e = spelling == "e" and last and len(out) > 1 and any(s in VOWELS for s in out)
        twice = at > 0 and size == 1 and letters[at] == letters[at - 1]
        if len(found) > 0 and not final_e and not (twice and found[0] not in VOWELS):
            out.extend(found)
        at += size
    return out


def _unknown(alphabet: Alphabet, letter: str, before: list[str]) -> list[str]:
    kind = alphabet.kind(letter)
    if kind == "syllable":
        code = alphabet.code(letter)
        return [_CONSONANTS[code % 5], VOWELS[code // 5 % 5]]
    if kind == "letter":
        return ["aa"] if len(before) > 0 and before[-1] not in VOWELS else ["DD"]
    return []


def split_words(alphabet: Alphabet, text: str) -> list[tuple[str, float]]:
    """Return each word, and the pause after it, measured in characters."""
    out: list[tuple[str, float]] = []
    word, pause = "", 0.0
    for c in alphabet.letters(text):
        if alphabet.kind(c) != "" or c == "'" or c == "’":
            if pause > 0:
                out.append((word, pause))
                word, pause = "", 0.0
            word += c
        else:
            pause += _STOPS.get(c, _BLANK)
    if word != "" or pause > 0:
        out.append((word, pause))
    return out


@dataclass(frozen=True, slots=True)
class SpelledSound:
    """A sound of a text. shape: "" for a pause. size: characters' time. strength: of a syllable, 0 for
    anything else.
    """

    shape: str
    size: float
    strength: float = 0.0


def sounds(alphabet: Alphabet, word: str) -> list[SpelledSound]:
    """Return a word's sounds, in turn.

    Content words are longer than the words between them. The first vowel usually has the stress.
    """
    out: list[SpelledSound] = []
    found = shapes(alphabet, word)
    weight = min(1.0, 0.35 + 0.09 * len(alphabet.letters(word))) - 0.1 * alphabet.scatter(word) / 100
    first = True
    before = ""
    for shape in found:
        vowel = shape in VOWELS
        syllable = vowel and before not in VOWELS
        strength = (weight if first else 0.6 * weight) if syllable else 0.0
        first = first and not syllable
        out.append(SpelledSound(shape, _VOWEL_LENGTH if vowel else _CONSONANT_LENGTH, strength))
        before = shape
    return out


@dataclass
class Spelled:
    """Something said, timed by its letters: pieces in time, and times and strengths (0..1) of its
    syllables.
    """

    pieces: list[MouthPiece] = field(default_factory=list)
    peaks: list[float] = field(default_factory=list)
    strengths: list[float] = field(default_factory=list)

    def add(self, plan: list[SpelledSound], start: float, end: float) -> None:
        """Add sounds that last from `start` to `end` seconds together."""
        at = start
        scale = (end - start) / sum([sound.size for sound in plan])
        for sound in plan:
            then = at + sound.size * scale
            if sound.shape != "":
                fully = min(1.0, 0.7 + 0.4 * sound.strength) if sound.shape in VOWELS else 1.0
                self.pieces.append(MouthPiece(at, then, sound.shape, fully))
            if sound.strength > 0:
                self.peaks.append(0.5 * (at + then))
                self.strengths.append(sound.strength)
            at = then


def read_aloud(alphabet: Alphabet, text: str) -> float:
    """Return how long a text takes to say, seconds."""
    letters = alphabet.letters(alphabet.stripped(text))
    return max(SHORTEST, sum([measure_letter(alphabet.code(letter)) for letter in letters]) / PACE)


def measure_letter(code: int) -> float:
    """Return how long a letter takes, measured in characters, by its code point: a Chinese, Japanese or
    Korean one is a syllable.
    """
    for script in _SYLLABARIES:
        if script.first <= code and code <= script.last:
            return script.size
    return 1.0


def spelled(alphabet: Alphabet, text: str, duration: float) -> Spelled:
    """Return the sounds of a text that lasts `duration` seconds; none if it has no known letter."""
    out = Spelled()
    plan: list[SpelledSound] = []
    for word, pause in split_words(alphabet, alphabet.stripped(text)):
        plan.extend(sounds(alphabet, word))
        if pause > 0:
            plan.append(SpelledSound("", pause))
    if duration >= 1e-3 and any(sound.shape != "" for sound in plan):
        edge = min(0.06, 0.1 * duration)
        out.add(plan, edge, duration - edge)
    return out
