"""What a study found: computed by hand, through files, and what cannot be said from too little."""

from __future__ import annotations

import json
import re
import shutil
from collections import Counter
from dataclasses import replace
from math import atan, pi, sqrt
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.analysis.example import compute_example, describe_example
from metagraph.research.study.analysis.reading import Data, StudyRating, collect_study, predict_task_seconds
from metagraph.research.study.analysis.results import analyse_study, compare_conditions
from metagraph.research.study.report import format_study_page, summarise_study
from metagraph.research.study.scores.machines import Score
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.study_plan import FILE
from tests.research.study.makers import four, row

DOCS = Path(__file__).resolve().parents[4] / "docs" / "researchers" / "study-report.md"
NOBODY = Data("Empty", ("meta", "manual"), {"a": "A"}, ("P1",))


# --- edge cases


def test_nobody_has_begun() -> None:
    found = analyse_study(NOBODY)
    assert found.time is None and not found.curves and not found.mistakes
    (words,) = summarise_study(found)
    assert "Nobody" in words
    assert "0 of 1 people have begun" in format_study_page(found)


def test_one_condition_cannot_be_compared() -> None:
    found = analyse_study(replace(NOBODY, rows=(row("P1", "meta", "a", 10.0, 0),)))
    assert found.time is None
    (words,) = summarise_study(found)
    assert "meta-graph" in words and "manual" not in words


def test_one_person_has_a_ratio_without_an_interval() -> None:
    found = analyse_study(
        replace(NOBODY, rows=(row("P1", "meta", "a", 10.0, 0), row("P1", "manual", "a", 79.0, 1)))
    )
    assert found.time is not None
    assert (found.time.ratio.value, found.time.ratio.low, found.time.test.p) == (
        pytest.approx(7.9),
        None,
        None,
    )
    (caution,) = found.time.cautions
    assert "no interval" in caution
    assert "no interval, 1 person" in format_study_page(found)


