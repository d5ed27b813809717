"""Clips of another skeleton through the real window: asked once, corrected by hand, retargeted, remembered;
or left out.
"""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app import translation
from app.project import watching
from app.project.autosave import state_folder
from app.project.kept_maps import keep_map, read_joint_maps
from metagraph.motion.joint_map import JointMap, JointPair, make_fingerprint

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def folder(toy, sample, tmp_path):
    """Two clips of the toy and two of the mannequin."""
    from metagraph.formats.gltf.writer import write_glb

    for name in ("rest", "wave"):
        write_glb(tmp_path / f"{name}.glb", [toy.clip(name, 0.6, swing=0.3)])
    for n, entry in enumerate(list(sample.clips.values())[:2]):
        write_glb(tmp_path / f"other{n}.glb", [entry.motion.trimmed(0, 20).renamed(f"other{n}")])
    return tmp_path


@pytest.fixture
def own(drive, folder):
    """A window with the toy's clips."""
    drive.importing.import_paths([str(folder / "rest.glb"), str(folder / "wave.glb")])
    drive.wait(lambda: len(drive.document.project.clips) == 2)
    drive.said = []
    drive.importing.told.connect(drive.said.append)
    drive.importing.retarget.__self__.told.connect(drive.said.append)
    return drive


def bring(drive, folder, *names):
    from app.features.retargeting.joint_map_dialog import JointMapDialog

    drive.importing.import_paths([str(folder / f"{name}.glb") for name in names])
    drive.wait(lambda: any(d.isVisible() for d in drive.window.findChildren(JointMapDialog)))
    dialog = next(d for d in drive.window.findChildren(JointMapDialog) if d.isVisible())
    drive.wait(lambda: dialog.figures.right is not None)
    return dialog


def press(button):
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def choose(drive, dialog, joint, target):
    """Choose by the keyboard, as a person at the combo does."""
    combo = dialog.combo(joint)
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_Home)
    for _ in range(0 if target is None else dialog.target.index(target) + 1):
        QTest.keyClick(combo, Qt.Key.Key_Down)
    drive.pause(30)


@pytest.mark.nightly
def test_clips_of_another_skeleton_are_asked_about_once_and_retargeted_in_one_step(own, folder, sample):
    drive = own
    dialog = bring(drive, folder, "other0", "other1")
    assert dialog.headline.text() == "2 clips have another skeleton"
    assert "other0.glb, other1.glb" in dialog.details.text() and "61 joints" in dialog.details.text()
    assert dialog.go.text() == "Retarget 2 clips" and dialog.go.isEnabled()
    assert not dialog.everything.isVisible(), "nobody else waits"
    assert dialog.combo("LeftHand").currentText() == "LeftHand"
    assert dialog.rows["LeftHand"].text(2) == "left hand"
    press(dialog.go)
    drive.wait(lambda: len(drive.document.project.clips) == 4)
    project = drive.document.project
    key = make_fingerprint(sample.skeleton)
    new = [e for e in project.clips.values() if e.brought_from]
    assert [e.name for e in new] == ["other0", "other1"] and set(project.joint_maps) == {key}
    assert all(e.motion.skeleton == project.skeleton for e in new)
    model = drive.library.rows
    tip = model.data(model.index(2), Qt.ItemDataRole.ToolTipRole)
    assert "61 joints" in tip
    drive.wait(lambda: any("2 of them retargeted" in words for words in drive.said))
    drive.actions["undo"].trigger()
    assert len(drive.document.project.clips) == 2 and not drive.document.project.joint_maps


@pytest.mark.nightly
def test_they_may_be_left_out_and_the_others_of_the_same_drop_come_in(own, folder, toy):
    from metagraph.formats.gltf.writer import write_glb

    drive = own
    write_glb(folder / "nod.glb", [toy.clip("nod", 0.4)])
    dialog = bring(drive, folder, "nod", "other0")
    assert "another skeleton" in dialog.headline.text() and dialog.leave.text() == "Skip it"
    press(dialog.leave)
    drive.wait(
        lambda: any(
            "Skipped: 1 clip with another skeleton. To do: retarget 1 clip" in words for words in drive.said
        )
    )
    assert [e.name for e in drive.document.project.clips.values()] == ["rest", "wave", "nod"]
    assert not read_joint_maps()


