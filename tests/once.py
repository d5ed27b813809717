"""What tests ask for again and again and is the same each time: a process measures it once."""

from __future__ import annotations

import copy
import functools
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST = 64  # results a process keeps
SAMPLES = Path(__file__).resolve().parents[1] / "sample_clips"


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


def read_once(read: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of the path of a sound that decodes each of the samples' sounds once, wherever a copy
    of it lies; who asks gets values of their own. Files that differ in a byte are read.
    """
    names = {path.name for kind in ("ogg", "wav", "flac") for path in SAMPLES.rglob(f"*.{kind}")}
    known: dict[tuple[Any, ...], Any] = {}

    @functools.wraps(read)
    def decoded(path: str | Path, *options: Any, **more: Any) -> Any:
        path = Path(path)
        if path.name not in names or not path.is_file():
            return read(path, *options, **more)
        digest = hashlib.blake2b(path.read_bytes(), digest_size=20).digest()
        key = (path.name, digest, options, *sorted(more.items()))
        if key not in known:
            if len(known) >= MOST:
                known.pop(next(iter(known)))
            known[key] = read(path, *options, **more)
        return copy.deepcopy(known[key])

    return decoded
