"""The line that says what came of an import, through the real window: every button it offers does what it
says.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QMessageBox

from app.features.character.character_gallery import CharacterGallery
from app.features.files.import_line import ImportLine
from metagraph.formats.gltf.writer import write_glb
from metagraph.graph.model import Project
from metagraph.motion.character_mesh import Surface
from metagraph.motion.skeleton import Skeleton
from tests.bodies import body

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def line(drive):
    (found,) = drive.window.findChildren(ImportLine)
    return found


@pytest.fixture
def folder(toy, sample, tmp_path):
    write_glb(tmp_path / "rest.glb", [toy.clip("rest", 0.6)])
    entry = next(iter(sample.clips.values()))
    write_glb(tmp_path / "other.glb", [entry.motion.trimmed(0, 20).renamed("other")])
    return tmp_path


def press(button):
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def leave(drive):
    from app.features.retargeting.joint_map_dialog import JointMapDialog

    def open_ones():
        return [d for d in drive.window.findChildren(JointMapDialog) if d.isVisible()]

    drive.wait(lambda: bool(open_ones()))
    (dialog,) = open_ones()
    press(dialog.leave)
    drive.wait(lambda: not dialog.isVisible())


def test_what_came_in_whole_says_what_to_do_next_until_it_is_done(drive, line, folder):
    from app.features.labelling.review_dialog import ReviewDialog

    drive.importing.import_paths([str(folder / "rest.glb")])
    drive.wait(line.isVisible)
    assert line.words.text().startswith("Imported 1 clip. Next: ")
    (button,) = line.offered
    press(button)
    (dialog,) = drive.window.findChildren(ReviewDialog)
    dialog.reject()
    assert line.isVisible(), "nothing was labelled"
    drive.session.selection.select_clips(tuple(drive.document.project.clips))
    drive.do("label_stance")
    assert line.isHidden()


@pytest.mark.nightly
def test_what_was_left_is_retargeted_by_one_click(drive, line, folder):
    drive.importing.import_paths([str(folder / "rest.glb")])
    drive.wait(lambda: len(drive.document.project.clips) == 1)
    drive.importing.import_paths([str(folder / "other.glb")])
    leave(drive)
    drive.wait(line.isVisible)
    assert "0 clips" in line.words.text() and "retarget 1 clip" in line.words.text()
    (button,) = line.offered
    assert button.text() == "Retarget 1 clip"
    press(button)
    drive.wait(lambda: len(drive.document.project.clips) == 2)
    assert any(e.brought_from for e in drive.document.project.clips.values())
    assert line.isHidden() or "Left out" not in line.words.text()
    assert drive.document.undo_stack.undoText() == "Retarget 1 clip"


@pytest.mark.nightly
def test_what_no_map_is_known_for_asks_for_the_joints(drive, line, folder, toy):
    from app.features.retargeting.joint_map_dialog import JointMapDialog

    drive.importing.import_paths([str(folder / "rest.glb")])
    drive.wait(lambda: len(drive.document.project.clips) == 1)
    odd = toy.clip("odd", 0.5)
    names = tuple(f"q{n}" for n in range(len(odd.skeleton)))
    s = odd.skeleton
    write_glb(
        folder / "odd.glb",
        [replace(odd, skeleton=Skeleton(names, s.parents, s.rest_rotations, s.rest_translations * 0 + 0.1))],
    )
    drive.importing.import_paths([str(folder / "odd.glb")])
    leave(drive)
    drive.wait(line.isVisible)
    (button,) = line.offered
    assert button.text() == "Map joints of 1 clip…"
    press(button)
    drive.wait(lambda: any(d.isVisible() for d in drive.window.findChildren(JointMapDialog)))
    leave(drive)
    drive.wait(line.isVisible)


@pytest.mark.nightly
def test_a_file_of_stand_ins_offers_to_choose_a_character(drive, line, toy, tmp_path, monkeypatch):
    whole = body(toy.skeleton, dict.fromkeys(range(len(toy.skeleton)), 0.1))
    part = replace(whole, triangles=whole.triangles[:1], surfaces=(Surface(0, 1, 0),))
    write_glb(tmp_path / "rest.glb", [toy.clip("rest", 0.6)], part)
    write_glb(tmp_path / "body.glb", [toy.clip("pose", 0.1)], whole)
    drive.importing.import_paths([str(tmp_path / "rest.glb")])
    drive.wait(line.isVisible)
    assert "rest.glb" in line.words.text() and "1 triangle" in line.words.text()
    label, button = line.offered
    assert label.text() == "Label clips…"
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *a, **k: (str(tmp_path / "body.glb"), ""))
    press(button)
    gallery = drive.window.findChild(CharacterGallery)
    gallery.from_file.click()
    drive.wait(gallery.use.isEnabled)
    press(gallery.use)
    drive.wait(lambda: drive.document.project.character is not None)


@pytest.mark.nightly
def test_the_details_say_each_thing_once_and_the_line_can_be_closed(drive, line, folder):
    for n in range(3):
        (folder / f"bad{n}.bvh").write_text("HIERARCHY\nROOT Hips\n{\n")
    drive.importing.import_paths([str(folder / "rest.glb"), *(str(folder / f"bad{n}.bvh") for n in range(3))])
    drive.wait(line.isVisible)
    assert "1 clip." in line.words.text() and "3 unusable files" in line.words.text()
    press(line.why)
    box = next(b for b in drive.window.findChildren(QMessageBox) if b.isVisible())
    assert box.text() == "Imported 1 clip"
    assert box.informativeText().count("\n") == 0 and "and 2 more" in box.informativeText()
    box.close()
    press(line.close_button)
    assert line.isHidden()


@pytest.mark.nightly
def test_what_came_in_is_offered_to_label_though_other_files_failed(drive, line, folder):
    (folder / "bad.bvh").write_text("noise")
    drive.importing.import_paths([str(folder / "rest.glb"), str(folder / "bad.bvh")])
    drive.wait(line.isVisible)
    assert line.offered[-1].text() == "Label clips…"


@pytest.mark.nightly
def test_the_line_goes_with_the_project_it_was_about(drive, line, folder):
    (folder / "bad.bvh").write_text("noise")
    drive.importing.import_paths([str(folder / "rest.glb"), str(folder / "bad.bvh")])
    drive.wait(line.isVisible)
    drive.document.load(Project(), None)
    assert line.isHidden()
