"""The cheapest words that select exactly some states, of all that could be typed: so that no one has to trust
our choice of what an expert would type.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import MappingProxyType

LONGEST = 24  # letters of a part of a name that is tried
WIDEST = 4  # parts that are put together at most
TRIED = 400  # parts of each kind that are tried together


@dataclass(frozen=True)
class Words:
    """text: what is typed. terms: how many thoughts are in it: parts of names, wanted or not."""

    text: str
    terms: int


@lru_cache(maxsize=4096)
def _pieces(name: str) -> tuple[str, ...]:
    """Return the parts of a name that can be typed as one; those of a clip are asked for again and again."""
    starts = [i for i, letter in enumerate(name) if letter not in " |-"]
    ends = [n for n, letter in enumerate(name) if letter in " |"] + [len(name)]
    pieces = dict[str, None]()
    for i in starts:
        last = min(next(n for n in ends if n >= i), i + LONGEST)
        pieces.update(dict.fromkeys(name[i:j] for j in range(i + 1, last + 1)))
    return tuple(pieces)


@lru_cache(maxsize=8)
def _parts(names: tuple[str, ...]) -> Mapping[int, str]:
    """Return set of names -> the shortest part that just these have."""
    seen: dict[str, int] = {}
    for n, name in enumerate(names):
        bit = 1 << n
        for piece in _pieces(name):
            seen[piece] = seen.get(piece, 0) | bit
    out: dict[int, str] = {}
    for piece, which in seen.items():
        known = out.get(which)
        if known is None or (len(piece), piece) < (len(known), known):
            out[which] = piece
    return MappingProxyType(out)


def _most(sets: Sequence[tuple[int, int]], left: int) -> int:
    """Return the first set that has most of what is left for its keys, 0 where none has any."""
    best, most = 0, 0.0
    for one, keys in sets:
        if one & left and (share := (one & left).bit_count() / keys) > most:
            best, most = one, share
    return best


class Finder:
    """What parts of names select. names: of all states there are, of which sets are reported as bits."""

    def __init__(self, names: Sequence[str]) -> None:
        self.names = tuple(n.lower() for n in names)

    @cached_property
    def parts(self) -> Mapping[int, str]:
        """Set of states -> the shortest part of a name that selects just these."""
        return _parts(self.names)

    def one(self, want: int) -> Words | None:
        """Return one part of names, or two that both must be there, that select a set; None if none do."""
        if want in self.parts:
            return Words(self.parts[want], 1)
        above = sorted((m for m in self.parts if m & want == want), key=lambda m: len(self.parts[m]))[:TRIED]
        both = [
            (len(self.parts[a]) + len(self.parts[b]) + 1, f"{self.parts[a]} {self.parts[b]}")
            for n, a in enumerate(above)
            for b in above[n + 1 :]
            if a & b == want
        ]
        return Words(min(both)[1], 2) if both else None

    def best(self, want: int, joined: bool = True) -> Words | None:
        """Return the cheapest words found that select a set: parts, parts but others, or several of these
        with | between them. joined: | may be typed. None if nothing was found.

        Single parts and pairs are tried all, up to `TRIED` of a kind; several are joined greedily, the part
        that gives most for a key first, so that more keys than needed may be typed, but never a wrong set.
        """
        simple = self._but(want)
        if not joined:
            return simple
        some = self._several(want)
        found = [w for w in (simple, some) if w is not None]
        return min(found, key=lambda w: (len(w.text) + 5 * w.terms, w.text)) if found else None

    def _but(self, want: int) -> Words | None:
        """Return words for a set that are one part, or one without some others."""
        plain = self.one(want)
        found = [plain] if plain is not None else []
        above = [m for m in self.parts if m & want == want and m != want]
        outside = [(m, len(part) + 7) for m, part in self.parts.items() if not m & want]
        for whole in sorted(above, key=lambda m: len(self.parts[m]))[:TRIED]:
            rest, text, terms = whole & ~want, self.parts[whole], 1
            while rest and terms <= WIDEST:
                best = _most(outside, rest)
                if not best:
                    break
                text, rest, terms = f"{text} -{self.parts[best]}", rest & ~best, terms + 1
            if not rest:
                found.append(Words(text, terms))
        return min(found, key=lambda w: (len(w.text) + 5 * w.terms, w.text)) if found else None

    def _several(self, want: int) -> Words | None:
        """Return words for a set as several parts with | between them."""
        inside = {m: Words(p, 1) for m, p in self.parts.items() if m & ~want == 0}
        for m, whole in list(self.parts.items()):
            # A part that selects a few too many, without one other part.
            more = m & ~want
            if more and m & want and more in self.parts and m & want not in inside:
                inside[m & want] = Words(f"{whole} -{self.parts[more]}", 2)
        costs = [(m, len(words.text) + 5 * words.terms) for m, words in inside.items()]
        left = want
        chosen: list[Words] = []
        while left:
            best = _most(costs, left)
            if not best or len(chosen) >= 60:
                return None
            chosen.append(inside[best])
            left &= ~best
        return Words("|".join(w.text for w in chosen), sum(w.terms for w in chosen))
