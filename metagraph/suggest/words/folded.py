"""Letters as names are compared: without accents, with one kind of kana and plain digits; and what kind of
writing they are.
"""

from __future__ import annotations

import unicodedata
from functools import lru_cache

_BASES = {"ł": "l", "ø": "o", "đ": "d", "ð": "d", "æ": "ae", "œ": "oe", "ı": "i", "ß": "ss", "þ": "th"}
_UMLAUTS = str.maketrans(
    {"ä": "ae", "ö": "oe", "ü": "ue", "ø": "oe", "å": "aa", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue"}
)
_HALVES = "\uff9e\uff9f"  # voicing marks of halfwidth kana
# By what romaji other than Hepburn's writes; long vowels are often written short.
_ROMAJI_AS = (
    ("shi", "si"),
    ("chi", "ti"),
    ("tsu", "tu"),
    ("fu", "hu"),
    ("ji", "zi"),
    ("sh", "sy"),
    ("ch", "ty"),
)
_LONG = (("ou", "o"), ("oo", "o"), ("uu", "u"), ("aa", "a"), ("ii", "i"), ("ei", "e"))
_VOWELS = "aiueo"


def fold_letters(text: str) -> tuple[str, tuple[int, ...]]:
    """Return a text's letters as they are compared, case kept, and where in the text each one comes from.

    The places have one entry more than letters: the text's length.
    """
    if text.isascii():
        return text, tuple(range(len(text) + 1))
    letters: list[str] = []
    places: list[int] = []
    at = 0
    while at < len(text):
        end = at + 1
        while end < len(text) and (unicodedata.combining(text[end]) or text[end] in _HALVES):
            end += 1
        for letter in _bases(text[at:end]):
            letters.append(letter)
            places.append(at)
        at = end
    return "".join(letters), (*places, len(text))


@lru_cache(maxsize=4096)
def _bases(cluster: str) -> str:
    """Return one letter with its marks in the form it is compared in."""
    out = []
    for letter in unicodedata.normalize("NFKC", cluster):
        if "\u30a1" <= letter <= "\u30f6":
            out.append(chr(ord(letter) - 0x60))  # katakana as hiragana
            continue
        apart = unicodedata.normalize("NFD", letter)
        if "\u3040" <= letter <= "\u30ff" or len(apart) == 1 or not unicodedata.combining(apart[1]):
            base = _BASES.get(letter.lower(), "")
            out.append((base.capitalize() if letter.isupper() else base) if base else letter)
        elif not unicodedata.combining(letter):
            out.append(apart[0])
    return "".join(out)


def strip_to_letters(text: str) -> str:
    """Return a phrase's letters alone: folded, small, without blanks, hyphens or apostrophes."""
    if text.isascii() and text.isalnum():
        return text.lower()
    return "".join(c for c in fold_letters(text)[0].lower() if c.isalnum() or c == "ー")


@lru_cache(maxsize=4096)  # the words of a language's phrases come in every order
def list_spellings(phrase: str) -> frozenset[str]:
    """Return the ways in which a phrase may stand in a name, each as `plain` has it."""
    kana = strip_to_letters(phrase)
    out = {kana}
    if phrase.isascii():
        return frozenset(out) if kana else frozenset()
    if any(ord(c) in _UMLAUTS for c in phrase):
        out.add(strip_to_letters(phrase.translate(_UMLAUTS)))
    if kana and all("ぁ" <= c <= "ゖ" or c == "ー" for c in kana):
        out |= list_romaji(kana)
    return frozenset(s for s in out if s)


def list_romaji(kana: str) -> set[str]:
    """Return how hiragana is written in Latin letters, by Hepburn and otherwise."""
    table = _kana()
    text, at, doubled = "", 0, False
    while at < len(kana):
        if kana[at] == "っ":
            doubled, at = True, at + 1
            continue
        if kana[at] == "ー":
            text, at = text + (text[-1:] if text[-1:] in _VOWELS else ""), at + 1
            continue
        pair = kana[at : at + 2]
        sound = table.get(pair) or table.get(kana[at], "")
        at += 2 if pair in table and len(pair) == 2 else 1
        text += (("t" if sound.startswith("ch") else sound[:1]) if doubled else "") + sound
        doubled = False
    out = {text}
    short = text
    for long, one in _LONG[:-2]:
        short = short.replace(long, one)
    out.add(short)
    for form in tuple(out):
        other = form
        for mine, theirs in _ROMAJI_AS:
            other = other.replace(mine, theirs)
        out.add(other)
        out.add(form.replace("wo", "o"))
    return out


@lru_cache(maxsize=1)
def _kana() -> dict[str, str]:
    rows = {
        "": "あいうえお", "k": "かきくけこ", "s": "さしすせそ", "t": "たちつてと", "n": "なにぬねの",
        "h": "はひふへほ", "m": "まみむめも", "r": "らりるれろ", "g": "がぎぐげご", "z": "ざじずぜぞ",
        "d": "だぢづでど", "b": "ばびぶべぼ", "p": "ぱぴぷぺぽ",
    }  # fmt: skip
    out = {
        kana: sound + vowel for sound, row in rows.items() for kana, vowel in zip(row, _VOWELS, strict=True)
    }
    out |= {"し": "shi", "ち": "chi", "つ": "tsu", "ふ": "fu", "じ": "ji", "ぢ": "ji", "づ": "zu"}
    out |= {"や": "ya", "ゆ": "yu", "よ": "yo", "わ": "wa", "を": "wo", "ん": "n"}
    out |= {"ぁ": "a", "ぃ": "i", "ぅ": "u", "ぇ": "e", "ぉ": "o", "ゔ": "vu"}
    for base in "きぎしじちにひびぴみり":
        sound = out[base][:-1]
        for small, vowel in zip("ゃゅょぇ", "auoe", strict=True):
            joined = "" if sound in ("sh", "j", "ch") else "y"
            out[base + small] = sound + joined + vowel
    for base, sound in (("ふ", "f"), ("ゔ", "v"), ("う", "w")):
        for small, vowel in zip("ぁぃぇぉ", "aieo", strict=True):
            out[base + small] = sound + vowel
    return out | {"てぃ": "ti", "でぃ": "di", "とぅ": "tu", "ふぁ": "fa"}


def is_run_together(letter: str) -> bool:
    """Whether a letter is of a writing without blanks between words: kana, hanzi, hangul."""
    code = ord(letter)
    return (
        0x3005 <= code <= 0x30FF
        or 0x3400 <= code <= 0x9FFF
        or 0xAC00 <= code <= 0xD7A3
        or 0xF900 <= code <= 0xFAFF
    )
