"""The projects participants work on: made from a task's clips, found again with every edit after a crash."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.imports import import_files
from metagraph.formats.project.clip_loading import Opened, load_motions
from metagraph.formats.project.paths import make_path_relative
from metagraph.formats.recovery import find_left_journals, recover, retire
from metagraph.formats.store import read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.research.study.plan.hidden_names import hide_names
from metagraph.research.study.study_plan import Study

Progress = Callable[[int, int], None]


def make_task_project(
    study: Study,
    clips: str | tuple[str, ...],
    name: str,
    reference: Path | None = None,
    numbered: Mapping[Path, Path] | None = None,
) -> Project:
    """Return a project of clips, none of them placed; its paths are absolute. Base pose and character are the
    reference's, whose clips are distinguished by their files' names. Raises FileError when a clip cannot be
    read: everybody works on the same ones. numbered: copy under a number -> clip, where names are hidden.
    """
    imported = import_files(Project(name), None, study.clips(clips) if numbered is None else list(numbered))
    left_out = [*imported.failures, *(why for s in imported.strangers for why in s.failures)]
    if left_out:
        raise FileError(
            study.path,
            f"a clip cannot be worked with: {left_out[0]}",
            "clips",
            "Correct it or leave it out, for everybody.",
        )
    project = imported.into(Project(name))
    project = project if numbered is None else hide_names(project)
    own = {copy.name: path.name for copy, path in (numbered or {}).items()}
    if reference is None:
        return project
    right = read_project(reference)
    base = right.clips.get(right.base.clip) if right.base.clip is not None else None
    here = next(
        (
            c.id
            for c in project.clips.values()
            if base is not None
            and own.get(Path(c.path).name, Path(c.path).name) == Path(base.path).name
            and c.take == base.take
        ),
        None,
    )
    if here is not None:
        project = edits.set_base(project, here, right.base.frame)
    if right.character is not None and (reference.parent / right.character).is_file():
        project = edits.set_character(project, (reference.parent / right.character).resolve().as_posix())
        project = edits.hide_meshes(project, right.hidden)
    return project


def write_task_project(project: Project, path: Path) -> Project:
    """Save a project with absolute paths as a file, whose paths are relative to it; return it as it was
    saved. Raises FileError.
    """
    folder = path.parent
    clips = {i: replace(c, path=make_path_relative(Path(c.path), folder)) for i, c in project.clips.items()}
    character = make_path_relative(Path(project.character), folder) if project.character else None
    return save_project(replace(project, clips=clips, character=character), path)


def reopen(path: Path, progress: Progress | None = None) -> tuple[Opened, int]:
    """Return a project with the edits its journal adds, and how many those are; its file then has them, too.
    Raises FileError.

    A journal of an older state of the file has nothing to add: the file was saved after it.
    """
    project, count, used = None, 0, None
    for journal in find_left_journals(path):  # the latest counts
        with suppress(FileError):
            found = recover(journal, path)
            if found is not None:
                project, count, used = *found, journal
    if project is None:
        project = read_project(path)
    if used is not None:  # whoever opens it begins a new journal, and may be killed just then
        save_project(project, path)
        retire(used)
    return load_motions(project, path.parent, progress), count
