"""Verbs that mean something else wherever the hand is: remove, rename, copy, paste, select all. Features
offer what they do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Verb = Literal["remove", "rename", "copy", "paste", "select_all"]


@dataclass(frozen=True)
class _Offer:
    rank: int
    applies: Callable[[], bool]
    do: Callable[[], object]


class Verbs:
    """Of what is offered for a verb, the one of the lowest rank that applies is done."""

    def __init__(self) -> None:
        self._offers: dict[Verb, list[_Offer]] = {}

    def offer(self, verb: Verb, applies: Callable[[], bool], do: Callable[[], object], rank: int = 5) -> None:
        """Let a verb do something while `applies`. rank: who is asked first, 0 to 9."""
        offers = self._offers.setdefault(verb, [])
        offers.append(_Offer(rank, applies, do))
        offers.sort(key=lambda o: o.rank)

    def can(self, verb: Verb) -> bool:
        """Return whether there is anything to do it to."""
        return any(o.applies() for o in self._offers.get(verb, ()))

    def do(self, verb: Verb) -> None:
        """Do it; nothing where nothing applies."""
        found = next((o for o in self._offers.get(verb, ()) if o.applies()), None)
        if found is not None:
            found.do()
