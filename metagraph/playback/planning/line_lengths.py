"""How long lines of dialogue take to say."""

from __future__ import annotations

from metagraph.graph.model import Project
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import read_aloud


def find_spoken_seconds(
    project: Project, line: str | None, text: str, duration: float | None = None
) -> float:
    """Return how long something takes to say: as asked, as its sound, as the line says, or as its text is
    long.
    """
    entry = project.lines.get(line or "")
    if duration is not None:
        return max(duration, 0.0)
    if line is not None and line in project.voices:
        return float(project.voices[line].duration)
    if entry is not None and entry.duration is not None:
        return entry.duration
    return read_aloud(ALPHABET, text)
