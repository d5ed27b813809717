"""Making many things at once without looking for circles among them, again and again, as they become more."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected(lasting: bool = False) -> Iterator[None]:
    """Have no circles looked for meanwhile, in any thread: for what makes tens of thousands of things that
    are in none, and is done in a moment. lasting: whatever there is by then stays as long as the program, and
    is never looked through: not even once afterwards, which takes 15 ms when a window was made.
    """
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if lasting:
            gc.freeze()
        if was:
            gc.enable()
