"""The gallery of characters, chosen from by clicks and keys."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

from app.features.character import character_portraits
from app.features.character.character_choice import MOST, OURS, list_recent, remember_character
from app.features.character.character_gallery import CharacterGallery
from preview.default_body.figure import DefaultBody
from preview.figure import SkinnedFigure

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def gallery(toys, monkeypatch):
    """The gallery over a window, without pictures: another process takes seconds to draw them."""
    drive = toys
    monkeypatch.setattr(character_portraits, "_draw", lambda orders: {})
    drive.do("character")
    dialog = drive.window.findChild(CharacterGallery)
    yield drive, dialog
    for left in drive.window.findChildren(CharacterGallery):
        left.close()
    QSettings().remove("character")


def names(dialog):
    return [dialog.list.item(n).text() for n in range(dialog.list.count())]


def click(dialog, name):
    item = dialog.list.item(names(dialog).index(name))
    QTest.mouseClick(
        dialog.list.viewport(),
        Qt.MouseButton.LeftButton,
        pos=dialog.list.visualItemRect(item).center(),
    )


def shown(drive):
    return drive.shell.stage.figures.figure(drive.document.project.skeleton)


def test_a_click_and_use_draw_the_project_with_ada_and_undo_takes_her_back(gallery):
    drive, dialog = gallery
    assert names(dialog)[:3] == ["Ada", "Ben", "Default body"]
    assert dialog.list.currentItem().text() == "Default body", "as it is drawn now"
    before = drive.document.project.character
    click(dialog, "Ada")
    assert dialog.use.isEnabled()
    QTest.mouseClick(dialog.use, Qt.MouseButton.LeftButton)
    drive.wait(lambda: drive.document.project.character is not None)
    assert Path(drive.document.project.character).name == "ada.glb"
    drive.document.undo()
    assert drive.document.project.character == before


@pytest.mark.nightly
def test_return_uses_what_is_chosen_and_the_default_body_is_one_of_them(gallery):
    drive, dialog = gallery
    click(dialog, "Ben")
    QTest.keyClick(dialog.list, Qt.Key.Key_Return)
    drive.wait(lambda: drive.document.project.character is not None)
    drive.wait(lambda: isinstance(shown(drive), (SkinnedFigure, DefaultBody)))
    drive.do("character")
    again = drive.window.findChildren(CharacterGallery)[-1]
    assert again.list.currentItem().text() == "Ben", "the one that is drawn"
    click(again, "Default body")
    QTest.mouseClick(again.use, Qt.MouseButton.LeftButton)
    assert drive.document.project.character is None


def test_a_file_that_holds_no_character_says_why_and_cannot_be_used(gallery, tmp_path, monkeypatch):
    _, dialog = gallery
    file = tmp_path / "nobody.glb"
    file.write_bytes(b"nothing")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *a, **k: (str(file), ""))
    drive, _ = gallery
    QTest.mouseClick(dialog.from_file, Qt.MouseButton.LeftButton)
    assert dialog.list.currentItem().text() == "nobody"
    drive.wait(lambda: not dialog.use.isEnabled(), 60)
    assert "nobody.glb" in dialog.said.text()


def test_files_chosen_lately_are_listed_until_they_are_gone(qapp, tmp_path):
    files = [tmp_path / f"{n}.glb" for n in range(MOST + 2)]
    for file in files:
        file.write_bytes(b"")
        remember_character(file)
    assert list_recent() == files[:1:-1]
    remember_character(files[3])
    assert list_recent()[0] == files[3] and len(list_recent()) == MOST
    files[3].unlink()
    assert files[3] not in list_recent()
    QSettings().remove("character")


@pytest.mark.nightly
def test_each_character_is_drawn_in_the_pose_of_the_clips():
    files = [*OURS.values(), None]
    portraits = character_portraits.draw_portraits(files, None, "dark", None)
    assert [p.refused for p in portraits] == ["", "", ""]
    for portrait in portraits:
        assert portrait.picture.shape[0] == portrait.picture.shape[1] > 100
        assert 0.1 < (portrait.picture[..., 3] > 0).mean() < 0.6


def test_our_characters_are_there():
    assert all(file.is_file() for file in OURS.values())


def test_a_character_that_is_dropped_by_itself_is_drawn_and_undo_takes_it_back(toys):
    drive = toys
    before = drive.document.project.character
    drive.importing.import_paths([str(OURS["Ben"])])
    drive.wait(lambda: drive.document.project.character != before, 60)
    assert Path(drive.document.project.character).name == "ben.glb"
    drive.document.undo()
    assert drive.document.project.character == before
