"""A fast start: what takes long to import waits until the first picture is there."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LATER = ("yaml", "numpy.ma", "soundfile", "app.project.recovering", "metagraph.formats.characters")
HEAVY = ("numba", "scipy", "trimesh", "torch", "pyqtgraph", "av", "PIL", "ufbx", "jsonschema")
START = f"""
import sys
from app import main
from app.main import open_window, prepare_application
main.UNSEEN = 30_000  # however busy the machine is
heavy = {HEAVY!r}

def first(window):
    assert not window.places.ready
    print("first:", *(m for m in (*heavy, *{LATER!r}) if m in sys.modules), flush=True)

once_painted = main._once_painted
main._once_painted = lambda window, begin: once_painted(window, lambda: (first(window), begin()))
app = prepare_application()
window = open_window(None, sample=True)

def watch():
    if window.places.ready and window.shell.stage.performance.skeleton() is not None:
        print("ready:", *(m for m in heavy if m in sys.modules), flush=True)
        assert window.places.made("properties") and not window.places.made("timeline"), "it is not seen"
        window.close()
        app.quit()

from PySide6.QtCore import QTimer
timer = QTimer(interval=20)
timer.timeout.connect(watch)
timer.start()
QTimer.singleShot(40000, lambda: app.exit(9))
sys.exit(app.exec())
"""


@pytest.mark.window
@pytest.mark.gl
def test_the_first_picture_waits_for_no_heavy_import_and_the_panels_follow(qapp, tmp_path):
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", START],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr, done.stderr
    first, ready = done.stdout.splitlines()
    assert first == "first:"
    assert set(ready.split()[1:]) <= {"PIL"}, "the character's textures"


def test_the_domain_starts_without_a_window():
    code = (
        f"import metagraph, app.cli.parser, sys; print(*(m for m in {(*HEAVY, 'PySide6', 'numpy')!r} "
        "if m "
        "in sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.strip() == ""
