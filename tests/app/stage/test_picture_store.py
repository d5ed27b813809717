"""Pictures on disk: found by what they show, bounded, and never in the way when they are broken."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtGui import QColor, QImage

from app.stage.kept_pictures import KeptPictures
from app.stage.picture_process import PictureOrder
from app.stage.picture_store import PictureStore, make_picture_key


@pytest.fixture
def order(toy):
    return PictureOrder(1, toy.clip("wave"), "bare", "dark", None, None)


def square(color: str, side: int = 8) -> QImage:
    out = QImage(side, side, QImage.Format.Format_RGBA8888)
    out.fill(QColor(color))
    return out


def noise(side: int, seed: int) -> QImage:
    data = np.random.default_rng(seed).integers(0, 255, (side, side, 4), np.uint8)
    return QImage(data.tobytes(), side, side, QImage.Format.Format_RGBA8888).copy()


def test_a_picture_is_found_by_what_it_shows(toy, order):
    same = replace(order, number=7)
    assert make_picture_key(same) == make_picture_key(order)
    turned = replace(order.clip, rotations=order.clip.rotations[:, ::-1].copy())
    for other in (
        replace(order, clip=turned),
        replace(order, what="scrub"),
        replace(order, theme="light"),
        replace(order, hidden=("hat",)),
        replace(order, paper=(1, 1, 1)),
    ):
        assert make_picture_key(other) != make_picture_key(order)


def test_a_character_whose_file_was_changed_is_another(order, tmp_path):
    path = tmp_path / "ada.glb"
    path.write_bytes(b"one")
    first = make_picture_key(replace(order, character=path))
    path.write_bytes(b"other")
    assert make_picture_key(replace(order, character=path)) != first
    path.unlink()
    assert make_picture_key(replace(order, character=path)) != first


def test_stills_and_strips_come_back_as_they_were_kept(tmp_path):
    store = PictureStore(tmp_path / "made")
    assert store.load("ab12") is None
    some = [noise(8, 1), noise(8, 2), noise(8, 3)]
    store.keep("ab12", some)
    store.keep("cd34", some[:1])
    back = store.load("ab12")
    assert back is not None and len(back) == 3 and len(store.load("cd34")) == 1
    for one, other in zip(back, some, strict=True):
        assert one.convertToFormat(other.format()) == other


@pytest.mark.parametrize("junk", [b"", b"\x89PNG\r\n", b"words" * 100])
def test_a_broken_file_is_ignored_and_taken_away(tmp_path, junk):
    store = PictureStore(tmp_path)
    store.keep("ab12", [square("red")])
    path = next(tmp_path.rglob("*.png"))
    path.write_bytes(junk)
    assert store.load("ab12") is None and not path.exists()


def test_what_was_not_looked_at_for_longest_goes(tmp_path):
    store = PictureStore(tmp_path)
    for n in range(4):
        store.keep(f"{n}{n}xx", [noise(16, n)])
    paths = {p.parent.name: p for p in tmp_path.rglob("*.png")}
    for age, name in enumerate(("00", "11", "22", "33")):
        os.utime(paths[name], (1000 + age, 1000 + age))
    assert store.load("00xx") is not None, "looked at: the second is the oldest now"
    size = paths["00"].stat().st_size
    PictureStore(tmp_path, most=4 * size).keep("44xx", [noise(16, 9)])
    left = {p.parent.name for p in tmp_path.rglob("*.png")}
    assert left == {"00", "33", "44"}


def test_a_disk_that_refuses_keeps_nothing_and_says_nothing(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    store = PictureStore(blocked)
    store.keep("ab12", [square("red")])
    assert store.load("ab12") is None


def test_what_was_drawn_once_is_found_the_next_time(qapp, qtbot, order, tmp_path):
    first, second = KeptPictures(), KeptPictures()
    with qtbot.waitSignal(first.missing, timeout=5000) as told:
        first.ask(order)
    assert told.args == [order]
    first.keep(order.number, [square("blue")])
    qtbot.waitUntil(lambda: any((tmp_path / "cache").rglob("*.png")), timeout=5000)
    with qtbot.waitSignal(second.found, timeout=5000) as told:
        second.ask(order)
    assert told.args[0] == order.number and len(told.args[1]) == 1
    first.stop()
    second.stop()
