"""Find what is beside a project file when it is opened: another window's lock, and journals of sittings that
ended in a crash.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.project.autosave import find_journal_shelter, state_folder
from metagraph.common.files import is_file
from metagraph.errors import FileError
from metagraph.formats.atomic import sweep
from metagraph.formats.locking import Holder, Lock, Owner
from metagraph.formats.new_file import access_of
from metagraph.formats.project.clip_loading import load_returned
from metagraph.formats.project.journal_register import JournalRegister
from metagraph.formats.project.journal_search import find_all_journals, find_journals_for, project_of
from metagraph.formats.recovery import DAMAGED, Left, find_journals_in, order_journals, read_journal, retire
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip

# The second name is that of early versions; `.old` were those that could not be read.
UNTITLED = r"\.untitled\.[0-9a-f]+\.(journal|old)|untitled(-\d+)?\.(journal|old)"
PICTURES = 8  # journals that are shown with a picture, the latest first


@dataclass(frozen=True)
class FoundJournal:
    """What was found beside a project file.

    `lock` is ours, unless there is a `holder`. `left` has journals with edits, the latest first. `notes` say
    in words what cannot be recovered. `poses` has, for a journal's picture, a clip of its project if one
    could be read.
    """

    lock: Lock | None
    holder: Holder | None
    left: tuple[Left, ...]
    notes: tuple[str, ...]
    poses: Mapping[Path, Clip] = field(default_factory=dict)


def register() -> JournalRegister:
    """Return the list of all journals of this user."""
    return JournalRegister(find_journal_shelter(state_folder()))


def look_beside(path: Path, owner: Owner) -> FoundJournal:
    """Take the lock of a project file, and read the journals that belong to it, wherever they are.
    Half-written files are removed. A missing project file can have journals, too.
    """
    journals = find_journals_for(path, register())
    if not is_file(path) and not (journals and path.parent.is_dir()):
        return FoundJournal(None, None, (), ())
    sweep(path.resolve().parent)
    lock = Lock(path, owner)
    holder = lock.acquire()
    return FoundJournal(lock, holder, *_read([(journal, path) for journal in journals]))


def list_untitled_journals() -> list[Path]:
    """Return the journals that opening a project would not offer, the latest last: of projects never saved
    whose windows are gone, and of those whose file is missing.
    """
    folder = state_folder()
    homeless = []
    for journal in find_all_journals(register(), ()):
        project = project_of(journal)
        if project is not None and not journal.name.endswith(DAMAGED) and not is_file(project):
            homeless.append(journal)
    return order_journals([*find_journals_in(folder, UNTITLED), *homeless])


def list_known_journals(recent: Sequence[Path]) -> list[Path]:
    """Return every journal whose window is gone, the latest last. The folders of the `recent` projects are
    searched, too.
    """
    found = [*find_journals_in(state_folder(), UNTITLED), *list_damaged_untitled()]
    return order_journals(
        [*found, *find_all_journals(register(), dict.fromkeys(path.parent for path in recent))]
    )


def list_damaged_untitled() -> list[Path]:
    return find_journals_in(state_folder(), rf"({UNTITLED}){re.escape(DAMAGED)}")


def read_untitled(journals: Sequence[Path]) -> FoundJournal:
    """Read journals, each with the project file it belongs to."""
    sweep(state_folder())
    return FoundJournal(None, None, *_read([(journal, project_of(journal)) for journal in journals]))


def _read(
    journals: Sequence[tuple[Path, Path | None]],
) -> tuple[tuple[Left, ...], tuple[str, ...], dict[Path, Clip]]:
    left: list[Left] = []
    notes: list[str] = []
    folders: dict[Path, Path | None] = {}
    for journal, saved in journals:
        try:
            found = read_journal(journal, saved if is_file(saved or "") else None)
        except FileError as error:
            notes.append(f"{error} ({journal})")
            continue
        if found is None:
            remove_journal(journal)  # everything in it was saved, or nothing was edited
            continue
        folders[journal] = saved.parent if saved is not None else None
        left.insert(0, found)
    poses = {found.path: find_telling_pose(found.project, folders[found.path]) for found in left[:PICTURES]}
    return tuple(left), tuple(notes), {path: clip for path, clip in poses.items() if clip is not None}


def find_telling_pose(project: Project, folder: Path | None) -> Clip | None:
    """Return a clip that shows what a project is about: that of its base pose, else of its first stance, else
    its first clip.
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


def remove_journal(journal: Path, discard: bool = False) -> None:
    """Remove a journal that was recovered or declined; if that is impossible, it is offered again. A damaged
    one is kept under another name until somebody discards it.
    """
    with suppress(OSError):
        if discard:
            journal.unlink(missing_ok=True)
        else:
            retire(journal)
        register().remove(journal)


def keep_as_copy(left: Left, saved: Path) -> Path:
    """Save a journal's project beside the project file it belongs to, under a free name; return the path.
    Raises FileError.
    """
    stem = saved.name.removesuffix(SUFFIX) if saved.name.endswith(SUFFIX) else saved.stem
    number = 1
    while (
        place := saved.with_name(f"{stem} recovered{f' {number}' if number > 1 else ''}{SUFFIX}")
    ).exists():
        number += 1
    save_project(left.project, place, like=access_of(saved) or access_of(left.path))
    return place
