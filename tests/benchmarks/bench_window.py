"""How the window feels, in figures: python tests/benchmarks/bench_window.py [cold] [stalls] [edits]
[proposing] [resting] [COUNT]

cold: seconds from starting the process to the first painted window, and to the first painted character of the
sample project, and the processor's seconds of all threads until then. stalls: the longest time the window's
thread did not come round while the sample project is opened, edited, given 300 lines and looked at, and
pictures a second in the preview. edits: milliseconds from an edit to the last view that followed it, and to
the painted window, in the sample project and in one of 10,000 actions; "own" is the processor time of the
window's thread alone, which stays the same when the machine is busy. resting: how much of one core the window
takes while it is paused and while it plays, and what it and the process that draws its pictures hold in
memory, half a minute after the sample was opened. proposing: how late a timer of 5 ms on the window's thread
comes while a job proposes labels for 1,000 clips, while all of them are compared with the stances, and while
the table of that is scrolled; the preview stands still, as drawing it without a graphics card would be all
that is seen. COUNT: this many actions and clips instead, and fewer rounds where they are less than a hundred.

Without a screen everything runs in Xvfb. Nothing of the user's is touched.
"""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
BEAT = 5  # milliseconds
COLD = """
import sys, time
started = float(sys.argv[1])
import gc
gc.disable()  # as `run_window` does
from app.main import open_window, prepare_application
app = prepare_application()
window = open_window(None, sample=True)
gc.enable()
window.resize(1680, 1020)
seen = []
def painted():
    now = time.time() - started, time.process_time()
    if not seen:
        seen.extend(now)
    if window.shell.stage.performance.skeleton() is not None:
        print(*seen, *now, len(sys.modules), flush=True)
        window.shell.stage.painted.disconnect(painted)
        QTimer.singleShot(0, window.close)
        QTimer.singleShot(0, app.quit)
from PySide6.QtCore import QTimer
window.shell.stage.painted.connect(painted)
app.exec()
"""


def cold(rounds: int = 5) -> None:
    found = []
    for _ in range(rounds + 1):
        out = subprocess.run(
            [sys.executable, "-c", COLD, str(time.time())],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
            timeout=60,
        )
        found.append([float(x) for x in out.stdout.split()[-5:]])
    # The first one compiled the modules.
    window, window_own, character, character_own, modules = zip(*found[1:], strict=True)
    for what, wall, own in (("window", window, window_own), ("character", character, character_own)):
        print(
            f"cold start to the first painted {what:10} median {statistics.median(wall):.2f} s, quickest "
            f"{min(wall):.2f} s; processor {statistics.median(own):.2f} s, quickest {min(own):.2f} s"
        )
    print(f"modules then {modules[0]:.0f}\n")


def wait(until: Callable[[], bool], seconds: float = 30) -> None:
    from PySide6.QtWidgets import QApplication

    end = time.monotonic() + seconds
    while not until():
        QApplication.processEvents()
        if time.monotonic() > end:
            raise TimeoutError(str(until))


def linger(seconds: float) -> None:
    end = time.monotonic() + seconds
    wait(lambda: time.monotonic() > end, seconds + 5)


def opened(window: object) -> None:
    """Open the sample project and wait until everything has settled."""
    from app.project.files import SAMPLE

    window.files.open(SAMPLE, template=True)
    wait(
        lambda: (
            bool(window.document.project.clips)
            and window.performance.skeleton() is not None
            and not window.jobs.running
        )
    )


def many_lines(project: object) -> object:
    """The project with 300 lines more, each of which asks for a gesture."""
    from dataclasses import replace

    from metagraph.graph.requests import Gesture, Line

    asks = (Gesture(tags=("unsure",), stroke=0.6),)
    more = {f"bench{n}": Line(text=f"Line {n} of a long scene.", duration=1.5, asks=asks) for n in range(300)}
    return replace(project, lines={**project.lines, **more})