@pytest.mark.nightly
def test_one_click_retargets_the_clips_of_every_other_skeleton(own, folder, sample):
    from app.features.retargeting.joint_map_dialog import JointMapDialog
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.motion.skeleton import Skeleton

    drive = own
    motion = next(iter(sample.clips.values())).motion.trimmed(0, 20)
    bones = motion.skeleton
    names = tuple(f"{name}_x" if n % 2 else name for n, name in enumerate(bones.names))
    third = Skeleton(names, bones.parents, bones.rest_rotations, bones.rest_translations * 1.3)
    write_glb(folder / "third.glb", [replace(motion, name="third", skeleton=third)])
    dialog = bring(drive, folder, "other0", "other1", "third")
    assert dialog.everything.text() == "Retarget all 3 clips"
    choose(drive, dialog, "LeftHand", None)
    assert not dialog.everything.isEnabled(), "a needed joint is missing"
    choose(drive, dialog, "LeftHand", "LeftHand")
    press(dialog.everything)
    drive.wait(lambda: len(drive.document.project.clips) == 5)
    project = drive.document.project
    assert len(project.joint_maps) == 2 and sum(bool(e.brought_from) for e in project.clips.values()) == 3
    drive.wait(lambda: any("3 of them retargeted" in words for words in drive.said))
    assert not any(d.isVisible() for d in drive.window.findChildren(JointMapDialog))


@pytest.mark.nightly
def test_a_joint_is_corrected_by_hand_and_what_is_missing_is_said(own, folder):
    drive = own
    dialog = bring(drive, folder, "other0")
    choose(drive, dialog, "LeftHand", None)
    assert not dialog.go.isEnabled() and "Still missing: left hand" in dialog.missing.text()
    assert dialog.figures.right is None
    dialog.doubtful.click()
    assert not dialog.rows["LeftHand"].isHidden() and dialog.rows["RightHand"].isHidden()
    choose(drive, dialog, "LeftHand", "LeftHand")
    assert dialog.go.isEnabled() and "Still missing" not in dialog.missing.text()
    assert dialog.rows["LeftHand"].text(4) == "chosen by hand"
    drive.wait(lambda: dialog.figures.right is not None)
    press(dialog.go)
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    (found,) = drive.document.project.joint_maps.values()
    assert found.of("LeftHand").why == "chosen by hand"


def test_how_a_skeleton_differs_is_said_in_the_language(own, folder):
    dialog = bring(own, folder, "other0")
    why = dialog.strangers.why
    assert why in dialog.details.text()
    translation.choose("de")
    try:
        assert translation.tr_phrase(why) != why
        dialog._say()
        assert translation.tr_phrase(why) in dialog.details.text()
    finally:
        translation.choose("en")
    dialog.reject()


@pytest.mark.nightly
def test_the_next_clips_of_that_skeleton_are_retargeted_unasked_and_that_is_told(own, folder):
    drive = own
    press(bring(drive, folder, "other0").go)
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    drive.importing.import_paths([str(folder / "other1.glb")])
    drive.wait(lambda: len(drive.document.project.clips) == 4)
    assert any("with the joint map of the project" in words for words in drive.said)


def test_a_map_of_the_user_is_offered_in_another_project(own, folder):
    drive = own
    dialog = bring(drive, folder, "other0")
    choose(drive, dialog, "Jaw" if "Jaw" in dialog.rows else dialog.source.names[-1], None)
    mine = dialog.map
    press(dialog.go)
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    assert list(read_joint_maps().values()) == [mine]
    from metagraph.graph.model import Project

    drive.document.load(Project(), None)
    drive.importing.import_paths([str(folder / "rest.glb"), str(folder / "wave.glb")])
    drive.wait(lambda: len(drive.document.project.clips) == 2)
    again = bring(drive, folder, "other0")
    assert again.map == mine and "last time" in again.details.text()
    press(again.leave)


