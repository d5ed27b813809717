"""Clips exported again while the window is open are read in place: labels and timing stay, half-written files
wait, one undo step.
"""

from __future__ import annotations

import os
import shutil

import pytest
from PySide6.QtWidgets import QMessageBox

from app.project import watching

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def opened(drive, toy, tmp_path, monkeypatch):
    """A window on a project of two files, one of them placed."""
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.graph import edits

    monkeypatch.setattr(watching, "EVERY", 100)
    for name, swing in (("rest", 0.05), ("wave", 0.6)):
        write_glb(tmp_path / f"{name}.glb", [toy.clip(name, 1.0, swing=swing)])
    drive.importing.import_paths([str(tmp_path)])
    drive.wait(lambda: len(drive.document.project.clips) == 2)
    drive.watcher.look()  # and every tenth of a second from now on
    ids = {clip.name: clip.id for clip in drive.document.project.clips.values()}
    drive.document.edit("Stance", lambda p: edits.add_stance(p, "arms", "rest", [ids["rest"]]))
    stance = next(iter(drive.document.project.graphs["arms"].stances))
    drive.document.edit("Wave", lambda p: edits.place_clips(p, [ids["wave"]], "arms", "gesture", stance))
    drive.document.edit(
        "Time",
        lambda p: edits.update_actions(p, [a.id for a in p.actions() if a.kind == "gesture"], tags=("kept",)),
    )
    drive.wait(lambda: len(drive.watcher._known) > 1)  # it has seen them as they are
    drive.ids, drive.place, drive.toy = ids, tmp_path, toy
    return drive


def write(drive, name: str, seconds: float) -> None:
    from metagraph.formats.gltf.writer import write_glb

    write_glb(drive.place / f"{name}.glb", [drive.toy.clip(name, seconds)])


@pytest.mark.nightly
def test_a_file_written_again_is_read_in_place_and_can_be_undone(opened):
    drive = opened
    clip = drive.ids["wave"]
    before = drive.document.project.clips[clip].frames
    write(drive, "wave", 2.0)
    drive.wait(lambda: drive.document.project.clips[clip].frames > before)
    assert len(drive.document.project.clips) == 2
    action = next(a for a in drive.document.project.actions() if a.kind == "gesture")
    assert action.clip == clip and action.tags == ("kept",)
    drive.actions["undo"].trigger()
    assert drive.document.project.clips[clip].frames == before


@pytest.mark.nightly
def test_a_file_touched_but_not_changed_is_no_edit(opened):
    drive = opened
    project = drive.document.project
    os.utime(drive.place / "wave.glb")
    drive.pause(800)
    assert drive.document.project is project


@pytest.mark.nightly
def test_a_broken_file_is_told_and_nothing_is_lost(opened):
    drive = opened
    said = []
    drive.watcher.told.connect(said.append)
    project = drive.document.project
    (drive.place / "wave.glb").write_bytes(b"not a glb at all, and longer than nothing")
    drive.wait(lambda: bool(said))
    assert "wave.glb" in said[0] and drive.document.project is project


@pytest.mark.nightly
def test_a_file_that_is_gone_for_a_moment_is_waited_for(opened):
    drive = opened
    clip = drive.ids["wave"]
    before = drive.document.project.clips[clip].frames
    shutil.move(drive.place / "wave.glb", drive.place / "kept.tmp")
    drive.pause(400)
    write(drive, "wave", 1.7)
    drive.wait(lambda: drive.document.project.clips[clip].frames > before)


@pytest.mark.nightly
def test_nothing_is_followed_when_it_is_switched_off(opened):
    drive = opened
    drive.actions["watch"].trigger()
    assert not drive.watcher.on and not drive.actions["watch"].isChecked()
    project = drive.document.project
    write(drive, "wave", 1.5)
    drive.pause(700)
    assert drive.document.project is project
    drive.actions["watch"].trigger()
    assert drive.watcher.on


@pytest.mark.nightly
def test_a_file_that_was_missing_when_the_project_was_opened_and_is_put_back_is_read(opened, qtbot):
    drive = opened
    project_file = drive.place / "mine.metagraph.yaml"
    drive.document.save(project_file)
    shutil.move(drive.place / "wave.glb", drive.place / "wave.kept")
    drive.files.open(project_file)
    clip = drive.ids["wave"]
    drive.wait(lambda: drive.document.project.clips[clip].motion is None)
    drive.wait(lambda: any(p.clip == clip for p in drive.problems.problems))
    for box in drive.window.findChildren(QMessageBox):
        box.close()
    drive.pause(300)
    said = []
    drive.watcher.told.connect(said.append)
    shutil.move(drive.place / "wave.kept", drive.place / "wave.glb")
    drive.wait(lambda: drive.document.project.clips[clip].motion is not None)
    assert said == ["Found again: wave"]
    assert not drive.document.dirty, "nothing that is saved has changed"
    drive.wait(lambda: not any(p.clip == clip for p in drive.problems.problems))


@pytest.mark.nightly
def test_a_missing_file_that_comes_back_broken_is_told_once(opened):
    drive = opened
    project_file = drive.place / "mine.metagraph.yaml"
    drive.document.save(project_file)
    (drive.place / "wave.glb").unlink()
    drive.files.open(project_file)
    drive.wait(lambda: drive.document.project.clips[drive.ids["wave"]].motion is None)
    for box in drive.window.findChildren(QMessageBox):
        box.close()
    said = []
    drive.watcher.told.connect(said.append)
    drive.pause(300)
    (drive.place / "wave.glb").write_bytes(b"not a glb at all")
    drive.wait(lambda: bool(said))
    drive.pause(500)
    assert len(said) == 1 and "wave.glb" in said[0]
