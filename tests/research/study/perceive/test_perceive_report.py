"""The report: everything in it, nothing from outside it, the same bytes for the same answers."""

from __future__ import annotations

import csv
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest

from metagraph.research.study.perceive.answers import keep_sheet
from metagraph.research.study.perceive.perceive_analysis import analyse_answers
from metagraph.research.study.perceive.perceive_data import collect_answers
from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan
from metagraph.research.study.perceive.perceive_report import (
    format_perceive_page,
    summarise_perceive,
    write_perceive_report,
)
from metagraph.research.study.perceive.simulated import Raters, write_simulated
from tests.research.study.perceive.perceive_makers import CHOICE, RATING, sheet, study, text

pytestmark = pytest.mark.usefixtures("quick_codes")

HOSTILE = "{all: {title: '<b>&\"', clip: x}, deaf: {title: </script>, clip: y}}"


def test_a_page_tables_and_figures_are_written_and_are_the_same_again(tmp_path: Path) -> None:
    words = text(people=12, items=5, asked=CHOICE + RATING, more="checks: {told: 2, same: 1}\n")
    made = write_simulated(
        tmp_path / "s", parse_perceive_plan(words), words.encode(), "x", Raters({"all": 1.0}, careless=0.1)
    )
    results = analyse_answers(collect_answers(made))
    written = write_perceive_report(results, tmp_path / "r")
    before = {p: p.read_bytes() for p in written}
    write_perceive_report(analyse_answers(collect_answers(made)), tmp_path / "r")
    assert before == {p: p.read_bytes() for p in written}
    assert {p.suffix for p in written} == {".html", ".csv", ".svg"}
    for path in written:
        if path.suffix == ".svg":
            ElementTree.fromstring(path.read_text())
    rows = list(csv.DictReader((tmp_path / "r" / "choices.csv").read_text().splitlines()))
    assert len(rows) == len(results.answers.choices) and {r["first_was"] for r in rows} == {"left", "right"}
    (pair,) = csv.DictReader((tmp_path / "r" / "pairs.csv").read_text().splitlines())
    assert pair["first"] == "all" and float(pair["p_holm"]) >= float(pair["p"])
    told = format_perceive_page(results)
    for part in ("What can be claimed", "What cannot", "Mixed model", "missed checks", "Sides", "simulated"):
        assert part in told
    assert "https:" not in told and "<script" not in told


def test_titles_cannot_break_out_of_the_pages(tmp_path: Path) -> None:
    made = study(tmp_path / "s", text(conditions=HOSTILE, more="consent: '</script><b>x'\n"))
    keep_sheet(made, sheet(made))
    told = format_perceive_page(analyse_answers(collect_answers(made)))
    assert '<b>&"' not in told and "</script>" not in told
    shown = (made.show / "index.html").read_text()
    assert shown.count("</script>") == 2 and "<b>x" not in shown

    tags: list[str] = []
    reader = HTMLParser()
    reader.handle_starttag = lambda tag, attrs: tags.append(tag)  # type: ignore[method-assign]
    reader.feed(told)
    assert "table" in tags and "script" not in tags


def test_without_answers_the_report_says_so(tmp_path: Path) -> None:
    made = study(tmp_path / "s", text())
    results = analyse_answers(collect_answers(made))
    (words,) = summarise_perceive(results)
    assert words.startswith("all and deaf: ")
    assert write_perceive_report(results, tmp_path / "r")[0].is_file()