def test_a_study_may_say_how_long_operators_take_its_people(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    write_study(folder, Truth(participants=2))
    usual = collect_study(folder, jumps=False).rows
    file = folder / FILE
    file.write_text(file.read_text(encoding="utf-8") + "operators: {M: 0, P: 2.2}\n", encoding="utf-8")
    for a, b in zip(usual, collect_study(folder, jumps=False).rows, strict=True):
        ops = a.run.operators
        thoughts, points = a.run.edits + a.run.undos, ops["P"] + ops["D"]
        assert b.predicted == pytest.approx(a.predicted - 1.35 * thoughts + 1.1 * points)


def test_what_was_not_finished_or_took_no_time_is_left_out() -> None:
    rows = (
        row("P1", "meta", "a", 10.0, 0),
        row("P1", "manual", "a", 79.0, 1, finished=False),
        row("P1", "manual", "a", 0.0, 2),
    )
    assert analyse_study(replace(NOBODY, rows=rows)).time is None


def test_what_the_time_limit_ended_counts_and_is_told() -> None:
    rows = [
        row("P1", "meta", "a", 10.0, 0),
        row("P1", "manual", "a", 60.0, 1, finished=False, timed_out=True),
    ]
    found = compare_conditions(rows)
    assert found is not None and found.ratio.value == pytest.approx(6.0)
    assert any("1 of 2 tasks" in words for words in found.cautions)


def test_people_who_did_only_one_are_left_out_and_told() -> None:
    found = compare_conditions([*four().rows, row("P9", "meta", "a", 1.0, 0)])
    assert found is not None and found.ratio.n == 4
    assert any(words.startswith("1 ") and "left out" in words for words in found.cautions)


def test_people_who_did_one_each_are_compared_as_groups() -> None:
    rows = [
        row(f"P{n}", c, "a", s, 0)
        for n, (c, s) in enumerate([("meta", 10.0), ("meta", 20.0), ("manual", 80.0), ("manual", 160.0)])
    ]
    found = compare_conditions(rows)
    assert found is not None and not found.paired
    # 2 doublings of spread apart by 3: error sqrt(0.5 / 2 + 0.5 / 2), 2 degrees of freedom.
    half = 4.302652729911275 * sqrt(0.5)
    assert (found.ratio.value, found.ratio.low) == (pytest.approx(8.0), pytest.approx(2 ** (3 - half)))
    assert "includes 1" in found.cautions[-1]
    alone = compare_conditions(rows[1:3])
    assert alone is not None and len(alone.cautions) == 1 and "no interval" in alone.cautions[0]


def test_other_tasks_in_each_condition_are_compared_by_clips() -> None:
    rows = [
        replace(row("P1", "meta", "a", 80.0, 0), clips=8),
        replace(row("P1", "manual", "b", 640.0, 1), clips=16),
    ]
    found = compare_conditions(rows)
    assert found is not None and found.unit == "clip"
    assert found.ratio.value == pytest.approx(4.0)


# --- by hand


def test_the_example_of_the_documentation_by_hand() -> None:
    found = analyse_study(four()).time
    assert found is not None
    # Each person's ratio over both tasks is 2, 4, 4, 8: 1, 2, 2, 3 doublings, mean 2, deviation sqrt(2/3),
    # error sqrt(1/6).
    assert [p.ratio for p in found.people] == [pytest.approx(r) for r in (2, 4, 4, 8)]
    half = 3.182446305283708 * sqrt(1 / 6)
    assert (found.ratio.value, found.ratio.low, found.ratio.high) == tuple(
        pytest.approx(2**x, rel=1e-12) for x in (2, 2 - half, 2 + half)
    )
    assert found.means["meta"].value == pytest.approx(100 * 2 ** (1 / 8))
    assert found.means["manual"].value == pytest.approx(400 * 2 ** (1 / 8))
    # t = 2 / sqrt(1/6); of 3 degrees of freedom its chance is 1 - 2/pi (angle + sin cos), of the angle whose
    # tangent is t / sqrt(3).
    angle = atan(2 * sqrt(2))
    assert found.test.statistic == pytest.approx(2 * sqrt(6), rel=1e-12)
    assert found.test.p == pytest.approx(1 - 2 / pi * (angle + 2 * sqrt(2) / 9), rel=1e-10)
    assert found.effect is not None and found.effect.value == pytest.approx(sqrt(pi), rel=1e-12), (
        "sqrt(6) times gamma(3/2) / sqrt(3/2)"
    )
    # Those who began with the meta-graph: 1 and 2 doublings; by hand: 2 and 3.
    assert found.order is not None
    assert found.order.second.value == pytest.approx(2**-0.5)
    assert found.order.second.low == pytest.approx(2 ** (-0.5 - 4.302652729911275 * sqrt(0.5) / 2), rel=1e-9)
    assert (found.order.adjusted.value, found.order.carried.value) == (
        pytest.approx(4.0),
        pytest.approx(2**0.25),
    )


def test_the_documentation_tells_the_same_figures() -> None:
    text, shown = DOCS.read_text(encoding="utf-8"), format_study_page(analyse_study(four()))
    for figure in ("4.00", "1.63 to 9.84", "4.90", "0.016", "1.77", "0.71", "0.25 to 2.03", "1.19"):
        assert figure in text and figure in shown, figure


def test_what_is_asked_is_tested_once_and_corrected_and_nothing_else_is() -> None:
    found = analyse_study(four())
    # In doublings: task a 1, 1, 2, 3 and task b 1, 3, 2, 3.
    assert {t: e.value for t, e in found.by_task.items()} == {
        "a": pytest.approx(2**1.75),
        "b": pytest.approx(2**2.25),
    }
    assert [(name, p == test.p) for name, test, p in found.together] == [("time", True)]
    shown = format_study_page(found)
    assert shown.count("p = 0.016") == 2, "alone and together; the sentence for a paper has its own form"
    assert len(re.findall(r"p (=|&lt;) ", shown)) == 2


def test_mistakes_and_ratings_are_means_of_people() -> None:
    good, bad = Score(right=10), Score(right=6, missing=4)
    rows = [replace(r, score=good if r.run.condition == "meta" else bad) for r in four().rows]
    ratings = tuple(
        StudyRating(f"P{n}", "SUS", c, v)
        for n, v in enumerate((50.0, 60.0, 70.0), 1)
        for c, v in (("meta", v + 10), ("manual", v))
    )
    found = analyse_study(replace(four(), rows=tuple(rows), ratings=ratings))
    recall = next(m for m in found.mistakes if m.name.startswith("recall"))
    assert (recall.means["meta"].value, recall.means["manual"].value) == (100.0, 60.0)
    sus = found.ratings[0]
    assert (sus.means["meta"].value, sus.difference.value if sus.difference else None) == (70.0, -10.0)
    assert [name for name, _, _ in found.together] == ["time", "F1 of connections, %", "SUS"]
    lucky = [replace(r, score=Score(right=10, missing=int(r.run.participant == "P1"))) for r in four().rows]
    bounded = next(
        m for m in analyse_study(replace(four(), rows=tuple(lucky))).mistakes if m.name.startswith("recall")
    ).means["meta"]
    assert bounded.high == 100.0 and bounded.low is not None and bounded.low < bounded.value < 100.0, (
        "no share is above all"
    )
    assert not any(m.name == "visible jumps" for m in found.mistakes), "they were not judged"


def test_a_prediction_counts_thoughts_and_drags() -> None:
    run = row("P1", "meta", "a", 10.0, 0, operators=Counter(K=10, P=4, B=8, D=2, H=3), edits=5, undos=1).run
    assert predict_task_seconds(run) == pytest.approx(2.8 + 6 * 1.1 + 0.8 + 1.2 + 6 * 1.35)


def test_the_published_example_has_no_interval() -> None:
    found = compute_example()
    assert found.ratio.value == pytest.approx(7.875) and found.ratio.low is None
    assert found.minutes == (pytest.approx(480 / 152), pytest.approx(3780 / 152))
    assert found.needed == {0.25: 3, 0.5: 3, 1.0: 5}
    assert "no interval" in describe_example(found) and "24.87" in describe_example(found)


# --- through files


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_study(tmp_path_factory.mktemp("made") / "study", Truth(participants=4, seed=5)).folder


@pytest.fixture
def study(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "study")
    return tmp_path / "study"


def test_a_folder_without_a_study_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"study\.yaml"):
        collect_study(tmp_path)


