"""The command that shows what a problem is about."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

from app.typed_command import list_program_words, quote_command

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.model import Project
    from metagraph.graph.problem import Problem

BEFORE, LASTS = 1.0, 3.0  # seconds of the performance before the moment, and that are drawn


def name_showing_command(project: Project, problem: Problem, path: Path) -> str:
    """Return what to type in a terminal to see what `rehearse` saw: the moment as a video, or the action's
    clip in the window where only the action's own turn shows it; "" of other problems.
    """
    action = project.action(problem.action or "")
    if problem.moment is not None:
        start = f"{max(0.0, problem.moment - BEFORE):.1f}"
        shown = ["--start", start, "-s", f"{LASTS:g}", "-o", "seen.mp4"]
        words = [*list_program_words(), "render", str(path), *shown]
    elif problem.code.startswith(("play-", "clip-jump")) and action and action.clip in project.clips:
        words = name_window_command(project, action.clip, path, list_shared_names(project))
    else:
        return ""
    return quote_command(words)


def list_shared_names(project: Project) -> set[str]:
    """Return the names that several clips have."""
    return {name for name, n in Counter(e.name for e in project.clips.values()).items() if n > 1}


def name_window_command(project: Project, clip: str, path: Path, shared: Collection[str]) -> list[str]:
    """Return the words of the command that opens the window on a clip. shared: names of several clips."""
    name = project.clips[clip].name
    if name.startswith("-") or name in shared:
        name = clip
    return [*list_program_words(), "window", str(path), "--clip", name]
