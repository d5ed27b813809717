"""From phones to mouth shapes: ARPAbet (AA1, with or without stress), IPA and SAMPA; from words by their
letters.

Shapes after the table of the Oculus visemes and what they are seen to do; diphthongs are two shapes.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf

from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import shapes
from metagraph.playback.life.mouth import MouthPiece
from metagraph.speech.textgrid import GridInterval, GridTier, TextGrid

_SILENT = {
    "",
    "sil",
    "sp",
    "spn",
    "pau",
    "#",
    "h#",
    "epi",
    "_",
    "<p:>",
    "<p>",
    "<sil>",
    "noise",
    "brth",
    "<eps>",
    "xxx",
    "...",
}

_ARPABET = {
    "aa": "aa",
    "ae": "aa",
    "ah": "aa",
    "ao": "O",
    "aw": "aa U",
    "ax": "E",
    "axr": "RR",
    "ay": "aa I",
    "eh": "E",
    "er": "RR",
    "ey": "E I",
    "ih": "I",
    "ix": "I",
    "iy": "I",
    "ow": "O U",
    "oy": "O I",
    "uh": "U",
    "uw": "U",
    "ux": "U",
    "axh": "E",
    "b": "PP",
    "p": "PP",
    "m": "PP",
    "em": "PP",
    "f": "FF",
    "v": "FF",
    "th": "TH",
    "dh": "TH",
    "d": "DD",
    "t": "DD",
    "dx": "DD",
    "l": "nn",
    "el": "nn",
    "n": "nn",
    "en": "nn",
    "nx": "nn",
    "ng": "kk",
    "eng": "kk",
    "k": "kk",
    "g": "kk",
    "q": "kk",
    "hh": "kk",
    "hv": "kk",
    "h": "kk",
    "ch": "CH",
    "jh": "CH",
    "sh": "CH",
    "zh": "CH",
    "s": "SS",
    "z": "SS",
    "r": "RR",
    "w": "U",
    "wh": "U",
    "y": "I",
    "bcl": "PP",
    "pcl": "PP",
    "dcl": "DD",
    "tcl": "DD",
    "gcl": "kk",
    "kcl": "kk",
}
_LONG_VOWELS = {
    k
    for k, v in _ARPABET.items()
    if len(k) == 2 and v.split()[0] in ("aa", "E", "I", "O", "U", "RR") and k != "wh"
}
_SIGNS = {  # IPA, and SAMPA where it differs
    "aa": "aɑɐʌæäɶAV{6",
    "E": "eɛəɜɘɞE@3",
    "I": "iɪɨjI1}",
    "O": "oɔɒɤœOQ9",
    "U": "uʊʉɯwʍyʏɥøUMHWY28",
    "PP": "pbmɓʙB",
    "FF": "fvɸβʋɱFP",
    "TH": "θðTD",
    "DD": "tdʈɖɾɗ4",
    "nn": "nlɭɫɲɳʎɬɮɴʟNJL5",
    "kk": "kgɡqcɟxɣχhɦħʔŋʕɠGXh?",
    "CH": "ʃʒɕʑʂʐçSZC",
    "SS": "szʦʣ",
    "RR": "rɹʀʁɻɽɚɝR`",
}
_SIGN = {sign: viseme for viseme, signs in _SIGNS.items() for sign in signs}
_VOWELS = ("aa", "E", "I", "O", "U")
_REDUCED = {"ə", "@", "ɘ", "ɐ", "6", "ax", "axh", "ix"}  # vowels that are hardly made
_TWO = (0.6, 0.4)  # how a diphthong's time is shared
_NOISE = re.compile(
    r"<[^<>]*>|\[[^\[\]]{3,}\]"
)  # WebMAUS' <usb> and <nib>, and what others put into brackets
_ASIDE = re.compile(r"_[A-Za-z0-9<>=?\\~^}-]")  # X-SAMPA's signs that only change the sound before: t_h
_TONE = re.compile(r"(\D*[^\W\d_])(?:_T|_)?([0-6])")  # a1, uo_4, aa_T2
_NAMED_PHONES = r"phon|segment|sampa|ipa|\bmau\b|\bph\b|^phs?$"
# WebMAUS calls its words ORT-MAU and KAN-MAU.
_NAMED_WORDS = r"word|\bort|\bkan\b|\btr[nls]\b|transcript|text|utter|phrase"


def is_arpabet(labels: Iterable[str]) -> bool:
    """Whether labels are ARPAbet: nearly all known there, and a vowel of two letters among them."""
    plain = [_bare(x) for x in labels if x.strip().casefold() not in _SILENT]
    known = sum(x in _ARPABET for x in plain)
    return bool(plain) and known >= 0.75 * len(plain) and any(x in _LONG_VOWELS for x in plain)


def find_visemes(label: str, arpabet: bool) -> tuple[list[str], float]:
    """Return a phone's mouth shapes in turn, none for silence, and how fully they are made, 0..1."""
    if label.strip().casefold() in _SILENT or _NOISE.fullmatch(label.strip()):
        return [], 0.0
    if arpabet:
        bare = _bare(label)
        if bare in _ARPABET:
            weak = bare in _REDUCED or (label.strip().endswith("0") and bare in _LONG_VOWELS)
            return _ARPABET[bare].split(), 0.65 if weak else 1.0
        out: list[str] = []
        while bare:  # two run together, as "PT"
            size = next((n for n in (3, 2, 1) if bare[:n] in _ARPABET), 0)
            out += _ARPABET[bare[:size]].split() if size else []
            bare = bare[max(1, size) :]
        return out, 1.0
    signs = [c for c in unicodedata.normalize("NFD", _ASIDE.sub("", label)) if not unicodedata.combining(c)]
    out = []
    for sign in signs:
        viseme = _SIGN.get(sign)
        if viseme is not None and (not out or out[-1] != viseme):
            out.append(viseme)
    if out[:2] in (["DD", "CH"], ["DD", "SS"]):
        out = out[1:]  # an affricate shows its second part
    return out, 0.65 if all(s in _REDUCED or s not in _SIGN for s in signs) else 1.0


