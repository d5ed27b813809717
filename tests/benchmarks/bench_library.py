"""The library on 1,000 clips: what scrolling, a search, groups and labels cost the window's thread, and how
soon 500 pictures are there the first time and the second.

    xvfb-run -a .venv/bin/python tests/benchmarks/bench_library.py [clips]

Milliseconds of the window's thread's processor, median and worst of many; 60 pictures a second leave 16.7.
Clips are the sample's, each shifted by some frames so that no two pictures are the same. The second opening
finds them on disk, in a folder of this run's own.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

SIZE = (640, 900)  # pixels of the panel
STEP = 45  # pixels of a step of the wheel, three times as many lines


def clips_of(count: int) -> Any:
    """Return the sample with so many clips, no two alike."""
    from metagraph.formats.store import open_project
    from metagraph.motion.clip import Clip

    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    own = list(project.clips.values())
    clips = dict(project.clips)
    for n in range(count - len(own)):
        entry = own[n % len(own)]
        assert entry.motion is not None
        motion, shift = entry.motion, 1 + n // len(own)
        rolled = replace(motion, rotations=np.roll(motion.rotations, shift, 0))
        assert isinstance(rolled, Clip)
        clips[f"x{n}"] = replace(entry, id=f"x{n}", name=f"{entry.name} {shift}", motion=rolled)
    character = str(ROOT / "sample_clips" / str(project.character))
    return replace(project, clips=dict(list(clips.items())[:count]), character=character)


def timed(work: Callable[[], object], rounds: int = 1) -> list[float]:
    """Return milliseconds of this thread's processor of each round."""
    out = []
    for _ in range(rounds):
        began = time.thread_time()
        work()
        out.append((time.thread_time() - began) * 1000)
    return out


def since(began: float) -> float:
    """Return milliseconds by the clock."""
    return (time.perf_counter() - began) * 1000


def processor_seconds(process: int) -> float:
    """Return what a running process has taken of the processor."""
    spent = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[11:13]
    return sum(map(int, spent)) / os.sysconf("SC_CLK_TCK")


def say(what: str, times: list[float]) -> None:
    print(f"{what:46} {statistics.median(times):8.1f} {max(times):8.1f}  ({len(times)})")


def main(count: int = 1000) -> None:
    from PySide6.QtTest import QTest

    from app.features.library.library_panel import LibraryPanel
    from app.main import prepare_application
    from app.project.document import Document
    from app.project.jobs import Jobs
    from app.stage import kept_pictures
    from app.stage.figures import Figures
    from app.stage.session import StageSession
    from app.stage.thumbnails import Thumbnails
    from metagraph.graph.editing.marks import mark, mark_of

    app = prepare_application()
    folder = Path(tempfile.mkdtemp()) / "pictures"
    kept_pictures.find_pictures_folder = lambda: folder
    project = clips_of(count)
    print(f"{count} clips, panel of {SIZE[0]} x {SIZE[1]}; ms: median, worst")
    for opening in ("first", "second"):
        document, jobs = Document(), Jobs()
        session = StageSession(document)
        drawn = Thumbnails(document, session, Figures(document, jobs))
        came: list[str] = []
        drawn.ready.connect(came.append)
        panel = LibraryPanel(document, session, drawn)
        panel.resize(*SIZE)
        panel.show()
        QTest.qWaitForWindowExposed(panel)
        document.project = type(project)()
        say(f"{opening} opening: model and places", timed(partial(document._set, project, "", "done")))
        say(f"{opening} opening: first paint", timed(panel.list.viewport().repaint))
        began = time.perf_counter()
        shown = len(list(panel.list.layout_of.rows_in(panel.list.viewport().rect())))
        while len(set(came)) < shown and time.perf_counter() - began < 60:
            QTest.qWait(10)
        say(f"{opening} opening: the {shown} pictures in sight", [since(began)])
        strips = []
        for entry in list(project.clips.values())[:8]:
            began = time.perf_counter()
            while not drawn.scrub(entry.id) and time.perf_counter() - began < 20:
                QTest.qWait(2)
            strips.append(since(began))
        say(f"{opening} opening: a strip to go through", strips)
        began, bar = time.perf_counter(), panel.list.verticalScrollBar()
        while len(set(came)) < min(500, count) and time.perf_counter() - began < 240:
            at = bar.value()
            while drawn.waiting and bar.value() == at:
                QTest.qWait(10)
            bar.setValue(at + bar.pageStep())
            app.processEvents()
        say(f"{opening} opening: {len(set(came))} pictures, page by page", [since(began)])
        drawing = f"{processor_seconds(drawn._process.pid):.1f} s" if drawn._process is not None else "none"
        print(f"{opening} opening: processor time of the process that draws, with its start: {drawing}")
        if opening == "first":
            drawn.stop()
            panel.close()
            panel.deleteLater()
            document.close_journal()
            jobs.stop()
            app.processEvents()
    view = panel.list

    def scroll() -> None:
        bar = view.verticalScrollBar()
        bar.setValue(bar.value() + STEP if bar.value() < bar.maximum() else 0)
        app.processEvents()

    for style, side in (("cards", 108), ("cards", 224), ("cards", 84), ("cards", 28), ("columns", 28)):
        panel.show_as(style, side)
        view.verticalScrollBar().setValue(0)
        for _ in range(120):  # what was scrolled to once has its pictures
            scroll()
        QTest.qWait(1500)
        view.verticalScrollBar().setValue(0)
        app.processEvents()
        name = style if style == "columns" else "lines" if side <= 54 else "cards"
        say(f"a step of {STEP} pixels: {name} of {side}", timed(scroll, 100))
        say(f"everything in sight anew: {name} of {side}", timed(view.viewport().repaint, 20))
    panel.show_as("cards", 108)
    app.processEvents()
    one = next(iter(project.clips))

    def heart(p: Any) -> Any:
        return mark(p, [one], favourite=not mark_of(p, one).favourite)

    work: dict[str, Callable[[], object]] = {
        "search": lambda: panel.search.setText("beat" if panel.search.text() == "" else ""),
        "sort by name, and back": lambda: (panel.sort("name"), panel.sort("given")),
        "group by stance, and back": lambda: (panel.group_by("stance"), panel.group_by("none")),
        "a label": lambda: document.edit(
            "x", lambda p: mark(p, [one], rating=1 + mark_of(p, one).rating % 5)
        ),
        "select all": lambda: (view.selectAll(), app.processEvents()),
        "a size": lambda: (panel.show_as("cards", 144), panel.show_as("cards", 108), app.processEvents()),
    }
    for what, do in work.items():
        say(what, timed(lambda do=do: (do(), app.processEvents()), 6))  # type: ignore[misc]
    drawn.stop()
    jobs.stop()
    document.close_journal()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
