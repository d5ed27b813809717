"""Videos are read the way up and at the times that players show; what is none says so."""

from __future__ import annotations

import struct
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.filmed.video import LARGEST, VideoFile, is_video
from tests.films import make_film


def read(path: Path) -> tuple[VideoFile, list[float], list[np.ndarray]]:
    with closing(VideoFile(path)) as video:
        found = list(video.read())
    return video, [round(f.seconds, 3) for f in found], [f.picture for f in found]


def turn(path: Path, matrix: tuple[int, int, int, int]) -> None:
    """Have players turn an MP4: the first four numbers of its track's matrix, by rows."""
    data = bytearray(path.read_bytes())
    at = data.index(b"tkhd") + 4 + 4 + 20 + 8 + 2 + 2 + 2 + 2
    a, b, c, d = (n << 16 for n in matrix)
    data[at : at + 36] = struct.pack(">9i", a, b, 0, c, d, 0, 0, 0, 1 << 30)
    path.write_bytes(data)


def test_pictures_have_the_times_of_the_file_though_they_come_unevenly(tmp_path: Path) -> None:
    times = [0.0, 0.1, 0.4, 0.45, 1.2, 2.0]
    video, found, pictures = read(make_film(tmp_path / "a.mp4", times))
    assert found == times and not video.broken and not video.has_sound
    assert pictures[0].shape == (32, 64, 3) and pictures[0][4, 4].min() > 200 > 50 > pictures[0][28, 60].max()


def test_of_fast_pictures_thirty_a_second_are_read(tmp_path: Path) -> None:
    video, found, _ = read(make_film(tmp_path / "a.mp4", [n / 120 for n in range(120)]))
    assert 28 <= len(found) <= 31 and video.left_out == 120 - len(found)
    assert min(np.diff(found)) > 0.029


@pytest.mark.parametrize(
    ("matrix", "bright"),
    [((0, 1, -1, 0), (4, 28)), ((-1, 0, 0, -1), (28, 60)), ((0, -1, 1, 0), (60, 4))],
    ids=["a quarter to the right", "upside down", "a quarter to the left"],
)
def test_a_film_of_a_turned_phone_is_turned_upright(
    tmp_path: Path, matrix: tuple[int, int, int, int], bright: tuple[int, int]
) -> None:
    path = make_film(tmp_path / "a.mp4", [0.0, 0.1])
    turn(path, matrix)
    picture = read(path)[2][0]
    assert picture.shape == ((64, 32, 3) if matrix[0] == 0 else (32, 64, 3))
    assert picture[bright].min() > 200 and picture[4, 4].max() < 50


def test_large_pictures_are_made_smaller(tmp_path: Path) -> None:
    pictures = read(make_film(tmp_path / "a.mp4", [0.0], size=(1920, 1080)))[2]
    assert pictures[0].shape == (540, LARGEST, 3)


def test_sound_is_noticed(tmp_path: Path) -> None:
    assert read(make_film(tmp_path / "a.mp4", [0.0, 0.5], sound=True))[0].has_sound


def test_a_film_of_one_picture_has_it(tmp_path: Path) -> None:
    assert read(make_film(tmp_path / "a.mp4", [0.0]))[1] == [0.0]


def test_a_film_that_breaks_off_gives_what_it_has(tmp_path: Path) -> None:
    whole = make_film(tmp_path / "a.mkv", [n / 20 for n in range(200)], size=(640, 480))
    cut = tmp_path / "cut.mkv"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    _, found, _ = read(cut)
    assert 0 < len(found) < 200


@pytest.mark.parametrize("content", [b"", b"no film at all" * 100, b"\0\0\0\x18ftypmp42\0\0\0\0mp42isom"])
def test_what_is_no_video_says_so_and_what_to_do(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.mp4"
    path.write_bytes(content)
    with pytest.raises(FileError, match=r"not a video that can be read.*Convert it to MP4"):
        read(path)


def test_an_mp4_without_its_end_is_refused(tmp_path: Path) -> None:
    path = make_film(tmp_path / "a.mp4", [n / 20 for n in range(100)])
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(FileError, match="not a video that can be read"):
        read(path)


def test_a_file_with_sound_alone_has_no_pictures(tmp_path: Path) -> None:
    import av

    with av.open(str(tmp_path / "a.mp4"), "w") as container:
        heard = container.add_stream("aac", rate=8000, layout="mono")
        silence = av.AudioFrame.from_ndarray(np.zeros((1, 8000), np.float32), "fltp", "mono")
        silence.sample_rate = 8000
        container.mux(heard.encode(silence))
        container.mux(heard.encode())
    with pytest.raises(FileError, match=r"it has no pictures.*Choose a video of a person"):
        read(tmp_path / "a.mp4")


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read(tmp_path / "none.mp4")
    with pytest.raises(FileError, match="directory"):
        read(tmp_path)


def test_videos_are_known_by_their_endings() -> None:
    assert is_video("talk.MP4") and is_video(Path("a.webm")) and not is_video("talk.jsonl")
