"""`metagraph mimic` with a video or a camera."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest

from app.cli import filmed_keypoints
from app.cli.parser import main
from metagraph.common import extra_steps
from metagraph.formats.clips import read_clips
from tests.films import install_stand_in, make_film, remove_stand_in

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"


@pytest.fixture
def film(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    install_stand_in(tmp_path / "home", monkeypatch)
    return make_film(tmp_path / "talk.mp4", [n / 10 for n in range(100)], sound=True)


def test_a_video_is_mimicked_and_its_keypoints_and_its_take_are_written(
    film: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    saved, take = tmp_path / "talk.jsonl", tmp_path / "talk.bvh"
    words = ["--save-keypoints", str(saved), "--take", str(take), "--no-mirror", "--json"]
    assert main(["mimic", str(SAMPLE), str(film), *words]) == 0
    said = json.loads(capsys.readouterr().out)
    assert "on hips" in {row["name"] for row in said["seen"]}
    assert said["dimensions"] == 2, "stances are looked for in the picture, as the window says"
    assert said["frames"] == 100 and said["seconds"] == 9.9 and "its sound is not used" in said["notes"]
    assert read_clips(take)[0].frames > 90
    assert main(["mimic", str(SAMPLE), str(saved), "--no-mirror", "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["seen"] == said["seen"]


def test_a_camera_is_mimicked(film: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["mimic", str(SAMPLE), "--camera", str(film), "--seconds", "1.5", "--json"])
    said = json.loads(capsys.readouterr().out)
    assert code == 0 and said["keypoints"] == f"camera {film}" and 1.0 < said["seconds"] <= 1.5


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ([], "one of them"),
        (["talk.mp4", "--camera"], "one of them"),
        (["talk.mp4", "--seconds", "3"], "give --camera, too"),
        (["--camera", "--seconds", "0"], "more than 0"),
        (["talk.json", "--save-keypoints", "a.jsonl"], "for a video or a camera"),
    ],
)
def test_options_that_exclude_each_other_are_refused(
    words: list[str], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["mimic", str(SAMPLE), *words]) != 0
    assert why in capsys.readouterr().err


def test_without_mediapipe_a_script_is_told_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    remove_stand_in(tmp_path, monkeypatch)
    path = make_film(tmp_path / "talk.mp4", [0.0, 0.1])
    assert main(["mimic", str(SAMPLE), str(path)]) != 0
    assert "metagraph extras add camera" in capsys.readouterr().err


def test_what_is_no_video_is_refused_before_anything_is_installed_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    remove_stand_in(tmp_path, monkeypatch)
    assert main(["mimic", str(SAMPLE), str(tmp_path / "none.mp4")]) != 0
    (tmp_path / "talk.mp4").write_bytes(b"not a film")
    assert main(["mimic", str(SAMPLE), str(tmp_path / "talk.mp4")]) != 0
    said = capsys.readouterr().err
    assert "none.mp4" in said and "not a video that can be read" in said and "extras" not in said


@pytest.mark.parametrize("answer", ["y", "n"])
def test_at_a_terminal_somebody_is_asked_before_it_is_installed(
    answer: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    remove_stand_in(tmp_path, monkeypatch)
    path = make_film(tmp_path / "talk.mp4", [7.5 + n / 10 for n in range(30)])

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(sys, "stdin", Terminal(answer + "\n"))
    assert not hasattr(filmed_keypoints, "install_extra"), "it is imported when it is needed"
    monkeypatch.setattr(extra_steps, "install_extra", lambda name: install_stand_in(tmp_path, monkeypatch))
    code = main(["mimic", str(SAMPLE), str(path), "--no-mirror"])
    said = capsys.readouterr()
    assert "Install it? [y/N]" in said.out and "150 MB" in said.out
    assert (code == 0) == (answer == "y")
    assert answer == "n" or "on hips" in said.out
