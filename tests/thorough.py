"""How thorough the tests are: METAGRAPH_THOROUGH=1 asks for what would take too long each time."""

from __future__ import annotations

import os

THOROUGH = bool(os.environ.get("METAGRAPH_THOROUGH"))


def many(usual: int, thorough: int) -> int:
    """Return how many of what a test draws there are."""
    return thorough if THOROUGH else usual
