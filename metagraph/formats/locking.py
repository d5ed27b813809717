"""Who has a project open: a lock file beside it, for windows on one computer and on several that share a
drive.

The file is made by O_EXCL, which network drives keep too, and no lock of the system's is asked for. It says
who made it; while its window is open it is touched every `REFRESH` seconds. A process that is gone is known
at once on its own computer, and elsewhere by a file that was not touched for `STALE` seconds by the drive's
own clock.
"""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import os
import platform
import tempfile
import time
import uuid
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import msgspec

from metagraph.common.programs import run_program, system_program
from metagraph.formats.new_file import Access, access_of, open_new

REFRESH = 30.0  # seconds
STALE = 150.0  # seconds; a computer may be busy, and a drive away for a while


class Owner(msgspec.Struct, frozen=True):
    """One sitting: a document in a process. machine: what else tells computers and containers of one name
    apart, "" if unknown.

    started: when the process began, in the system's own terms, since numbers of processes come again. since:
    seconds since 1970.
    """

    host: str
    machine: str
    user: str
    pid: int
    started: str
    sitting: str
    since: float


def new_owner() -> Owner:
    """Return a new sitting of this process."""
    pid = os.getpid()
    return Owner(platform.node(), _machine(), _user(), pid, _started(pid), uuid.uuid4().hex[:12], time.time())


def _user() -> str:
    try:
        import getpass

        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # a number without a name, as in containers
        return "somebody"


@cache
def _machine() -> str:
    """Return what numbers of processes are valid in: a boot of Linux and its namespace; elsewhere the host's
    name has to do.
    """
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
        return f"{boot} {Path('/proc/self/ns/pid').readlink()}"
    except OSError:
        return ""


def _started(pid: int) -> str:
    """Return when a process began, "" where that is not known. Raises ProcessLookupError when there is
    none.
    """
    if pid <= 0:
        raise ProcessLookupError(pid)
    if os.name == "nt":
        return _started_on_windows(pid)
    try:
        os.kill(pid, 0)
    except PermissionError:
        pass  # another user's
    except OverflowError:
        raise ProcessLookupError(pid) from None
    if _machine():  # there is a /proc
        with contextlib.suppress(FileNotFoundError, PermissionError, IndexError):
            fields = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
            if fields[0] in (b"Z", b"X"):
                raise ProcessLookupError(pid)
            return fields[19].decode()
        return ""
    ps = system_program("ps")
    if ps is not None:
        with contextlib.suppress(OSError):  # TimeoutError is one
            return run_program([ps, "-o", "lstart=", "-p", str(pid)], 5.0)[1].strip()
    return ""


def _started_on_windows(pid: int) -> str:
    kernel = ctypes.WinDLL("kernel32", use_last_error=True)  # type: ignore[attr-defined,unused-ignore]
    kernel.OpenProcess.restype = ctypes.c_void_p
    handle = kernel.OpenProcess(0x1000, False, pid)  # PROCESS_QUERY_LIMITED_INFORMATION
    if not handle:
        if ctypes.get_last_error() == 5:  # type: ignore[attr-defined,unused-ignore]  # denied: another user's
            return ""
        raise ProcessLookupError(pid)
    try:
        times = [ctypes.c_uint64() for _ in range(4)]  # made, ended, in the kernel, outside it
        if not kernel.GetProcessTimes(ctypes.c_void_p(handle), *map(ctypes.byref, times)):
            return ""
        code = ctypes.c_uint32()
        if (
            kernel.GetExitCodeProcess(ctypes.c_void_p(handle), ctypes.byref(code)) and code.value != 259
        ):  # STILL_ACTIVE
            raise ProcessLookupError(pid)
        return str(times[0].value)
    finally:
        kernel.CloseHandle(ctypes.c_void_p(handle))


def is_here(owner: Owner) -> bool:
    """Return whether an owner is or was on this computer, where its process can be looked for."""
    return (owner.host, owner.machine) == (platform.node(), _machine())


def is_gone(owner: Owner | None, file: Path, look_only: bool = False) -> bool:
    """Return whether nobody writes to a lock or journal any more. owner: as the file says; None where it says
    nothing. look_only: make no file to ask the drive for its time; this computer's clock counts.

    On this computer that is certain; for another one it means that the file was not touched for long.
    """
    if owner is not None and is_here(owner):
        try:
            started = _started(owner.pid)
        except ProcessLookupError:
            return True
        return bool(started and owner.started) and started != owner.started
    return _untouched(file, look_only) > STALE


def process_mark() -> str:
    """Return what tells this process from all others of all computers, in letters that file names take."""
    return _mark(os.getpid())


@cache
def _mark(pid: int) -> str:
    return f"{_place()}-{pid}-{_plain(_started(pid))}"


