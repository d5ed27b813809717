"""Mimicking a recording in the real window: choose the file, look, and the character does it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtWidgets import QFileDialog, QLabel, QMessageBox

from app.features.mimic import filmed_keypoints
from app.features.mimic.camera_dialog import CameraDialog
from app.features.mimic.mimic_dialog import MimicDialog, pick_recording
from app.project.files import SAMPLE
from metagraph.common.extra_steps import ExtraError
from metagraph.graph import requests as a
from tests.films import install_stand_in, make_film, remove_stand_in

KEYPOINTS = Path(__file__).resolve().parents[4] / "sample_clips" / "keypoints"
DEEP, FLAT = KEYPOINTS / "conversation.mediapipe.jsonl", KEYPOINTS / "conversation.openpose.json"


def test_one_frame_of_many_stands_for_its_folder(tmp_path: Path) -> None:
    frames = [tmp_path / f"v_{n:012}_keypoints.json" for n in range(3)]
    for frame in frames:
        frame.write_text("{}")
    assert pick_recording(frames[1]) == tmp_path
    (tmp_path / "alone").mkdir()
    only = tmp_path / "alone" / frames[0].name
    shutil.copy(frames[0], only)
    assert pick_recording(only) == only and pick_recording(DEEP) == DEEP


@pytest.fixture
def opened(drive: Any) -> Any:
    drive.files.open(SAMPLE, template=True)
    drive.wait(
        lambda: (
            len(drive.document.project.clips) == 152
            and bool(drive.performance.shown.plan.layers["arms"].cues)
        ),
        60,
    )
    return drive


def dialog_of(drive: Any, monkeypatch: pytest.MonkeyPatch, path: Path) -> MimicDialog:
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(path), ""))
    drive.actions["mimic"].trigger()
    drive.wait(lambda: drive.window.findChild(MimicDialog) is not None)
    dialog = drive.window.findChild(MimicDialog)
    drive.wait(dialog.isVisible)
    return dialog


def told(drive: Any) -> str:
    return drive.window.statusBar().currentMessage()


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_recording_becomes_a_performance_that_plays_and_can_be_undone(
    opened: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    drive = opened
    before = dict(drive.document.project.performances)
    drive.session.onstage.set_performance(None)
    dialog = dialog_of(drive, monkeypatch, DEEP)
    assert (
        dialog.mirror.isChecked()
        and not dialog.gaze.isChecked()
        and all(box.isChecked() for box in dialog.layers.values())
    )
    dialog.mirror.setChecked(False)
    dialog.go.click()
    drive.wait(lambda: len(drive.document.project.performances) == len(before) + 1, 60)
    (made,) = [i for i in drive.document.project.performances if i not in before]
    kept = drive.document.project.performances[made]
    assert drive.session.onstage.performance == made and kept.name == "conversation.mediapipe" and kept.idle
    stances = [drive.document.project.stance(ask.stance).name for ask in kept.asks if isinstance(ask, a.Go)]
    assert {"on hips", "arms crossed", "weight left", "head tilt left"} <= set(stances)
    drive.wait(lambda: drive.performance.shown.length == kept.length and bool(drive.performance.answers()))
    arms = drive.performance.shown.plan.layers["arms"]
    assert drive.document.project.stance(arms.stance_at(14.0)).name == "on hips"
    assert "The requests are in the performance below" in told(drive)
    drive.document.undo()
    assert drive.document.project.performances == before


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_what_is_seen_is_added_to_the_performance_on_stage(
    opened: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    drive = opened
    drive.performance.requests.ask(a.Nod(at=2.0))
    stage = drive.session.onstage.performance
    dialog = dialog_of(drive, monkeypatch, DEEP)
    dialog.layers["head"].setChecked(False)
    dialog.layers["body"].setChecked(False)
    assert dialog.go.isEnabled()
    dialog.layers["arms"].setChecked(False)
    assert not dialog.go.isEnabled()
    dialog.layers["arms"].setChecked(True)
    dialog.go.click()
    drive.wait(lambda: len(drive.document.project.performances[stage].asks) > 1, 60)
    asks = drive.document.project.performances[stage].asks
    assert isinstance(asks[0], a.Nod) and {ask.layer for ask in asks[1:]} == {"arms"}
    assert drive.session.onstage.performance == stage


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_files_that_are_none_and_people_in_no_stance_are_told(
    opened: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    drive, said = opened, []
    monkeypatch.setattr(QMessageBox, "warning", lambda *words: said.append(words[1:]))
    (tmp_path / "none.json").write_text("{}")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(tmp_path / "none.json"), ""))
    drive.actions["mimic"].trigger()
    drive.wait(lambda: bool(said))
    assert said[0][0] == "Not read" and "it holds no keypoints" in said[0][1]
    lying = [[n * 20.0 + 1, 300.0, 0.9] for n in range(17)]
    (tmp_path / "lying.json").write_text(json.dumps([{"keypoints": lying}] * 40))
    before = drive.document.project
    dialog_of(drive, monkeypatch, tmp_path / "lying.json").go.click()
    drive.wait(lambda: "No stance of the project" in told(drive))
    assert drive.document.project is before


@pytest.mark.window
@pytest.mark.gl
def test_without_a_character_or_while_live_there_is_nobody_to_mimic_with(drive: Any) -> None:
    assert not drive.actions["mimic"].isEnabled()


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_video_is_read_by_an_estimator_and_mimicked(
    opened: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install_stand_in(tmp_path / "home", monkeypatch)
    film = make_film(tmp_path / "talk.mp4", [n / 10 for n in range(100)], sound=True)
    dialog = dialog_of(opened, monkeypatch, film)
    words = " ".join(label.text() for label in dialog.findChildren(QLabel))
    assert "talk.mp4: 100 frames, 9.9 s, without depth" in words
    assert "Its sound is not used." in words and "Found by Stand-in 1." in words
    before = set(opened.document.project.performances)
    dialog.mirror.setChecked(False)
    dialog.go.click()
    opened.wait(lambda: len(opened.document.project.performances) == len(before) + 1, 60)
    (made,) = set(opened.document.project.performances) - before
    asks = opened.document.project.performances[made].asks
    assert "on hips" in {opened.document.project.stance(ask.stance).name for ask in asks}


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_without_mediapipe_the_user_is_asked_and_may_decline_or_install(
    opened: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    remove_stand_in(tmp_path, monkeypatch)
    film = make_film(tmp_path / "talk.mp4", [n / 10 for n in range(10)])
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(film), ""))
    asked: list[str] = []
    wanted = "Cancel"

    def answer(box: QMessageBox) -> None:
        asked.append(f"{box.text()} {box.informativeText()}")
        next(button for button in box.buttons() if button.text().replace("&", "") == wanted).click()

    monkeypatch.setattr(QMessageBox, "exec", answer)
    opened.actions["mimic"].trigger()
    assert "150 MB" in asked[0] and "Apache-2.0" in asked[0] and "this computer" in asked[0]
    assert not opened.window.findChildren(MimicDialog) and not opened.shell.jobs.running

    wanted, said = "Install", list[str]()
    monkeypatch.setattr(QMessageBox, "warning", lambda *words: said.append(str(words[2])))

    def install(name: str, *_: object) -> None:
        raise ExtraError("It could not be installed (no network).")

    monkeypatch.setattr(filmed_keypoints, "install_extra", install)
    opened.actions["mimic"].trigger()
    opened.wait(lambda: bool(said))
    assert said == ["It could not be installed (no network)."]
    monkeypatch.setattr(filmed_keypoints, "install_extra", lambda *_: install_stand_in(tmp_path, monkeypatch))
    opened.actions["mimic"].trigger()
    opened.wait(lambda: bool(opened.window.findChildren(MimicDialog)))
    opened.window.findChild(MimicDialog).reject()


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_camera_films_until_it_is_stopped(
    opened: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install_stand_in(tmp_path / "home", monkeypatch)
    film = make_film(tmp_path / "talk.mp4", [n / 20 for n in range(600)])
    opened.actions["mimic_camera"].trigger()
    opened.wait(lambda: opened.window.findChild(CameraDialog) is not None)
    dialog = opened.window.findChild(CameraDialog)
    dialog.device.setText(str(film))
    dialog.go.click()
    assert dialog.go.text() == "Stop filming"
    opened.wait(lambda: dialog.words.text().endswith("s filmed"), 20)
    dialog.go.click()
    opened.wait(lambda: opened.window.findChild(MimicDialog) is not None, 20)
    made = opened.window.findChild(MimicDialog)
    assert made.keypoints.seconds < 10
    made.reject()


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_camera_that_is_not_there_is_reported(
    opened: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install_stand_in(tmp_path / "home", monkeypatch)
    said: list[str] = []
    monkeypatch.setattr(QMessageBox, "warning", lambda *words: said.append(str(words[2])))
    opened.actions["mimic_camera"].trigger()
    opened.wait(lambda: opened.window.findChild(CameraDialog) is not None)
    dialog = opened.window.findChild(CameraDialog)
    dialog.device.setText("98")
    dialog.go.click()
    opened.wait(lambda: bool(said), 20)
    assert "camera 98 cannot be opened" in said[0]
