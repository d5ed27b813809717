"""What stays in memory (Linux): of an hour of watching files, and of windows that were closed.

    .venv/bin/python tests/benchmarks/bench_memory.py watching [looks] [clips]
    .venv/bin/python tests/benchmarks/bench_memory.py windows [count]

watching: 2,400 looks at 10,000 clip files for changes, without the 1.5 s between them; resident memory before
and after, and the median time of a look on its thread and on the window's. windows: one after the other in
this process, each on the sample project, played, edited 50 times, all undone, every dialog opened and closed;
after each, resident memory, what the allocator has given out, and what more of ours is alive than after the
one before. Without a screen it runs in Xvfb. Nothing of the user's is touched.
"""

from __future__ import annotations

import ctypes
import gc
import os
import shutil
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
EDITS = 50
MALLINFO = (
    "arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost",
)  # fmt: skip


def resident() -> float:
    """Return this process's memory in MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def watching(looks: int = 2400, clips: int = 10_000) -> None:
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from PySide6.QtCore import QEventLoop
    from PySide6.QtWidgets import QApplication

    from app.project.document import Document
    from app.project.jobs import Jobs
    from app.project.watching import Watcher
    from metagraph.graph.model import ClipEntry, Project

    app = QApplication([])
    with tempfile.TemporaryDirectory() as folder:
        names = [f"clip {n}.glb" for n in range(clips)]
        for name in names:
            (Path(folder) / name).touch()
        document, jobs = Document(), Jobs()
        entries = {
            f"c{n}": ClipEntry(f"c{n}", name, f"{folder}/{name}", motion=object())
            for n, name in enumerate(names)
        }  # type: ignore[arg-type]
        document.project = Project("many", clips=entries)
        watcher = Watcher(document, jobs)
        here: list[float] = []

        def look() -> None:
            loop = QEventLoop()
            begun = time.perf_counter()
            watcher.look()
            here.append(time.perf_counter() - begun)
            while watcher._busy:
                loop.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents, 1000)
            app.sendPostedEvents(None, 52)  # deferred deletion, which the window's own loop does

        for _ in range(20):
            look()
        gc.collect()
        before, begun = resident(), time.perf_counter()
        for _ in range(looks):
            look()
        each = (time.perf_counter() - begun) / looks
        gc.collect()
        after = resident()
        print(
            f"{looks} looks at {clips} clips: {before:.1f} MB before, {after:.1f} MB after "
            f"({after - before:+.1f} MB)"
        )
        print(
            f"a look: {each * 1000:.0f} ms in all, {statistics.median(here[20:]) * 1000:.2f} ms of them on "
            "the window's thread"
        )
        jobs.stop()


# --- windows


def wait(until: Callable[[], bool], seconds: float = 30) -> None:
    from PySide6.QtWidgets import QApplication

    end = time.monotonic() + seconds
    while not until() and time.monotonic() < end:
        QApplication.processEvents()
        QApplication.sendPostedEvents(None, 52)
        time.sleep(0.002)


def linger(seconds: float) -> None:
    end = time.monotonic() + seconds
    wait(lambda: time.monotonic() > end)


def sitting(folder: Path, dialogs: bool) -> None:
    """Open a window, work in it, close it."""
    from app.main import make_window
    from app.project.files import SAMPLE
    from metagraph.graph import edits
    from tests.app.every_dialog import DIALOGS, opened
    from tests.app.handles import Handles

    w = Handles(make_window())
    w.window.show()
    w.make_late_panels()
    w.files.open(SAMPLE, template=True)
    wait(lambda: bool(w.document.project.clips) and w.performance.skeleton() is not None)
    wait(lambda: w.compatibility.judged is not None)
    for n in range(EDITS):
        w.document.edit("Change seed", lambda p, n=n: edits.set_settings(p, seed=n + 100))
        linger(0.02)
    for _ in range(EDITS):
        w.document.undo()
    linger(1.0)  # it plays
    for name, open_it in DIALOGS.items() if dialogs else ():
        open_it(w, folder)
        wait(lambda: bool(opened()), 10)
        if not opened():
            print(f"no dialog: {name}")
        linger(0.2)
        for dialog in reversed(opened()):
            dialog.reject()
        linger(0.1)
    w.document.undo_stack.setClean()
    w.window.close()
    w.window.deleteLater()


def alive() -> Counter[str]:
    """Return how many objects of ours are alive, by class; widgets of Qt's own count as such."""
    from PySide6.QtWidgets import QWidget

    ours = ("app.", "metagraph.", "preview.")
    return Counter(
        type(one).__qualname__ if str(type(one).__module__).startswith(ours) else "QWidget"
        for one in gc.get_objects()
        if str(type(one).__module__).startswith(ours) or isinstance(one, QWidget)
    )


def in_use() -> float:
    """Return how much memory C's allocator has given out, MB: without what is free between the pieces, which
    resident memory has in it. nan where it does not tell.
    """

    class Told(ctypes.Structure):
        _fields_ = [(name, ctypes.c_size_t) for name in MALLINFO]

    library = ctypes.CDLL(None)
    if not hasattr(library, "mallinfo2"):
        return float("nan")
    library.malloc_trim(0)
    library.mallinfo2.restype = Told
    told = library.mallinfo2()
    return (told.uordblks + told.hblkhd) / 1e6


def windows(count: int = 5, dialogs: int = 1) -> None:
    from PySide6.QtCore import QSettings

    from app.main import prepare_application

    prepare_application()
    with tempfile.TemporaryDirectory() as folder:
        os.environ.update(XDG_DATA_HOME=folder, XDG_CONFIG_HOME=folder)
        QSettings.setDefaultFormat(QSettings.Format.IniFormat)
        QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)
        print("window  resident      step  allocated      step  what more is alive than before")
        before, last, held = alive(), float("nan"), float("nan")
        for n in range(count):
            sitting(Path(folder), bool(dialogs))
            linger(0.5)
            gc.collect()
            linger(0.1)
            gc.collect()
            used, now = in_use(), alive()
            size = resident()
            more = sorted((now - before).items(), key=lambda x: -x[1])
            words = ", ".join(f"{name} {k:+}" for name, k in more[:12]) if n else ""
            print(
                f"{n + 1:6} {size:6.1f} MB {size - last:+6.1f} MB  {used:6.1f} MB {used - held:+6.1f} MB  "
                f"{words}",
                flush=True,
            )
            before, last, held = now, size, used


def main(chosen: str = "", *numbers: str) -> None:
    if chosen == "windows":
        if sys.platform.startswith("linux") and not os.environ.get("DISPLAY") and shutil.which("xvfb-run"):
            screen = ["xvfb-run", "-a", "-s", "-screen 0 1920x1200x24"]
            os.execvp(screen[0], [*screen, sys.executable, __file__, chosen, *numbers])
        windows(*map(int, numbers))
    elif chosen == "watching":
        watching(*map(int, numbers))
    else:
        print(__doc__)


if __name__ == "__main__":
    main(*sys.argv[1:])