def _place() -> str:
    return hashlib.sha256(f"{platform.node()}\n{_machine()}".encode()).hexdigest()[:8]


def _plain(started: str) -> str:
    return "".join(c for c in started if c.isascii() and c.isalnum())


def mark_is_gone(mark: str) -> bool | None:
    """Return whether the process of a mark is gone; None where it is or was on another computer."""
    place, pid, started = mark.split("-")
    if place != _place():
        return None
    try:
        now = _plain(_started(int(pid)))
    except ProcessLookupError:
        return True
    return bool(started and now) and started != now


def _untouched(file: Path, look_only: bool = False) -> float:
    """Return for how many seconds a file was not touched, by the clock of the drive where one may write
    there, unless one only looks.
    """
    try:
        touched = file.stat().st_mtime
    except OSError:
        return 0.0
    now = time.time()
    if look_only:
        return now - touched
    with contextlib.suppress(OSError):
        handle, name = tempfile.mkstemp(prefix=".clock-", dir=file.parent)
        now = os.fstat(handle).st_mtime
        os.close(handle)
        Path(name).unlink()
    return now - touched


@dataclass(frozen=True)
class Holder:
    """Who has a lock. owner: None where its file cannot be read. gone: see `is_gone`; sure: and it is
    certain.
    """

    owner: Owner | None
    gone: bool
    content: bytes

    @property
    def sure(self) -> bool:
        return self.gone and self.owner is not None and is_here(self.owner)


def lock_path(saved: Path) -> Path:
    """Return where the lock of a project file lies: beside it, hidden."""
    return saved.with_name(f".{saved.name}.lock")


def holder(path: Path, look_only: bool = False) -> Holder | None:
    """Return who has the lock file at `path`, None if nobody. look_only: see `is_gone`."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError:
        content = b""
    try:
        owner = msgspec.json.decode(content, type=Owner)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        owner = None
    return Holder(owner, is_gone(owner, path, look_only), content)


class Lock:
    """The lock of one project file for one sitting. held: whether it is ours; it may be that the folder takes
    none. made_again: whether somebody had removed it while it was held.

    like: who may read it where the project file is not there yet.
    """

    def __init__(self, saved: Path, owner: Owner, like: Access | None = None) -> None:
        self.saved = saved.resolve()  # the file that a link means
        self.path, self.owner, self.like = lock_path(self.saved), owner, like
        self.held = self.made_again = False
        self._away = False  # its folder was, when it was looked for
        self._content = msgspec.json.encode(owner) + b"\n"

    def acquire(self, take_over: bool = False) -> Holder | None:
        """Take the lock; return who has it, or None when it is ours or none can be had there.

        What is certainly left behind is taken over; what only seems to be, when `take_over` says so.
        """
        found: Holder | None = None
        for _ in range(5):
            try:
                handle = open_new(self.path, access_of(self.saved) or self.like)
            except FileExistsError:
                found = holder(self.path)
                if found is None:
                    continue  # given back just now
                if found.content == self._content:
                    self.held = True
                    return None
                if not (found.sure or (take_over and found.gone)):
                    return found if not self.path.is_dir() else None
                self._put_aside(found)
            except OSError:
                return None  # a read-only folder: what is opened there cannot be saved there either
            else:
                try:
                    os.write(handle, self._content)
                    self.held = True
                except OSError:  # a full disk
                    with contextlib.suppress(OSError):
                        self.path.unlink()
                finally:
                    with contextlib.suppress(OSError):  # a drive that is away by now
                        os.close(handle)
                return None
        return found

    def _put_aside(self, found: Holder) -> None:
        """Remove a lock that was left behind, but not the one that somebody else has made in its place
        meanwhile.
        """
        aside = self.path.with_name(f"{self.path.name}.{self.owner.sitting}")
        with contextlib.suppress(OSError):
            self.path.replace(aside)
            if aside.read_bytes() != found.content and not self.path.exists():
                aside.replace(self.path)
            else:
                aside.unlink()

    def refresh(self) -> bool:
        """Say that it is still held; return False when somebody has taken it over, and it is not held any
        more.
        """
        if not self.held and not self._away:
            return True
        try:
            content = self.path.read_bytes()
            if content == self._content:
                os.utime(self.path)
        except FileNotFoundError:  # somebody tidied up
            self.held = False
            free = self.acquire() is None
            self.made_again, self._away = self.held, free and not self.held
            return free
        except OSError:
            return True  # the drive is away
        self.held = content == self._content
        return self.held

    def release(self) -> None:
        """Give the lock back, if it is still ours."""
        if self.held:
            self.held = False
            with contextlib.suppress(OSError):
                if self.path.read_bytes() == self._content:
                    self.path.unlink()
