"""Starts every program that Metagraph starts, so that no file of a stranger is ever run.

A program is one of the system's own, from a folder that only the administrator writes to
(`find_system_program`), or this Python with a module that this process could import, too (`python`), or a
file whose digest is known (`metagraph.engines.targets.web_tools`). None is looked for along PATH, in the
working folder or beside a project. Each begins in an empty folder of the user's, with a list of variables
that it may need and no others.
"""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import subprocess

ROOT = Path(__file__).resolve().parents[2]  # what this package was imported from

# What a program may learn of the user's environment: where home, screen, sound and scratch space are, which
# language is spoken, how things are drawn and computed. Not PYTHON*, NODE_*, LD_PRELOAD, BASH_ENV, GIT_* and
# the like, which name code to run.
_KEPT = {
    "HOME", "USER", "LOGNAME", "LANG", "LANGUAGE", "TZ", "TERM", "TMPDIR", "TEMP", "TMP", "CI",
    "DISPLAY", "WAYLAND_DISPLAY", "XAUTHORITY", "DBUS_SESSION_BUS_ADDRESS", "PULSE_SERVER",
    "CUDA_VISIBLE_DEVICES", "SSL_CERT_FILE", "SSL_CERT_DIR", "REQUESTS_CA_BUNDLE", "NODE_EXTRA_CA_CERTS",
    "HTTP_PROXY", "HTTPS_PROXY", "NO_PROXY", "ALL_PROXY", "NPM_CONFIG_REGISTRY", "NPM_CONFIG_CAFILE",
    "SYSTEMROOT", "SYSTEMDRIVE", "WINDIR", "COMSPEC", "PATHEXT", "USERPROFILE", "USERNAME", "HOMEDRIVE",
    "HOMEPATH", "APPDATA", "LOCALAPPDATA", "PROGRAMDATA", "PROGRAMFILES", "NUMBER_OF_PROCESSORS",
    "PROCESSOR_ARCHITECTURE", "DEBIAN_FRONTEND",
}  # fmt: skip
_KEPT_BEGINNINGS = (
    "LC_", "XDG_", "QT_", "LIBGL_", "MESA_", "GALLIUM_", "LP_", "EGL_", "__GL", "__EGL", "METAGRAPH_",
    "NUMBA_", "OMP_", "OPENBLAS_", "MKL_", "MALLOC_", "PIP_",
)  # fmt: skip
_FOLDERS = (
    "LD_LIBRARY_PATH",
    "DYLD_LIBRARY_PATH",
    "QT_PLUGIN_PATH",
    "QT_QPA_PLATFORM_PLUGIN_PATH",
)  # of code

# A child knows the modules that its parent knows, from where the parent has them, and nothing else.
_BEGIN = (
    "import sys, runpy; sys.path[:] = sys.argv.pop(1).split(chr(10)); "
    "runpy.run_module(sys.argv.pop(1), run_name='__main__', alter_sys=True)"
)


def start(command: Sequence[str], **options: Any) -> subprocess.Popen[Any]:
    """Start a program; options as for `subprocess.Popen`. command: its first word is the whole path of a
    program. env: variables besides those of `environment`. cwd: another folder than the empty one, of
    Metagraph's own. Raises OSError if it cannot be started, ValueError for a program without its folder.
    """
    import subprocess

    if not Path(command[0]).is_absolute():
        raise ValueError(f"the program '{command[0]}' has no folder: anybody's could be meant")
    options["env"] = make_program_environment(options.get("env") or {})
    options["cwd"] = options.get("cwd") or find_working_folder()
    return subprocess.Popen(command, **options)


def run_program(command: Sequence[str], timeout: float | None = None, **options: Any) -> tuple[int, str]:
    """Run a program to its end, as `start` does; return its exit status and all it said. Raises OSError, and
    TimeoutError where it took longer than `timeout` seconds.
    """
    import subprocess

    with start(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options
    ) as process:
        try:
            said, _ = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            process.kill()
            raise TimeoutError(f"{Path(command[0]).name} took more than {timeout:g} s") from None
        except BaseException:
            process.kill()
            raise
    return process.returncode, said.decode("utf-8", "replace")


def make_python_command(module: str, *words: str) -> list[str]:
    """Return the command that runs a module of ours with this Python, whatever lies in the working folder or
    is said in PYTHON* variables.
    """
    options = ["-I", "-X", "utf8", *(["-B"] if sys.dont_write_bytecode else [])]
    if sys.pycache_prefix:
        options += ["-X", f"pycache_prefix={sys.pycache_prefix}"]
    return [sys.executable, *options, "-c", _BEGIN, "\n".join(_search_path()), module, *words]


