"""When the life layers do what: drawn once from the seed, then pure in time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from metagraph.graph.life import Life
from metagraph.playback.life.track import Track
from metagraph.playback.life.voice import Voice


@dataclass(frozen=True)
class Schedule:
    """Everything that happens of itself from 0 to `end` seconds."""

    end: float = 0.0


def schedule(life: Life, track: Track, voices: Mapping[str, Voice], seed: int, end: float, before: Schedule, now: float) -> Schedule:
    """Return the schedule to `end`. What `before` holds that begins before `now` stays exactly as it was."""
    return Schedule(end)
