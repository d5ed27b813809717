"""Put an export's files into their folder, completely, without replacing foreign files.

An export is staged in a folder of its own first. A record says which target, which project and which files
stand there, with their digests, so that writing again knows its own files; what else stands in the way is
foreign. While files are exchanged the record lists both the old and the new ones: after a crash in between,
`metagraph verify` says so, and exporting again replaces either.
"""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import msgspec

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import is_file, is_inside, read_file
from metagraph.common.network_paths import explain_refusal
from metagraph.common.wording import phrase
from metagraph.engines.export_error import ExportError
from metagraph.errors import FileError
from metagraph.formats.atomic import FORSAKEN, write_atomically
from metagraph.formats.clips import digest
from metagraph.formats.locking import mark_is_gone, process_mark
from metagraph.formats.outputs import refuse_inputs

RECORD = ".metagraph-export.json"
BEFORE = ".first"  # of a staging folder: what is moved before everything else
STAGED = ".exporting-"  # staging folders begin so
_LAST = {".glb": 1, ".json": 2}  # files that are moved behind the others
NAMED = 4  # foreign files that are named


class ExportRecord(msgspec.Struct, frozen=True):
    """What was written: for which target, of which project; its files by their paths in the folder, with
    their SHA-256. replaced: those of the export before, while files are exchanged; None afterwards.
    """

    target: str
    project: str
    files: dict[str, str]
    replaced: dict[str, str] | None = None

    def knows(self, name: str, sha256: str) -> bool:
        """Return whether an export has written this content under this name."""
        return sha256 in (self.files.get(name), (self.replaced or {}).get(name))


class ForeignFilesError(ExportError):
    """Files in the folder belong to something else, or were changed since they were exported. files: their
    paths in the folder.
    """

    def __init__(self, folder: Path, files: tuple[str, ...], of: ExportRecord | None) -> None:
        self.folder, self.files = folder, files
        more = f" and {len(files) - NAMED} more" if len(files) > NAMED else ""
        whose = f"; the folder holds an export of '{of.project}' for '{of.target}'" if of is not None else ""
        super().__init__(
            f"{folder} already has {', '.join(files[:NAMED])}{more}{whose}. Choose another folder, or say "
            "that they may be overwritten (on the command line: --overwrite)."
        )


def read_record(folder: Path) -> ExportRecord | None:
    """Return the record of the export in a folder, or None if there is no readable record."""
    try:
        return msgspec.json.decode(read_file(folder / RECORD, TEXT_FILE), type=ExportRecord)
    except (FileError, msgspec.DecodeError, UnicodeDecodeError):
        return None


def find_foreign_files(folder: Path, wanted: Mapping[str, str], target: str, project: str) -> tuple[str, ...]:
    """Return the files that would be overwritten although they belong to something else, or were changed.
    wanted: the new files by name, with their digests; one that stands there already, byte for byte, is in
    nobody's way.
    """
    known = read_record(folder)
    mine = known if known is not None and (known.target, known.project) == (target, project) else None
    out = []
    for name, new in wanted.items():
        path = folder / name
        if not path.exists():
            continue
        if path.is_dir() or ((found := digest(path)) != new and not (mine and mine.knows(name, found))):
            out.append(name)
    return tuple(out)


