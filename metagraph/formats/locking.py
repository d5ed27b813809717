"""Find out who has a project open, by a lock file beside it, for windows on one computer and on several that
share a drive.

The file is made by O_EXCL, which network drives respect too; the system's own locks are not used. It says who
made it, and is touched every `REFRESH` seconds while its window is open. That a process is gone shows at once
on its own computer; elsewhere it shows when the file was not touched for `STALE` seconds by the drive's own
clock.
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

from metagraph.common.programs import find_system_program, run_program
from metagraph.formats.new_file import Access, access_of, open_new

REFRESH = 30.0  # seconds
STALE = 150.0  # seconds; a computer may be busy, and a drive unreachable for a while


class Owner(msgspec.Struct, frozen=True):
    """One sitting: a document in a process.

    `machine` is what else distinguishes computers and containers with the same name, "" if unknown. `started`
    is when the process began, in the system's own notation, because process ids are reused. `since` is in
    seconds since 1970.
    """

    host: str
    machine: str
    user: str
    pid: int
    started: str
    sitting: str
    since: float


def make_owner() -> Owner:
    """Return a new sitting of this process."""
    pid = os.getpid()
    return Owner(platform.node(), _machine(), _user(), pid, _started(pid), uuid.uuid4().hex[:12], time.time())


def _user() -> str:
    try:
        import getpass

        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # a user id without a name, as in containers
        return "somebody"


@cache
def _machine() -> str:
    """Return where process ids are valid: a boot of Linux and its namespace; "" elsewhere, where only the
    host's name is used.
    """
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
        return f"{boot} {Path('/proc/self/ns/pid').readlink()}"
    except OSError:
        return ""


def _started(pid: int) -> str:
    """Return when a process began, "" if that is unknown. Raises ProcessLookupError if there is no such
    process.
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
    ps = find_system_program("ps")
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
        times = [ctypes.c_uint64() for _ in range(4)]  # created, ended, in the kernel, outside it
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
    """Return whether an owner is or was on this computer, where its process can be looked up."""
    return (owner.host, owner.machine) == (platform.node(), _machine())


def is_gone(owner: Owner | None, file: Path, look_only: bool = False) -> bool:
    """Return whether no process writes to a lock or journal any more.

    `owner` is the one in the file; None if it says none. With `look_only`, no file is made to read the
    drive's clock, and this computer's clock is used. On this computer the answer is certain; for another one
    it means that the file was not touched for `STALE` seconds.
    """
    if owner is not None and is_here(owner):
        try:
            started = _started(owner.pid)
        except ProcessLookupError:
            return True
        return bool(started and owner.started) and started != owner.started
    return _untouched(file, look_only) > STALE


def process_mark() -> str:
    """Return what distinguishes this process from all others on all computers, in letters that are valid in
    file names.
    """
    return _mark(os.getpid())


@cache
def _mark(pid: int) -> str:
    return f"{_place()}-{pid}-{_plain(_started(pid))}"


def _place() -> str:
    return hashlib.sha256(f"{platform.node()}\n{_machine()}".encode()).hexdigest()[:8]


def _plain(started: str) -> str:
    return "".join(c for c in started if c.isascii() and c.isalnum())


def mark_is_gone(mark: str) -> bool | None:
    """Return whether the process of a mark is gone; None if it is or was on another computer."""
    place, pid, started = mark.split("-")
    if place != _place():
        return None
    try:
        now = _plain(_started(int(pid)))
    except ProcessLookupError:
        return True
    return bool(started and now) and started != now


def _untouched(file: Path, look_only: bool = False) -> float:
    """Return for how many seconds a file was not touched, by the drive's clock if a file can be made there
    and `look_only` is False, else by this computer's.
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
    """The owner of a lock.

    `owner` is None if the file cannot be read. `gone` is as in `is_gone`; `sure` is True if that is certain.
    """

    owner: Owner | None
    gone: bool
    content: bytes

    @property
    def sure(self) -> bool:
        return self.gone and self.owner is not None and is_here(self.owner)


def lock_path(saved: Path) -> Path:
    """Return the path of a project file's lock: beside it, hidden."""
    return saved.with_name(f".{saved.name}.lock")


def find_holder(path: Path, look_only: bool = False) -> Holder | None:
    """Return who has the lock file at `path`, None if nobody. `look_only` is as in `is_gone`."""
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
    """The lock of one project file for one sitting.

    `held` says whether it is ours; there may be none if the folder cannot hold one. `made_again` says whether
    somebody had removed it while it was held. `like` says who may read it if the project file does not exist
    yet.
    """

    def __init__(self, saved: Path, owner: Owner, like: Access | None = None) -> None:
        self.saved = saved.resolve()  # the file that a link points to
        self.path, self.owner, self.like = lock_path(self.saved), owner, like
        self.held = self.made_again = False
        self._away = False  # whether its folder was gone at the last look
        self._content = msgspec.json.encode(owner) + b"\n"

    def acquire(self, take_over: bool = False) -> Holder | None:
        """Take the lock; return who has it, or None if it is ours or none can be made there.

        A lock that was certainly left behind is taken; one that only seems to be is taken if `take_over` is
        True.
        """
        found: Holder | None = None
        for _ in range(5):
            try:
                handle = open_new(self.path, access_of(self.saved) or self.like)
            except FileExistsError:
                found = find_holder(self.path)
                if found is None:
                    continue  # released just now
                if found.content == self._content:
                    self.held = True
                    return None
                if not (found.sure or (take_over and found.gone)):
                    return found if not self.path.is_dir() else None
                self._put_aside(found)
            except OSError:
                return None  # a read-only folder: its files cannot be saved there either
            else:
                try:
                    os.write(handle, self._content)
                    self.held = True
                except OSError:  # a full disk
                    with contextlib.suppress(OSError):
                        self.path.unlink()
                finally:
                    with contextlib.suppress(OSError):  # a drive that is gone by now
                        os.close(handle)
                return None
        return found

    def _put_aside(self, found: Holder) -> None:
        """Remove a lock that was left behind, but not one that somebody else made in its place in the
        meantime.
        """
        aside = self.path.with_name(f"{self.path.name}.{self.owner.sitting}")
        with contextlib.suppress(OSError):
            self.path.replace(aside)
            if aside.read_bytes() != found.content and not self.path.exists():
                aside.replace(self.path)
            else:
                aside.unlink()

    def refresh(self) -> bool:
        """Show that the lock is still held; return False if somebody took it, so that it is no
        longer held.
        """
        if not self.held and not self._away:
            return True
        try:
            content = self.path.read_bytes()
            if content == self._content:
                os.utime(self.path)
        except FileNotFoundError:  # somebody removed it
            self.held = False
            free = self.acquire() is None
            self.made_again, self._away = self.held, free and not self.held
            return free
        except OSError:
            return True  # the drive is gone
        self.held = content == self._content
        return self.held

    def release(self) -> None:
        """Remove the lock, if it is still ours."""
        if self.held:
            self.held = False
            with contextlib.suppress(OSError):
                if self.path.read_bytes() == self._content:
                    self.path.unlink()
