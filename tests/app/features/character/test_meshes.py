"""Meshes of the character hidden and shown through the real window, and what stands over the default body."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.store import read_project
from preview.default_body.figure import DefaultBody
from preview.figure import SkinnedFigure
from tests.bodies import body

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def scene(toy, tmp_path):
    """A file with a clip and a body of balls, and one with a single triangle of it."""
    whole = body(toy.skeleton, dict.fromkeys(range(len(toy.skeleton)), 0.1))
    write_glb(tmp_path / "whole.glb", [toy.clip("wave", 0.6, swing=0.3)], whole)
    part = replace(whole, triangles=whole.triangles[:1], surfaces=whole.surfaces[:1])
    part = replace(part, surfaces=(replace(part.surfaces[0], count=1),))
    write_glb(tmp_path / "proxy.glb", [toy.clip("rest", 0.6)], part)
    return tmp_path


def shown(drive):
    skeleton = drive.document.project.skeleton
    return drive.shell.stage.figures.figure(skeleton) if skeleton is not None else None


@pytest.mark.nightly
def test_a_stand_in_is_drawn_as_the_default_body_and_a_button_in_the_view_asks_for_a_character(
    drive, scene, monkeypatch
):
    from app.features.character import character_gallery

    drive.importing.import_paths([str(scene / "proxy.glb")])
    drive.wait(lambda: isinstance(shown(drive), DefaultBody))
    over = drive.shell.panel("character").no_mesh
    drive.wait(lambda: over.isVisible() and over.height() >= over.button.height() > 10)
    assert over.parentWidget().rect().contains(over.geometry())
    assert drive.document.project.character is None
    QTest.mouseClick(over.button, Qt.MouseButton.LeftButton)
    gallery = drive.window.findChild(character_gallery.CharacterGallery)
    assert gallery is not None and gallery.isVisible()
    gallery.reject()
    drive.document.edit("Choose", lambda p: replace(p, character=str(scene / "proxy.glb")))
    drive.wait(lambda: "1 triangle, a stand-in" in over.words.text())
    drive.document.edit("Choose", lambda p: replace(p, character=str(scene / "whole.glb")))
    drive.wait(lambda: isinstance(shown(drive), SkinnedFigure))
    drive.wait(lambda: not over.isVisible())


@pytest.mark.nightly
def test_a_mesh_is_hidden_by_a_click_saved_and_shown_again_by_undo(drive, scene):
    from app.features.character.meshes_dialog import MeshesDialog

    drive.importing.import_paths([str(scene / "whole.glb")])
    drive.wait(lambda: isinstance(shown(drive), SkinnedFigure))
    all_of_it = len(shown(drive).mesh.triangles)
    drive.do("meshes")
    (dialog,) = drive.window.findChildren(MeshesDialog)
    (item,) = [dialog.list.item(n) for n in range(dialog.list.count())]
    drive.wait(lambda: dialog.windowHandle().isExposed())
    row = dialog.list.visualItemRect(item)
    box = QPoint(row.left() + 10, row.center().y())
    QTest.mouseClick(dialog.list.viewport(), Qt.MouseButton.LeftButton, pos=box)
    assert drive.document.project.hidden == (item.text(),)
    assert drive.document.undo_stack.undoText() == f"Hide '{item.text()}'"
    drive.wait(lambda: isinstance(shown(drive), DefaultBody))
    assert shown(drive).instead.endswith("is hidden") and dialog.list.count() == 1, "it can be shown again"
    drive.document.save(scene / "p.metagraph.yaml")
    assert read_project(scene / "p.metagraph.yaml").hidden == (item.text(),)
    dialog.every.click()
    drive.wait(lambda: isinstance(shown(drive), SkinnedFigure))
    assert len(shown(drive).mesh.triangles) == all_of_it and item.checkState() == Qt.CheckState.Checked
    drive.actions["undo"].trigger()
    assert drive.document.project.hidden and item.checkState() == Qt.CheckState.Unchecked
    dialog.reject()


def test_a_button_in_the_view_hides_and_shows_each_mesh_and_stays_open(drive, scene, monkeypatch):
    drive.importing.import_paths([str(scene / "whole.glb")])
    drive.wait(lambda: isinstance(shown(drive), SkinnedFigure))
    panel = drive.preview
    button = panel.mesh_button
    drive.wait(lambda: panel.drawn is not None)
    assert not button.isVisible(), "of one mesh there is nothing to choose"
    monkeypatch.setattr(button, "_meshes", lambda: ("Body", "Sword"))
    panel.view.painted.emit(0.0)
    assert button.isVisible() and panel.view.rect().contains(button.geometry())
    assert not button.geometry().intersects(panel.watch_button.geometry())
    menu = button.menu_of
    menu.popup(button.mapToGlobal(QPoint(0, button.height())))
    sword = next(a for a in menu.actions() if a.text() == "Sword")
    QTest.mouseClick(menu, Qt.MouseButton.LeftButton, pos=menu.actionGeometry(sword).center())
    assert drive.document.project.hidden == ("Sword",) and menu.isVisible() and not sword.isChecked()
    assert drive.document.undo_stack.undoText() == "Hide 'Sword'"
    menu.setActiveAction(sword)
    QTest.keyClick(menu, Qt.Key.Key_Space)
    assert not drive.document.project.hidden and menu.isVisible()
    menu.close()
