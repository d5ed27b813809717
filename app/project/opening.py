"""Open a project with everything it names: its clips, and the sounds of its lines."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.project.clip_loading import Opened, load_motions
from metagraph.formats.project.history import UndoStep, list_undo_steps, with_motion
from metagraph.formats.recovery import Left
from metagraph.formats.store import open_project
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.model import Project

Progress = Callable[[int, int], None]


def open_whole(path: Path, progress: Progress | None = None) -> Opened:
    """Read a project file with its clips and voices. Raises FileError; missing files beside it are in the
    notes.
    """
    if path.is_dir():
        raise FileError(
            path, "is a folder", "on opening it", "Give the project file in it, or label the folder."
        )
    return _voiced(open_project(path, progress), path.resolve().parent)


def load_whole(project: Project, folder: Path, progress: Progress | None = None) -> Opened:
    """Read the clips and voices of a project that is in memory."""
    return _voiced(load_motions(project, folder, progress), folder)


def load_recovered(
    left: Left, folder: Path, progress: Progress | None = None
) -> tuple[Opened, tuple[UndoStep, ...]]:
    """Read the clips and voices of a journal's project, and return the steps that lead to it."""
    opened = load_whole(left.project, folder, progress)
    steps = list_undo_steps(left)
    if not steps:
        return opened, ()
    return opened, with_motion(steps, left.project, opened.project, lambda p: load_motions(p, folder).project)


def take_over(project: Project, found: Project) -> Project:
    """Return `project` with the clips that have motion in `found` and none here."""
    clips = {
        i: found.clips[i] if e.motion is None and i in found.clips else e for i, e in project.clips.items()
    }
    return replace(project, clips=clips, skeleton=project.skeleton or found.skeleton)


def with_motion_of(project: Project, other: Project) -> Project:
    """Return the project, with motion from `other` for equal clips that have none."""
    found = {
        i: other.clips[i] for i, e in project.clips.items() if e.motion is None and other.clips.get(i) == e
    }
    return replace(project, clips={**project.clips, **found}) if found else project


def with_face(project: Project, folder: Path) -> Project:
    """Return the project with its character's morph targets; the code that draws it reports errors in the
    file.
    """
    if project.character is None:
        return project
    from metagraph.formats.gltf.reader import read_morph_targets

    try:
        return with_morphs(project, read_morph_targets(folder / project.character))
    except FileError:
        return project


def _voiced(opened: Opened, folder: Path) -> Opened:
    opened = replace(opened, project=with_face(opened.project, folder))
    if not any(line.audio or line.phones for line in opened.project.lines.values()):
        return opened
    from metagraph.speech.lines import load_voices

    project, notes = load_voices(opened.project, folder)
    return replace(opened, project=project, notes=(*opened.notes, *notes))
