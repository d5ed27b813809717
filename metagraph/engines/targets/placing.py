"""Putting an export's files where they are wanted, whole, and over nothing that is not its own.

An export is written beside the folder first. A record in the folder says which target, which project and
which files stand there, with their digests, so that writing again knows its own files; what else stands in
the way is foreign.
"""

from __future__ import annotations

import errno
import hashlib
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import msgspec

from metagraph.budgets import SOUND_FILE, TEXT_FILE
from metagraph.engines.export import ExportError
from metagraph.errors import FileError
from metagraph.files import is_file, is_inside, opened, read_file
from metagraph.formats.atomic import write_atomically
from metagraph.wording import told

RECORD = ".metagraph-export.json"
NAMED = 4  # foreign files that are named


class Record(msgspec.Struct, frozen=True):
    """What was written: for which target, of which project; its files by their paths in the folder, with
    their SHA-256.
    """

    target: str
    project: str
    files: dict[str, str]


class ForeignFilesError(ExportError):
    """Files stand where the export would go that are of something else, or were changed since. files: their
    paths in the folder.
    """

    def __init__(self, folder: Path, files: tuple[str, ...], of: Record | None) -> None:
        self.folder, self.files = folder, files
        more = f" and {len(files) - NAMED} more" if len(files) > NAMED else ""
        whose = f"; the folder holds an export of '{of.project}' for '{of.target}'" if of is not None else ""
        super().__init__(
            f"{folder} already has {', '.join(files[:NAMED])}{more}{whose}. Choose another folder, or say "
            "that they may be overwritten."
        )


def read_record(folder: Path) -> Record | None:
    """Return what was exported into a folder; None where nothing was, or where it cannot be told."""
    try:
        return msgspec.json.decode(read_file(folder / RECORD, TEXT_FILE), type=Record)
    except (FileError, msgspec.DecodeError, UnicodeDecodeError):
        return None


def foreign(folder: Path, wanted: Mapping[str, str], target: str, project: str) -> tuple[str, ...]:
    """Return which files would be overwritten that are of something else, or were changed since they were
    written. wanted: the new files by name, with their digests; one that stands there already, byte for byte,
    is in nobody's way.
    """
    known = read_record(folder)
    mine: Mapping[str, str] = (
        known.files if known is not None and (known.target, known.project) == (target, project) else {}
    )
    out = []
    for name, digest in wanted.items():
        path = folder / name
        if path.is_dir() or (path.exists() and _digest(path) not in (digest, mine.get(name))):
            out.append(name)
    return tuple(out)


def place(
    staged: Staging, folder: Path, names: Iterable[str], target: str, project: str, overwrite: bool
) -> None:
    """Move files from where they were staged into a folder, and take away what an earlier export of the same
    left that this has not.

    Raises ForeignFilesError, before anything is changed, unless they may be overwritten; FileError when a
    file cannot be written.
    """
    before = read_record(folder)
    digests = {name: _digest(staged.path / name) for name in names}
    others = foreign(folder, digests, target, project)
    if others and not overwrite:
        raise ForeignFilesError(folder, others, before)
    gone = []
    if before is not None and (before.target, before.project) == (target, project):
        for name in before.files.keys() - digests.keys():
            old = folder / name
            if is_inside(old, folder) and is_file(old) and _digest(old) == before.files[name]:
                gone.append(name)
    record = msgspec.json.format(msgspec.json.encode(Record(target, project, digests)), indent=1)
    write_atomically(staged.path / RECORD, record)
    staged.move([*digests, RECORD], gone)


class Staging:
    """A folder inside the export's own, so that moving out of it is one step a file; gone at the end, and
    with it a folder that was made for nothing. Raises FileError.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        try:
            self._made = [p for p in (folder, *folder.parents) if not p.exists()]
            folder.mkdir(parents=True, exist_ok=True)
            self.path = Path(tempfile.mkdtemp(prefix=".exporting-", dir=folder))
        except (OSError, ValueError) as error:
            remedy = "Choose a folder you may write to."
            raise FileError(
                folder,
                told("cannot be made ({value})", value=getattr(error, "strerror", None) or error),
                told("on making the folder"),
                remedy,
            ) from None

    def __enter__(self) -> Staging:
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.path, ignore_errors=True)
        for empty in sorted(set(self._made), key=lambda p: -len(p.parts)):
            with suppress(OSError):  # it holds the export
                empty.rmdir()

    def move(self, names: Sequence[str], gone: Sequence[str] = ()) -> None:
        """Move staged files to their places, and take those that are `gone` away: all of it, or nothing; what
        stood there stays until all that comes is in its place. The one that names the others comes last.
        Raises FileError.
        """
        aside = self.path / ".before"
        done: list[tuple[Path, Path | None]] = []  # a place, and where what stood there is kept
        try:
            aside.mkdir()
            for n, name in enumerate((*names, *gone)):
                place, kept = self.folder / name, aside / str(n)
                self._made += [p for p in place.parents if not p.exists()]
                place.parent.mkdir(parents=True, exist_ok=True)
                if place.is_dir() and not place.is_symlink():
                    raise OSError(errno.EISDIR, "a folder stands there", str(place))
                stood = place.is_symlink() or place.exists()
                if stood:
                    place.replace(kept)
                done.append((place, kept if stood else None))
                if n < len(names):
                    (self.path / name).replace(place)
        except OSError as error:
            self._put_back(done)
            where = Path(error.filename2 or error.filename or self.folder)
            remedy = "Close what has it open, or choose a folder you may write to, with space left."
            raise FileError(
                where,
                told("cannot be written ({value})", value=error.strerror or error),
                told("on exporting"),
                remedy,
            ) from None
        except BaseException:
            self._put_back(done)
            raise

    def _put_back(self, done: Sequence[tuple[Path, Path | None]]) -> None:
        for place, kept in reversed(done):
            with suppress(OSError):
                if kept is not None:
                    kept.replace(place)
                else:
                    place.unlink(missing_ok=True)


def _digest(path: Path) -> str:
    with opened(path, SOUND_FILE) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