@pytest.mark.nightly
def test_saved_and_opened_again_they_are_retargeted_and_followed_when_exported_anew(
    own, folder, sample, monkeypatch
):
    from metagraph.formats.gltf.writer import write_glb

    drive = own
    press(bring(drive, folder, "other0").go)
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    drive.document.save(folder / "p.metagraph.yaml")
    drive.files.open(folder / "p.metagraph.yaml")
    drive.wait(lambda: not drive.jobs.running)
    entry = list(drive.document.project.clips.values())[2]
    assert (
        entry.motion.skeleton == drive.document.project.skeleton
        and entry.motion.brought_from == entry.brought_from
    )
    monkeypatch.setattr(watching, "EVERY", 100)
    drive.watcher.look()
    drive.pause(500)
    motion = next(iter(sample.clips.values())).motion
    write_glb(folder / "other0.glb", [motion.trimmed(0, 31).renamed("other0")])
    drive.wait(lambda: drive.document.project.clips[entry.id].frames == 31)
    fresh = drive.document.project.clips[entry.id]
    assert (
        fresh.brought_from == entry.brought_from and fresh.motion.skeleton == drive.document.project.skeleton
    )


@pytest.mark.nightly
def test_a_map_is_corrected_later_and_its_clips_are_retargeted_again_in_one_step(own, folder):
    from app.features.retargeting.joint_map_dialog import JointMapDialog

    drive = own
    drive.actions.refresh()
    assert not drive.actions["joint_maps"].isEnabled()
    press(bring(drive, folder, "other0", "other1").go)
    drive.wait(lambda: len(drive.document.project.clips) == 4)
    before = drive.document.project
    drive.actions.refresh()
    drive.actions["joint_maps"].trigger()
    shown = lambda: [d for d in drive.window.findChildren(JointMapDialog) if d.isVisible()]  # noqa: E731
    drive.wait(lambda: bool(shown()))
    (dialog,) = shown()
    assert dialog.headline.text() == "2 clips were retargeted" and dialog.leave.text() == "Keep as it is"
    choose(drive, dialog, "Neck", None)
    assert dialog.contacts.isChecked()
    QTest.mouseClick(dialog.contacts, Qt.MouseButton.LeftButton, pos=QPoint(8, dialog.contacts.height() // 2))
    press(dialog.go)
    drive.wait(lambda: drive.document.project is not before)
    after = drive.document.project
    assert not next(iter(after.joint_maps.values())).contacts
    assert (
        list(after.clips) == list(before.clips) and next(iter(after.joint_maps.values())).of("Neck") is None
    )
    assert all(after.clips[i].motion is not before.clips[i].motion for i in list(after.clips)[2:])
    drive.actions["undo"].trigger()
    assert drive.document.project is before


@pytest.mark.nightly
def test_marking_a_row_marks_both_figures(own, folder):
    drive = own
    dialog = bring(drive, folder, "other0")
    item = dialog.rows["RightHand"]
    rect = dialog.tree.visualItemRect(item)
    dialog.tree.scrollToItem(item)
    drive.pause(30)
    rect = dialog.tree.visualItemRect(item)
    QTest.mouseClick(
        dialog.tree.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(rect.left() + 20, rect.center().y())
    )
    assert dialog.figures.marked == ("RightHand", "RightHand")
    press(dialog.leave)


def test_maps_are_kept_latest_last_and_damage_spoils_no_other(qapp):
    def made(n):
        return JointMap(f"s{n}", "t", (JointPair("a", "b", "hips"),))

    assert read_joint_maps() == {}
    for n in (1, 2, 1):
        keep_map(made(n))
    assert [m.source for m in read_joint_maps().values()] == ["s2", "s1"]
    place = state_folder() / "joint_maps.json"
    rows = json.loads(place.read_text())
    place.write_text(json.dumps([{"source": 1}, *rows]))
    assert [m.source for m in read_joint_maps().values()] == ["s2", "s1"]
    place.write_text("{ torn")
    assert read_joint_maps() == {}
    keep_map(made(3))
    assert len(read_joint_maps()) == 1
