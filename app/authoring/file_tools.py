"""Tools about other files: exports for engines, and the merge with another person's copy."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from msgspec import Struct

from app.authoring.tool import AuthorError, AuthorTool, EditReport, ToolOutcome, ToolWork, shorten_lines
from app.project.opening import load_whole, with_motion_of
from app.translation import tr_noop
from metagraph.common.wording import phrase
from metagraph.formats.project.merging import MergeError, merge_projects
from metagraph.formats.store import read_project
from metagraph.graph.manual.meta import make_exportable


class ExportCall(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """folder: where to, relative to the project. target: the engine or format; a wrong one is answered with
    those there are. compress: pack the GLB. overwrite: also replace files of another export.
    """

    folder: str
    target: str = "metagraph"
    compress: bool = False
    overwrite: bool = False


class ExportReport(Struct, omit_defaults=True):
    """What was written. losses: what the target cannot hold of this project. next: what to do in the engine.
    verified: what was read again, and that it is whole.
    """

    target: str
    folder: str
    files: list[str]
    clips: int
    losses: list[str] = []
    warnings: list[str] = []
    next: list[str] = []
    verified: list[str] = []


def _export(work: ToolWork, given: ExportCall) -> ToolOutcome:
    """Export for an engine, and verify what was written."""
    from metagraph.engines.targets import registry
    from metagraph.engines.targets.target import Contents

    folder = work.find_path(given.folder)
    if folder == work.folder.resolve():
        raise AuthorError("folder: give a folder of its own for the export, such as 'game'")
    project, differences = make_exportable(work.project)
    character = work.folder / project.character if project.character else None
    contents = Contents(character, base=work.folder, compress=given.compress)
    made = registry.write_for_target(project, given.target, folder, contents, overwrite=given.overwrite)
    work.report(1, 2, "exported; verifying what was written")
    report = ExportReport(
        made.target,
        str(folder),
        shorten_lines([path.relative_to(folder).as_posix() for path in made.files]),
        made.clips,
        [*map(str, made.losses), *map(str, differences)],
        [str(words) for words in made.warnings],
        [str(words) for words in made.steps],
    )
    if given.target == registry.DEFAULT:
        report.verified = _verify(folder)
    return ToolOutcome(report)


def _verify(folder: Path) -> list[str]:
    """Return what was verified. Raises AuthorError if something is not whole."""
    from metagraph.engines.verifying_exports import verify

    found = verify(folder)
    faults = [fault for one in found for fault in one.faults]
    if faults:
        words = "; ".join(f"{fault.place}: {fault.words} {fault.remedy}" for fault in faults[:3])
        raise AuthorError(f"the export was written, but is not whole: {words}")
    return [f"{Path(one.file).name}: {part.name} {part.words}" for one in found for part in one.parts]


class MergeCall(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """theirs: another copy of this project. base: the project before either was changed. prefer: whose value
    is kept where both changed the same one.
    """

    base: str
    theirs: str
    prefer: Literal["ours", "theirs"] = "ours"


def _merge(work: ToolWork, given: MergeCall) -> ToolOutcome:
    """Bring what was done in another copy into this project."""
    base, theirs = (read_project(work.find_path(name)) for name in (given.base, given.theirs))
    sides = (phrase("in ours"), phrase("in theirs"))
    try:
        if given.prefer == "theirs":
            found = merge_projects(base, theirs, work.project, (sides[1], sides[0]))
        else:
            found = merge_projects(base, work.project, theirs, sides)
    except MergeError as error:
        raise AuthorError(f"the two cannot be merged: {error}") from None
    opened = load_whole(with_motion_of(found.project, work.project), work.folder)
    notes = [*(f"conflict: {words}" for words in found.kept), *opened.notes]
    return ToolOutcome(EditReport(notes=shorten_lines(notes)), opened.project)


TOOLS = (
    AuthorTool(
        "export",
        "Export the project for an engine or a format, and verify the files.",
        ExportCall,
        ExportReport,
        _export,
        "writes",
        long=True,
    ),
    AuthorTool(
        "merge",
        "Bring what another person did in a copy of the project into this one.",
        MergeCall,
        EditReport,
        _merge,
        "edits",
        tr_noop("Merge with a copy"),
    ),
)
