"""How thorough the tests are.

METAGRAPH_NIGHTLY=1 also runs the tests marked `nightly`; METAGRAPH_THOROUGH=1 runs them and repeats more.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")

THOROUGH = bool(os.environ.get("METAGRAPH_THOROUGH"))
NIGHTLY = THOROUGH or bool(os.environ.get("METAGRAPH_NIGHTLY"))


def many(usual: int, thorough: int) -> int:
    """Return how many of what a test draws there are."""
    return thorough if THOROUGH else usual


def some(every: Sequence[T], usual: int) -> list[T]:
    """Return one in `usual` of what is tried, and all of it where asked to be thorough."""
    return list(every[:: many(usual, 1)])
