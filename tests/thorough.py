"""How thorough the tests are: METAGRAPH_THOROUGH=1 asks for what would take too long each time."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")

THOROUGH = bool(os.environ.get("METAGRAPH_THOROUGH"))


def many(usual: int, thorough: int) -> int:
    """Return how many of what a test draws there are."""
    return thorough if THOROUGH else usual


def some(every: Sequence[T], usual: int) -> list[T]:
    """Return one in `usual` of what is tried, and all of it where asked to be thorough."""
    return list(every[:: many(usual, 1)])
