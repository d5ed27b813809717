"""`metagraph mimic`: what is seen in keypoints, and the character doing as they do."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.parser import main
from metagraph.formats.clips import read_clips
from metagraph.formats.store import open_project, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.requests import Performance

ROOT = Path(__file__).resolve().parents[3]
KEYPOINTS = ROOT / "sample_clips" / "keypoints"
FLAT, DEEP = KEYPOINTS / "conversation.openpose.json", KEYPOINTS / "conversation.mediapipe.jsonl"


@pytest.fixture(scope="module")
def stances(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of the sample project with its stances and transitions alone: nobody mimics with more."""
    path = tmp_path_factory.mktemp("stances") / "talk.metagraph.yaml"
    whole = read_project(ROOT / "sample_clips" / "sample.metagraph.yaml")
    used = {x.clip for x in whole.actions() if x.kind in ("stance", "transition")}
    save_project(edits.remove_clips(whole, [i for i in whole.clips if i not in used]), path, None)
    return path


@pytest.fixture
def project(stances: Path, tmp_path: Path) -> Path:
    path = tmp_path / "talk.metagraph.yaml"
    shutil.copy(stances, path)
    for folder in ("clips", "lines"):
        (tmp_path / folder).symlink_to(ROOT / "sample_clips" / folder)
    shutil.copy(ROOT / "sample_clips" / "ada.glb", tmp_path)
    return path


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, Any, str]:
    code = main(["mimic", *map(str, words), "--json"])
    said = capsys.readouterr()
    return code, json.loads(said.out), said.err


def test_what_is_seen_is_listed_with_when_the_character_goes_there(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, data, _ = run(capsys, project, DEEP, "--no-mirror")
    assert code == 0 and data["frames"] == 200 and data["dimensions"] == 3 and data["mirrored"] is False
    rows = [(row["layer"], row["name"]) for row in data["seen"]]
    assert rows.index(("arms", "on hips")) < rows.index(("arms", "arms crossed"))
    assert ("body", "weight left") in rows and ("body", "weight right") in rows
    row = next(row for row in data["seen"] if row["name"] == "on hips")
    assert 6.5 < row["at"] < 8.0 and row["at"] < row["goes"] < row["there"]


@pytest.mark.nightly
def test_it_mirrors_unless_told_not_to(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sides = [
        [row["name"] for row in run(capsys, project, DEEP, *words)[1]["seen"] if row["layer"] == "body"]
        for words in ((), ("--no-mirror",))
    ]
    swapped = [name.replace("left", "*").replace("right", "left").replace("*", "right") for name in sides[1]]
    assert sides[0] == swapped and "weight left" in sides[0]


@pytest.mark.nightly
def test_in_words_it_says_the_same(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["mimic", str(project), str(DEEP)]) == 0
    text = capsys.readouterr().out
    assert "200 frames" in text and "19.9 s" in text
    assert "weight both          is there already" in text and "on hips              goes there" in text


def test_only_layers_that_are_wanted_mimic(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, data, _ = run(capsys, project, DEEP, "--layer", "arms")
    assert {row["layer"] for row in data["seen"]} == {"arms"}


def test_it_is_kept_as_a_performance_of_the_project(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, data, _ = run(capsys, project, DEEP, "--keep", "as filmed", "--seed", "9")
    assert code == 0 and data["written"] == [str(project)]
    kept = next(p for p in open_project(project).project.performances.values() if p.name == "as filmed")
    assert (
        len(kept.asks) == len(data["seen"])
        and kept.seed == 9
        and kept.idle
        and kept.length == pytest.approx(21.9)
    )
    assert all(ask.at is not None and ask.told is not None for ask in kept.asks)


def test_the_requests_are_written_as_a_performance(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import msgspec

    out = tmp_path / "out" / "asks.json"
    assert run(capsys, project, DEEP, "--gaze", "-o", out)[0] == 0
    kept = msgspec.json.decode(out.read_bytes(), type=Performance)
    assert {ask.__struct_config__.tag for ask in kept.asks} == {"stance", "look"}


@pytest.mark.nightly
def test_plain_motion_is_written(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from metagraph.formats.bvh.file import read_bvh

    out = tmp_path / "show.bvh"
    assert run(capsys, project, DEEP, "-o", out)[1]["written"] == [str(out)]
    assert read_bvh(out).duration == pytest.approx(21.9, abs=0.1)


@pytest.mark.nightly
@pytest.mark.gl
def test_the_persons_own_motion_becomes_a_take(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "takes" / "seen.bvh"
    code, data, _ = run(capsys, project, DEEP, "--no-mirror", "--take", out)
    clip = read_clips(out)[0]
    assert code == 0 and str(out) in data["written"]
    assert clip.duration == pytest.approx(data["seconds"], abs=0.2)
    left, right = tmp_path / "l.glb", tmp_path / "r.glb"
    run(capsys, project, DEEP, "--no-mirror", "--take", left)
    run(capsys, project, DEEP, "--take", right)  # as in a mirror
    turns = [read_clips(path)[0].rotations for path in (left, right)]
    assert np.abs(turns[0] - turns[1]).max() > 0.1


@pytest.mark.nightly
def test_flat_keypoints_make_no_take_and_it_says_what_would(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["mimic", str(project), str(FLAT), "--take", str(tmp_path / "x.bvh")]) == 1
    assert "no depth" in capsys.readouterr().err and not (tmp_path / "x.bvh").exists()


@pytest.mark.nightly
def test_a_contact_sheet_is_drawn(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "sheet.png"
    assert run(capsys, project, DEEP, "-o", out, "--size", "96x64")[0] == 0
    assert out.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "show.gif"], "the file can be .mp4, .png, .glb, .usda, .bvh, .json, not '.gif'"),
        (["--fps", "0"], "frames a second"),
        (["--picture", "wide"], "give --size as 960x540"),
    ],
)
def test_what_cannot_be_is_refused(
    project: Path, words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, data, _ = run(capsys, project, DEEP, *words)
    assert code == 1 and message in data["error"]


def test_a_file_that_holds_no_keypoints_says_so(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "none.json"
    path.write_text('{"cats": 2}')
    code, data, _ = run(capsys, project, path)
    assert code == 1 and "none.json, frame 0" in data["error"] and "cats" in data["error"]


def test_whoever_is_in_no_stance_is_told_of_by_the_exit_code(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "lying.json"
    lying = [[n * 20.0 + 1, 300.0, 0.9] for n in range(17)]
    path.write_text(json.dumps([{"keypoints": lying}] * 40))
    code, data, err = run(capsys, project, path)
    assert code == 3 and data["seen"] == [] and "30 frames a second were assumed" in err


def test_nobody_is_recorded_in_a_project_without_clips(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "empty.metagraph.yaml"
    from metagraph.formats.store import save_project
    from metagraph.graph.model import Project

    save_project(Project("empty"), path, None)
    code, data, _ = run(capsys, path, FLAT)
    assert code == 1 and "no clips" in data["error"]
