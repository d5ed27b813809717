"""Clips under numbers instead of names: which participant sees which task so, and which number is which clip.

Which number a clip has follows from the participant, the condition and the task alone, so nothing else needs
to be kept to know it again; it differs from one condition to the next, or the first would tell the second.
"""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from metagraph.errors import FileError
from metagraph.graph.model import Project

ALONE = frozenset({".glb", ".bvh", ".fbx"})  # files that can be copied without others


def has_hidden_names(task: int, number: int, conditions: int, tasks: int) -> bool:
    """Return whether a participant (number 0, 1, 2 ...) sees a task (its place in the plan) under numbers.

    Every other task is. Over `2 * conditions` participants names are crossed with the order of conditions and
    with the order of tasks, over twice as many with both together. conditions, tasks: how many orders of each
    there are.
    """
    turn = number // conditions
    return (task + number % conditions + turn + number // (conditions * tasks)) % 2 == 1


def make_clip_numbers(paths: Sequence[Path], participant: str, condition: str, task: str) -> dict[str, Path]:
    """Return number (as "07.glb") -> clip. Raises FileError for a clip that needs other files beside it."""

    def place(path: Path) -> str:
        return hashlib.sha256(f"{participant}/{condition}/{task}/{path.name}".encode()).hexdigest()

    for path in paths:
        if path.suffix.lower() not in ALONE:
            raise FileError(
                path,
                "its name cannot be hidden, as it may need other files",
                "names",
                f"Convert it to one of {', '.join(sorted(ALONE))}.",
            )
    width = max(2, len(str(len(paths))))
    return {f"{n:0{width}}{path.suffix.lower()}": path for n, path in enumerate(sorted(paths, key=place), 1)}


def copy_numbered(numbered: Mapping[str, Path], folder: Path) -> list[Path]:
    """Copy clips into a folder under their numbers; return the copies. Raises FileError."""
    out = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, path in numbered.items():
            shutil.copyfile(path, folder / name)
            out.append(folder / name)
    except OSError as error:
        raise FileError(
            folder,
            f"clips cannot be copied ({error.strerror or error})",
            "names",
            "Make room, and check that you can write to that folder.",
        ) from None
    return out


def hide_names(project: Project) -> Project:
    """Call every clip by its file's number."""
    clips = {i: replace(c, name=f"Clip {Path(c.path).stem}") for i, c in project.clips.items()}
    return replace(project, clips=clips)


def reveal_names(project: Project, numbered: Mapping[str, Path]) -> Project:
    """Return a project with the clips' own names and files; what has no number stays."""
    clips = {
        i: replace(c, path=found.as_posix(), name=found.stem)
        if (found := numbered.get(Path(c.path).name)) is not None
        else c
        for i, c in project.clips.items()
    }
    return replace(project, clips=clips)
