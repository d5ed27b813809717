"""`metagraph label`: a folder of clips becomes a project and a report that says why."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.formats.store import SUFFIX, open_project, read_project
from metagraph.graph.check import check_project
from metagraph.graph.problem import Problem

ROOT = Path(__file__).resolve().parents[3]
CLIPS = ROOT / "sample_clips" / "clips"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Clips of two stances of the arms, and what leads from one to the other."""
    place = tmp_path / "talk"
    place.mkdir()
    ours = ("hands_at_sides__", "on_hips__")
    for path in CLIPS.glob("*.glb"):
        if path.name.startswith(ours) and not any(
            other in path.name for other in ("crossed", "chin", "clasped")
        ):
            shutil.copy(path, place)
    return place


@pytest.mark.gl
def test_a_folder_becomes_a_project_and_a_report(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["label", str(folder), "--play", "10", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    project = open_project(Path(data["project"])).project
    assert (
        data["labelled"] == len(project.clips) == len(list(folder.glob("*.glb")))
        and not data["left"]
        and not data["errors"]
    )
    assert {s.name for s in project.graphs["arms"].stances.values()} == {"hands at sides", "on hips"}
    assert not [p for p in check_project(project) if p.severity == "error"]
    page = Path(data["report"]).read_text()
    stances = sum(len(graph.stances) for graph in project.graphs.values())
    assert page.count("data:image/jpeg") == len(project.clips) + stances
    assert "http" not in re.sub(r"data:[^'\"]*", "", page)  # nothing is fetched from anywhere
    assert "name begins with" in page and "hands at sides" in page


@pytest.mark.nightly
def test_what_is_not_sure_enough_is_left_with_its_reason(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "sure.metagraph.yaml"
    assert (
        main(
            [
                "label",
                str(folder),
                "-o",
                str(out),
                "--above",
                "0.9",
                "--from",
                "motion",
                "--no-pictures",
                "--play",
                "0",
                "--json",
            ]
        )
        == 3
    )
    shown = capsys.readouterr()
    data = json.loads(shown.out)
    assert data["left"] and 0 < data["labelled"] < len(list(folder.glob("*.glb")))
    assert "certain" in shown.err
    assert "<img" not in Path(data["report"]).read_text()


@pytest.mark.nightly
def test_a_project_is_labelled_on_from_where_it_is(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "part.metagraph.yaml"
    main(
        [
            "label",
            str(folder),
            "-o",
            str(out),
            "--above",
            "0.9",
            "--from",
            "motion",
            "--no-pictures",
            "--play",
            "0",
            "--json",
        ]
    )
    first = json.loads(capsys.readouterr().out)["labelled"]
    main(["label", str(out), "--no-pictures", "--play", "0", "--json"])
    second = json.loads(capsys.readouterr().out)
    assert first + second["labelled"] == len(list(folder.glob("*.glb")))


def test_a_stance_that_nothing_leads_to_is_told_as_check_tells_it(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in folder.glob("*__to_*.glb"):
        path.unlink()
    assert main(["label", str(folder), "--no-pictures", "--play", "0", "--no-bridges", "--json"]) == 3
    shown = capsys.readouterr()
    data = json.loads(shown.out)
    assert not data["left"]
    assert [e for e in data["errors"] if "cannot be reached" in e]
    assert "problem: stance " in shown.err and "cannot be reached" in shown.err
    assert "exit code 3: " in shown.err
    assert main(["check", data["project"]]) == 3
    shown = capsys.readouterr()
    assert "cannot be reached" in shown.out and "exit code 3: " in shown.err


@pytest.mark.nightly
def test_such_a_stance_is_reached_by_blending_and_that_is_told(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in folder.glob("*__to_*.glb"):
        path.unlink()
    assert main(["label", str(folder), "--no-pictures", "--play", "0", "--json"]) == 0
    shown = capsys.readouterr()
    data = json.loads(shown.out)
    assert data["bridged"] and not data["errors"]
    assert "bridged: " in shown.err
    assert main(["check", data["project"]]) == 0


@pytest.mark.parametrize("given", ["nothing", "empty"])
def test_a_folder_that_is_not_there_or_empty_is_told(
    tmp_path: Path, given: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "empty").mkdir()
    assert main(["label", str(tmp_path / given)]) == 1
    assert "while labelling it" in (told := capsys.readouterr().err) or "while importing it" in told


def test_names_are_escaped_in_the_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = tmp_path / "odd"
    place.mkdir()
    shutil.copy(next(CLIPS.glob("hands_at_sides__stance.glb")), place / "a & b 'x' idle.glb")
    main(["label", str(place), "--no-pictures", "--play", "0", "--json"])
    page = Path(json.loads(capsys.readouterr().out)["report"]).read_text()
    assert "a & b" not in page


def kinds(path: Path) -> dict[str, str]:
    project = open_project(path).project
    return {project.clips[a.clip].name: a.kind for a in project.actions()}


def test_patterns_of_a_file_are_read_with_and_a_broken_one_is_told(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, team = tmp_path / "team.metagraph.yaml", tmp_path / "team.json"
    team.write_text('{"patterns": 1, "kinds": {"shrug": "fidget"}}')
    main(
        [
            "label",
            str(folder),
            "-o",
            str(out),
            "--from",
            "name",
            "--patterns",
            str(team),
            "--no-pictures",
            "--play",
            "0",
        ]
    )
    assert {kind for name, kind in kinds(out).items() if "shrug" in name} == {"fidget"}
    team.write_text('{"patterns": 1,\n "kinds": }')
    capsys.readouterr()
    assert main(["label", str(folder), "-o", str(out), "--patterns", str(team)]) != 0
    assert "team.json, line 2" in capsys.readouterr().err


def test_what_was_taught_is_used_only_when_asked_for(
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    qapp: object,
) -> None:
    from app.project.learned import Learned

    Learned().edit(lambda p: p.with_pattern("kinds", "shrug", "fidget"))
    out = tmp_path / "taught.metagraph.yaml"
    for options, kind in (([], "gesture"), (["--learned"], "fidget")):
        main(
            [
                "label",
                str(folder),
                "-o",
                str(out),
                "--from",
                "name",
                "--no-pictures",
                "--play",
                "0",
                "--overwrite",
                *options,
            ]
        )
        assert {k for name, k in kinds(out).items() if "shrug" in name} == {kind}


@pytest.mark.nightly
def test_a_stance_that_no_clip_rests_in_is_held_and_told(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in folder.glob("on_hips__stance*"):
        path.unlink()
    out = tmp_path / "held.metagraph.yaml"
    main(["label", str(folder), "-o", str(out), "--no-pictures", "--play", "0", "--json"])
    shown = capsys.readouterr()
    assert (
        "no clip rests there; " in json.loads(shown.out)["held"]["on hips"] and "held: on hips: " in shown.err
    )
    page = out.with_name("held.labels.html").read_text()
    assert (
        "Stances that no clip rests in" in page
        and "likelihood 1 80%" in page
        and "timing, joints, likelihood" in page
    )


@pytest.mark.nightly
def test_clips_of_another_skeleton_are_left_out_or_retargeted_as_asked(
    folder: Path, capsys: pytest.CaptureFixture[str], zoo_files: dict[str, Path]
) -> None:
    for path in folder.glob("*.glb"):
        if not path.name.startswith("on_hips__"):
            path.unlink()
    shutil.copy(zoo_files["mixamo"], folder / "other.glb")
    shutil.copy(zoo_files["mixamo"], folder / "another.glb")
    out = folder.parent / "p"
    main(["label", str(folder), "-o", str(out), "--no-pictures", "--play", "0"])
    told = [line for line in capsys.readouterr().err.splitlines() if "another character" in line]
    assert len(told) == 1 and "another.glb and 1 more" in told[0] and "3 clips" in told[0]
    main(["label", str(folder), "-o", str(out), "--no-pictures", "--play", "0", "--retarget"])
    assert "another character" not in capsys.readouterr().err
    project = open_project(out.with_name("p.metagraph.yaml")).project
    assert sum(bool(e.brought_from) for e in project.clips.values()) == 6
    assert [x.contacts for x in project.joint_maps.values()] == [True]
    again = [
        "label",
        str(folder),
        "-o",
        str(out),
        "--no-pictures",
        "--play",
        "0",
        "--retarget",
        "--no-contacts",
    ]
    main([*again, "--overwrite"])
    project = open_project(out.with_name("p.metagraph.yaml")).project
    assert [x.contacts for x in project.joint_maps.values()] == [False]


@pytest.mark.nightly
def test_labelling_again_leaves_the_earlier_report(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["label", str(folder), "--json", "--no-pictures", "--play", "0"]
    assert main(command) == 0
    report = Path(json.loads(capsys.readouterr().out)["report"])
    before = report.read_bytes()
    assert main(command) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["labelled"] == 0 and data["report"] is None and report.read_bytes() == before


def test_who_does_not_wait_until_it_was_played_keeps_everything(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object) -> list[Problem]:
        assert "clips labelled in" in capsys.readouterr().out
        raise KeyboardInterrupt

    monkeypatch.setattr("metagraph.playback.rehearsal.rehearse", stop)
    assert main(["label", str(folder), "--no-pictures"]) == 1
    assert "stopped" in capsys.readouterr().err
    project = folder.with_name(f"{folder.name}{SUFFIX}")
    assert any(True for _ in read_project(project).actions())
    assert "<h2>" in folder.with_name(f"{folder.name}.labels.html").read_text(encoding="utf-8")
