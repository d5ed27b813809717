"""A window left open for a week, on a screen of 24 bits: xvfb-run -a -s "-screen 0 1680x1050x24"
python tests/reliability/window_week.py [--days 7] [--hours 8]

Every half minute of a working day something is done: a clip or an action is looked at, a workspace opened, a
request performed, something edited, undone, redone or saved, a dialog opened and closed; the playhead goes on
by that half minute in between, and pictures are drawn. Nobody waits, so that a week takes minutes. Each day:
what the process holds, how many widgets and Python objects there are, steps to undo, bytes of the journal,
and milliseconds that a thing took. Exit code 1 where something grew by more than a day accounts for.
"""

from __future__ import annotations

import argparse
import gc
import os
import random
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

os.environ.setdefault("QT_QPA_PLATFORM", "xcb")

from PySide6.QtCore import QCoreApplication, QEvent  # noqa: E402
from PySide6.QtWidgets import QApplication  # noqa: E402

from app import faults  # noqa: E402
from app.main import make_window, prepare_application  # noqa: E402
from app.project.files import SAMPLE  # noqa: E402
from app.shell.workspaces import WORKSPACES  # noqa: E402
from metagraph.graph import edits, requests  # noqa: E402
from tests.app.every_dialog import DIALOGS, opened  # noqa: E402
from tests.app.handles import Handles  # noqa: E402

STEP = 30.0  # seconds between two things


def held() -> float:
    """Return the MB of memory this process holds; nan where the system does not tell."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20
    except OSError:
        return float("nan")


class Week:
    """A window, and what is done in it. kinds: how often each was."""

    def __init__(self, window: Handles, folder: Path, chance: random.Random) -> None:
        self.window, self.folder, self.chance = window, folder, chance
        self.kinds: dict[str, int] = {}
        self.things: tuple[Callable[[], object], ...] = (
            self.look_at_clip, self.look_at_clip, self.look_at_action, self.edit, self.edit, self.drag,
            self.undo, self.workspace, self.perform, self.watch, self.dialog, self.save,
        )  # fmt: skip

    def look_at_clip(self) -> None:
        clip = self.chance.choice(list(self.window.document.project.clips))
        self.window.session.selection.select_clips((clip,))
        self.window.session.transport.show_clip(clip)

    def look_at_action(self) -> None:
        action = self.chance.choice(list(self.window.document.project.actions()))
        self.window.session.place.set_layer(action.layer)
        self.window.session.selection.select_actions((action.id,))
        self.window.session.show_context(action.id)

    def edit(self) -> None:
        action = self.chance.choice(list(self.window.document.project.actions()))
        value = self.chance.uniform(0.1, 2.0)
        self.window.document.edit(
            "Change likelihood", lambda p: edits.update_actions(p, (action.id,), likelihood=value)
        )

    def drag(self) -> None:
        for _ in range(30):
            seed = self.chance.randrange(2**31)
            self.window.document.edit("Drag", lambda p, seed=seed: edits.set_settings(p, seed=seed), "drag")

    def undo(self) -> None:
        for _ in range(self.chance.randrange(4)):
            self.window.document.undo()
        self.window.document.redo()

    def workspace(self) -> None:
        self.window.workspaces.choose(self.chance.choice(WORKSPACES).id)

    def perform(self) -> None:
        self.window.performance.requests.ask(requests.Gesture())

    def watch(self) -> None:
        self.window.session.transport.show_plan()
        self.window.session.transport.seek(self.chance.uniform(0, 60))

    def dialog(self) -> None:
        name = self.chance.choice(list(DIALOGS))
        DIALOGS[name](self.window, self.folder)
        turn(20)
        while opened():
            opened()[-1].reject()
            turn(2)

    def save(self) -> None:
        self.window.files.save()

    def one(self) -> None:
        thing = self.chance.choice(self.things)
        self.kinds[thing.__name__] = self.kinds.get(thing.__name__, 0) + 1
        thing()
        transport = self.window.session.transport
        transport.seek(transport.seconds + STEP)
        turn(3)


def turn(times: int) -> None:
    for _ in range(times):
        QApplication.processEvents()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)


def main(days: int, hours: float) -> int:
    """Work for that long; return 1 where something grew."""
    chance = random.Random(1)
    app = prepare_application()
    told: list[object] = []
    faults.listeners.append(told.append)
    rows: list[dict[str, float]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.environ.update(XDG_DATA_HOME=str(folder / "state"), XDG_CONFIG_HOME=str(folder / "state"))
        window = Handles(make_window())
        window.window.resize(1680, 1000)
        window.window.show()
        path = shutil.copytree(SAMPLE.parent, folder / "show") / SAMPLE.name
        window.files.open(path)
        end = time.monotonic() + 60
        while not window.document.project.clips or window.performance.skeleton() is None:
            assert time.monotonic() < end, "the sample does not open"
            turn(1)
        while window.jobs.running:
            turn(1)
        week = Week(window, folder, chance)
        for day in range(days + 1):  # on the first, everything is seen for the first time
            took = []
            for _ in range(round(hours * 3600 / STEP)):
                begin = time.perf_counter()
                week.one()
                took.append(1e3 * (time.perf_counter() - begin))
            while window.jobs.running:
                turn(1)
            turn(10)
            gc.collect()
            took.sort()
            journal = sum(p.stat().st_size for p in folder.rglob("*.journal"))
            rows.append({
                "day": day, "MB": held(), "widgets": len(app.allWidgets()), "objects": len(gc.get_objects()),
                "steps": window.document.undo_stack.count(), "journal kB": journal / 1024,
                "ms": took[len(took) // 2], "95 % ms": took[int(0.95 * len(took))], "faults": len(told),
            })  # fmt: skip
            print("  ".join(f"{k} {v:,.1f}" for k, v in rows[-1].items()), flush=True)
        print(week.kinds)
        window.document.undo_stack.setClean()
        window.window.close()
    first, last = rows[1], rows[-1]
    bounds = {
        "MB": 1.15,
        "widgets": 1.0,
        "ms": 1.5,
    }  # a machine that does other things, too, is slower at times
    grew = [k for k, most in bounds.items() if last[k] > most * first[k]]
    print(f"grew: {', '.join(grew) or 'nothing'}; faults: {told[:3]}")
    return 1 if grew or told else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--days", type=int, default=7)
    parser.add_argument("--hours", type=float, default=8.0)
    options = parser.parse_args()
    sys.exit(main(options.days, options.hours))
