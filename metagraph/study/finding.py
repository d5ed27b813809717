"""The cheapest words that select exactly some states, of all that could be typed: so that no one has to trust
our choice of what an expert would type.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

LONGEST = 24  # letters of a part of a name that is tried
WIDEST = 4  # parts that are put together at most
TRIED = 400  # parts of each kind that are tried together


@dataclass(frozen=True)
class Words:
    """text: what is typed. terms: how many thoughts are in it: parts of names, wanted or not."""

    text: str
    terms: int


class Finder:
    """What parts of names select. names: of all states there are, of which sets are told as bits."""

    def __init__(self, names: Sequence[str]) -> None:
        self.names = tuple(n.lower() for n in names)

    @cached_property
    def parts(self) -> Mapping[int, str]:
        """Set of states -> the shortest part of a name that selects just these."""
        seen: dict[str, int] = {}
        for n, name in enumerate(self.names):
            pieces = {
                name[i:j] for i in range(len(name)) for j in range(i + 1, min(len(name), i + LONGEST) + 1)
            }
            for piece in pieces:
                if not any(c in " |-" for c in piece[:1]) and " " not in piece and "|" not in piece:
                    seen[piece] = seen.get(piece, 0) | 1 << n
        out: dict[int, str] = {}
        for piece, which in seen.items():
            if which not in out or (len(piece), piece) < (len(out[which]), out[which]):
                out[which] = piece
        return out

    def one(self, want: int) -> Words | None:
        """Return one part of names, or two that both must be there, that select a set; None where none do."""
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
        with | between them. joined: | may be typed. None where nothing was found.

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
        outside = [m for m in self.parts if not m & want]
        for whole in sorted(above, key=lambda m: len(self.parts[m]))[:TRIED]:
            rest, text, terms = whole & ~want, self.parts[whole], 1
            while rest and terms <= WIDEST:
                best = max(
                    outside, key=lambda m: (m & rest).bit_count() / (len(self.parts[m]) + 7), default=0
                )
                if not best & rest:
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
        left = want
        chosen: list[Words] = []
        while left:
            best = max(
                inside,
                key=lambda m: (m & left).bit_count() / (len(inside[m].text) + 5 * inside[m].terms),
                default=0,
            )
            if not best & left or len(chosen) >= 60:
                return None
            chosen.append(inside[best])
            left &= ~best
        return Words("|".join(w.text for w in chosen), sum(w.terms for w in chosen))