def stalls() -> None:
    from PySide6.QtCore import Qt, QTimer

    from app.main import prepare_application

    prepare_application()
    from app.main import make_window
    from metagraph.graph import edits
    from tests.app.handles import Handles

    window = Handles(make_window())
    window.window.resize(1680, 1020)
    window.window.show()
    gaps: dict[str, list[float]] = {}
    state = {"phase": "start", "last": time.perf_counter()}

    def beat() -> None:
        now = time.perf_counter()
        gaps.setdefault(str(state["phase"]), []).append((now - float(state["last"])) * 1e3)
        state["last"] = now

    timer = QTimer(timerType=Qt.TimerType.PreciseTimer)
    timer.timeout.connect(beat)
    timer.start(2)
    rate = 0.0

    def phase(name: str, seconds: float, what: Callable[[], object] = lambda: None) -> None:
        state["phase"] = name
        what()
        linger(seconds)

    def select() -> None:
        window.session.jump(
            action=next(a.id for a in window.document.project.actions() if a.kind == "gesture")
        )

    def timing() -> None:
        window.document.edit(
            "Change timing",
            lambda p: edits.update_actions(p, window.session.selection.actions, timing={"blend_in": 0.33}),
        )

    phase("first paint", 1.0)
    phase("late panels", 2.0, window.window.load_late_panels)
    phase("open the sample", 4.0, lambda: opened(window))
    before, start = window.preview.frames, time.perf_counter()
    phase("playing", 4.0)
    rate = (window.preview.frames - before) / (time.perf_counter() - start)
    phase("select an action", 1.5, select)
    phase("edit its timing", 1.0, timing)
    phase("undo", 1.0, window.document.undo)
    phase("another layer", 1.0, lambda: window.session.place.set_layer("head"))
    phase("another stance", 1.0, lambda: window.do("stance_2"))
    phase("the machine", 1.5, lambda: window.show("machine"))
    phase("light theme", 2.0, lambda: window.do("theme"))
    phase(
        "import 152 clips", 4.0, lambda: window.importing.import_paths([str(ROOT / "sample_clips" / "clips")])
    )
    phase("add 300 lines", 3.0, lambda: window.document.edit("Add lines", many_lines))
    place = Path(tempfile.mkdtemp()) / "saved.metagraph.yaml"
    phase("save", 1.0, lambda: window.files.saver.save(place))  # as the command does, on a thread
    timer.stop()
    print(f"{'phase':18} {'longest gap':>12} {'over 50 ms':>11}")
    for name, found in gaps.items():
        print(f"{name:18} {max(found):9.1f} ms {sum(g > 50 for g in found):11}")
    print(
        f"preview in the window ({window.preview.view.width()} x {window.preview.view.height()}): {rate:.1f} "
        "pictures a second\n"
    )
    _close(window)


def large(project: object, count: int) -> object:
    """The project with the clips of its actions placed again and again, until there are `count` actions."""
    from metagraph.graph import edits

    graphs = {layer: list(graph.actions.values()) for layer, graph in project.graphs.items()}
    while sum(len(g.actions) for g in project.graphs.values()) < count:
        for layer, actions in graphs.items():
            for stance in project.graphs[layer].stances:
                for kind in ("gesture", "fidget"):
                    clips = [a.clip for a in actions if a.stance == stance and a.kind == kind]
                    if clips:
                        project = edits.place_clips(project, clips, layer, kind, stance)
    return project


def changes(
    action: str, stance: str, layer: str, clips: list[str]
) -> list[tuple[str, Callable[[object], object] | None]]:
    """Return edits by name, each different every time it is made; None stands for undo."""
    from metagraph.graph import edits

    numbers = iter(range(1, 1000))
    return [
        (
            "timing",
            lambda p: edits.update_actions(p, (action,), timing={"blend_in": 0.1 + next(numbers) / 1000}),
        ),
        ("likelihood", lambda p: edits.update_actions(p, (action,), likelihood=1 + next(numbers) / 1000)),
        ("drop 20 clips", lambda p: edits.place_clips(p, clips, layer, "fidget", stance)),
        ("rename a stance", lambda p: edits.rename_stance(p, stance, f"stance {next(numbers)}")),
        ("base pose", lambda p: edits.set_base(p, clips[0], next(numbers))),
        ("undo", None),
    ]


