"""Cameras: how systems call them, and what is said where there is none."""

from __future__ import annotations

import time
from contextlib import closing
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.filmed.camera import CameraError, CameraFeed, name_device
from tests.films import make_film


def test_each_system_has_its_own_way_to_name_a_camera() -> None:
    assert name_device("0", "linux")[:2] == ("/dev/video0", "v4l2")
    assert name_device("/dev/video2", "linux")[0] == "/dev/video2"
    assert name_device("1", "darwin")[:2] == ("1", "avfoundation")
    assert name_device("Integrated Camera", "win32")[:2] == ("video=Integrated Camera", "dshow")


def test_a_camera_that_is_not_there_says_what_to_check() -> None:
    with pytest.raises(CameraError, match=r"camera /dev/video98 cannot be opened.*plugged in"):
        CameraFeed("/dev/video98")


def test_whoever_is_slow_gets_the_newest_picture(tmp_path: Path) -> None:
    film = make_film(tmp_path / "a.mp4", [n / 20 for n in range(20)])
    with closing(CameraFeed(str(film))) as camera:
        found = []
        for picture in camera.read():
            found.append(picture.seconds)
            time.sleep(0.2)
    assert len(found) < 10 and found == sorted(found)


def test_a_camera_can_be_closed_while_it_is_read(tmp_path: Path) -> None:
    film = make_film(tmp_path / "a.mp4", [n / 20 for n in range(200)])
    camera = CameraFeed(str(film))
    pictures = camera.read()
    next(pictures)
    camera.close()
    assert len(list(pictures)) <= 1


def test_a_file_that_is_no_video_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.mp4").write_bytes(b"nothing")
    with pytest.raises(FileError, match="not a video"):
        CameraFeed(str(tmp_path / "a.mp4"))
