"""What an hour of an open window costs: 2,400 looks at 10,000 clip files for changes, without the 1.5 s
between them.

    .venv/bin/python tests/benchmarks/bench_memory.py [looks] [clips]

Prints resident memory before and after (Linux), and the median time of a look on its thread and on the
window's.
"""

from __future__ import annotations

import gc
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtCore import QEventLoop
from PySide6.QtWidgets import QApplication

from app.project.document import Document
from app.project.jobs import Jobs
from app.project.watching import Watcher
from metagraph.graph.model import ClipEntry, Project


def resident() -> float:
    """Return this process's memory in MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main(looks: int, clips: int) -> None:
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


if __name__ == "__main__":
    main(*(int(word) for word in (sys.argv[1:] or ["2400", "10000"])))
