"""Tables for spreadsheets: no text is taken for a formula, numbers stay numbers, and all is read back."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.common.csv_text import escape_cell, format_csv, restore_cell
from metagraph.formats.manual_table import parse_manual_table
from metagraph.research.study.reports.tables import format_rows

ROOT = Path(__file__).resolve().parents[2]
FORMULAS = ("=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "\r=1", "\n=1", "'=1", "''@x", "＝1+1")


@pytest.mark.parametrize("text", FORMULAS)
def test_a_formula_gets_an_apostrophe_and_is_read_back(text: str) -> None:
    (cell,) = next(csv.reader(io.StringIO(format_csv([[text]]), newline="")))
    assert cell == f"'{text}" and restore_cell(cell) == text


PLAIN = ("-1", "+2.5", "-.5", "1e-3", "-1e+6", -3, 2.5, "", "plain", "it's", "'quoted'", "a=b")


@pytest.mark.parametrize("value", PLAIN)
def test_numbers_and_plain_texts_stay(value: object) -> None:
    assert escape_cell(value) == value and restore_cell(str(value)) == str(value)


@given(st.lists(st.lists(st.text(), min_size=1, max_size=3), min_size=1, max_size=4), st.sampled_from(",;\t"))
def test_every_text_is_read_back(rows: list[list[str]], separator: str) -> None:
    found = list(csv.reader(io.StringIO(format_csv(rows, separator), newline=""), delimiter=separator))
    read = [[restore_cell(cell) for cell in row] for row in found]
    assert [row or [""] for row in read] == rows
    first = [cell[:1] for row in found for cell in row if cell.strip("+-.0123456789eE") != ""]
    assert not set(first) & set("=+-@\t\r\n")


def test_a_study_table_keeps_numbers_and_disarms_texts() -> None:
    lines = format_rows(("who", "value"), [("=HYPERLINK(1)", -0.5), ("P01", None)]).splitlines()
    assert lines == ["who,value", "'=HYPERLINK(1),-0.5", "P01,n/a"]


def test_a_table_of_links_reads_back_names_that_were_disarmed() -> None:
    (row,) = parse_manual_table(format_csv([["from", "to"], ["=wave()", "@nod"]]))
    assert (row.cells["from"], row.cells["to"]) == ("=wave()", "@nod")


def test_nothing_writes_tables_by_other_means() -> None:
    own = re.compile(r"csv\.writer|csv\.DictWriter")
    files = [p for part in ("metagraph", "app", "preview") for p in (ROOT / part).rglob("*.py")]
    assert [p.name for p in files if own.search(p.read_text(encoding="utf-8"))] == []