def _bare(label: str) -> str:
    return re.sub(r"[^a-z]", "", label.strip().casefold())


def drop_tones(labels: Iterable[str]) -> dict[str, str]:
    """Return each label without the digit of its tone, as phones of Mandarin, Cantonese and Vietnamese have
    it: where at least half of the labels with a vowel end in a digit, and not all in the same one. Otherwise
    digits are SAMPA's vowels, and labels stay as they are.
    """
    given = set(labels)
    found = {label: m for label in given if (m := _TONE.fullmatch(label.strip())) is not None}
    vowels = [x for x in given if any(_SIGN.get(c) in _VOWELS for c in x)]
    toned = len({m[2] for m in found.values()}) > 1 and 2 * len(found) >= len(vowels)
    return {label: found[label][1] if toned and label in found else label for label in given}


def list_mouth_pieces(grid: TextGrid) -> list[MouthPiece]:
    """Return what the mouth goes through in a TextGrid, by its phones or, where it has none, its words."""
    tiers = list_phone_tiers(grid)
    if tiers:
        phones = tiers[0]
        arpabet = is_arpabet(i.text for i in phones.intervals)
        labels = [i.text for i in phones.intervals]
        bare = {} if arpabet else drop_tones(labels)  # digits of ARPAbet are stress
        found = [(i, bare.get(i.text, i.text)) for i in _in_turn(phones)]
        return [p for i, label in found for p in _spread(i, *find_visemes(label, arpabet))]
    words = _pick(_speaking(grid), _NAMED_WORDS, short=False)
    return [p for i in _in_turn(words[0]) for p in _spell(i)] if words else []


def list_phone_tiers(grid: TextGrid) -> list[GridTier]:
    """Return the tiers that hold phones: those whose names say so, one for each speaker; else the one whose
    labels are short.
    """
    tiers = _speaking(grid)
    plain = [t for t in tiers if not re.search(_NAMED_WORDS, t.name.casefold())]
    return _pick(plain, _NAMED_PHONES, short=True) or _pick(tiers, _NAMED_PHONES, short=True)


def _speaking(grid: TextGrid) -> list[GridTier]:
    return [
        t for t in grid.tiers if not t.points and any(i.text.casefold() not in _SILENT for i in t.intervals)
    ]


def _in_turn(tier: GridTier) -> list[GridInterval]:
    """Return a tier's intervals by start, each ending where the next begins: a mouth says one thing at a
    time.
    """
    ordered = sorted(tier.intervals, key=lambda i: i.start)
    ends = [min(a.end, b.start) for a, b in pairwise(ordered)]
    return [replace(i, end=end) if end < i.end else i for i, end in zip(ordered, [*ends, inf], strict=False)]


def _pick(tiers: Sequence[GridTier], pattern: str, short: bool) -> list[GridTier]:
    """Return the tiers whose names fit a pattern, else the longest whose labels are short, or are not."""
    named = [t for t in tiers if re.search(pattern, t.name.casefold())]
    if named:
        return named

    def length(tier: GridTier) -> float:
        sizes = sorted(len(i.text) for i in tier.intervals if i.text.casefold() not in _SILENT)
        return sizes[len(sizes) // 2]

    fitting = [t for t in tiers if (length(t) <= 2.5) == short]
    return sorted(fitting, key=lambda t: -len(t.intervals))[:1]


def _spread(interval: GridInterval, found: list[str], strength: float) -> list[MouthPiece]:
    """Return an interval's pieces: a diphthong's two, or equal parts."""
    if not found or interval.end <= interval.start:
        return []
    parts = _TWO if len(found) == 2 and all(f in _VOWELS for f in found) else (1 / len(found),) * len(found)
    out, at = [], interval.start
    for viseme, part in zip(found, parts, strict=True):
        end = at + part * (interval.end - interval.start)
        out.append(MouthPiece(at, end, viseme, strength))
        at = end
    return out


def _spell(interval: GridInterval) -> list[MouthPiece]:
    if interval.text.casefold() in _SILENT:
        return []
    found = [s for word in interval.text.split() for s in shapes(ALPHABET, word)]
    sizes = [1.25 if s in _VOWELS else 0.8 for s in found]
    scale = (interval.end - interval.start) / sum(sizes) if sizes else 0.0
    out, at = [], interval.start
    for viseme, size in zip(found, sizes, strict=True):
        out.append(MouthPiece(at, at + size * scale, viseme))
        at += size * scale
    return out