def edit_latency(most: int = 10_000) -> None:
    from PySide6.QtWidgets import QApplication

    from app.main import prepare_application

    prepare_application()
    from app.main import make_window
    from tests.app.handles import Handles

    window = Handles(make_window())
    window.window.resize(1680, 1020)
    window.window.show()
    window.make_late_panels()
    opened(window)
    small = window.document.project
    window.session.transport.set_playing(False)
    many = large(small, most)
    for project in (small,) if many is small else (small, many):
        if project is not small:
            window.document.load(project, None)
            linger(3)
        count = sum(1 for _ in project.actions())
        action = next(a.id for a in project.actions() if a.kind == "gesture")
        clips = list(project.clips)[:20]
        stance = project.action(action).stance
        layer = project.action(action).layer
        window.session.jump(action=action)
        for name, what in changes(action, stance, layer, clips):
            followed, painted, own = [], [], []
            for _ in range(8 if most >= 100 else 1):
                linger(0.4)
                wait(lambda: not window.jobs.at_work)  # the last edit's plan and check are done
                start, busy = time.perf_counter(), time.thread_time()
                if what is None:
                    window.document.undo()
                else:
                    window.document.edit(name, what)
                followed.append((time.perf_counter() - start) * 1e3)
                QApplication.processEvents()
                painted.append((time.perf_counter() - start) * 1e3)
                own.append((time.thread_time() - busy) * 1e3)
            print(
                f"{count:6} actions  {name:16} edit and slots: median {statistics.median(followed):6.1f}, "
                f"longest {max(followed):6.1f} ms;"
                f"  painted: median {statistics.median(painted):6.1f}, longest {max(painted):6.1f} ms;"
                f"  own: median {statistics.median(own):6.1f} ms"
            )
    _close(window)


def resting() -> None:
    from PySide6.QtCore import QEventLoop, QTimer

    from app.main import prepare_application

    prepare_application()
    from app.main import make_window
    from tests.app.handles import Handles

    window = Handles(make_window())
    window.window.resize(1680, 1020)
    window.window.show()
    window.make_late_panels()
    opened(window)

    def busy(seconds: float) -> tuple[float, float]:
        """Let the window go its way; return how much of a core it took, and pictures a second."""
        loop = QEventLoop()
        QTimer.singleShot(round(seconds * 1000), loop.quit)
        wall, used, frames = time.perf_counter(), time.process_time(), window.preview.frames
        loop.exec()
        wall = time.perf_counter() - wall
        return (time.process_time() - used) / wall, (window.preview.frames - frames) / wall

    busy(6)
    rounds = [busy(4) for _ in range(3)]
    share, rate = (statistics.median(x) for x in zip(*rounds, strict=True))
    size = f"{window.preview.view.width()} x {window.preview.view.height()}"
    each = share / max(rate, 1e-9) * 1e3
    print(f"playing: {share:.1%} of a core, {rate:.1f} pictures a second, {each:.1f} ms each ({size})")
    window.session.transport.set_playing(False)
    busy(22)
    print(f"paused:  {busy(8)[0]:.2%} of a core")
    children = [
        int(p.name)
        for p in Path("/proc").glob("[0-9]*")
        if (p / "stat").exists()
        and (p / "stat").read_text().rpartition(")")[2].split()[1] == str(os.getpid())
    ]
    for name, pid in (("window", os.getpid()), *(("pictures", pid) for pid in children)):
        found = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
        held = {line.split(":")[0]: int(line.split()[1]) / 1e3 for line in found if line.endswith("kB")}
        print(f"memory:  {name} {held['Rss']:.0f} MB resident, {held['Pss']:.0f} MB its own share")
    _close(window)


def again(project: object, count: int) -> object:
    """A project of `count` clips, none placed: a project's clips again and again under other names, each a
    clip of its own.
    """
    from metagraph.graph import edits
    from metagraph.graph.model import Project
    from metagraph.motion.clip import Clip

    motions = [e.motion for e in project.clips.values() if e.motion is not None]
    made = []
    for n in range(count):
        c = motions[n % len(motions)]
        name = f"{c.name} {n}"
        made.append(
            (
                f"{name}.glb",
                0,
                "",
                Clip(name, c.skeleton, c.fps, c.rotations.copy(), c.translations, c.translated),
            )
        )
    return edits.add_clips(Project("many"), made)


