"""A video becomes the keypoints of a person, by a process that looks at its pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.filmed.estimator import EstimatorError, EstimatorMissingError
from metagraph.formats.filmed.film import (
    FilmStoppedError,
    film_camera,
    film_video,
    write_filmed_keypoints,
)
from metagraph.formats.keypoints.reader import read_keypoints
from tests.films import install_stand_in, make_film, remove_stand_in

TIMES = [n / 20 for n in range(40)]


@pytest.fixture
def extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return install_stand_in(tmp_path / "home", monkeypatch)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return make_film(tmp_path / "a.mp4", TIMES)


def test_keypoints_have_the_times_of_pictures_and_come_in_space_and_in_the_picture(
    extra: Path, path: Path
) -> None:
    told: list[tuple[int, int]] = []
    filmed = film_video(path, lambda done, total: told.append((done, total)))
    track = filmed.track
    assert track.times.tolist() == pytest.approx(TIMES) and track.dims == 3 and len(track.names) == 33
    assert track.flat is not None and track.flat.dims == 2 and np.ptp(track.flat.points[..., 0]) > 20
    assert track.notes == ("found by Stand-in 1",)
    assert told[-1] == (40, 40) and [done for done, _ in told[:-1]] == list(range(1, 41))


def test_what_was_found_is_written_and_read_again_the_same(extra: Path, path: Path, tmp_path: Path) -> None:
    filmed = film_video(path)
    write_filmed_keypoints(filmed, tmp_path / "a.jsonl")
    again = read_keypoints(tmp_path / "a.jsonl")
    for one, other in ((filmed.track, again), (filmed.track.flat, again.flat)):
        assert one is not None and other is not None
        np.testing.assert_array_equal(one.points, other.points)
        np.testing.assert_array_equal(one.times, other.times)


def test_pictures_without_anybody_are_said_and_a_film_without_anybody_is_refused(
    extra: Path, tmp_path: Path
) -> None:
    some = film_video(make_film(tmp_path / "some.mp4", TIMES, dark=range(10), sound=True))
    assert "its sound is not used" in some.track.notes
    assert "nobody was found in 10 of its 40 pictures" in some.track.notes
    assert (some.track.confidence[:10] == 0).all() and (some.track.confidence[10:] > 0).any()
    with pytest.raises(FileError, match=r"none.mp4, 40 pictures: nobody was found in it.*Film one person"):
        film_video(make_film(tmp_path / "none.mp4", TIMES, dark=range(40)))


def test_a_film_that_breaks_off_says_until_when_it_was_used(extra: Path, tmp_path: Path) -> None:
    times = [0.0, 0.1, 0.2, 40000.0, 40000.1]
    filmed = film_video(make_film(tmp_path / "a.mkv", times))
    assert len(filmed.frames) == 3
    assert any(note.startswith("it breaks off after 0.2 s") for note in filmed.track.notes)


def test_it_can_be_stopped(extra: Path, path: Path) -> None:
    told: list[int] = []
    with pytest.raises(FilmStoppedError):
        film_video(path, lambda done, total: told.append(done), lambda: len(told) >= 3)
    assert told == [1, 2, 3]


def test_without_the_extra_the_message_says_what_to_install(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    remove_stand_in(tmp_path, monkeypatch)
    with pytest.raises(EstimatorMissingError, match=r"Apache-2.0.*metagraph extras add camera.*keypoints of"):
        film_video(path)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("broken", "does not run here: libEGL.so.1: cannot open"),
        ("dies", "stopped by itself"),
        ("babbles", "stopped by itself"),
    ],
)
def test_an_estimator_that_fails_is_reported_with_a_remedy(
    extra: Path, path: Path, how: str, words: str
) -> None:
    (extra / how).touch()
    with pytest.raises(EstimatorError, match=words):
        film_video(path)


def test_a_film_in_the_place_of_a_camera_is_played_in_real_time_until_it_ends(
    extra: Path, tmp_path: Path
) -> None:
    filmed = film_camera(str(make_film(tmp_path / "a.mp4", [n / 20 for n in range(12)])))
    assert filmed.track.times[0] == 0.0 and 0.3 < filmed.track.seconds < 0.6
    assert filmed.track.flat is not None


def test_a_camera_films_as_long_as_it_is_told(extra: Path, path: Path) -> None:
    told: list[float] = []
    assert film_camera(str(path), 0.5, told.append).track.seconds <= 0.5
    assert told and max(told) <= 0.5
    stopped = film_camera(str(path), None, told.append, lambda: len(told) > 12)
    assert len(stopped.frames) < 40
