"""Load the clips of a project: read their files, find those that moved, and fit each clip to the skeleton."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from metagraph.common.files import is_file, make_unforeseen_error
from metagraph.common.network_paths import is_closed, recover_original_path
from metagraph.errors import clean_text
from metagraph.formats.clips import digest
from metagraph.formats.fbx.processes import batch
from metagraph.formats.motion_cache import read_or_kept
from metagraph.formats.project.moved_files import find_clip_place, find_moved_files, list_missing_clips
from metagraph.formats.project.paths import close_paths_below, make_path_relative
from metagraph.graph.clip_source import get_source_clip, with_changed_file, with_source
from metagraph.graph.editing.retargeting import Bringing
from metagraph.graph.face.takes import FACE_TAKE, is_face_take, put_on_body
from metagraph.graph.model import ClipEntry, Project
from metagraph.motion.adopt import SkeletonMismatchError, adopt
from metagraph.motion.clip import Clip, ClipError
from metagraph.motion.joint_map import RetargetError


@dataclass(frozen=True)
class Opened:
    """A project read from a file.

    `notes` say in words what was repaired or is worth knowing. `digest` is the file's SHA-256 in hex. `newer`
    says that a newer Metagraph wrote the file, so that it may only be read.
    """

    project: Project
    notes: tuple[str, ...] = ()
    digest: str | None = None
    newer: bool = False


def load_motions(
    project: Project, folder: Path | None, progress: Callable[[int, int], None] | None = None
) -> Opened:
    """Load the motion of every clip that has none. Paths are relative to `folder`; None if all are
    absolute.
    """
    if folder is not None and folder.parent == folder:
        folder = None  # the root folder is never a project's folder; nothing is searched there
    if folder is not None:
        project = close_paths_below(project, folder)  # a journal's project was read without one
    return _load(
        project,
        folder,
        find_moved_files(list_missing_clips(project, folder), folder) if folder is not None else {},
        progress,
    )


def relocate(
    project: Project, folder: Path | None, where: Path, progress: Callable[[int, int], None] | None = None
) -> Project:
    """Return the project with missing clips loaded from anywhere below `where`, and their paths corrected.

    They are found by content, or by name if the content has changed. Those that are back in their places are
    read there.
    """
    return _load(
        project, folder, find_moved_files(list_missing_clips(project, folder), where, by_name=True), progress
    ).project


def load_returned(
    project: Project, folder: Path | None, progress: Callable[[int, int], None] | None = None
) -> Opened:
    """Load the motion of clips without one whose files are in their places. Nothing is searched."""
    return _load(project, folder, {}, progress)


@batch()
def _load(
    project: Project,
    folder: Path | None,
    found: Mapping[str, Path],
    progress: Callable[[int, int], None] | None,
) -> Opened:
    """Load the clips without motion; `found` says where moved files are now."""
    by_path: dict[str, list[ClipEntry]] = {}
    for entry in project.clips.values():
        if entry.motion is None:
            by_path.setdefault(entry.path, []).append(entry)
    loading = _Loading(project, folder, found)
    for n, (name, entries) in enumerate(by_path.items()):
        if progress is not None:
            progress(n, len(by_path))
        loading.load(name, entries)
    return loading.opened()


class _Loading:
    """Clips while their files are read.

    `found` has the files that are elsewhere than their path says. `strangers` has the ids of clips that do
    not fit the skeleton.
    """

    def __init__(self, project: Project, folder: Path | None, found: Mapping[str, Path]) -> None:
        self.project, self.folder, self.found = project, folder, found
        self.clips = dict(project.clips)
        self.skeleton = project.skeleton
        self.notes: list[str] = []
        self.strangers: list[str] = []

    def opened(self) -> Opened:
        """Return the project with what was read, and the notes."""
        project = replace(self.project, clips=self.clips, skeleton=self.skeleton)
        if self.strangers:
            project = _brought(project, self.strangers, self.notes)
        return Opened(project, tuple(dict.fromkeys(self.notes)))

    def load(self, name: str, entries: Sequence[ClipEntry]) -> None:
        """Read the file of some clips. `name` is its path in the project."""
        place = self.found.get(name) or find_clip_place(entries[0], self.folder)
        path = self._path(name, place)
        if name in self.found:
            self.notes.append(f"'{recover_original_path(name)}' has moved to '{path}'")
        if is_closed(name) and name not in self.found:
            return  # one note says so for all of them
        if not is_file(place):
            self.notes.append(f"'{clean_text(name)}' is missing")
            return
        try:
            now = digest(place)
            read = {a: read_or_kept(place, now, a) for a in dict.fromkeys(e.as_is for e in entries)}
        except Exception as error:  # one bad file never spoils a project
            self.notes.append(str(make_unforeseen_error(place, error)))
            return
        if any(e.digest and now != e.digest for e in entries):
            self.notes.append(f"'{path}' has changed since it was imported")
        for entry in entries:
            takes = read[entry.as_is]
            if 0 <= entry.take < len(takes):
                motion = self._fitted(entry, takes[entry.take].renamed(entry.name))
                self.clips[entry.id] = with_changed_file(replace(entry, path=path), motion, now)
            else:
                self.notes.append(f"'{path}' no longer has take {entry.take + 1} ('{entry.name}')")

    def _path(self, name: str, place: Path) -> str:
        """Return the path by which the project names this file from now on."""
        if name not in self.found and "\\" not in name:
            return name
        if self.folder is None or Path(name).is_absolute():
            return place.resolve().as_posix()
        return make_path_relative(place, self.folder)

    def _fitted(self, entry: ClipEntry, motion: Clip) -> Clip:
        """Return motion on the project's skeleton. If the project has none, it takes that of the first clip
        with a body. Motion that does not fit is returned as it is, and its clip becomes a stranger.
        """
        if is_face_take(motion):
            self.strangers.append(entry.id)
            return motion
        if self.skeleton is None:
            self.skeleton = motion.skeleton
        try:
            return adopt(motion, self.skeleton)
        except SkeletonMismatchError:
            self.strangers.append(entry.id)
            return motion


def _brought(project: Project, strangers: Iterable[str], notes: list[str]) -> Project:
    """Return the project with those clips retargeted for whose skeleton it has a joint map. `check` reports
    the others.
    """
    bringing = Bringing(project)
    clips = dict(project.clips)
    for ident in strangers:
        entry = clips[ident]
        motion: Clip = get_source_clip(entry)  # type: ignore[assignment]
        joint_map = bringing.known(motion)
        if is_face_take(motion):
            try:
                clips[ident] = with_source(
                    replace(entry, brought_from=FACE_TAKE), put_on_body(project, motion)
                )
            except RetargetError as error:
                notes.append(f"'{entry.path}': {error}")
            continue
        if joint_map is None:
            if entry.brought_from:
                notes.append(
                    f"'{entry.path}' was retargeted, but its joint map is not in the project: import it again"
                )
            continue
        try:
            motion = bringing.bring(motion, joint_map)
        except (RetargetError, ClipError) as error:
            notes.append(
                f"'{entry.path}' could not be retargeted: {error}. Import it again to map its joints anew."
            )
            continue
        clips[ident] = with_source(replace(entry, brought_from=motion.brought_from), motion)
    return replace(project, clips=clips)
