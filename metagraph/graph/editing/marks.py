"""Edits of what is on clips to find them again, and of the order in which actions are listed. Nothing plays
differently for the first; the second changes nothing but lists either, since what plays is drawn by ids.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from msgspec import structs

from metagraph.graph.clip_mark import BARE, ClipMark
from metagraph.graph.model import Project


def mark_of(project: Project, clip: str) -> ClipMark:
    """Return what is on a clip."""
    return project.marks.get(clip, BARE)


def mark(project: Project, clips: Collection[str], **changes: Any) -> Project:
    """Put something on clips: fields of `ClipMark`. What says nothing is not kept, nor what is on clips that
    are gone.
    """
    kept = {clip: found for clip, found in project.marks.items() if clip in project.clips}
    for clip in clips:
        if clip not in project.clips:
            continue
        found = structs.replace(kept.get(clip, BARE), **changes)
        if found == BARE:
            kept.pop(clip, None)
        else:
            kept[clip] = found
    return replace(project, marks=kept) if kept != project.marks else project
