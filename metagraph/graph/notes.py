"""Notes of animators: one on the project, and one on each action."""

from __future__ import annotations

from dataclasses import replace

from metagraph.graph.model import Project

PROJECT = ""  # the key of the note that is on the project itself


def set_note(project: Project, about: str, text: str) -> Project:
    """Write a note, or take it away with "". about: an action's id, or `PROJECT`. Notes on actions that are
    gone go, too.
    """
    kept = {key: note for key, note in project.notes.items() if key == PROJECT or project.action(key)}
    text = text.rstrip()
    if text:
        kept[about] = text
    else:
        kept.pop(about, None)
    return replace(project, notes=kept) if kept != project.notes else project