@pytest.mark.nightly
def test_nothing_is_missing_of_a_whole_study(study: Path) -> None:
    found = collect_study(study)
    assert (found.missing, len(found.rows), found.simulated) == ((), 16, True)
    assert all(r.score is not None and r.score.jumps is not None for r in found.rows)
    assert {r.sitting for r in found.rows} == {1, 2}
    assert len([r for r in found.ratings if r.measure == "SUS"]) == 8


def test_without_jumps_the_clips_are_not_needed(study: Path) -> None:
    for clip in (study / "clips").iterdir():
        clip.unlink()
    found = collect_study(study, jumps=False)
    assert all(r.score is not None and r.score.jumps is None for r in found.rows)


def test_whatever_is_missing_or_odd_is_told_and_the_rest_is_used(study: Path) -> None:
    data = study / "data"
    shutil.rmtree(data / "P01")
    log = data / "P02" / "log.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    log.write_text("".join(lines[: len(lines) // 2]) + '{"n": 99')
    first = next((data / "P03").glob("*-small-meta*"))
    first.write_text(first.read_text() + "\n")
    next((data / "P03").glob("*-large-manual*")).unlink()
    (data / "stranger").mkdir()
    found = collect_study(study)
    told_ = "\n".join(found.missing)
    for words in (
        "P01: has not begun.",
        "P02: the last line of the log was not written whole",
        "P02: has not come to the end.",
        "was not finished; its time is left out.",
        "P03, small (meta): its project was changed after the sitting.",
        "P03, large (manual): its project cannot be used",
        "stranger: a folder of data, but nobody of that name takes part",
    ):
        assert words in told_, words
    assert (
        next(
            r
            for r in found.rows
            if (r.run.participant, r.run.task, r.run.condition) == ("P03", "large", "manual")
        ).score
        is None
    )
    assert analyse_study(found).time is not None
    shown = format_study_page(analyse_study(found))
    for words in found.missing:
        assert words.partition(": ")[2].replace("'", "&#x27;") in shown


def test_a_changed_plan_is_told(study: Path) -> None:
    path = study / FILE
    path.write_text(path.read_text() + "# a remark\n")
    assert any(words.startswith("P01: ") and "version" in words for words in collect_study(study).missing)


def test_a_task_without_a_reference_has_no_score(study: Path) -> None:
    path = study / FILE
    path.write_text(path.read_text().replace("  reference: small.metagraph.yaml\n", ""))
    (study / "large.metagraph.yaml").write_text("no project")
    found = collect_study(study)
    assert any(words.startswith("small: ") and "reference" in words for words in found.missing)
    assert any(words.startswith("large: its reference cannot be used") for words in found.missing)
    assert all(r.score is None for r in found.rows)


def test_questionnaires_that_cannot_be_scored_are_told(study: Path) -> None:
    log = study / "data" / "P01" / "log.jsonl"
    events = [json.loads(line) for line in log.read_text().splitlines()]
    for e in events:
        if e["type"] == "answer" and e["item"] == "sus3":
            e["value"] = 9
    log.write_text("".join(json.dumps(e) + "\n" for e in events))
    assert any("P01: System Usability Scale" in words for words in collect_study(study).missing)
