"""Assign the keys that choose in an open menu: each belongs to one entry, in any language."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache


@lru_cache(maxsize=256)
def with_distinct_keys(texts: tuple[str, ...]) -> tuple[str, ...]:
    """Return the texts of one menu, with each key used for at most one entry. The first text that marks a key
    keeps it. A later one gets another of its letters, beginnings of words first, or none if all are taken.

    A text without a mark stays without.
    """
    taken: dict[str, int] = {}  # key -> index of its text
    for place, text in enumerate(texts):
        key = read_mnemonic_key(text)
        if key:
            taken.setdefault(key, place)
    out = []
    for place, text in enumerate(texts):
        key = read_mnemonic_key(text)
        if not key or taken[key] == place:
            out.append(text)
            continue
        plain = _without(text)
        free = next((n for n in _offered(plain) if plain[n].lower() not in taken), None)
        if free is None:
            out.append(plain)
        else:
            taken[plain[free].lower()] = place
            out.append(f"{plain[:free]}&{plain[free:]}")
    return tuple(out)


def read_mnemonic_key(text: str) -> str:
    """Return the key that a text marks, in lower case; "" if it marks none."""
    place = _marked(text)
    return text[place + 1].lower() if place is not None else ""


def _marked(text: str) -> int | None:
    """Return where the mark is. Two in a row are one visible "&"."""
    place = 0
    while (place := text.find("&", place)) >= 0 and place + 1 < len(text):
        if text[place + 1] != "&":
            return place
        place += 2
    return None


def _without(text: str) -> str:
    place = _marked(text)
    return text if place is None else text[:place] + text[place + 1 :]


def _offered(plain: str) -> Iterator[int]:
    """Yield the indices of letters and digits: those that begin words, then the others."""
    begins = [n for n, c in enumerate(plain) if c.isalnum() and (n == 0 or not plain[n - 1].isalnum())]
    yield from begins
    yield from (n for n, c in enumerate(plain) if c.isalnum() and n not in begins)
