"""`metagraph import`: clips into a project."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.cli.command_output import open_for_command, say
from app.cli.outputs import ProjectOutput, with_project_ending
from app.cli.progress_line import ProgressLine
from metagraph.errors import FileError
from metagraph.formats.action_labels import apply_labels, read_labels
from metagraph.formats.clip_readers import describe_clip_files
from metagraph.formats.import_words import count_alike, describe_import, list_remedies
from metagraph.formats.imports import import_files
from metagraph.formats.project.pieces import read_other_project
from metagraph.formats.store import SUFFIX
from metagraph.graph.editing.one_sided import describe_one_sided, list_one_sided
from metagraph.graph.editing.taking import describe_taking
from metagraph.graph.model import Project


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "paths",
        type=Path,
        nargs="*",
        help="clip files and folders (BVH, GLB, glTF, VRM animation, FBX, C3D, TRC, AMC, SMPL .npz, faces as "
        "CSV or JSON), and other projects, whose stances and actions come with their clips",
    )
    parser.add_argument(
        "--labels",
        type=Path,
        metavar="FILE",
        help="place the clips and change actions according to this label file (Blender's add-on writes one)",
    )
    parser.add_argument(
        "--retarget", action="store_true", help="retarget clips of other skeletons to the project's"
    )
    parser.add_argument(
        "--no-contacts",
        action="store_true",
        help="with --retarget: do not correct hands that touch their own body",
    )


def _taken(project: Project, path: Path, other: Path, options: Namespace) -> tuple[Project, str, bool]:
    """Return the project with what another one holds, what that was in words, and whether something was left
    out.
    """
    piece = read_other_project(other, path)
    for note in piece.notes:
        print(f"note: {other.name}: {note}", file=sys.stderr)
    taking = piece.into(project, options.retarget)
    left = [thing for thing in taking.things if thing.becomes == "left out"]
    clips = [thing for thing in left if thing.kind == "clip"]
    for thing in clips or left:
        print(f"left out: {thing.kind} '{thing.name}': {thing.words}", file=sys.stderr)
    words = f"{other.name.removesuffix(SUFFIX)}: {describe_taking(taking)}"
    if clips and not options.retarget:
        words += ". Add --retarget to bring clips of another skeleton onto this one"
    return taking.project, words, bool(left)


def run(options: Namespace) -> int:
    if not options.paths and options.labels is None:
        from app.typed_command import list_program_words, quote_command

        print(
            "metagraph import: give clips or a folder, such as: "
            f"{quote_command(list_program_words())} import my.metagraph.yaml clips/",
            file=sys.stderr,
        )
        return 2
    path: Path = options.project if options.project.is_file() else with_project_ending(options.project)
    with ProjectOutput(path) as output:
        return _imported(options, output)


def _imported(options: Namespace, output: ProjectOutput) -> int:
    path = output.path
    rows = read_labels(options.labels) if options.labels is not None else ()
    project = open_for_command(path) if path.is_file() else Project(name=path.name.removesuffix(SUFFIX))
    known = list_one_sided(project)
    others = [other for other in options.paths if other.name.endswith(SUFFIX)]
    files = [file for file in options.paths if file not in others]
    taken: list[str] = []
    lacking = False
    for other in others:
        project, words, left_out = _taken(project, path, other, options)
        taken.append(words)
        lacking = lacking or left_out
    line = ProgressLine(options, "Reading clips")
    result = import_files(
        project,
        path.resolve().parent,
        files,
        lambda done, total, file: line.tell(done, total, file.name),
        retarget="yes" if options.retarget else "no",
        contacts=not options.no_contacts,
    )
    line.finish()
    if files and not result.loaded and not result.failures and not result.chosen:
        place = ", ".join(str(p) for p in files)
        raise FileError(
            place,
            "has no clips",
            "while importing it",
            describe_clip_files(),
        )
    for failure in count_alike(result.failures):
        print(f"left out: {failure}", file=sys.stderr)
    if not options.json:
        for note in count_alike(result.notes):
            print(f"note: {note}", file=sys.stderr)
    before = {(entry.path, entry.take) for entry in project.clips.values()}
    again = sum((file, take) in before for file, take, *_ in result.loaded)
    if result.loaded or result.chosen:
        project = result.into(project)
    at = {(entry.path, entry.take): entry.id for entry in project.clips.values()}
    fresh = {clip.name: at[file, take] for file, take, _, clip in result.loaded}
    project, placed, left = apply_labels(project, rows, fresh)
    for why in left:
        print(f"not labelled: {why}", file=sys.stderr)
    one_sided = [one for one in list_one_sided(project) if one not in known]
    for one in one_sided:
        print(f"one arm: {describe_one_sided(one)}", file=sys.stderr)
    if one_sided:
        print(f"note: metagraph label {path} --twins adds mirrored twins for the other arm", file=sys.stderr)
    if result.loaded or result.chosen or placed or taken:
        output.save(project)
    data = {
        "project": str(path),
        "imported": len(result.loaded),
        "new": len(result.loaded) - again,
        "retargeted": result.retargeted,
        **({"labelled": placed, "not_labelled": list(left)} if options.labels is not None else {}),
        **({"taken": taken} if taken else {}),
        **({"one arm": {one.name: one.lacks for one in one_sided}} if one_sided else {}),
        "failures": list(result.failures),
        "notes": list(result.notes),
        "remedies": [remedy.command for remedy in list_remedies(result)],
    }
    imported = describe_import(result, window=False)
    if again:
        imported += f" ({len(result.loaded) - again} new, {again} read again)"
    found = [*taken, *([imported] if files or not taken else [])]
    words = f"{path}: {'. '.join(found)}"
    say(options, words if options.labels is None else f"{words}. Labelled {placed} of {len(rows)}", data)
    if not result.loaded and result.failures:
        return 1
    return 3 if result.failures or left or lacking else 0