def place_files(
    staged: Staging, folder: Path, names: Iterable[str], target: str, project: str, overwrite: bool
) -> None:
    """Move files from where they were staged into a folder, and take away what an earlier export of the same
    left that this has not.

    Raises ForeignFilesError, before anything is changed, unless they may be overwritten; FileError when a
    file cannot be written.
    """
    before = read_record(folder)
    digests = {name: digest(staged.path / name) for name in names}
    refuse_inputs(folder / name for name in (*digests, RECORD))
    others = find_foreign_files(folder, digests, target, project)
    if others and not overwrite:
        raise ForeignFilesError(folder, others, before)
    gone = []
    known: dict[str, str] = {}
    if before is not None and (before.target, before.project) == (target, project):
        known = {**(before.replaced or {}), **before.files}
        for name in sorted(known.keys() - digests.keys()):
            old = folder / name
            if explain_refusal(name, folder) is not None or not is_inside(old, folder):
                continue  # no name that an export would have written
            if is_file(old) and before.knows(name, digest(old)):
                gone.append(name)
    (staged.path / BEFORE).mkdir()
    _write_record(staged.path / BEFORE / RECORD, ExportRecord(target, project, digests, known))
    _write_record(staged.path / RECORD, ExportRecord(target, project, digests))
    # Last what names the others: the GLB, its JSON right after it, the record.
    order = sorted(digests, key=lambda name: (_LAST.get(Path(name).suffix.lower(), 0), -name.count("/")))
    staged.move([f"{BEFORE}/{RECORD}", *order, RECORD], gone)


def _write_record(path: Path, record: ExportRecord) -> None:
    write_atomically(path, msgspec.json.format(msgspec.json.encode(record), indent=1))


class Staging:
    """A folder inside the export's own, so that moving out of it is one step a file; gone at the end, and
    with it a folder that was made for nothing. What killed exports have left of theirs is removed. Raises
    FileError.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        try:
            self._made = [p for p in (folder, *folder.parents) if not p.exists()]
            folder.mkdir(parents=True, exist_ok=True)
            sweep_staging(folder)
            self.path = Path(tempfile.mkdtemp(prefix=f"{STAGED}{process_mark()}-", dir=folder))
        except (OSError, ValueError) as error:
            remedy = "Choose a folder that you can write to."
            raise FileError(
                folder,
                phrase("cannot be created ({value})", value=getattr(error, "strerror", None) or error),
                phrase("creating the folder"),
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
        """Move staged files to their places, in this order, and take those that are `gone` away: all of it,
        or nothing. At every moment there is a whole file in each place, the old one or the new one. Raises
        FileError.
        """
        aside = self.path / ".before"
        done: list[tuple[Path, Path | None]] = []  # a place, and where what stood there is kept
        try:
            aside.mkdir()
            for n, name in enumerate((*names, *gone)):
                place, kept = self.folder / name.removeprefix(f"{BEFORE}/"), aside / str(n)
                self._made += [p for p in place.parents if not p.exists()]
                place.parent.mkdir(parents=True, exist_ok=True)
                if place.is_dir() and not place.is_symlink():
                    raise OSError(errno.EISDIR, "a folder stands there", str(place))
                stood = place.is_symlink() or place.exists()
                if stood:
                    _keep(place, kept)
                done.append((place, kept if stood else None))
                if n < len(names):
                    (self.path / name).replace(place)
                else:
                    place.unlink()
        except OSError as error:
            self._put_back(done)
            where = Path(error.filename2 or error.filename or self.folder)
            remedy = "Close what has it open, or choose a folder you may write to, with space left."
            raise FileError(
                where,
                phrase("cannot be written ({value})", value=error.strerror or error),
                phrase("exporting"),
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


def _keep(place: Path, kept: Path) -> None:
    """Keep a file under another name as well; a copy where the file system has no second names."""
    try:
        os.link(place, kept, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(place, kept, follow_symlinks=False)


def sweep_staging(folder: Path) -> list[Path]:
    """Remove the staging folders of exports that were killed; return them. Those of other computers, which
    cannot be asked, go after a day.
    """
    swept = find_forsaken_staging(folder)
    for path in swept:
        shutil.rmtree(path, ignore_errors=True)
    return swept


def find_forsaken_staging(folder: Path) -> list[Path]:
    """Return the staging folders that killed exports have left in a folder."""
    found: list[Path] = []
    with suppress(OSError, ValueError):
        for path in folder.glob(f"{STAGED}*"):
            mark = path.name.removeprefix(STAGED).rpartition("-")[0]
            gone = mark_is_gone(mark) if mark else None
            if gone is None:
                gone = time.time() - path.stat().st_mtime > FORSAKEN
            if gone and path.is_dir() and not path.is_symlink():
                found.append(path)
    return found
