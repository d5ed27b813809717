"""Errors that nobody foresaw, wherever they happen: each told once, and a report of it without a word of what
the project holds.

`install` takes them from slots, guarded methods, threads, what the interpreter cannot raise, and processes
started from this one; what ends the program with a fault of the system's is written into a file, which the
next start finds (`read_crash_reports`).
"""

from __future__ import annotations

import atexit
import contextlib
import faulthandler
import os
import re
import sys
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

from metagraph import __version__
from metagraph.errors import FileError
from metagraph.formats.locking import mark_is_gone, process_mark

ROOT = Path(__file__).resolve().parents[1]
FOLDER = "METAGRAPH_FAULTS"  # the variable that tells processes we start where their errors go
KEPT = 50  # different faults, and last actions, that are remembered
PACKAGES = ("PySide6_Essentials", "numpy", "moderngl", "pyqtgraph", "msgspec", "trimesh")


@dataclass
class UncaughtError:
    """where: "window", "thread ...", "job ...", "process". what: kind and words of the error, without names
    of anybody's. place: the last lines of ours it went through. count: how often it came.
    """

    where: str
    what: str
    place: str
    when: float
    count: int = 1
    trace: tuple[str, ...] = field(default=(), repr=False)


_known: dict[tuple[str, str], UncaughtError] = {}
_actions: deque[str] = deque(maxlen=KEPT)
_lock = threading.Lock()
# Called with each fault that comes for the first time, and with errors that were foreseen but caught nowhere;
# on the thread it happened on.
listeners: list[Callable[[UncaughtError | Exception], None]] = []


def is_foreseen(error: BaseException) -> bool:
    """Return whether an error says in words what the user can do about it."""
    ours = type(error).__module__.startswith("metagraph.")
    return isinstance(error, FileError) or (ours and isinstance(error, ValueError | RuntimeError))


def note(action: str) -> None:
    """Remember the name of what is being done, of the program's own words."""
    _actions.append(f"{time.strftime('%H:%M:%S')} {action}")


def report_error(error: BaseException, where: str) -> None:
    """Take an error that was caught nowhere; on any thread. Never raises."""
    if isinstance(error, Exception) and is_foreseen(error):
        _hand_out(error)
        return
    lines = tuple(_lines(error))
    fault = UncaughtError(where, _what(error), lines[-1] if lines else "", time.time(), trace=lines)
    with _lock:
        known = _known.get((fault.what, fault.place))
        if known is not None:
            known.count += 1
            return
        if len(_known) >= KEPT:
            return
        _known[fault.what, fault.place] = fault
    _hand_out(fault)


def _hand_out(told: UncaughtError | Exception) -> None:
    for listener in list(listeners):
        with contextlib.suppress(Exception):  # a window that is being closed
            listener(told)


def forget_faults() -> None:
    """Begin again, as if nothing had happened."""
    with _lock:
        _known.clear()
        _actions.clear()


# --- the report


def format_fault_report() -> str:
    """Return what is known, as text: versions, the names of the last actions, what happened and where."""
    return "\n".join([*_versions(), "", format_happenings()])


def format_happenings() -> str:
    """Return the names of the last actions, and what went wrong and where, as text."""
    with _lock:
        faults = list(_known.values())
    lines = ["Last actions", *(f"  {a}" for a in _actions or ("none",)), ""]
    for fault in faults:
        often = f", {fault.count} times" if fault.count > 1 else ""
        when = time.strftime("%H:%M:%S", time.localtime(fault.when))
        lines += [f"{when} {fault.where}{often}: {fault.what}"]
        lines += [f"  {line}" for line in fault.trace]
    return "\n".join([*lines, ""])


def _versions() -> Iterable[str]:
    import platform  # like the next: it takes a while to import, for a start
    from importlib.metadata import PackageNotFoundError, version

    yield f"Metagraph {__version__}"
    system = f"{platform.system()} {platform.release()}, {platform.machine()}"
    yield f"Python {platform.python_version()} on {system}"
    for name in PACKAGES:
        with contextlib.suppress(PackageNotFoundError):
            yield f"{name.replace('_', '-')} {version(name)}"


_QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"|`[^`]*`|«[^»]*»")
_PLACE = re.compile(r"(?:[A-Za-z]:)?[\\/][^\s,;:)]+")


def strip_quotes(text: str) -> str:
    """Return words of an error without what it quotes, which may be of the project, and without paths."""
    text = _PLACE.sub("…", _QUOTED.sub("'…'", text))
    return text if len(text) <= 200 else f"{text[:200]} …"


