"""`metagraph annotate`: reading, learning and performing an annotation from the command line."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from app.cli.parser import main
from metagraph.formats.store import open_project

ROOT = Path(__file__).resolve().parents[3]
EAF = ROOT / "sample_clips" / "annotation" / "conversation.eaf"


@pytest.fixture
def project(tmp_path: Path, toy: Any) -> Path:
    """A project of its own, without clips on disk."""
    path = tmp_path / "talk.metagraph.yaml"
    shutil.copy(ROOT / "sample_clips" / "sample.metagraph.yaml", path)
    (tmp_path / "clips").symlink_to(ROOT / "sample_clips" / "clips")
    shutil.copy(ROOT / "sample_clips" / "ada.glb", tmp_path)
    return path


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, Any, str]:
    code = main([*map(str, words), "--json"])
    told = capsys.readouterr()
    return code, json.loads(told.out), told.err


@pytest.mark.nightly
def test_without_anything_wanted_it_only_tells(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = project.read_bytes()
    code, data, notes = run(capsys, "annotate", project, EAF)
    assert code == 0 and not data["saved"]
    assert data["tiers"]["Left arm"] == "left arm" and data["tiers"]["Speech"] == "speech"
    assert {"layer": "head", "label": "nodding", "count": 33, "meaning": "gesture positive"} in data["labels"]
    arms = data["layers"]["arms"]
    assert arms["actions"] == 52 and len(arms["matrix"]) == len(arms["states"]) == len(arms["seen"]) == 7
    assert abs(sum(arms["seen"]) - 1) < 0.01
    assert "12 actions" in notes
    assert project.read_bytes() == before
    assert main(["annotate", str(project), str(EAF)]) == 0
    assert "nothing was saved" in capsys.readouterr().out


@pytest.mark.nightly
def test_models_are_learned_and_a_performance_kept(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, data, _ = run(capsys, "annotate", project, EAF, "--learn", "--states", "--perform", "casual talk")
    assert (code, data["learned"], data["saved"]) == (0, ["body", "arms", "head"], True)
    saved = open_project(project).project
    assert saved.markov["head"].tags == ("positive", "negative", "")
    assert saved.performances[data["performance"]].name == "casual talk"
    arms = data["replayed"]["arms"]
    assert arms["asked"] == arms["played"] == 52 and 0 < arms["other_limb"] < 26
    assert saved.tiers["Right arm"] == "right arm"
    code, data, _ = run(capsys, "annotate", project, EAF, "--learn", "--shares")
    assert code == 0 and open_project(project).project.markov["head"].tags == ()


def test_tiers_and_labels_are_said_otherwise_and_remembered(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tiers = ("--tier", "Right arm=ignore", "--tier", "Speech=body")
    labels = ("--label", "Gesture=fidget calm", "--label", "body: speaks=transition")
    code, data, _ = run(capsys, "annotate", project, EAF, *tiers, *labels, "--perform", "x")
    assert code == 0
    assert data["tiers"]["Right arm"] == "ignore" and data["tiers"]["Speech"] == "body"
    assert set(data["layers"]["arms"]["states"]) == {"left fidget", "left transition"}
    _, again, _ = run(capsys, "annotate", project, EAF)
    assert (again["tiers"], again["labels"]) == (data["tiers"], data["labels"])


def test_another_annotators_tiers_are_read_where_asked(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    again = tmp_path / "again.eaf"
    text = EAF.read_text(encoding="utf-8")
    start = text.index("<TIER", text.index('TIER_ID="Speech"') - 200)
    rows = "".join(
        f"""<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="again{n}" TIME_SLOT_REF1="ts{2 * n + 1}"
        TIME_SLOT_REF2="ts{2 * n + 2}"><ANNOTATION_VALUE>fidget</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION>
        </ANNOTATION>"""
        for n in range(4)
    )
    tier = """<TIER TIER_ID="Left arm rater BM" LINGUISTIC_TYPE_REF="none">""" + rows + "</TIER>"
    again.write_text(text[:start] + tier + text[start:], encoding="utf-8")
    code, data, notes = run(capsys, "annotate", project, again)
    assert code == 0 and data["tiers"]["Left arm rater BM"] == "ignore"
    assert "Not read: Left arm rater BM" in notes
    code, data, notes = run(capsys, "annotate", project, again, "--annotator", "BM")
    assert code == 0 and data["tiers"]["Left arm rater BM"] == "left arm"
    assert data["tiers"]["Left arm"] == "ignore" and "Not read: Left arm" in notes
    code, data, _ = run(capsys, "annotate", project, again, "--annotator", "CC")
    assert code == 1 and "'CC' annotated nothing that is read; there are '', 'BM'" in data["error"]


WRONG = {
    "a tier that is not there": (
        ("--tier", "Left arms=left arm"),
        "there is no 'Left arms' in the annotation; did you mean 'Left arm'?",
    ),
    "a role that is none": (("--tier", "Body=tail"), "the role of a tier is one of left arm"),
    "no role": (("--tier", "Body"), "--tier is given as"),
    "a label that is not there": (("--label", "dance=gesture"), "--label: there is no 'dance'"),
    "a meaning that is none": (
        ("--label", "fidget=dance"),
        "the meaning of a label is one of gesture, fidget",
    ),
    "negative smoothing": (("--smoothing", "-1"), "--smoothing must be 0 or more"),
    "nothing to learn from": (
        tuple(
            x
            for t in ("Left arm", "Right arm", "Head stance", "Head action", "Body")
            for x in ("--tier", f"{t}=ignore")
        )
        + ("--learn",),
        "no tier is read as an action; the tiers are 'Speech'",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_told_and_nothing_saved(
    case: str, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words, cause = WRONG[case]
    before = project.read_bytes()
    code, data, _ = run(capsys, "annotate", project, EAF, *words)
    assert code == 1 and cause in data["error"]
    assert project.read_bytes() == before


def test_files_that_are_no_annotations_are_told(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "talk.eaf").write_text("HIERARCHY")
    code, data, _ = run(capsys, "annotate", project, tmp_path / "talk.eaf", "--learn")
    assert code == 1 and "talk.eaf, line 1, column 1" in data["error"]
    code, data, _ = run(capsys, "annotate", tmp_path / "none.metagraph.yaml", EAF)
    assert code == 1
    with pytest.raises(SystemExit):
        main(["annotate", str(project), str(EAF), "--states", "--shares"])
    assert "not allowed with" in capsys.readouterr().err


def test_an_annotation_of_speech_alone_is_done_with_a_problem(
    project: Path, shared_data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, data, _ = run(capsys, "annotate", project, shared_data / "elan" / "test.eaf")
    assert code == 3 and data["layers"] == {}
    code, data, _ = run(capsys, "annotate", project, shared_data / "elan" / "sample_3.0.eaf", "--learn")
    assert code == 0 and data["learned"] == ["arms"] and data["layers"]["arms"]["states"] == ["both gesture"]
