"""How words of any writing are compared: without case, punctuation and hyphens ("Uh-huh." = "uh huh"), in
one Unicode form, however they are parted ("d'accord" = "d' accord", そう です = そうです), drawn out
("jaaa" = "ja") or left without accents ("si" for "sí").
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache

_APOSTROPHES = str.maketrans("’‘ʼ`´＇", "''''''")
_BETWEEN = re.compile(r"[^\w'%]+")
_WAVE = re.compile(r"(?<=[ぁ-ヿ])[〜～~]+")  # わー〜: a vowel held, as ー says
_RUNS = re.compile(r"(.)\1\1+")
_RUN = re.compile(r"(.)\1+")
_HIRAGANA = {c: c - 0x60 for c in range(0x30A1, 0x30F7)}  # ハイ is はい
_ACCENTS = frozenset("\u0300\u0301\u0302\u0303\u0327")  # those that typists leave out; ä, ö, ü are letters
_HELD = "ーっ"  # そうですねー, はいっ
_STOPS = "、。，！？；：「」『』（）…・"
_LONGEST = 200  # letters that are looked at as phrases alone


@lru_cache(maxsize=1 << 15)
def split_tokens(text: str) -> tuple[str, ...]:
    """Return what a text's words are compared by; marks of vowels (Devanagari) belong to their letters."""
    text = text.translate(_APOSTROPHES)
    if text.isascii():
        bare = _BETWEEN.sub(" ", text.casefold().replace("_", " "))
    else:
        text = _WAVE.sub("ー", text)
        text = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", text).casefold())
        bare = "".join(c if _belongs(c) else " " for c in text if unicodedata.category(c) != "Cf")
    return tuple(t for t in (w.strip("'") for w in bare.split()) if t and t != "%")


def _belongs(c: str) -> bool:
    return c.isalnum() or c in "'%" or unicodedata.category(c)[0] == "M"


def is_unspaced(c: str) -> bool:
    """Whether a letter is of a writing that puts no blanks between words: Han, kana, Thai, Lao, Khmer,
    Burmese.
    """
    return (
        "\u3040" <= c <= "\u30ff"
        or "\u3400" <= c <= "\u9fff"
        or "\uf900" <= c <= "\ufaff"
        or "\U00020000" <= c <= "\U0003ffff"
        or "\u0e00" <= c <= "\u0eff"
        or "\u1000" <= c <= "\u109f"
        or "\u1780" <= c <= "\u17ff"
        or c == "々"
    )


def join_tokens(texts: Iterable[str]) -> str:
    """Return words as one text: blanks between them, but where writing has none."""
    out = ""
    for text in texts:
        close = out[-1:] and text and all(is_unspaced(c) or c in _STOPS for c in (out[-1], text[0]))
        out += text if close or not out else f" {text}"
    return out


def _key(token: str) -> str:
    """Return a token's letters as phrases are made of them: no apostrophes, katakana as hiragana."""
    return token.replace("'", "").translate(_HIRAGANA)


def _bare(key: str) -> str:
    """Return a Latin phrase without the accents that typists leave out."""
    apart = unicodedata.normalize("NFD", key)
    plain = "".join(c for c in apart if c not in _ACCENTS)
    return unicodedata.normalize("NFC", plain) if plain.isascii() else key


class Vocabulary:
    """Phrases to find among words, the longest first. without: phrases that are others, though they are these
    when accents are left out.
    """

    def __init__(self, phrases: Iterable[str], without: Iterable[str] = ()) -> None:
        self._keys: dict[str, bool] = {}  # letters -> whether several tokens may make them
        others = {make_token_key(split_tokens(p)) for p in without}
        for phrase in phrases:
            words = split_tokens(phrase)
            key = make_token_key(words)
            several = len(words) > 1 or "'" in phrase.translate(_APOSTROPHES) or any(map(is_unspaced, key))
            bare = _bare(key)
            for form in (key, *([bare] if len(bare) > 1 and bare not in others else [])):  # "é" is no "e"
                if form:
                    self._keys[form] = self._keys.get(form, False) or several
        self._most = max(map(len, self._keys), default=0)

    def __contains__(self, words: tuple[str, ...]) -> bool:
        return self._has(make_token_key(words), len(words))

    def is_plainly(self, words: tuple[str, ...]) -> bool:
        """Whether tokens are a phrase, not drawn out: あの, not あのー."""
        return make_token_key(words) in self._keys

    def _has(self, key: str, count: int) -> bool:
        """Whether the letters of so many tokens are a phrase, as they are or drawn out. "E R" is no "er"."""
        found = self._keys.get(key)
        if found is None and (key[-1:] in _HELD or _RUNS.search(key) is not None):
            drawn = (_RUNS.sub(r"\1\1", key), _RUNS.sub(r"\1", key), key.rstrip(_HELD))
            found = next((f for d in drawn if (f := self._keys.get(d)) is not None), None)
        return found is not None and (found or count == 1)

    def at(self, words: Sequence[tuple[str, ...]], n: int) -> int:
        """Return how many of the words, each in its tokens, from the n-th on make the longest phrase that
        begins there; 0 for none.
        """
        found, key, count = 0, "", 0
        for m in range(n, len(words)):
            key += make_token_key(words[m])
            count += len(words[m])
            if len(_RUN.sub(r"\1", key)) > self._most:
                break
            if words[m] and words[n] and self._has(key, count):
                found = m + 1 - n
        return found

    def made_of(self, words: Sequence[tuple[str, ...]]) -> bool:
        """Whether words, each in its tokens, are phrases and nothing else. Where writing has no blanks, a
        word may hold several.
        """
        key = "".join(map(make_token_key, words))
        if not key or len(key) > _LONGEST:
            return False
        ends = dict(_ends(words))
        reached = {0: 0}  # letters -> tokens before them
        for a in range(len(key)):
            if a in reached:
                for b, count in ends.items():
                    if b > a and b not in reached and self._has(key[a:b], count - reached[a]):
                        reached[b] = count
        return len(key) in reached


def make_token_key(words: tuple[str, ...]) -> str:
    """Return the letters of tokens as they are compared with phrases."""
    return "".join(map(_key, words))


def _ends(words: Sequence[tuple[str, ...]]) -> Iterator[tuple[int, int]]:
    """Yield where a phrase may end, behind a token or a letter of a writing without blanks, and how many
    tokens have begun by then.
    """
    at = count = 0
    for word in words:
        for token in word:
            key, count = _key(token), count + 1
            yield from ((at + n, count) for n, c in enumerate(key, 1) if is_unspaced(c) or n == len(key))
            at += len(key)


@lru_cache(maxsize=64)
def make_word_vocabularies(
    responses: tuple[str, ...], hesitations: tuple[str, ...]
) -> tuple[Vocabulary, Vocabulary, Vocabulary, Vocabulary]:
    """Return responses, hesitations, those that are either, and those that are both, to find; left without
    its accents none becomes one of the others.
    """
    answers, pauses = Vocabulary(responses, hesitations), Vocabulary(hesitations, responses)
    both = Vocabulary(r for r in responses if split_tokens(r) in pauses)
    return answers, pauses, Vocabulary((*responses, *hesitations)), both
