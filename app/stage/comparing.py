"""Compare an open project with another version of it: what differs, and the motion of each thing in both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from app.stage.playback_source import ShownPlayback, play_in_context
from metagraph.formats.project.clip_loading import load_returned
from metagraph.graph.editing.differences import Difference, list_differences
from metagraph.graph.model import LAYERS, Project
from metagraph.motion.clip import Clip
from metagraph.playback.planner import make_plan

Side = Literal["before", "after"]
RATE = 30.0  # poses a second of a moving picture
LONGEST = 12.0  # seconds of a moving picture
IMPROVISED = 8.0  # seconds in which a change of settings is looked at


@dataclass(frozen=True)
class VersionComparison:
    """Two versions of a project with the motion of their clips, and what differs."""

    before: Project
    after: Project
    differences: tuple[Difference, ...]


def compare_projects(before: Project, after: Project, folder: Path | None) -> VersionComparison:
    """Return how a version differs from what is open; for a thread. Clips that are the same in both are not
    read again. folder: what the paths of the earlier version are relative to.
    """
    entries = {
        i: replace(entry, motion=known.motion, source=known.source)
        if (known := after.clips.get(i)) is not None and known == entry
        else entry
        for i, entry in before.clips.items()
    }
    loaded = load_returned(replace(before, clips=entries), folder).project
    return VersionComparison(loaded, after, tuple(list_differences(loaded, after)))


def film_difference(found: VersionComparison, difference: Difference, side: Side) -> Clip | None:
    """Return what a thing that differs looks like in one of the versions: a clip, an action between its
    stances, a stance; for what is no motion, what the project improvises. None if the thing is not in this
    version, or cannot be shown.
    """
    project = found.before if side == "before" else found.after
    if difference.fate == ("added" if side == "before" else "removed"):
        return None
    if difference.part == "clips":
        entry = project.clips.get(difference.ident)
        return entry.motion if entry is not None else None
    action = difference.ident
    if difference.part == "stances":
        stance = project.stance(difference.ident)
        loops = project.graphs[stance.layer].of(stance.id, "stance") if stance is not None else ()
        if not loops:
            return None
        action = loops[0].id
    if project.skeleton is None:
        return None
    shown = project.action(action)
    starts = {x: start for x in LAYERS if (start := project.graphs[x].start) is not None}
    if shown is not None:
        return _film(project, play_in_context(project, shown.id, shown.layer, starts))
    return _film(project, ShownPlayback(project, make_plan(project, IMPROVISED, seed=1), IMPROVISED))


def count_fates(differences: Sequence[Difference]) -> tuple[int, int, int]:
    """Return how many things are new, gone and changed."""
    fates = [one.fate for one in differences]
    return fates.count("added"), fates.count("removed"), fates.count("changed")


def _film(project: Project, shown: ShownPlayback) -> Clip | None:
    times = np.arange(0.0, min(shown.length, LONGEST), 1 / RATE)
    pose = shown.pose(times) if len(times) else None
    if pose is None or project.skeleton is None:
        return None
    return Clip("shown", project.skeleton, RATE, pose.rotations, pose.translations[:, :1])
