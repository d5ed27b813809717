"""Label a folder without a window: import, propose, place what is certain, and report each decision with its
reason.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from argparse import Namespace
from collections.abc import Container, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.progress_line import ProgressLine

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from app.cli.outputs import ProjectOutput
    from metagraph.graph.editing.one_sided import OneSided
    from metagraph.graph.model import Project
    from metagraph.graph.problem import Problem
    from metagraph.suggest.alike import LabelledExample
    from metagraph.suggest.proposal import Proposal
    from metagraph.suggest.words.patterns import Patterns


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `label`."""
    parser.add_argument(
        "folder", type=Path, help="a folder of clips, or a project with clips that have no label yet"
    )
    parser.add_argument(
        "-o", "--out", type=Path, help="the project to write (default: next to the folder, with its name)"
    )
    parser.add_argument(
        "--above",
        type=float,
        default=0.0,
        metavar="SURE",
        help="place only clips whose proposal is at least this certain, 0 to 1 (default: all)",
    )
    parser.add_argument(
        "--from",
        dest="sources",
        action="append",
        choices=("name", "motion", "learned"),
        help="use only this source of evidence; repeat for more",
    )
    parser.add_argument(
        "--learned",
        action="store_true",
        help="also use what you taught Metagraph in the window: corrections, name patterns, saved projects",
    )
    parser.add_argument(
        "--patterns", type=Path, metavar="FILE", help="name patterns exported from the window (Graph menu)"
    )
    parser.add_argument(
        "--retarget",
        action="store_true",
        help="retarget clips of other skeletons to the skeleton that most clips have",
    )
    parser.add_argument(
        "--no-contacts",
        action="store_true",
        help="with --retarget: do not correct hands that touch their own body",
    )
    parser.add_argument(
        "--no-bridges",
        action="store_true",
        help="do not blend to stances that no clip leads to or from",
    )
    parser.add_argument(
        "--play",
        type=float,
        default=60.0,
        metavar="SECONDS",
        help="play the result for this many seconds and each action once, and report visible faults; 0 "
        "skips this (default: 60)",
    )
    parser.add_argument(
        "--twins",
        action="store_true",
        help="where only one arm has gestures or fidgets in a stance, add mirrored twins for the other",
    )
    parser.add_argument("--no-pictures", action="store_true", help="write the report without pictures")


def run(options: Namespace) -> int:
    """Label a folder or project; write the project and an HTML report beside it."""
    from app.cli.command_output import LONGEST
    from app.cli.outputs import ProjectOutput, with_project_ending
    from metagraph.errors import FileError
    from metagraph.formats.outputs import claim, note_written
    from metagraph.formats.store import SUFFIX

    if not 0 <= options.play <= LONGEST:
        raise ValueError(f"--play must be 0 to {LONGEST} seconds")
    source: Path = options.folder
    if not source.exists():
        raise FileError(
            source,
            "there is no such folder or project",
            "while labelling it",
            "Give a folder of clips, or a project.",
        )
    path = with_project_ending(
        options.out
        or (source if source.is_file() else source.resolve().parent / f"{source.resolve().name}{SUFFIX}")
    )
    if source.is_file() and not (path.exists() and path.samefile(source)):
        claim(path)  # clips of a folder are added to a project that is there; two projects are not mixed
    with ProjectOutput(path) as output:
        code = _labelled(options, output)
    if source.is_file() and not path.samefile(source):
        note_written(path)
    return code


