"""Read clips from files of any format, singly or hundreds at once."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from metagraph.common.budgets import MOTION_FILE, SOUND_FILE
from metagraph.common.files import guard_reader, make_unforeseen_error, open_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError, clean_text
from metagraph.formats.clip_readers import (
    FACE_READERS,
    HEAD,
    ClipReader,
    find_reader,
    find_reader_for,
    list_clip_suffixes,
)
from metagraph.formats.stray_poses import is_bind_pose
from metagraph.formats.takes import NAME, ONE_FRAME, note_repair
from metagraph.motion.clip import Clip, ClipError, Repair
from metagraph.motion.roles import find_roles, is_humanoid
from metagraph.motion.skeleton import Skeleton

FIGURE = 12  # joints below the root of another person, at least


@dataclass(frozen=True, eq=False)
class ImportReport:
    """The result of importing many files.

    `clips` has (file, number of the take in the file, clip). `failures` has an error for each file that could
    not be read. `notes` are for the user, each with its file's name. `cancelled` is True if the user stopped
    before the end.
    """

    clips: tuple[tuple[Path, int, Clip], ...]
    failures: tuple[FileError, ...]
    notes: tuple[str, ...]
    cancelled: bool = False


@guard_reader
def read_clips(path: str | Path, as_is: Collection[str] = ()) -> list[Clip]:
    """Return all takes of a file, with poses of one frame after the others. A bind pose of one frame without
    a name of its own is skipped if other takes are longer; a note on those says so.

    The content decides what the file is, and must agree with its extension. `as_is` names repairs
    (`takes.REPAIRS`) not to make. Takes that are then not skipped come after the others, so that numbers stay
    the same. Raises FileError.
    """
    path = Path(path)
    wanted, found = find_reader_for(path.suffix.lower()), _reader(path)
    remedy = phrase("Clips are read from {endings}.", endings=", ".join(list_clip_suffixes()))
    if wanted is None:
        raise FileError(
            path,
            phrase("'{value}' is not a file extension for clips", value=path.suffix or path.name),
            phrase("its name"),
            remedy,
        )
    if isinstance(found, str):
        cause = phrase("it is {kind}, not {names}", kind=found, names=wanted.name)
        raise FileError(path, cause, phrase("its first bytes"), remedy)
    if path.suffix.lower() not in found.suffixes:
        raise FileError(
            path,
            phrase("it is {names} despite its extension", names=found.name),
            phrase("its first bytes"),
            phrase("Rename it to match its content."),
        )
    try:
        clips = found.read(path, as_is)
    except ClipError as error:
        raise FileError(path, str(error), phrase("its motion"), phrase("Export it again.")) from error
    return _without_junk(_tell_other_figures(clips), as_is)


def _tell_other_figures(clips: list[Clip]) -> list[Clip]:
    """Return clips with a note on the people in their skeleton whose motion nobody plays: a scene of two has
    two roots, and joints find their roles on one of them.
    """
    told: dict[int, str | None] = {}
    for clip in clips:
        if id(clip.skeleton) not in told:
            told[id(clip.skeleton)] = _other_figures(clip.skeleton)
    notes = [told[id(clip.skeleton)] for clip in clips]
    return [
        replace(clip, notes=(*clip.notes, note)) if note else clip
        for clip, note in zip(clips, notes, strict=True)
    ]


def _other_figures(skeleton: Skeleton) -> str | None:
    roots = np.flatnonzero(skeleton.parents < 0).tolist()
    figures = [(root, skeleton.descendants(root)) for root in roots]
    figures = [(root, joints) for root, joints in figures if len(joints) >= FIGURE]
    if len(figures) < 2:
        return None
    hips = find_roles(skeleton).get("hips")
    played = next((root for root, joints in figures if hips == root or hips in joints), None)
    others = [root for root, joints in figures if root != played and _is_person(skeleton, (root, *joints))]
    if played is None or not others:
        return None
    return phrase(
        "it has several figures: the one below '{name}' is played, not {others}. Export one to a file",
        name=clean_text(skeleton.names[played][:40]),
        others=", ".join(f"'{clean_text(skeleton.names[root][:40])}'" for root in others[:6]),
    )


def _is_person(skeleton: Skeleton, joints: Sequence[int]) -> bool:
    own = sorted(set(joints))
    place = {joint: n for n, joint in enumerate(own)}
    part = Skeleton(
        tuple(skeleton.names[j] for j in own),
        np.array([place.get(int(skeleton.parents[j]), -1) for j in own]),
        skeleton.rest_rotations[own],
        skeleton.rest_translations[own],
    )
    return is_humanoid(find_roles(part))


def _without_junk(clips: list[Clip], as_is: Collection[str]) -> list[Clip]:
    """Move poses of one frame after the longer takes, and drop those that tools leave behind: bind poses
    without a name of their own.
    """
    short = [clip for clip in clips if clip.frames == 1]
    if not short or len(short) == len(clips):
        return clips
    junk = [clip for clip in short if _unnamed(clip) and is_bind_pose(clip)]
    poses = [clip for clip in short if clip not in junk]
    if poses:
        names = ", ".join(repr(clip.name) for clip in poses)
        told = phrase("{names}: one frame only, a pose", names=names)
        poses = [replace(clip, notes=(*clip.notes, told)) for clip in poses]
    kept = [*(clip for clip in clips if clip.frames > 1), *poses]
    if not junk:
        return kept
    made = ONE_FRAME not in as_is
    skipped = tuple(
        Repair(ONE_FRAME, phrase("skipped '{name}': a bind pose of one frame", name=c.name), made, n)
        for n, c in enumerate(junk, len(kept))
    )
    if not made:
        return [*kept, *(note_repair(clip, repair) for clip, repair in zip(junk, skipped, strict=True))]
    names = ", ".join(repr(clip.name) for clip in junk)
    told = phrase("skipped {names}: a bind pose of one frame", names=names)
    kept[0] = replace(kept[0], notes=(*kept[0].notes, told))
    return [replace(clip, repairs=(*clip.repairs, *skipped)) for clip in kept]


def _unnamed(clip: Clip) -> bool:
    """Return whether a take is named after its file because it has no name of its own."""
    return any(repair.name == NAME for repair in clip.repairs)


def _reader(path: Path) -> ClipReader | str:
    """Return the reader of a file, found by its content, or a description of what else it is. Raises
    FileError if it cannot be read.
    """
    with open_file(path, MOTION_FILE) as file:
        head = file.read(HEAD)
    if not head:
        return phrase("an empty file")
    found = find_reader(head)
    if found is not None:
        return found
    if head.startswith(b"version https://git-lfs"):
        return phrase("a Git LFS pointer whose content was never fetched")
    if head.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] == b"<":
        return phrase("a web page or XML file")
    return phrase("another kind of file")


def is_face_recording(path: Path) -> bool:
    """Return whether a table or a JSON file is a recording of a face, as of Live Link Face."""
    try:
        return _reader(path) in FACE_READERS
    except FileError:
        return False


def find_clip_files(folder: str | Path) -> list[Path]:
    """Return every clip file in a folder and below, sorted by path ignoring case. Hidden files and folders
    are skipped.
    """
    folder, endings = Path(folder), (*list_clip_suffixes(), ".json")
    found = [
        p
        for p in folder.rglob("*")
        if p.suffix.lower() in endings
        and p.is_file()
        and not any(part.startswith(".") for part in p.relative_to(folder).parts)
        # Most tables and most JSON are something else.
        and (p.suffix.lower() not in (".csv", ".json") or is_face_recording(p))
    ]
    return sorted(found, key=lambda p: (str(p).casefold(), str(p)))


def import_clips(
    paths: Iterable[str | Path],
    progress: Callable[[int, int, Path], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ImportReport:
    """Read many files; a bad one fails alone.

    `progress` is called before each file with the number of files done, the number of all files, and the
    file. `cancelled` is called before each file. Files with equal skeletons share one Skeleton object. FBX
    files are read a few at a time by processes that are started once. Files of other formats take a few
    milliseconds of Python code, which threads would not make faster.
    """
    files = [Path(p) for p in paths]
    with read_together(files) as begun:
        return _import_clips(files, begun, progress, cancelled)


@contextmanager
def read_together(paths: Iterable[Path]) -> Iterator[Mapping[Path, Future[list[Clip]]]]:
    """Begin to read those of many files that another process reads, a few at a time. Files not waited for at
    the end are not read.
    """
    fbx = [path for path in paths if path.suffix.lower() == ".fbx"]
    if len(fbx) < 2:
        yield {}
        return
    from metagraph.formats.fbx.processes import batch

    with batch():
        pool = ThreadPoolExecutor(min(4, os.cpu_count() or 1))
        try:
            yield {path: pool.submit(read_clips, path) for path in fbx}
        finally:
            pool.shutdown(cancel_futures=True)


def _import_clips(
    files: list[Path],
    begun: Mapping[Path, Future[list[Clip]]],
    progress: Callable[[int, int, Path], None] | None,
    cancelled: Callable[[], bool] | None,
) -> ImportReport:
    clips: list[tuple[Path, int, Clip]] = []
    failures: list[FileError] = []
    notes: list[str] = []
    skeletons: dict[str, Clip] = {}
    stopped = False
    for done, path in enumerate(files):
        if cancelled is not None and cancelled():
            stopped = True
            break
        if progress is not None:
            progress(done, len(files), path)
        try:
            takes = begun[path].result() if path in begun else read_clips(path)
        except Exception as error:  # readers may raise any kind of error
            failures.append(make_unforeseen_error(path, error))
            continue
        for number, clip in enumerate(takes):
            if clip.face_of:
                continue
            known = skeletons.setdefault(clip.skeleton.fingerprint, clip)
            clips.append(
                (
                    path,
                    number,
                    clip if known.skeleton is clip.skeleton else replace(clip, skeleton=known.skeleton),
                )
            )
            notes += [f"{path.name}: {note}" for note in clip.notes]
    if progress is not None and not stopped and files:
        progress(len(files), len(files), files[-1])
    return ImportReport(tuple(clips), tuple(failures), tuple(dict.fromkeys(notes)), stopped)


def digest(path: str | Path) -> str:
    """Return the SHA-256 of a file's content in hex. Raises FileError."""
    with open_file(path, SOUND_FILE) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
