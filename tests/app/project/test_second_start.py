"""A second start hands what it was given to the running window, where the user chose so."""

from __future__ import annotations

import os
import shutil
import socket
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QDialog, QMessageBox

from app.features.files.import_line import ImportLine
from app.main import WindowKeeper
from app.project import second_start
from app.project.second_start import RUNNING, SETTING, StartRequest, find_socket_name
from metagraph.formats.bvh.file import write_bvh
from tests.conftest import Toy

ROOT = Path(__file__).resolve().parents[3]
SECOND = """
import sys
from PySide6.QtCore import QSettings
from app.project import second_start
second_start.is_handed_over = lambda: sys.argv[1] == "running"
second_start.PATIENCE = int(sys.argv[2])
request = second_start.StartRequest(tuple(sys.argv[3:]))
print("taken" if second_start.send_start_request(request) else "own window")
"""

pytestmark = [pytest.mark.window, pytest.mark.gl, pytest.mark.skipif(os.name == "nt", reason="Unix sockets")]


@pytest.fixture
def runtime(tmp_path_factory, monkeypatch):
    """A runtime folder of the user's own, with a short path."""
    import tempfile

    place = Path(tempfile.mkdtemp(prefix="mg"))
    place.chmod(0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(place))
    yield place
    shutil.rmtree(place, ignore_errors=True)


@pytest.fixture
def listening(drive, runtime):
    """The running window, which takes what second starts are given."""
    keeper = WindowKeeper(drive.window)
    starts = drive.shell.second_starts
    drive.do("second_start")
    assert starts.listens and drive.actions["second_start"].isChecked()
    yield keeper
    starts.choose(False)
    starts.asked.disconnect()
    drive.shell.actions.refresh()


def start(*paths, choice=RUNNING, patience=5000):
    """Start a second Metagraph as far as it decides where to open."""
    return subprocess.Popen(
        [sys.executable, "-c", SECOND, choice, str(patience), *map(str, paths)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        text=True,
    )


def finish(drive, process) -> str:
    drive.wait(lambda: process.poll() is not None, 60)
    return process.communicate()[0].strip()


def test_a_project_opens_in_the_running_window(drive, listening, tmp_path):
    shutil.copy(ROOT / "sample_clips" / "practice.metagraph.yaml", tmp_path / "mine.metagraph.yaml")
    assert finish(drive, start(tmp_path / "mine.metagraph.yaml")) == "taken"
    drive.wait(lambda: drive.document.path == tmp_path / "mine.metagraph.yaml")


def test_it_asks_about_unsaved_edits_as_usual(drive, listening, tmp_path, monkeypatch):
    from metagraph.graph import edits

    asked = []
    monkeypatch.setattr(
        QMessageBox, "question", lambda *words: (asked.append(words[2]), QMessageBox.StandardButton.Cancel)[1]
    )
    drive.document.edit("Change seed", lambda p: edits.set_settings(p, seed=77))
    before = drive.document.project
    shutil.copy(ROOT / "sample_clips" / "practice.metagraph.yaml", tmp_path / "mine.metagraph.yaml")
    assert finish(drive, start(tmp_path / "mine.metagraph.yaml")) == "taken"
    drive.wait(lambda: bool(asked))
    assert "unsaved changes" in asked[0] and drive.document.project is before


def test_a_folder_of_clips_becomes_a_new_project_that_offers_to_label_them(drive, listening, tmp_path):
    folder = tmp_path / "takes of Anna"
    folder.mkdir()
    for name in ("one", "two"):
        write_bvh(Toy().clip(name), folder / f"{name}.bvh")
    assert finish(drive, start(folder)) == "taken"
    drive.wait(lambda: len(drive.document.project.clips) == 2, 40)
    assert drive.document.project.name == "takes of Anna" and drive.document.path is None
    line = drive.window.findChild(ImportLine)
    drive.wait(lambda: "Label clips…" in [button.text() for button in line.offered])


def test_a_window_that_asks_something_is_left_alone(drive, listening):
    box = QDialog(drive.window)
    box.setModal(True)
    box.show()
    drive.wait(box.isVisible)
    assert finish(drive, start(ROOT / "sample_clips" / "practice.metagraph.yaml")) == "own window"
    box.close()
    box.deleteLater()


def test_a_window_that_hangs_or_crashed_blocks_nobody(drive, runtime):
    name = find_socket_name()
    hung = socket.socket(socket.AF_UNIX)
    hung.bind(name)
    hung.listen()  # it takes the connection and never answers
    assert finish(drive, start(patience=300)) == "own window"
    hung.close()  # a crash leaves the file
    assert Path(name).exists() and finish(drive, start()) == "own window"
    starts = drive.shell.second_starts
    starts.choose(True)
    assert starts.listens, "what the crash left is replaced"
    assert finish(drive, start()) == "taken"
    starts.choose(False)


def test_only_this_user_can_reach_the_socket(listening):
    place = Path(find_socket_name())
    assert stat.S_IMODE(place.stat().st_mode) & 0o077 == 0
    assert stat.S_IMODE(place.parent.stat().st_mode) & 0o077 == 0


def test_what_is_no_request_is_answered_and_changes_nothing(drive, listening):
    told = []
    drive.shell.second_starts.asked.connect(told.append)
    with socket.socket(socket.AF_UNIX) as stranger:
        stranger.connect(find_socket_name())
        stranger.sendall(b'{"paths": 5}\n')
        stranger.setblocking(False)
        drive.pause(200)
        assert stranger.recv(100) == b"busy\n" and not told


def test_as_it_comes_nothing_listens_and_nothing_is_asked(drive, runtime):
    assert QSettings().value(SETTING) is None
    drive.shell.second_starts.follow()
    assert not drive.shell.second_starts.listens and not list(runtime.rglob("*"))
    assert finish(drive, start(choice="beside")) == "own window"
    drive.do("second_start")
    assert drive.shell.second_starts.listens
    drive.do("second_start")
    assert not drive.shell.second_starts.listens and not second_start.is_handed_over()


def test_a_request_is_read_as_it_was_written():
    import msgspec

    request = StartRequest(("/a b/ö.metagraph.yaml",), True, "wave", "token")
    assert msgspec.json.decode(msgspec.json.encode(request), type=StartRequest) == request