def _labelled(options: Namespace, output: ProjectOutput) -> int:
    from app.authoring.bridging import join_labelled
    from app.cli.label_report import format_label_report
    from metagraph.formats.atomic import write_atomically
    from metagraph.formats.import_words import count_alike
    from metagraph.graph.check import check_project, list_grave_problems
    from metagraph.graph.editing.one_sided import describe_one_sided, list_one_sided
    from metagraph.suggest.flags import needs_look
    from metagraph.suggest.jumps.bridges import describe_bridges, describe_unbridged
    from metagraph.suggest.left_aside import group_reasons
    from metagraph.suggest.propose import SOURCES, accept, propose

    began = time.perf_counter()
    source, path = options.folder, output.path
    patterns, examples = _taught(options, path)
    begun = _begun(options, path)
    project, notes = begun.project, begun.notes
    found = propose(
        project,
        begun.clips,
        patterns=patterns,
        examples=examples,
        sources=tuple(options.sources or SOURCES),
        progress=ProgressLine(options, "Measuring clips").tell,
    )
    taken = accept(project, found, options.above)
    labelled, bridges = join_labelled(begun.before, taken.project, not options.no_bridges)
    one_sided = list_one_sided(labelled)
    if options.twins:
        labelled = add_twins(labelled, one_sided, path.resolve().parent)
    taken = replace(taken, project=labelled)
    if not begun.merged or labelled != begun.before:
        output.save(taken.project, source if source.is_file() else None)
    changed = not begun.merged or bool(begun.clips)  # if not, the report of what was labelled earlier stays
    place = _free_report(path)
    gaps = [] if options.no_bridges else describe_unbridged(taken.project)
    joined = describe_bridges(taken.project, bridges)
    lists: dict[str, Sequence[str]] = {
        "Blended, because no clip leads there": joined,
        "Not joined to the other stances": gaps,
        "Mirrored for the other arm" if options.twins else "Only one arm": [
            describe_one_sided(one) for one in one_sided
        ],
        "While importing": count_alike(notes),
    }
    drawn = _draw(options, taken.project, path, [*found.proposals]) if changed else {}

    def write_report(lists: Mapping[str, Sequence[str]]) -> None:
        page = format_label_report(taken.project, found, taken, drawn, lists, path)
        write_atomically(place, page.encode())

    if changed:
        write_report(lists)
    look = [p for p in found.doubtful if needs_look(p, taken.left)]
    errors = [p.message for p in list_grave_problems(check_project(taken.project))]
    seconds = time.perf_counter() - began
    held = {s.name: r.reason for i, r in taken.held.items() if (s := taken.project.stance(i)) is not None}
    _tell("note", count_alike(notes))
    _tell("held", [f"{name}: {reason}" for name, reason in held.items()])
    _tell("bridged", joined)
    _tell("no bridge", gaps)
    _tell_one_sided(one_sided, options.twins)
    for word, reasons in (("skipped", found.aside), ("left", taken.left)):
        _tell(word, [f"{_several(project, clips)}: {why}" for why, clips in group_reasons(reasons)])
    _tell("problem", errors)
    names = {clip: project.clips[clip].name for clip in found.proposals}
    disputed = _tell_disputed(found.proposals.values(), {p.clip for p in look}, names)
    words = (
        f"{path}: {len(taken.placed)} of {len(found.proposals)} clips labelled in {seconds:.1f} s, "
        f"{_count_looks(len(look), len(disputed))}" + (f"\n{place}" if changed else "")
    )
    data: dict[str, Any] = {
        "project": str(path),
        "report": str(place) if changed else None,
        "labelled": len(taken.placed),
        "left": {names[c]: why for c, why in taken.left.items()},
        "held": held,
        "bridged": joined,
        "no bridge": gaps,
        "one arm": {one.name: {"lacks": one.lacks, "actions": len(one.actions)} for one in one_sided},
        "twins": _count_lacking(one_sided) if options.twins else 0,
        "aside": {project.clips[c].name: why for c, why in found.aside.items()},
        "look": [names[p.clip] for p in look],
        "contradictions": disputed,
        "errors": errors,
        "seconds": round(seconds, 2),
    }
    if begun.merged:
        told_of, data_of = _told_of_merging(begun, path)
        words, data = f"{words}\n{told_of}", data | data_of
    if not options.json:
        print(words, flush=True)  # all is written; who does not wait for what is seen may stop it
    seen = _rehearse(options, taken.project, path) if options.play > 0 and changed else []
    if seen:
        write_report({"Seen when it was played": [p.message for p in seen], **lists})
    if options.json:
        print(json.dumps({**data, "seen": [p.message for p in seen]}))
    return _exit_code(len(taken.left), len(errors), sum(p.severity == "error" for p in seen))


