"""Videos read back: the picture that is shown at a time, whatever the file's rate and shape."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from metagraph.errors import FileError
from preview.video import write_video
from preview.video_reading import VideoPictures, measure_video_seconds, read_pictures, read_video_sound


def grey(count: int, size: tuple[int, int] = (64, 64)) -> list[np.ndarray]:
    return [np.full((size[1], size[0], 3), 20 * n, np.uint8) for n in range(count)]


def shades(path: Path, times: list[float], size: tuple[int, int] = (64, 64)) -> list[int]:
    return [round(float(p.mean()) / 20) for p in read_pictures(path, np.array(times), size)]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    write_video(tmp_path / "a.mp4", grey(10), 10)
    return tmp_path / "a.mp4"


def test_each_time_has_the_picture_that_is_shown_then(path: Path) -> None:
    assert measure_video_seconds(path) == pytest.approx(1.0, abs=0.01)
    assert shades(path, [0.0, 0.05, 0.1, 0.55, 0.9]) == [0, 0, 1, 5, 9]
    assert shades(path, [k / 30 for k in range(30)]) == [k // 3 for k in range(30)]
    assert shades(path, [0.5]) == [5] and shades(path, [0.7, 0.7, 0.7]) == [7, 7, 7]


def test_beyond_its_end_is_an_error_that_says_where(path: Path) -> None:
    with pytest.raises(FileError, match=r"1\.50 s"):
        shades(path, [0.5, 1.0, 1.5])


def test_another_shape_is_fitted_and_not_stretched(tmp_path: Path) -> None:
    write_video(tmp_path / "w.mp4", [np.full((32, 96, 3), 200, np.uint8)] * 3, 10)
    (picture,) = read_pictures(tmp_path / "w.mp4", np.array([0.0]), (64, 64))
    assert picture.shape == (64, 64, 3) and picture[:20].max() < 10 and picture[28:36].min() > 180


def test_sound_is_read_at_the_rate_that_is_asked_for_and_may_be_missing(path: Path, tmp_path: Path) -> None:
    assert read_video_sound(path, 44100) is None
    tone = (0.5 * np.sin(np.arange(44100) * 0.06)).astype(np.float32)
    write_video(tmp_path / "s.mp4", grey(10), 10, sound=(tone, 44100))
    found = read_video_sound(tmp_path / "s.mp4", 22050)
    assert (
        found is not None and abs(len(found) - 22050) < 2500 and 0.4 < np.abs(found[4000:18000]).max() < 0.6
    )


def test_what_is_no_video_is_told(tmp_path: Path) -> None:
    (tmp_path / "x.mp4").write_bytes(b"no video" * 100)
    for read in (measure_video_seconds, lambda p: shades(p, [0.0]), lambda p: read_video_sound(p, 44100)):
        with pytest.raises(FileError) as told:
            read(tmp_path / "x.mp4")
        assert told.value.remedy
    with pytest.raises(FileError):
        measure_video_seconds(tmp_path / "none.mp4")


def test_a_video_is_asked_at_any_time_forwards_and_backwards(tmp_path: Path) -> None:
    write_video(tmp_path / "long.mp4", [np.full((64, 64, 3), 5 * n, np.uint8) for n in range(50)], 10)
    video = VideoPictures(tmp_path / "long.mp4")
    try:
        assert video.seconds == pytest.approx(5.0, abs=0.05) and video.size == (64, 64)
        for at, shown in ((0.0, 0), (0.31, 3), (4.02, 40), (1.25, 12), (1.24, 12), (9.0, 49), (-3.0, 0)):
            assert round(float(video.at(at).mean()) / 5) == shown, at
        assert video.at(2.01) is video.at(2.05), "one picture is made once"
    finally:
        video.close()


def test_a_large_video_comes_smaller_and_a_picture_is_a_video_that_stands(tmp_path: Path) -> None:
    write_video(tmp_path / "wide.mp4", grey(3, (640, 160)), 10)
    video = VideoPictures(tmp_path / "wide.mp4", (320, 320))
    assert video.at(0.1).shape == (80, 320, 3)
    video.close()
    Image.fromarray(np.full((40, 60, 3), 200, np.uint8)).save(tmp_path / "still.png")
    still = VideoPictures(tmp_path / "still.png")
    assert still.at(0.0).shape == (40, 60, 3) and abs(float(still.at(100.0).mean()) - 200) < 4
    still.close()
    (tmp_path / "no.mp4").write_bytes(b"nothing")
    with pytest.raises(FileError, match=r"no\.mp4"):
        VideoPictures(tmp_path / "no.mp4")
