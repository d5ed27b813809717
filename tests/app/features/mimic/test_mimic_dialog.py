"""Mimicking a recording in the real window: choose the file, look, and the character does it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox

from app.features.mimic.mimic_dialog import MimicDialog, pick_recording
from app.project.files import SAMPLE
from metagraph.graph import requests as a

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
