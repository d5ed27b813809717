"""Left/right twins of what is selected: mirrored on a thread, written beside the project, added and placed in
one step.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.project.jobs import WindowJob
from app.translation import tr, tr_error, tr_plural
from metagraph.common.file_names import make_file_stem
from metagraph.formats.clips import digest, read_clips
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.imports import Loaded
from metagraph.formats.project.paths import make_path_relative
from metagraph.formats.takes import REPAIRS
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.fitting_twins import fit_twins
from metagraph.graph.editing.mirroring import TwinClip, make_twin_clips, mirror_clips, place_twins
from metagraph.graph.edits import add_clips
from metagraph.graph.model import Project
from metagraph.motion.adopt import adopt

if TYPE_CHECKING:
    from app.shell.context import Shell

FOLDER = "mirrored"


def make_twins(shell: Shell) -> None:
    """Make twins of the selected actions, or of the selected clips; select them when they are there."""
    document, session = shell.document, shell.stage.session
    actions, clips, folder = session.selection.actions, session.selection.clips, document.folder
    project = document.project
    if folder is None:
        shell.tell(
            tr(
                "Save the project first. Mirrored clips are written beside it, in the folder '{folder}'.",
                folder=FOLDER,
            )
        )
        return

    def work(job: WindowJob) -> list[tuple[TwinClip, Loaded]]:
        made = make_twin_clips(project, actions, skip=True) if actions else mirror_clips(project, clips)
        out = []
        for n, twin in enumerate(made):
            job.tell(n, len(made), twin.name)
            if job.cancelled:
                return []
            out.append((twin, write_twin(twin, folder)))
        return out

    def done(made: list[tuple[TwinClip, Loaded]]) -> None:
        if not made:
            return
        if document.folder != folder or any(project.clips[c].id not in document.project.clips for c in clips):
            shell.tell(tr("The project has changed in the meantime. Make the twins again."))
            return
        before = document.project
        try:
            count = sum(len(twin.actions) for twin, _ in made) or len(made)
            document.edit(
                tr_plural("Make {count:,} mirrored twin", "Make {count:,} mirrored twins", count),
                lambda p: with_twins(p, made),
            )
        except EditError as error:
            shell.tell(tr_error(error))
            return
        after = document.project
        if actions:
            session.selection.select_actions(
                tuple(a.id for a in after.actions() if before.action(a.id) is None)
            )
        else:
            session.selection.select_clips(tuple(c for c in after.clips if c not in before.clips))
        words = (
            tr_plural("Made {count:,} mirrored twin", "Made {count:,} mirrored twins", count)
            if actions
            else tr_plural("Mirrored {count:,} clip", "Mirrored {count:,} clips", count)
        )
        names = ", ".join(twin.name for twin, _ in made[:3]) + (" …" if len(made) > 3 else "")
        shell.tell(
            tr("{words}: {names}. Saved in {folder}.", words=words, names=names, folder=folder / FOLDER)
        )

    shell.jobs.start(tr("Making mirrored twins"), work, done, lambda error: shell.tell(tr_error(error)))


def write_twin(twin: TwinClip, folder: Path) -> Loaded:
    """Write a mirrored clip below the project's folder, under a name no other file has; return it as it is
    read back.
    """
    place = folder / FOLDER
    place.mkdir(exist_ok=True)
    stem = make_file_stem(twin.name, "clip")
    path, n = place / f"{stem}.glb", 2
    while path.exists():
        path, n = place / f"{stem}_{n}.glb", n + 1
    write_glb(path, [twin.motion])
    (read,) = read_clips(path, REPAIRS)  # it is what it should be, so nothing of it is repaired
    return (
        make_path_relative(path, folder),
        0,
        digest(path),
        adopt(read.renamed(twin.name), twin.motion.skeleton),
    )


def with_twins(project: Project, made: list[tuple[TwinClip, Loaded]]) -> Project:
    """Return the project with mirrored clips added, and the twins of their actions placed and fitted to
    their stances. Raises EditError.
    """
    project = add_clips(project, [loaded for _, loaded in made])
    idents = {(e.path, e.take): e.id for e in project.clips.values()}
    new = {idents[path, take] for _, (path, take, _, _) in made}
    project = replace(
        project, clips={i: replace(e, as_is=REPAIRS) if i in new else e for i, e in project.clips.items()}
    )
    pairs = {action: idents[loaded[0], loaded[1]] for twin, loaded in made for action in twin.actions}
    if not pairs:
        return project
    known = {action.id for action in project.actions()}
    placed = place_twins(project, pairs)
    return fit_twins(placed, [action.id for action in placed.actions() if action.id not in known])
