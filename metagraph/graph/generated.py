"""Clips that a learned model made: in the project like all others, and they say so."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from metagraph.graph.edits import add_clips
from metagraph.graph.model import ClipEntry, Project
from metagraph.motion.clip import Clip


def add_generated(
    project: Project, loaded: Iterable[tuple[str, int, str, Clip]], model: str, seed: int
) -> Project:
    """Add clips as `add_clips` does, with who made them. model: its name, as people know it. seed: its
    chance.
    """
    loaded = tuple(loaded)
    project = add_clips(project, loaded)
    new = {(path, take) for path, take, *_ in loaded}
    clips = {
        ident: replace(entry, made_by=model, made_seed=seed) if (entry.path, entry.take) in new else entry
        for ident, entry in project.clips.items()
    }
    return replace(project, clips=clips)


def describe_origin(entry: ClipEntry) -> str:
    """Return who made a clip, in words; "" for one that was not generated."""
    return f"made by the model '{entry.made_by}', seed {entry.made_seed}" if entry.made_by else ""