def proposing(count: int = 1000) -> None:
    import threading

    from PySide6.QtCore import Qt, QTimer
    from PySide6.QtWidgets import QApplication

    from app.main import prepare_application

    prepare_application()
    from app.main import make_window
    from metagraph.suggest.propose import accept, propose
    from tests.app.handles import Handles

    window = Handles(make_window())
    window.window.resize(1680, 1020)
    window.window.show()
    window.make_late_panels()
    opened(window)
    window.session.transport.set_playing(False)
    window.document.load(again(window.document.project, count), None)
    linger(6)  # the cards in sight have their pictures
    late: dict[str, list[float]] = {}
    took: dict[str, float] = {}
    state = {"phase": "nothing runs", "last": time.perf_counter()}

    def beat() -> None:
        now = time.perf_counter()
        late.setdefault(str(state["phase"]), []).append(max(0.0, (now - float(state["last"])) * 1e3 - BEAT))
        state["last"] = now

    timer = QTimer(timerType=Qt.TimerType.PreciseTimer)
    timer.timeout.connect(beat)
    timer.start(BEAT)

    def phase(name: str, seconds: float, until: Callable[[], bool] = lambda: True) -> None:
        state["phase"], start = name, time.perf_counter()
        linger(seconds)
        wait(until, 120)
        took[name] = time.perf_counter() - start

    found: list[object] = []
    phase("nothing runs", 3.0)
    project = window.document.project
    window.jobs.start(
        "Proposing labels",
        lambda job: propose(project, cancelled=lambda: job.cancelled, progress=job.tell),
        found.append,
        print,
    )
    phase("proposing labels", 0.0, lambda: bool(found))
    placing: list[object] = []
    threading.Thread(target=lambda: placing.append(accept(project, found[0]).project), daemon=True).start()
    phase("placing all (thread)", 0.0, lambda: bool(placing))
    window.document.edit("Place", lambda _: placing[0])
    judged = window.compatibility
    phase(
        "looking for jumps",
        0.5,
        lambda: judged.judged is not None and judged.judged.measured["arms"].labelled > 0,
    )
    window.do("compatibility")
    dialog = next(w for w in QApplication.topLevelWidgets() if type(w).__name__ == "MatrixDialog")
    phase("comparing clips", 0.0, lambda: dialog.model.rows is not None and dialog.model.rowCount() == count)
    bar = dialog.table.verticalScrollBar()

    def scroll() -> None:
        bar.setValue((bar.value() + 23) % max(1, bar.maximum()))

    mover = QTimer(interval=16)
    mover.timeout.connect(scroll)
    mover.start()
    phase("scrolling the table", 4.0)
    mover.stop()
    timer.stop()
    print(
        f"{f'phase, with {count} clips':26} {'takes':>8} {'95 % late by':>14} {'longest':>12} "
        f"{'over 50 ms':>11}"
    )
    for name, delays in late.items():
        ranked = sorted(delays)
        most = ranked[min(len(ranked) - 1, int(len(ranked) * 0.95))]
        print(
            f"{name:26} {took[name]:6.1f} s {most:11.1f} ms {ranked[-1]:9.1f} ms "
            f"{sum(d > 50 for d in delays):11}"
        )
    _close(window)


def _close(window: object) -> None:
    window.document.undo_stack.setClean()
    window.window.close()


def main() -> None:
    counts = [word for word in sys.argv[1:] if word.isdecimal()]
    chosen = [word for word in sys.argv[1:] if word not in counts]
    chosen = chosen or ["cold", "stalls", "edits", "proposing", "resting"]
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY") and shutil.which("xvfb-run"):
        screen = ["xvfb-run", "-a", "-s", "-screen 0 1920x1200x24"]
        os.execvp("xvfb-run", [*screen, sys.executable, __file__, *sys.argv[1:]])
    if "METAGRAPH_BENCH" in os.environ:
        {
            "stalls": stalls,
            "edits": lambda: edit_latency(*map(int, counts)),
            "proposing": lambda: proposing(*map(int, counts)),
            "resting": resting,
        }[chosen[0]]()
        return
    with tempfile.TemporaryDirectory() as folder:
        os.environ.update(
            XDG_DATA_HOME=folder,
            XDG_CONFIG_HOME=folder,
            PYTHONPYCACHEPREFIX=f"{folder}/cache",
            METAGRAPH_BENCH="1",
        )
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # modules are compiled once, as they are for people
        subprocess.run(
            [
                sys.executable,
                "-c",
                "from app.main import *; app = prepare_application(); w = make_window(); "
                "w.make_late_panels(); w.close()",
            ],
            check=True,
            cwd=ROOT,
        )
        for name in chosen:
            if name == "cold":
                cold()
            else:  # a process each: a second window in one process would find everything loaded
                subprocess.run([sys.executable, __file__, name, *counts], check=True)


if __name__ == "__main__":
    main()
