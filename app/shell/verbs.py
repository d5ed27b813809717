"""Define verbs that depend on the context: remove, rename, copy, paste, select all, find. Features offer
what they do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Verb = Literal["remove", "rename", "copy", "paste", "select_all", "find"]


@dataclass(frozen=True)
class _Offer:
    rank: int
    applies: Callable[[], bool]
    do: Callable[[], object]


class Verbs:
    """Runs, of the offers for a verb that apply, the one with the lowest rank."""

    def __init__(self) -> None:
        self._offers: dict[Verb, list[_Offer]] = {}

    def offer(self, verb: Verb, applies: Callable[[], bool], do: Callable[[], object], rank: int = 5) -> None:
        """Make a verb do something while `applies` returns True. Offers are tried by `rank`, 0 to 9."""
        offers = self._offers.setdefault(verb, [])
        offers.append(_Offer(rank, applies, do))
        offers.sort(key=lambda o: o.rank)

    def can(self, verb: Verb) -> bool:
        """Return whether the verb does anything now."""
        return any(o.applies() for o in self._offers.get(verb, ()))

    def do(self, verb: Verb) -> None:
        """Run the verb; nothing happens if no offer applies."""
        found = next((o for o in self._offers.get(verb, ()) if o.applies()), None)
        if found is not None:
            found.do()
