"""`metagraph speech`: what two say to each other, told, written and kept in a project."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from app.cli.parser import main
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import open_project, save_project
from metagraph.formats.transcripts.reader import read_transcript
from tests.speech import group, talk

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips"


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    return talk.make_conversation(tmp_path)


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, Any, str]:
    code = main(["speech", *map(str, words), "--json"])
    said = capsys.readouterr()
    return code, json.loads(said.out), said.err


def test_counts_and_lengths_are_told(files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    code, data, error = run(capsys, files[0], "--words", files[1])
    assert (
        code == 0 and not error and data["name"] == "talk" and data["length"] == pytest.approx(30.3, abs=0.1)
    )
    first, second = data["sides"]
    assert (
        first["response"]["count"] == 2
        and second["response"]["count"] == 4
        and first["hesitation"]["count"] == 2
    )
    assert (
        3 < first["clause"]["words"] < 6
        and first["clause"]["spread"] > 0
        and first["words"] == len(talk.speak().words[0])
    )


def test_in_words_it_says_the_same(files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["speech", str(files[0])]) == 0
    said = capsys.readouterr()
    assert "talk: 30.3 s" in said.out and "clauses" in said.out and "note: talk.wav, left" in said.err


@pytest.mark.parametrize("suffix", [".eaf", ".TextGrid", ".json"])
def test_it_writes_what_can_be_read_back(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    out = tmp_path / f"out{suffix}"
    code, data, _ = run(capsys, files[0], "--words", files[1], "-o", out)
    assert code == 0 and data["written"] == str(out)
    back = read_transcript(out)
    assert [len(s) for s in back.segments.values()] == [
        sum(row[k]["count"] for k in ("clause", "response", "hesitation")) for row in data["sides"]
    ]


@pytest.mark.nightly
def test_it_keeps_a_conversation_in_a_project(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = tmp_path / "talk.metagraph.yaml"
    shutil.copy(SAMPLE / "sample.metagraph.yaml", project)
    for folder in ("clips", "lines"):
        (tmp_path / folder).symlink_to(SAMPLE / folder)
    shutil.copy(SAMPLE / "ada.glb", tmp_path)
    code, data, _ = run(capsys, files[0], "--words", files[1], "--project", project, "--name", "Dogs")
    kept = open_project(project).project.conversations
    assert code == 0 and list(kept)[-1] == data["kept"] and data["kept"].startswith("v")
    clauses = data["delivered"][0][0]  # what becomes of the rates
    assert clauses["asked"] == 0.75 and clauses["count"] >= clauses["performed"] >= clauses["strokes"] > 0
    assert len(open_project(project).project.timelines[data["kept"]].cuts) > 1  # it is filmed
    assert kept[data["kept"]].name == "Dogs" and kept[data["kept"]].sides[0].audio == "talk.wav"


def test_bad_usage_says_what_is_right(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["speech", str(files[0]), "-o", str(tmp_path / "a.mp4")]) == 1
    assert ".eaf, .TextGrid, .vtt, .srt, .tsv, .json" in capsys.readouterr().err
    assert main(["speech", *[str(files[0])] * 9]) == 1
    assert "up to 8 sound files" in capsys.readouterr().err
    assert main(["speech", *[str(files[0])] * 3, "--words", *[str(files[1])] * 2]) == 1
    assert "3 sounds and 2 transcripts" in capsys.readouterr().err
    assert main(["speech", str(tmp_path / "gone.wav")]) == 1
    assert "gone.wav" in capsys.readouterr().err


@pytest.mark.nightly
def test_a_language_can_be_chosen_brought_or_is_what_the_project_says(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = (files[0], "--words", files[1])
    code, data, error = run(capsys, *given, "--language", "DE")
    assert code == 0 and [s["language"] for s in data["sides"]] == ["de", "de"]
    assert "(en)" in error and "(de)" in error
    own = tmp_path / "own.yaml"
    own.write_text("code: xx\nname: Own\nresponses: did you run away\nhesitations: no")
    code, data, _ = run(capsys, *given, "--words-list", own)
    assert [s["language"] for s in data["sides"]] == ["xx", "xx"] and data["sides"][1]["response"][
        "count"
    ] == 1
    code, data, error = run(capsys, *given, "--words-list", own, "--language", "auto")
    assert [s["language"] for s in data["sides"]] == ["en", "en"] and not error
    project = tmp_path / "sample.metagraph.yaml"
    shutil.copy(SAMPLE / "sample.metagraph.yaml", project)
    project.write_text(project.read_text(encoding="utf-8") + "language: fr\n", encoding="utf-8")
    code, data, error = run(capsys, *given, "--project", project)
    assert [s["language"] for s in data["sides"]] == ["fr", "fr"] and "as you chose" in error
    kept = open_project(project).project
    assert kept.language == "fr" and kept.conversations[data["kept"]].sides[0].language == "fr"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--language", "klingon"), "no words of 'klingon'"),
        (("--words-list", "nowhere.yaml"), "nowhere.yaml"),
    ],
)
def test_a_language_that_is_not_there_is_told(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str], words: tuple[str, ...], said: str
) -> None:
    assert main(["speech", str(files[0]), *words]) == 1
    assert said in capsys.readouterr().err


# --- more than two


@pytest.fixture
def three(tmp_path: Path) -> tuple[Path, Path]:
    spoken = group.spoken()
    audio, words = tmp_path / "three.wav", tmp_path / "three.json"
    talk.write_sound(audio, spoken.samples, spoken.rate)
    talk.write_words(words, spoken)
    return audio, words


@pytest.mark.nightly
def test_three_are_kept_and_it_says_where_each_looks(
    three: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = tmp_path / "a.metagraph.yaml"
    save_project(make_paths_absolute(open_project(SAMPLE / "sample.metagraph.yaml").project, SAMPLE), project)
    given = (three[0], "--words", three[1], "--project", project)
    code, data, _ = run(capsys, *given, "--name", "Three")
    kept = open_project(project).project.conversations[data["kept"]]
    assert code == 0 and len(data["sides"]) == len(data["delivered"]) == len(kept.sides) == 3
    doing = [{share["doing"] for share in looks} for looks in data["looks"]]
    assert all(found & {"addressed", "aside"} and any("speaking" in d for d in found) for found in doing)
    assert main(["speech", *map(str, given), "--name", "Again"]) == 0
    out = capsys.readouterr().out
    assert "SPEAKER_02: when speaking" in out
    assert "all speakers: when addressed, looks at the speaker for" in out


def test_who_takes_part_is_chosen_by_name_or_number(
    three: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    given = (three[0], "--words", three[1], "--speakers")
    for chosen in ("3, speaker_00", "SPEAKER_02,1"):
        code, data, _ = run(capsys, *given, chosen)
        assert code == 0 and [s["name"] for s in data["sides"]] == ["SPEAKER_02", "SPEAKER_00"]
        assert data["looks"] == []
    for chosen, why in (("Zoe,1", "there is no speaker 'Zoe'"), ("2", "two or more"), ("2,2", "two or more")):
        assert main(["speech", *map(str, given), chosen]) == 1
        assert why in capsys.readouterr().err