def _tell_disputed(
    proposals: Iterable[Proposal], looked: Container[str], names: Mapping[str, str]
) -> list[str]:
    """Print where name and motion contradict each other, but for clips that need a look anyway; return the
    names of the others.
    """
    disputed = {names[p.clip]: p.conflicts[0] for p in proposals if p.conflicts and p.clip not in looked}
    _tell("contradiction", [f"{name}: {why}" for name, why in disputed.items()])
    return [*disputed]


def _count_looks(looks: int, disputed: int) -> str:
    """Return how many clips somebody should look at, and how many more have a misleading name."""
    words = f"{looks} {'needs' if looks == 1 else 'need'} a look"
    if not disputed:
        return words
    return (
        f"{words}, and the name of {disputed} more contradicts {'its' if disputed == 1 else 'their'} motion"
    )


def _count_lacking(one_sided: Sequence[OneSided]) -> int:
    return sum(len(one.actions) for one in one_sided)


def _tell_one_sided(one_sided: Sequence[OneSided], mirrored: bool) -> None:
    from metagraph.graph.editing.one_sided import describe_one_sided

    _tell("mirrored" if mirrored else "one arm", map(describe_one_sided, one_sided))
    if one_sided and not mirrored:
        count = _count_lacking(one_sided)
        clips = "clip" if count == 1 else "clips"
        print(f"note: --twins adds {count} mirrored {clips} for the other arm", file=sys.stderr)


def add_twins(project: Project, one_sided: Sequence[OneSided], folder: Path) -> Project:
    """Return a project with twins of what one arm alone has, whose clips are written below its folder. What
    has no side, or no motion, gets none.
    """
    from app.features.twins.mirrored_twins import with_twins, write_twin
    from metagraph.graph.edit_error import EditError
    from metagraph.graph.editing.mirroring import make_twin_clips

    actions = [action for one in one_sided for action in one.actions]
    try:
        made = [(twin, write_twin(twin, folder)) for twin in make_twin_clips(project, actions, skip=True)]
    except EditError:
        return project
    return with_twins(project, made)


def _rehearse(options: Namespace, project: Project, path: Path) -> list[Problem]:
    """Play a project that was written, and print what is seen."""
    from app.cli.showing_command import name_showing_command
    from metagraph.playback.rehearsal import rehearse

    seen = rehearse(project, options.play, ProgressLine(options, "Playing it to find faults").tell)
    for problem in seen:
        command = name_showing_command(project, problem, path)
        helps = f"  [{command}]" if command else f". {problem.remedy}"  # nothing to look at: what would help
        _tell("seen", [f"{problem.message}{helps}"])
    return seen


def _draw(options: Namespace, project: Project, path: Path, clips: Sequence[str]) -> Mapping[str, Any]:
    from app.cli.label_pictures import draw_label_pictures

    tell = ProgressLine(options, "Drawing pictures").tell
    return {} if options.no_pictures else draw_label_pictures(project, path.resolve().parent, clips, tell)


def _tell(word: str, lines: Iterable[str]) -> None:
    for line in lines:
        print(f"{word}: {line}", file=sys.stderr)


def _exit_code(left: int, errors: int, faults: int) -> int:
    """Return the exit code, and print why it is not 0."""
    from app.cli.command_output import explain_code_3
    from metagraph.formats.project.verified import count_in_words

    counts = (
        (left, "clip left", "clips left"),
        (errors, "problem", "problems"),
        (faults, "fault seen", "faults seen"),
    )
    failing = [count_in_words(count, one, many) for count, one, many in counts if count]
    if failing:
        explain_code_3(", ".join(failing))
    return 3 if failing else 0


def _told_of_merging(begun: Begun, path: Path) -> tuple[str, dict[str, int]]:
    """Return words and data about a project to which clips were added."""
    counts = {
        "added": len(begun.clips or ()),
        "skipped": begun.skipped,
        "kept": len(begun.before.clips),
        "waiting": begun.waiting,
    }
    actions = sum(1 for _ in begun.before.actions())
    words = (
        f"added {counts['added']} clips to the project, which keeps its {counts['kept']} clips and {actions} "
    )
    words += "unchanged actions"
    if begun.skipped:
        words += f"; skipped {begun.skipped} clips that it already has"
    if begun.waiting:
        from app.typed_command import list_program_words, quote_command

        command = quote_command([*list_program_words(), "label", str(path)])
        words += f"; {begun.waiting} of its clips have no label yet: {command}"
    if not begun.clips:
        words += (
            "; nothing was changed. Add --overwrite to make the project again and keep this one as a version"
        )
    return words, counts


