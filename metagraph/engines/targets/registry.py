"""List the targets, and write for one: `write_for_target(project, "playcanvas", folder)`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.engines.export import make_export_stem, require_exportable
from metagraph.engines.export_error import ExportError
from metagraph.engines.targets.losses import CONVERSATIONS
from metagraph.engines.targets.next_steps import README, find_next_steps, list_steps, make_readme
from metagraph.engines.targets.placing import Staging
from metagraph.engines.targets.placing import place_files as move
from metagraph.engines.targets.target import (
    BARE,
    Contents,
    ExportedFiles,
    ExportOrder,
    ExportTarget,
    TargetReport,
    Tell,
)
from metagraph.formats.atomic import sync_together, write_atomically
from metagraph.formats.store import make_writable
from metagraph.graph.model import Project

# Modules of this package that have TARGETS, in the order of the lists shown to the user.
MODULES = (
    "runtimes",
    "web",
    "playcanvas",
    "godot_tree",
    "unity_controller",
    "interactivity",
    "statecharts",
    "agents",
    "vrm",
    "vrma",
    "usd",
    "blender",
)
DEFAULT = "metagraph"


@cache
def list_targets() -> Mapping[str, ExportTarget]:
    """Return all targets by name."""
    found: dict[str, ExportTarget] = {}
    for module in MODULES:
        found |= {
            target.name: target for target in import_module(f"metagraph.engines.targets.{module}").TARGETS
        }
    return found


def get_target(name: str) -> ExportTarget:
    """Return a target. Raises ExportError naming the existing ones."""
    known = list_targets()
    if name in known:
        return known[name]
    near = get_close_matches(name, known, 1)
    raise ExportError(
        f"there is no target '{name}'; "
        + (f"did you mean '{near[0]}'?" if near else f"there are {', '.join(known)}")
    )


def describe_losses(project: Project, name: str) -> tuple[str, ...]:
    """Return in words what a target loses of a project."""
    every = (*get_target(name).losses, CONVERSATIONS)
    return tuple(words for loss in every if (words := loss.told(project)) is not None)


def write_for_target(
    project: Project,
    name: str,
    folder: str | Path,
    contents: Contents = BARE,
    tell: Tell | None = None,
    overwrite: bool = False,
) -> TargetReport:
    """Write a project for a target into a folder, which is made if necessary.

    `overwrite` also replaces files that are not of an earlier export of the same project for the same target.
    Either all of it is written, or nothing. Raises ExportError while the project has errors, or if a packed
    GLB is asked for and the target cannot unpack it; ForeignFilesError, an ExportError, if foreign files are
    in the way; FileError if a file cannot be written.
    """
    chosen = get_target(name)
    if contents.compress and not chosen.unpacks:
        able = ", ".join(t.name for t in list_targets().values() if t.unpacks)
        raise ExportError(
            phrase(
                "'{name}' cannot read a compressed GLB: export it without --compress, or for {able}",
                name=name,
                able=able,
            )
        )
    project = make_writable(project)
    warnings = require_exportable(project)
    place = Path(folder)
    with Staging(place) as staged:
        order = ExportOrder(project, staged.path, make_export_stem(project), contents)
        if tell is not None:
            order = replace(order, tell=tell)
        lost = describe_losses(project, name)
        with sync_together():
            made = _with_readme(chosen.write(order), chosen, order, lost)
        names = tuple(path.relative_to(staged.path).as_posix() for path in made.files)
        move(staged, place, names, name, project.name, overwrite)
    clips = len(project.uses.keys() | {project.base.clip} - {None})
    files = tuple(place / n for n in names)
    return TargetReport(
        name, files, clips, lost, (*made.notes, *warnings), list_steps(name, make_export_stem(project))
    )


def _with_readme(
    made: ExportedFiles, chosen: ExportTarget, order: ExportOrder, lost: Sequence[str]
) -> ExportedFiles:
    """Write a README into an export's folder, unless the target writes a guide of its own."""
    if find_next_steps(chosen.name).guide:
        return made
    path = order.folder / README
    names = [file.relative_to(order.folder).as_posix() for file in made.files]
    text = make_readme(chosen.name, chosen.title, chosen.files, order.stem, names, lost)
    write_atomically(path, text.encode())
    return replace(made, files=(*made.files, path))
