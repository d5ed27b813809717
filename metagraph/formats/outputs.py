"""Decide which files a command may overwrite: none that somebody else made, that it reads, or that is open
elsewhere.

While a command runs (`check_outputs`), each writer of files asks first (`claim_output`). An existing file may
be replaced if this user's Metagraph wrote it and nobody has changed it since, which a note in the user's data
folder shows (path and SHA-256), or with `--overwrite`. What the command reads, and a project that a window
has open, is never replaced. Outside commands nothing is checked; the window asks on its own.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from urllib.parse import unquote

import msgspec

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.common.user_folders import find_user_folder
from metagraph.errors import FileError
from metagraph.formats.locking import find_holder, lock_path
from metagraph.formats.replacing import replace_file

STAGED = ".exporting-"  # beginning of the names of folders in which an export is staged
MOST = 4000  # notes that are kept; the oldest are removed first
# Reports that were written to a folder that is read; no command reads them.
_REPORTS = (".csv", ".html", ".svg", ".pdf", ".xes", ".tsv")


class _Written(msgspec.Struct, frozen=True):
    path: str
    sha256: str
    command: str


def find_data_folder() -> Path | None:
    """Return the user's folder for what the program remembers, METAGRAPH_DATA if that is set; None if the
    home folder is unknown.
    """
    if "METAGRAPH_DATA" in os.environ:
        return Path(os.environ["METAGRAPH_DATA"])
    base = find_user_folder("data")
    return base / "Metagraph" / "Metagraph" if base is not None else None


class Outputs:
    """The outputs of one command.

    `overwrite` says whether it may replace what others made. `command` is its name, because it may replace
    its own outputs, but not another command's.
    """

    def __init__(self, overwrite: bool = False, command: str = "") -> None:
        self.overwrite, self.command = overwrite, command
        self._read: list[Path] = []  # files
        self._folders: list[Path] = []  # folders whose files are read
        self._made: list[Path] = []  # folders that are written
        self._claimed: list[Path] = []  # files that will be written
        self._own: list[Path] = []  # files and folders that the command updates itself
        data = find_data_folder()
        self._notes = data / "written" if data is not None else None

    def reads(self, *paths: Path) -> None:
        """Declare that the command reads files, or folders of files. Raises FileError if it would overwrite
        one.
        """
        for path in paths:
            whole = _whole(path)
            (self._folders if whole.is_dir() else self._read).append(whole)
            if whole.suffix.lower() == ".gltf":
                self._read += map(_whole, _beside(whole))
        for claimed in self._claimed:
            self.refuse_input(claimed)

    def keeps_up(self, *paths: Path) -> None:
        """Declare that the command changes files, or files in a folder, in place, as is its purpose."""
        self._own += map(_whole, paths)

    def claim(self, path: Path) -> None:
        """Declare a file or folder that will be written, before the work begins. Raises FileError if
        something would be lost.
        """
        if path.is_dir():
            self._made.append(_whole(path))
            return
        self.check(path)
        self._claimed.append(path)
        if not path.exists():
            self._made.append(_whole(path))  # it may become a folder

    def check(self, path: Path, content: bytes | None = None) -> None:
        """Raise FileError if a file must not be written. `content` is its new content; if it has that
        already, nothing is lost.
        """
        whole = _whole(path)
        if any(own in (whole, *whole.parents) for own in self._own):
            return
        self.refuse_input(path)
        if not whole.exists() or not stat.S_ISREG(whole.stat().st_mode):
            return  # also for a pipe or a terminal
        refuse_locked(whole)
        if self.overwrite or self._is_own(whole) or (content is not None and _holds(whole, content)):
            return
        raise FileError(
            path,
            "is there already, and this command did not write it, or it was changed since then",
            "",
            "Write to another file, or say --overwrite to replace it.",
        )

    def refuse_input(self, path: Path) -> None:
        """Raise FileError if a file is one that the command reads, under any name."""
        whole = _whole(path)
        source = self._input(whole)
        if source is not None:
            same = "is read by this very command, and must not be written over"
            linked = f"is the same file as {source}, which this command reads"
            cause = same if source == whole else linked
            raise FileError(path, cause, "", "Write to another file.")

    def wrote(self, path: Path, whatever: bool = False) -> None:
        """Remember that a file was written. If that cannot be noted, the next command asks for --overwrite.
        With `whatever`, files that the command updates are noted, too.
        """
        whole = _whole(path)
        own = any(own in (whole, *whole.parents) for own in self._own)
        if self._notes is None or (own and not whatever):
            return
        if any(part.startswith(STAGED) for part in whole.parts):
            return  # it is moved to its place later, where the export knows its own files
        with suppress(OSError):
            if stat.S_ISREG(whole.stat().st_mode):
                self._notes.mkdir(parents=True, exist_ok=True)
                note = msgspec.json.encode(_Written(str(whole), _digest(whole), self.command))
                replace_file(self._note(whole), note, sync=False)

    def tidy(self) -> None:
        """Remove the oldest notes if there are too many."""
        if self._notes is None:
            return
        with suppress(OSError):
            notes = sorted(self._notes.iterdir(), key=lambda note: note.stat().st_mtime)
            for old in notes[: max(0, len(notes) - MOST)]:
                old.unlink(missing_ok=True)

    def _note(self, whole: Path) -> Path:
        assert self._notes is not None
        return self._notes / f"{hashlib.sha256(os.fsencode(whole)).hexdigest()[:40]}.json"

    def _is_own(self, whole: Path) -> bool:
        if self._notes is None:
            return False
        try:
            note = msgspec.json.decode(self._note(whole).read_bytes(), type=_Written)
            return (note.path, note.command) == (str(whole), self.command) and note.sha256 == _digest(whole)
        except (OSError, msgspec.MsgspecError, UnicodeError):
            return False

    def _input(self, whole: Path) -> Path | None:
        """Return the input that a file is, under any name or link; None if it is not one."""
        for path in self._read:
            if path == whole:
                return path
            with suppress(OSError):
                if path.samefile(whole):
                    return path
        if not whole.exists() or whole.suffix.lower() in _REPORTS:
            return None
        for folder in self._folders:
            inside = folder in whole.parents
            apart = any(folder in made.parents and made in whole.parents for made in self._made)
            if inside and not apart and not self._is_own(whole):
                return whole
        return None if whole.stat().st_nlink < 2 else self._linked(whole)

    def _linked(self, whole: Path) -> Path | None:
        """Return the file in a folder that is read that is this file under another name."""
        here = whole.stat()
        for folder in self._folders:
            for top, _, names in os.walk(folder):
                for name in names:
                    with suppress(OSError):
                        found = Path(top, name).stat()
                        if (found.st_dev, found.st_ino) == (here.st_dev, here.st_ino):
                            return Path(top, name)
        return None


def refuse_locked(path: Path) -> None:
    """Raise FileError if a window, or another command, has a project file open."""
    if path.suffix.lower() not in (".yaml", ".yml"):
        return
    found = find_holder(lock_path(_whole(path)))
    if found is None or found.sure:
        return
    raise make_locked_error(path, found)


def make_locked_error(path: Path, found: object) -> FileError:
    """Return the error that says who has a project file open. `found` is a `Holder`."""
    owner = getattr(found, "owner", None)
    whose = f" by {owner.user} on {owner.host} (process {owner.pid})" if owner is not None else ""
    return FileError(
        path,
        f"is open in a window or another command{whose}",
        "",
        f"Close it there first. If nobody has it open, remove {lock_path(_whole(path)).name} beside it.",
    )


_now: Outputs | None = None


@contextmanager
def check_outputs(outputs: Outputs) -> Iterator[Outputs]:
    """Check all files that are written inside the `with` block."""
    try:
        with _outputs_are(outputs):
            yield outputs
    finally:
        outputs.tidy()


@contextmanager
def _outputs_are(outputs: Outputs | None) -> Iterator[None]:
    global _now
    before, _now = _now, outputs
    try:
        yield
    finally:
        _now = before


def allow_all_outputs() -> AbstractContextManager[None]:
    """Check nothing inside the `with` block: for a window, which asks the user itself."""
    return _outputs_are(None)


@contextmanager
def claim_output(path: Path, content: bytes | None = None) -> Iterator[None]:
    """Check that a file may be written, and remember that it was. `content` is as in `Outputs.check`. Raises
    FileError.
    """
    outputs = _now
    if outputs is None:
        yield
        return
    outputs.check(path, content)
    yield
    outputs.wrote(path)


def claim(*paths: Path) -> None:
    """Declare what the running command will write; see `Outputs.claim`."""
    if _now is not None:
        for path in paths:
            _now.claim(path)


def declare_inputs(*paths: Path) -> None:
    """Declare what the running command reads; see `Outputs.reads`."""
    if _now is not None:
        _now.reads(*paths)


def declare_updates(*paths: Path) -> None:
    """Declare what the running command changes in place; see `Outputs.keeps_up`."""
    if _now is not None:
        _now.keeps_up(*paths)


def refuse_inputs(paths: Iterable[Path]) -> None:
    """Raise FileError if the running command reads one of these files."""
    if _now is not None:
        for path in paths:
            _now.refuse_input(path)


def note_written(*paths: Path) -> None:
    """Remember files that were written without `claim_output`."""
    if _now is not None:
        for path in paths:
            _now.wrote(path, whatever=True)


def _beside(path: Path) -> list[Path]:
    """Return the files that a glTF names: its buffers and pictures."""
    try:
        data = msgspec.json.decode(read_file(path, TEXT_FILE))
        things = [*data.get("buffers", ()), *data.get("images", ())]
        uris = [str(thing.get("uri", "data:")) for thing in things]
    except (FileError, msgspec.MsgspecError, UnicodeError, AttributeError, TypeError, RecursionError):
        return []  # the code that reads it reports what is wrong
    return [path.parent / unquote(uri) for uri in uris if not uri.startswith("data:")]


def _whole(path: Path) -> Path:
    return Path(os.path.realpath(path))


def _holds(path: Path, content: bytes) -> bool:
    return path.stat().st_size == len(content) and path.read_bytes() == content


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def find_paths(values: Iterable[object]) -> Iterator[Path]:
    """Yield the paths among values, and in lists of them."""
    for value in values:
        if isinstance(value, Path):
            yield value
        elif isinstance(value, (list, tuple)):
            yield from find_paths(value)