def _several(project: Project, clips: Iterable[str]) -> str:
    names = [project.clips[clip].name for clip in clips]
    return (
        names[0]
        if len(names) == 1
        else f"{len(names)} clips ({', '.join(names[:3])}{' ...' * (len(names) > 3)})"
    )


def _taught(options: Namespace, path: Path) -> tuple[Patterns | None, list[LabelledExample]]:
    """Return the name patterns and the examples to learn from. Both are empty unless requested, so that a run
    gives the same result everywhere.
    """
    from app.project.pattern_files import read_patterns
    from metagraph.suggest.words.names import merge_patterns

    given = read_patterns(options.patterns) if options.patterns is not None else None
    if not options.learned:
        return given, []
    from PySide6.QtCore import QCoreApplication

    from app.project.learned import Learned

    QCoreApplication.setApplicationName(
        "Metagraph"
    )  # as the window is called: that is where it keeps what it learned
    QCoreApplication.setOrganizationName("Metagraph")
    learned = Learned()
    learned.failed.connect(lambda words: print(f"note: {words}", file=sys.stderr))
    patterns = learned.patterns
    return merge_patterns(patterns, given) if given is not None else patterns, learned.examples_beside(path)


@dataclass(frozen=True)
class Begun:
    """What is to be labelled. clips: only these, None for all that wait. notes: what there is to say about
    what was read. before: the project that was there. merged: whether there was one that clips were added to.
    skipped: how many of the folder's clips it has already. waiting: how many of its clips are not placed,
    which is left so.
    """

    project: Project
    clips: list[str] | None
    notes: list[str]
    before: Project
    merged: bool = False
    skipped: int = 0
    waiting: int = 0


def _begun(options: Namespace, path: Path) -> Begun:
    """Return the project to label: the one that was given, or clips of a folder, added to the project that is
    at `path`.
    """
    from app.cli.command_output import open_for_command
    from metagraph.errors import FileError
    from metagraph.formats.clip_readers import describe_clip_files
    from metagraph.formats.imports import import_files
    from metagraph.formats.store import SUFFIX
    from metagraph.graph.model import Project
    from metagraph.suggest.propose import list_waiting_clips

    source: Path = options.folder
    if source.is_file():
        project = open_for_command(source)
        return Begun(project, None, [], project)
    merged = path.is_file() and not options.overwrite
    before = open_for_command(path) if merged else Project(name=path.name.removesuffix(SUFFIX))
    line = ProgressLine(options, "Reading clips")
    result = import_files(
        before,
        path.resolve().parent,
        [source],
        lambda done, total, file: line.tell(done, total, file.name),
        retarget="yes" if options.retarget else "no",
        contacts=not options.no_contacts,
    )
    line.finish()
    if not result.loaded:
        why = result.failures[0] if result.failures else "has no clips"
        raise FileError(source, why, "while importing it", describe_clip_files())
    known = {(x, entry.take) for entry in before.clips.values() for x in (entry.path, entry.digest)}
    fresh = replace(
        result,
        loaded=tuple(
            (name, take, content, clip)
            for name, take, content, clip in result.loaded
            if known.isdisjoint({(name, take), (content, take)})
        ),
    )
    project = fresh.into(before) if fresh.loaded else before
    clips = [clip for clip in project.clips if clip not in before.clips]
    notes = [*result.failures, *result.notes]
    skipped = len(result.loaded) - len(fresh.loaded)
    return Begun(
        project, clips if merged else None, notes, before, merged, skipped, len(list_waiting_clips(before))
    )


def _free_report(path: Path) -> Path:
    """Return the path of the report: beside the project. It replaces nothing but an earlier report."""
    from metagraph.errors import FileError
    from metagraph.formats.outputs import claim
    from metagraph.formats.store import SUFFIX

    stem = path.name.removesuffix(SUFFIX)
    for number in range(1, 100):
        place = path.with_name(f"{stem}.labels{f' {number}' if number > 1 else ''}.html")
        with suppress(FileError):
            claim(place)
            return place
    return place
