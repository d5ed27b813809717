"""Recorded conversations of two, with the motion of one or both."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from metagraph.graph.conversation import Conversation
from metagraph.motion.clip import Clip

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Recorded:
    """A conversation, and how each side moved, None where nobody knows. samples: `[2, N]` of both voices at
    `generation.features.RATE`, None where they are in the conversation's files. notes: what there is to know
    about how it was read. files: what it was read from.
    """

    name: str
    clips: tuple[Clip | None, Clip | None]
    conversation: Conversation
    samples: Array | None = None
    notes: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
