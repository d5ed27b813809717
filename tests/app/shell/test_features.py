"""The shell knows no feature by name: a feature is taken out by deleting its folder and its line."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from app.features import FEATURES
from tests.recipes import code_of
from tests.thorough import some

ROOT = Path(__file__).resolve().parents[3]
START = """
import sys
from app.main import make_window, prepare_application
app = prepare_application()
window = make_window()
window.show()
window.make_late_panels()
window.shell.stage.session.set_mode("manual")
window.shell.stage.session.set_mode("meta")
app.processEvents()
print(*window.places.panels, *(c.id for c in window.shell.actions.commands))
window.close()
"""


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.parametrize(
    ("feature", "gone"),
    some([("manual", "manual"), ("problems", "problems"), ("conversation", "converse")], 2),
)
def test_a_feature_goes_by_deleting_its_folder_and_its_line(feature, gone, tmp_path):
    shutil.copytree(ROOT / "app", tmp_path / "app", ignore=shutil.ignore_patterns("__pycache__"))
    for package in ("metagraph", "preview"):
        (tmp_path / package).symlink_to(ROOT / package)
    shutil.rmtree(tmp_path / "app" / "features" / feature)
    table = tmp_path / "app" / "features" / "__init__.py"
    lines = table.read_text(encoding="utf-8").splitlines(keepends=True)
    table.write_text("".join(x for x in lines if x.strip() != f'"{feature}",'), encoding="utf-8")
    environment = {
        **os.environ,
        "XDG_DATA_HOME": str(tmp_path),
        "XDG_CONFIG_HOME": str(tmp_path),
        "QT_QPA_PLATFORM": "offscreen",
    }
    done = subprocess.run(
        [sys.executable, "-c", START],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
    there = done.stdout.split()
    assert gone not in there and "graph" in there and "undo" in there


def test_every_folder_of_a_feature_is_named_once():
    folders = {p.parent.name for p in (ROOT / "app" / "features").glob("*/__init__.py")}
    assert sorted(FEATURES) == sorted(folders)


@pytest.fixture
def greeting(monkeypatch):
    """The feature that the page "Add a feature" has as its recipe, with its line among the others."""
    feature = ModuleType("app.features.greeting")
    exec(compile(code_of("Add a feature"), "greeting", "exec"), vars(feature))
    monkeypatch.setitem(sys.modules, feature.__name__, feature)
    monkeypatch.setattr("app.features.FEATURES", (*FEATURES, "greeting"))


@pytest.mark.window
@pytest.mark.fresh_window
def test_a_feature_comes_by_its_folder_and_its_line(greeting, drive, toy):
    (entry,) = [a for a in drive.menus["&Help"].actions() if a.objectName() == "greet"]
    assert entry.text() == "&Greet" and entry.shortcut().toString() == "Ctrl+Alt+G"
    drive.do("greet")
    assert drive.window.statusBar().currentMessage() == f"Hello, {drive.document.project.name}"
    drive.document.load(toy.project(), None)
    drive.shell.actions.refresh()
    assert not entry.isEnabled(), "it is for projects without a skeleton"
