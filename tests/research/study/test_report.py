"""The page and the tables: whole, alone, the same each time, and safe with any words."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import Results, analyse_study
from metagraph.research.study.report import (
    format_p_value,
    format_study_page,
    summarise_study,
    write_study_report,
)
from metagraph.research.study.reports import plots
from metagraph.research.study.reports.tables import format_cell, study_tables
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.statistics.small_samples import Estimate
from tests.research.study.makers import four


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    return analyse_study(
        collect_study(write_study(tmp_path_factory.mktemp("made") / "study", Truth(participants=6)).folder)
    )


@pytest.mark.nightly
def test_the_page_is_whole_and_needs_nothing_beside_it(results: Results) -> None:
    text = format_study_page(results)
    for title in (
        "Time",
        "Order",
        "Practice",
        "Where the time went",
        "Mistakes",
        "Ratings",
        "The tests",
        "Reckoned otherwise",
        "The mixed model",
        "Time that is not counted",
        "Who took part, and what is missing",
        "How it was reckoned",
    ):
        assert f">{title}</h" in text, title
    assert "simulated" in text and "Nothing is missing." in text
    assert not re.search(r"https?://(?!www\.w3\.org)", text) and "<script" not in text and "<img" not in text
    assert "prefers-color-scheme: light" in text and "@media print" in text


def test_every_plot_is_drawn_whole(results: Results) -> None:
    text = format_study_page(results)
    found = re.findall(r"<svg.*?</svg>", text)
    assert len(found) == 7
    for svg in found:
        tree = ElementTree.fromstring(svg)
        wide, high = (float(x) for x in tree.attrib["viewBox"].split()[2:])
        for mark in tree.iter():
            for key in ("x", "x1", "x2", "cx"):
                assert 0 <= float(mark.attrib.get(key, 0)) <= wide, mark.attrib
            for key in ("y", "y1", "y2", "cy"):
                assert 0 <= float(mark.attrib.get(key, 0)) <= high, mark.attrib


def test_the_same_data_give_the_same_bytes(results: Results, tmp_path: Path) -> None:
    for folder in ("one", "two"):
        written = write_study_report(results, tmp_path / folder)
        assert len(written) == 8 + 7 + 2
    for path in written:
        assert path.read_bytes() == (tmp_path / "one" / path.relative_to(tmp_path / "two")).read_bytes()


def test_words_from_files_are_no_markup() -> None:
    data = replace(four(), title="<b>&'", missing=("<script>",), tasks={"a": "<i>a", "b": "B"})
    text = format_study_page(analyse_study(data))
    assert "<script>" not in text and "<b>&" not in text and "<i>a" not in text
    assert "&lt;script&gt;" in text


def test_tables_have_a_row_for_each(results: Results) -> None:
    found = {name: list(csv.DictReader(text.splitlines())) for name, text in study_tables(results).items()}
    assert len(found["participants.csv"]) == 6
    assert len(found["tasks.csv"]) == 24
    assert len(found["clips.csv"]) == 6 * 2 * (9 + 16)
    assert len(found["mistakes.csv"]) == sum(len(r.score.mistakes) for r in results.data.rows if r.score)
    assert len(found["questionnaires.csv"]) == 6 * 2 * (10 + 6) + 6 * 2 * 2
    task = found["tasks.csv"][0]
    assert float(task["seconds"]) == pytest.approx(
        sum(float(task[f"{s}_seconds"]) for s in ("dragging", "timing", "looking", "undoing", "other")),
        abs=1e-4,
    )
    assert found["participants.csv"][0]["ratio"] != "n/a"


def test_cells_say_what_is_not_known() -> None:
    assert [format_cell(v) for v in (None, True, 2.5, 3.0, 0.1234567, "x", 7)] == [
        "n/a",
        "yes",
        "2.5",
        "3",
        "0.123457",
        "x",
        "7",
    ]


def test_the_first_sentence_is_the_finding(results: Results) -> None:
    first = summarise_study(results)[0]
    told = r"[\d.]+ times as long as with the meta-graph \(95 % interval [\d.]+ to [\d.]+, 6 people\)\."
    assert re.fullmatch(f"Working on the state machine by hand took {told}", first)


def test_chances_are_written_as_journals_do() -> None:
    assert [format_p_value(p) for p in (None, 0.0004, 0.0125, 1.0)] == [
        "no p",
        "p &lt; 0.001",
        "p = 0.013",
        "p = 1.000",
    ]


def test_times_are_written_as_people_read_them() -> None:
    assert [plots.format_duration(s) for s in (0.5, 42.4, 89.0, 90.0, 600.0, 5400.0, 63 * 3600)] == [
        "0.5 s",
        "42 s",
        "89 s",
        "1.5 min",
        "10 min",
        "1.5 h",
        "63 h",
    ]


def test_plots_of_one_person_and_of_equal_values_have_axes() -> None:
    alone = Estimate(5.0, None, None, 1)
    for svg in (
        plots.plot_paired([("P1", 5.0, 5.0)], (alone, alone), ("a", "b")),
        plots.plot_ratios([("all", alone)]),
        plots.plot_learning({"meta": ([5.0, 5.0, 5.0], 5.0, 0.0)}, {"meta": "a"}),
        plots.plot_stacked({"meta": {"x": 0.0}}, {"meta": "a"}),
        plots.plot_means([("SUS", {"meta": alone})]),
    ):
        assert ElementTree.fromstring(svg).tag.endswith("svg")
        assert "nan" not in svg and "inf" not in svg.replace("inside", "")
