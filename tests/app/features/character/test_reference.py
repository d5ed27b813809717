"""A reference video beside the character or behind it, at the playhead's time and an offset."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

from app.features.character.reference import ReferencePicture
from preview.video import write_video

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def video(tmp_path):
    write_video(tmp_path / "ref.mp4", [np.full((48, 64, 3), 5 * n, np.uint8) for n in range(50)], 10)
    return tmp_path / "ref.mp4"


@pytest.fixture
def shown(toys, video, monkeypatch):
    toys.session.transport.set_playing(False)
    toys.session.transport.seek(1.05)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(video), ""))
    modifiers = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
    toys.key(Qt.Key.Key_R, modifiers)
    toys.wait(lambda: shade(toys) == 10)
    yield toys
    toys.preview.reference.close()
    toys.preview.reference.set_behind(False)


def shade(drive):
    picture = drive.preview.reference.picture
    return round(float(picture.mean()) / 5) if picture is not None else None


def test_its_picture_is_that_of_the_playhead_whichever_way_that_goes(shown):
    for seconds, wanted in ((3.02, 30), (0.5, 5), (20.0, 49)):
        shown.session.transport.seek(seconds)
        shown.wait(lambda wanted=wanted: shade(shown) == wanted)


def test_its_offset_is_typed_and_dragged(shown):
    bar = shown.preview.reference_bar
    bar.offset.setFocus()
    bar.offset.selectAll()
    QTest.keyClicks(bar.offset, "2")
    QTest.keyClick(bar.offset, Qt.Key.Key_Return)
    shown.wait(lambda: shade(shown) == 30)
    assert bar.offset.value() == 2.0
    (picture,) = shown.preview.findChildren(ReferencePicture)
    middle = picture.rect().center()
    QTest.mousePress(picture, Qt.MouseButton.LeftButton, pos=middle)
    QTest.mouseMove(picture, middle - QPoint(50, 0))
    QTest.mouseRelease(picture, Qt.MouseButton.LeftButton, pos=middle - QPoint(50, 0))
    assert shown.preview.reference.offset == pytest.approx(1.5) and bar.offset.value() == 1.5
    shown.wait(lambda: shade(shown) == 25)


def test_it_stands_behind_the_character_where_that_is_chosen(shown):
    panel = shown.preview
    (beside,) = panel.findChildren(ReferencePicture)
    assert beside.isVisible() and panel.scene().picture is None
    panel.reference_bar.place.setCurrentIndex(1)
    panel.reference_bar.place.activated.emit(1)
    assert beside.isHidden() and panel.scene().picture is panel.reference.picture
    shown.do("no_reference")
    assert panel.scene().picture is None and panel.reference_bar.isHidden()


def test_one_that_is_missing_or_broken_says_so_and_what_to_do(shown, tmp_path):
    reference = shown.preview.reference
    reference.choose(tmp_path / "gone.mp4")
    assert reference.picture is None and "gone.mp4" in reference.trouble
    (tmp_path / "broken.mp4").write_bytes(b"nothing")
    reference.choose(tmp_path / "broken.mp4")
    shown.wait(lambda: "Convert it to MP4" in reference.trouble)


def test_it_is_there_again_with_the_project(shown, video, tmp_path):
    reference = shown.preview.reference
    reference.close()
    shown.document.save(tmp_path / "p.metagraph.yaml")
    reference.choose(video)
    reference.set_offset(0.5)
    project = shown.document.project
    shown.document.load(project, None)
    assert reference.path is None
    shown.document.load(project, tmp_path / "p.metagraph.yaml")
    assert (reference.path, reference.offset) == (video, 0.5)
