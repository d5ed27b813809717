"""What a stance that nobody named is called: as an animator would say what its pose looks like."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from metagraph.suggest.stances import Shape

Array = NDArray[Any]


def pose_words(shape: Shape, usual: Shape | None = None) -> str:
    """Return words for a stance's pose."""
    return f"{shape.layer} stance"