def _what(error: BaseException) -> str:
    kind = type(error)
    if kind.__module__ == "builtins":  # the interpreter's own words quote names
        words = strip_quotes(str(error))
        return f"{kind.__name__}: {words}" if words else kind.__name__
    return f"{kind.__module__}.{kind.__qualname__}"


def _lines(error: BaseException) -> Iterable[str]:
    """Give where an error went through, the last last; what caused it before it."""
    cause = error.__cause__ or (error.__context__ if not error.__suppress_context__ else None)
    if cause is not None and cause is not error:
        yield from _lines(cause)
        yield f"and then {_what(error)}"
    for frame in traceback.extract_tb(error.__traceback__)[-30:]:
        yield f"{_inside(frame.filename)}:{frame.lineno} {frame.name}"


def _inside(path: str) -> str:
    """Return a file's path without where on this computer it lies."""
    with contextlib.suppress(ValueError):
        return Path(path).relative_to(ROOT).as_posix()
    parts = Path(path).parts
    known = [n for n, part in enumerate(parts) if part in ("site-packages", "lib")]
    return "/".join(parts[known[-1] + 1 :]) if known else Path(path).name


# --- where they come from


def install(folder: Path) -> None:
    """Take every error that is caught nowhere in this process from now on, and those of the processes it
    starts. folder: where what ends the program is written.
    """
    sys.excepthook = _raised
    threading.excepthook = _raised_on_thread
    sys.unraisablehook = _unraisable
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        os.environ[FOLDER] = str(folder)
        _watch(folder)


def install_in_child() -> None:
    """In a process that such a one has started: errors are written down for it. Costs nothing elsewhere."""
    place = os.environ.get(FOLDER)
    if not place or sys.excepthook is not sys.__excepthook__:
        return

    def write(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        sys.__excepthook__(kind, error, trace)
        if isinstance(error, Exception) and not is_foreseen(error):
            lines = [f"process {Path(sys.argv[0]).name}: {_what(error)}", *(f"  {x}" for x in _lines(error))]
            with contextlib.suppress(OSError):
                path = Path(place) / f"child-{process_mark()}.txt"
                path.write_text("\n".join([*lines, ""]), encoding="utf-8")

    sys.excepthook = write


def _watch(folder: Path) -> None:
    path = folder / f"crash-{process_mark()}.txt"
    file = path.open("wb", buffering=0)
    faulthandler.enable(file, all_threads=True)

    def end() -> None:
        faulthandler.disable()
        file.close()
        with contextlib.suppress(OSError):
            if not path.stat().st_size:
                path.unlink()

    atexit.register(end)


def _raised(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    sys.__excepthook__(kind, error, trace)
    if isinstance(error, Exception):
        report_error(error, "window")


def _raised_on_thread(raised: threading.ExceptHookArgs) -> None:
    if isinstance(raised.exc_value, Exception):
        threading.__excepthook__(raised)
        report_error(
            raised.exc_value, f"thread {raised.thread.name if raised.thread is not None else ''}".strip()
        )


def _unraisable(raised: sys.UnraisableHookArgs) -> None:
    sys.__unraisablehook__(raised)
    if isinstance(raised.exc_value, Exception):
        report_error(raised.exc_value, "the interpreter")


def read_child_faults(folder: Path) -> None:
    """Report what processes of ours have written down."""
    for path in sorted(folder.glob("child-*.txt")):
        with contextlib.suppress(OSError, UnicodeDecodeError):
            what, *trace = path.read_text(encoding="utf-8").splitlines()
            path.unlink()
            fault = UncaughtError(
                "process", what, trace[-1].strip() if trace else "", time.time(), 1, tuple(trace)
            )
            with _lock:
                new = (fault.what, fault.place) not in _known
                _known.setdefault((fault.what, fault.place), fault).count += not new
            if new:
                _hand_out(fault)


def read_crash_reports(folder: Path) -> str:
    """Return what ended earlier runs, as the system told it, "" if none did; it is reported once."""
    found: list[str] = []
    for path in sorted(folder.glob("crash-*.txt")):
        with contextlib.suppress(OSError, ValueError):
            if mark_is_gone(path.stem.removeprefix("crash-")) is False:
                continue
            text = path.read_text(encoding="utf-8", errors="replace")
            path.unlink()
            if text.strip():
                found.append(re.sub(r'File "([^"]*)"', lambda m: f"File {_inside(m[1])}", text))
    return "\n".join(found)
