"""The command that shows what a problem is about."""

from __future__ import annotations

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
        words = [
            *list_program_words(),
            "render",
            str(path),
            "--start",
            start,
            "-s",
            f"{LASTS:g}",
            "-o",
            "seen.mp4",
        ]
    elif problem.code.startswith(("play-", "clip-jump")) and action and action.clip in project.clips:
        words = name_window_command(project, action.clip, path)
    else:
        return ""
    return quote_command(words)


def name_window_command(project: Project, clip: str, path: Path) -> list[str]:
    """Return the words of the command that opens the window on a clip."""
    name = project.clips[clip].name
    if name.startswith("-") or sum(entry.name == name for entry in project.clips.values()) > 1:
        name = clip
    return [*list_program_words(), "window", str(path), "--clip", name]
