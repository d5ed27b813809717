"""A project that is dropped on the window opens in it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QMimeData, QPoint, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent
from PySide6.QtWidgets import QApplication

from metagraph.formats.store import save_project

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def saved(toy, tmp_path):
    path = tmp_path / "Мой проект.metagraph.yaml"
    save_project(toy.project(), path)
    return path


def test_it_opens_wherever_it_is_dropped(drive, saved):
    library = drive.library.list.viewport()
    for place in (drive.middle(), (library, library.rect().center()), (drive.window, QPoint(5, 5))):
        drive.files.new()
        assert drive.drop_files(place, saved)
        drive.wait(lambda: drive.document.path == saved)


def test_the_frame_says_open_for_a_project_and_import_for_clips(drive, saved):
    shown, window = [], drive.window
    for name in (str(saved), str(saved.parent)):
        data = QMimeData()
        data.setUrls([QUrl.fromLocalFile(name)])
        more = Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
        QApplication.sendEvent(window, QDragEnterEvent(QPoint(5, 5), *more))
        assert window.drop_frame.isVisible()
        shown.append(window.drop_frame.words)
        QApplication.sendEvent(window, QDragLeaveEvent())
    assert shown == ["Drop to open", "Drop to import"]


def test_with_other_files_it_is_refused_in_words_and_nothing_changes(drive, saved, tmp_path):
    told, before = [], drive.document.project
    drive.files.told.connect(told.append)
    clip = tmp_path / "wave.bvh"
    clip.write_text("HIERARCHY")
    drive.drop_files((drive.window, QPoint(5, 5)), saved, clip)
    drive.pause(50)
    assert told == ["A project opens alone. Drop the other files after it."]
    assert drive.document.project is before and drive.document.path is None
