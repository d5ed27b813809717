"""Making many things at once without looking for circles among them, again and again, as they become more."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Have no circles looked for meanwhile, in any thread: for what makes tens of thousands of things that
    are in none, and is done in a moment.
    """
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()
