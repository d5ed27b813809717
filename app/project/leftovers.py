"""What stands beside a project file when it is opened: another window's lock, and journals of sittings that
ended in a crash.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from pathlib import Path

from app.project.document import state_folder
from metagraph.errors import FileError
from metagraph.formats.atomic import sweep
from metagraph.formats.locking import Holder, Lock, Owner
from metagraph.formats.recovery import Left, journals_in, left_journals, read_journal
from metagraph.formats.store import SUFFIX, load_returned, save_project
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.records import dataclass

# The second as they were called at first, `.old` as those were that could not be read.
UNTITLED = r"\.untitled\.[0-9a-f]+\.(journal|old)|untitled(-\d+)?\.(journal|old)"
PICTURES = 8  # journals that are shown with one, the latest first


@dataclass(frozen=True)
class FoundJournal:
    """lock: ours, unless there is a holder. left: journals with edits, the latest first. notes: what cannot
    be recovered, in words. poses: for a journal's picture, a clip of its project where one could be read.
    """

    lock: Lock | None
    holder: Holder | None
    left: tuple[Left, ...]
    notes: tuple[str, ...]
    poses: Mapping[Path, Clip] = field(default_factory=dict)


def look_beside(path: Path, owner: Owner) -> FoundJournal:
    """Take the lock of a project file, and read the journals that were left beside it; what was left
    half-written there goes.
    """
    if not path.is_file():
        return FoundJournal(None, None, (), ())
    sweep(path.resolve().parent)
    lock = Lock(path, owner)
    return FoundJournal(lock, lock.acquire(), *_read(left_journals(path), path))


def untitled_journals() -> list[Path]:
    """Return the journals of projects never saved whose windows are gone."""
    return journals_in(state_folder(), UNTITLED)


def read_untitled(journals: Sequence[Path]) -> FoundJournal:
    sweep(state_folder())
    return FoundJournal(None, None, *_read(journals, None))


def _read(
    journals: Sequence[Path], saved: Path | None
) -> tuple[tuple[Left, ...], tuple[str, ...], dict[Path, Clip]]:
    left: list[Left] = []
    notes: list[str] = []
    for journal in journals:
        try:
            found = read_journal(journal, saved)
        except FileError as error:
            notes.append(f"{error} ({journal})")
            continue
        if found is None:
            forget(journal)  # all of it was saved, or nothing edited
            continue
        left.insert(0, found)
    folder = saved.parent if saved is not None else None
    poses = {found.path: pose_of(found.project, folder) for found in left[:PICTURES]}
    return tuple(left), tuple(notes), {path: clip for path, clip in poses.items() if clip is not None}


def pose_of(project: Project, folder: Path | None) -> Clip | None:
    """Return a clip that shows what a project is about: of its base pose, else its first stance, else its
    first.
    """
    loops = [a.clip for a in project.actions() if a.kind == "stance"]
    for ident in dict.fromkeys(i for i in (project.base.clip, *loops[:1], *list(project.clips)[:1]) if i):
        entry = project.clips.get(ident)
        if entry is not None:
            with suppress(FileError, OSError, ValueError):
                loaded = load_returned(replace(project, clips={ident: entry}), folder).project
                if loaded.clips[ident].motion is not None:
                    return loaded.clips[ident].motion
    return None


def forget(journal: Path) -> None:
    """Remove a journal that was taken over or declined; where that is not allowed it is offered again."""
    with suppress(OSError):
        journal.unlink(missing_ok=True)


def keep_as_copy(left: Left, saved: Path) -> Path:
    """Save a journal's project beside the project file it belongs to, under a name that is free; return
    where. Raises FileError.
    """
    stem = saved.name.removesuffix(SUFFIX) if saved.name.endswith(SUFFIX) else saved.stem
    number = 1
    while (
        place := saved.with_name(f"{stem} recovered{f' {number}' if number > 1 else ''}{SUFFIX}")
    ).exists():
        number += 1
    save_project(left.project, place)
    return place