def _search_path() -> list[str]:
    """Return where this process finds modules, without its working folder and folders relative to it."""
    try:
        here = Path.cwd().resolve()
    except OSError:  # it is gone
        here = ROOT
    out = [str(ROOT)]
    for entry in sys.path:
        if "\n" in entry or not Path(entry).is_absolute() or entry in out:
            continue
        if Path(entry).resolve() != here or here == ROOT:
            out.append(entry)
    return out


def make_program_environment(more: dict[str, str] | None = None) -> dict[str, str]:
    """Return the variables that a program is given. more: others, which are ours."""
    out = {}
    for name, value in os.environ.items():
        known = name.upper()
        if known in _KEPT or known.startswith(_KEPT_BEGINNINGS):
            out[name] = value
        if known in _FOLDERS:
            out[name] = os.pathsep.join(_absolute(value))
    out["PATH"] = os.pathsep.join(str(place) for place in _system_places())
    return {name: value for name, value in out.items() if value or name not in _FOLDERS} | (more or {})


def _absolute(folders: str) -> list[str]:
    """Return the whole paths of a list of folders: an empty one means the working folder."""
    return [place for place in folders.split(os.pathsep) if Path(place).is_absolute()]


def leave_working_folder() -> None:
    """Take the working folder out of PATH, in which Qt and libraries look for programs (`xdg-open`, `gcc`).
    For programs that begin; a library must leave its host's environment alone.
    """
    os.environ["PATH"] = os.pathsep.join(_absolute(os.environ.get("PATH", "")))


def _system_places() -> Iterator[Path]:
    """Yield the folders that a system keeps its programs in."""
    if sys.platform == "win32":
        windows = Path(os.environ.get("SYSTEMROOT", r"C:\Windows"))
        yield from (
            windows / "System32",
            windows,
            Path(os.environ.get("PROGRAMFILES", r"C:\Program Files")) / "nodejs",
        )
    else:
        yield from map(
            Path, ("/usr/local/bin", "/opt/homebrew/bin", "/usr/bin", "/bin", "/usr/sbin", "/sbin")
        )


def find_system_program(name: str) -> str | None:
    """Return the path of one of the system's programs; None if it has none, or one that others can change."""
    for place in _system_places():
        for ending in (".exe", ".cmd") if sys.platform == "win32" else ("",):
            path = place / (name + ending)
            if path.is_file() and os.access(path, os.X_OK) and is_own(path):
                return str(path)
    return None


def find_working_folder() -> Path:
    """Return the folder that programs begin in: an empty one of the user's, or else the package's own."""
    from metagraph.common.disk_cache import cache_folder

    place = cache_folder("empty")
    return place if place is not None and make_own(place) else ROOT


def make_own(folder: Path) -> bool:
    """Make one of Metagraph's folders below that for caches, which nobody else can write to; return whether
    that could be done.
    """
    try:
        for place in (folder.parent, folder):
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
            found = place.stat()
            if os.name != "nt" and found.st_uid == os.geteuid() and found.st_mode & 0o022:
                place.chmod(stat.S_IMODE(found.st_mode) & ~0o022)
    except OSError:
        return False
    return is_own(folder)


def is_own(path: Path) -> bool:
    """Return whether nobody but the user and the administrator can change what lies at a path: who owns it
    and each folder above it, and who may write there. On Windows the user's profile is guarded by the system.
    """
    if os.name == "nt":
        return True
    try:
        path = path.resolve(strict=True)
        return all(_is_guarded(place.stat()) for place in (path, *path.parents))
    except OSError:
        return False


def _is_guarded(found: os.stat_result) -> bool:
    me = os.geteuid()
    if found.st_uid not in (0, me):
        return False
    shared = found.st_mode & 0o022
    if shared == 0o020 and found.st_gid in (0, os.getegid()) and os.getegid() in (0, me):
        shared = 0  # a group with this user alone in it, as most systems have
    # In a folder as /tmp is, others can add files but not replace what is there.
    return not shared or (stat.S_ISDIR(found.st_mode) and bool(found.st_mode & stat.S_ISVTX))


def read_own(path: Path, most: int) -> bytes | None:
    """Return a file's content if nobody but the user could have written it and it has at most `most` bytes;
    for what is going to be run.
    """
    try:
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(handle, "rb") as file:
            found = os.fstat(handle)
            if not stat.S_ISREG(found.st_mode) or found.st_size > most or found.st_mode & 0o022:
                return None
            return (
                file.read()
                if is_own(path) and (os.name == "nt" or found.st_uid in (0, os.geteuid()))
                else None
            )
    except OSError:
        return None
