"""The real window, killed at any moment: xvfb-run -a python tests/reliability/window_kills.py [--count 50]

Each round opens the project in a window of its own process, goes on with what a crash left, edits and saves
by the window's own commands, and is killed. Exit code 1 when an edit that was finished is nowhere.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.atomic import sweep  # noqa: E402
from metagraph.formats.recovery import find_left_journals, read_journal  # noqa: E402
from metagraph.formats.store import SUFFIX, read_project  # noqa: E402
from tests.processes import started  # noqa: E402
from tests.projects import few_of_the_sample  # noqa: E402

WINDOW = """
import random, sys
from pathlib import Path
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from app import faults
from app.main import open_window, prepare_application
from app.project.recovering import RecoverDialog
from app.shell.fault_dialog import find_fault_folder
from metagraph.graph import edits

app = prepare_application()
faults.install(find_fault_folder())
faults.listeners.append(lambda told: print("fault", told, flush=True))
chance, ready = random.Random(int(sys.argv[2])), []

def answer():
    box = QApplication.activeModalWidget()
    if isinstance(box, RecoverDialog):
        print("recovers", flush=True)
        for field in box.fields[1:]:
            field.setCurrentIndex(field.findData("discard"))
        box.accept()

def work():
    answer()
    if not ready:
        return
    document = window.shell.document
    number = document.project.settings.seed + 1
    document.edit("Seed", lambda p: edits.set_settings(p, seed=number))
    print("at", number, flush=True)
    what = chance.random()
    if what < 0.2:
        window.shell.actions["save"].trigger()
    elif what < 0.3:
        print("at", number - 1, flush=True)  # undone is finished, too
        window.shell.actions["undo"].trigger()
        window.shell.actions["redo"].trigger()
        print("at", number, flush=True)

window = open_window(Path(sys.argv[1]))

def opened():
    print("at", window.shell.document.project.settings.seed, flush=True)
    ready.append(1)

window.shell.files.opened.connect(opened)
timer = QTimer(interval=15)
timer.timeout.connect(work)
timer.start()
QTimer.singleShot(120000, lambda: app.exit(9))
sys.exit(app.exec())
"""


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--count", type=int, default=50)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    chance, wrong, edits, recovered = random.Random(given.seed), [], 0, 0
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        top = Path(name)
        path = few_of_the_sample(top / "show")
        assert path.name.endswith(SUFFIX)
        state = {"XDG_DATA_HOME": str(top / "state"), "XDG_CONFIG_HOME": str(top / "state")}
        for number in range(given.count):
            words = (sys.executable, "-c", WINDOW, path, chance.randrange(2**31))
            told, goes_on = [], False
            with started(*words, env={**os.environ, **state}, stdout=subprocess.PIPE, longest=150) as window:
                assert window.stdout is not None
                for line in window.stdout:
                    told.append(line.split())
                    if line.startswith("at "):
                        break
                time.sleep(chance.uniform(0, 3.0))
                window.kill()
                told += [line.split() for line in window.stdout.read().split("\n")[:-1]]
                window.wait(10)
            at = [int(line[1]) for line in told if line and line[0] == "at"]
            goes_on = ["recovers"] in told
            left = [read_journal(journal, path) for journal in find_left_journals(path)]
            seeds = [x.project.settings.seed for x in left if x is not None]
            latest = max([read_project(path).settings.seed, *seeds])
            faults = [" ".join(line) for line in told if line and line[0] == "fault"]
            if not at or latest < at[-1] or faults:
                wrong.append(f"round {number}: {at[-1:]} was finished, {latest} is left; {faults}")
            sweep(path.parent)
            if list(path.parent.glob(".saving-*")):
                wrong.append(f"round {number}: unfinished files stay")
            edits, recovered = edits + max(0, len(at) - 1), recovered + goes_on
        shutil.rmtree(top / "show")
    minutes = (time.monotonic() - begun) / 60
    print(
        f"{given.count} windows killed in {minutes:.1f} minutes, {edits} edits finished, "
        f"{recovered} recovered"
    )
    for words in wrong:
        print(f"WRONG: {words}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
