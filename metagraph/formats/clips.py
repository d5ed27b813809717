"""Read clips from files of any format, one by one or by the hundred."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from metagraph.budgets import MOTION_FILE, SOUND_FILE
from metagraph.errors import FileError
from metagraph.files import guarded, opened, unforeseen
from metagraph.formats.live_link_face import is_live_link
from metagraph.formats.stray_poses import is_bind_pose
from metagraph.formats.takes import NAME, ONE_FRAME, repaired
from metagraph.motion.clip import Clip, ClipError, Repair
from metagraph.wording import told

SUFFIXES = (".bvh", ".glb", ".gltf", ".vrm", ".vrma", ".fbx", ".csv")

_GLTF = (".glb", ".gltf", ".vrm", ".vrma")
_REMEDY = told("Clips are read from {endings}.", endings=", ".join(SUFFIXES))


@dataclass(frozen=True, eq=False)
class ImportReport:
    """What came of importing many files.

    clips: (file, take's number in the file, clip). failures: one error per file that could not be read.
    notes: what the user should know, each naming its file. cancelled: whether the user stopped before the
    end.
    """

    clips: tuple[tuple[Path, int, Clip], ...]
    failures: tuple[FileError, ...]
    notes: tuple[str, ...]
    cancelled: bool = False


@guarded
def read_clips(path: str | Path, as_is: Collection[str] = ()) -> list[Clip]:
    """Return all takes of a file, poses of one frame behind the others. A bind pose of one frame without a
    name of its own is skipped where other takes are longer, with a note on those.

    The content decides what the file is, and must agree with its ending. as_is: repairs (`takes.REPAIRS`) not
    to make; takes that are then not skipped stand behind the others, whose numbers stay. Raises FileError.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    kind = _content(path)
    wanted = {".bvh": "bvh", ".fbx": "fbx", ".csv": "live link", **dict.fromkeys(_GLTF, "gltf")}.get(suffix)
    if wanted is None:
        raise FileError(
            path,
            told("'{value}' is not an ending of a clip file", value=path.suffix or path.name),
            told("its name"),
            _REMEDY,
        )
    if kind != wanted:
        names = {
            "bvh": told("a BVH file"),
            "gltf": told("a glTF file"),
            "fbx": told("an FBX file"),
            "live link": told("a recording of Live Link Face"),
        }
        if kind in names:
            raise FileError(
                path,
                told("it is {names} in spite of its ending", names=names[kind]),
                told("its first bytes"),
                told("Rename it to match its content."),
            )
        raise FileError(
            path,
            told("it is {kind}, not {names}", kind=kind, names=names[wanted]),
            told("its first bytes"),
            _REMEDY,
        )
    try:
        if wanted == "bvh":
            from metagraph.formats.bvh import read_bvh

            clips = [read_bvh(path, as_is=as_is)]
        elif wanted == "gltf":
            from metagraph.formats.gltf import read_gltf_clips

            clips = read_gltf_clips(path, as_is)
        elif wanted == "live link":
            from metagraph.formats.live_link_face import read_live_link

            clips = [read_live_link(path)]
        else:
            from metagraph.formats.fbx import read_fbx_clips

            clips = read_fbx_clips(path, as_is=as_is)
    except ClipError as error:
        raise FileError(path, str(error), told("its motion"), told("Export it again.")) from error
    return _without_junk(clips, as_is)


def _without_junk(clips: list[Clip], as_is: Collection[str]) -> list[Clip]:
    """Put poses of one frame behind the longer takes, and drop those that tools leave behind: bind poses
    without a name of their own.
    """
    short = [clip for clip in clips if clip.frames == 1]
    if not short or len(short) == len(clips):
        return clips
    junk = [clip for clip in short if _unnamed(clip) and is_bind_pose(clip)]
    poses = [clip for clip in short if clip not in junk]
    if poses:
        told = f"{', '.join(repr(clip.name) for clip in poses)}: one frame only, a pose"
        poses = [replace(clip, notes=(*clip.notes, told)) for clip in poses]
    kept = [*(clip for clip in clips if clip.frames > 1), *poses]
    if not junk:
        return kept
    made = ONE_FRAME not in as_is
    skipped = tuple(
        Repair(ONE_FRAME, f"skipped {c.name!r}: a bind pose of one frame", made, n)
        for n, c in enumerate(junk, len(kept))
    )
    if not made:
        return [*kept, *(repaired(clip, repair) for clip, repair in zip(junk, skipped, strict=True))]
    told = f"skipped {', '.join(repr(clip.name) for clip in junk)}: a bind pose of one frame"
    kept[0] = replace(kept[0], notes=(*kept[0].notes, told))
    return [replace(clip, repairs=(*clip.repairs, *skipped)) for clip in kept]


def _unnamed(clip: Clip) -> bool:
    """Whether a take bears its file's name for want of one of its own."""
    return any(repair.name == NAME for repair in clip.repairs)


def _content(path: Path) -> str:
    """Return "bvh", "gltf", "fbx", "live link", or a description of something else. Raises FileError when it
    cannot be read.
    """
    with opened(path, MOTION_FILE) as file:
        head = file.read(4096)
    start = head.lstrip(b"\xef\xbb\xbf \t\r\n")
    if not head:
        return told("an empty file")
    if head.startswith(b"glTF") or start.startswith(b"{"):
        return "gltf"
    if head.startswith(b"Kaydara FBX Binary") or start.startswith(b"; FBX") or b"FBXHeaderExtension" in head:
        return "fbx"
    if start[:9].upper() == b"HIERARCHY":
        return "bvh"
    if is_live_link(head):
        return "live link"
    if head.startswith(b"version https://git-lfs"):
        return told("a Git LFS pointer whose content was never fetched")
    if start[:1] == b"<":
        return told("a web page or XML file")
    return told("something else")


def is_face_recording(path: Path) -> bool:
    """Whether a table is a recording of Live Link Face."""
    try:
        return _content(path) == "live link"
    except FileError:
        return False


def find_clip_files(folder: str | Path) -> list[Path]:
    """Return every clip file in a folder and below, sorted by path without regard to case; hidden ones are
    skipped.
    """
    folder = Path(folder)
    found = [
        p
        for p in folder.rglob("*")
        if p.suffix.lower() in SUFFIXES
        and p.is_file()
        and not any(part.startswith(".") for part in p.relative_to(folder).parts)
        and (p.suffix.lower() != ".csv" or is_face_recording(p))  # most tables are something else
    ]
    return sorted(found, key=lambda p: (str(p).casefold(), str(p)))


def import_clips(
    paths: Iterable[str | Path],
    progress: Callable[[int, int, Path], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ImportReport:
    """Read many files; a bad one fails alone.

    progress: called before each file with how many are done, how many there are, and the file. cancelled:
    asked before each file. Files whose skeletons are the same share one Skeleton object. FBX files are read a
    few at a time, by processes that are started once; the other formats take a few milliseconds of
    Python's own, where threads gain nothing.
    """
    files = [Path(p) for p in paths]
    with reading_together(files) as begun:
        return _import_clips(files, begun, progress, cancelled)


@contextmanager
def reading_together(paths: Iterable[Path]) -> Iterator[Mapping[Path, Future[list[Clip]]]]:
    """Begin to read those of many files that another process reads, a few at a time; what is not wanted any
    more at the end is not read.
    """
    fbx = [path for path in paths if path.suffix.lower() == ".fbx"]
    if len(fbx) < 2:
        yield {}
        return
    from metagraph.formats.fbx_readers import batch

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
        except Exception as error:  # no kind is trusted to be the only one
            failures.append(unforeseen(path, error))
            continue
        for number, clip in enumerate(takes):
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
    """Return the SHA-256 of a file's content, hex. Raises FileError."""
    with opened(path, SOUND_FILE) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
