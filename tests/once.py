"""What tests ask for again and again and is the same each time: a process measures it once."""

from __future__ import annotations

import copy
import functools
import hashlib
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST = 64  # results a process keeps


def heard_once(measure: Callable[[NDArray[Any], int], Any]) -> Callable[[NDArray[Any], int], Any]:
    """Return a function of a sound, samples `[N]` and samples a second, that measures each sound once; who
    asks gets values of their own.
    """
    known: dict[tuple[bytes, str, tuple[int, ...], int], Any] = {}

    @functools.wraps(measure)
    def measured(samples: NDArray[Any], rate: int) -> Any:
        digest = hashlib.blake2b(np.ascontiguousarray(samples).view(np.uint8).data, digest_size=20).digest()
        key = (digest, samples.dtype.str, samples.shape, rate)
        if key not in known:
            if len(known) >= MOST:
                known.pop(next(iter(known)))
            known[key] = measure(samples, rate)
        return copy.deepcopy(known[key])

    return measured
