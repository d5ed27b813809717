"""The pages that docs/researchers/papers.md leads to are true: what they name exists, and their values and
numbers are right.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs" / "researchers"
PAPERS = {  # page -> the paper
    "papers-borer": "borer-meta-graph.md",
    "papers-yang": "yang-statistics-based-motion-synthesis.md",
    "papers-taylor": "taylor-flow-vae.md",
}
GIVEN = ROOT.parent / "shared" / "papers"
WORDS = ("two", "three", "four", "five")
PLAIN = re.compile(r"\d+(?:,\d{3})*(?:\.\d+)?")
VERDICTS = ("same", "different", "better", "missing")
NUMBER = re.compile(r"(?<![\w.-])\d[\d,]*(?:\.\d+)?")
POWER = re.compile(r"(\d+(?:\.\d+)?) x 10\^(-?\d+)")
VALUE = re.compile(r"`([^`]+)` = (-?[\d.]+)")
FIGURE = re.compile(r"\d+(?:\.\d+)? ?(?:%|s\b|times|transitions|cm)")
COMMAND = re.compile(r"`(?:metagraph|python) [^`]+`")
DOTTED = re.compile(r"(?<![.\w])[a-z_]+(?:\.\w+)+")


@dataclass(frozen=True)
class PapersRow:
    paper: str
    section: str
    says: str
    there: str
    ours: str
    here: str
    test: str
    verdict: str


def rows() -> list[PapersRow]:
    """Return the rows of each page's first table."""
    out = []
    for paper in PAPERS:
        _, _, table = (PAGES / f"{paper}.md").read_text(encoding="utf-8").partition("\n| Section |")
        for line in table.partition("\n\n")[0].splitlines()[2:]:
            cells = [c.strip() for c in line.strip().strip("|").split("|")]
            assert len(cells) == 7, f"a row has {len(cells)} columns: {line[:80]}"
            out.append(PapersRow(paper, *cells))
    return out


ROWS = rows()
EVERY = pytest.mark.parametrize("paper", PAPERS)


def of(paper: str) -> list[PapersRow]:
    return [row for row in ROWS if row.paper == paper]


def named(name: str) -> Any:
    """Return what a dotted name below `metagraph` stands for, modules imported on the way."""
    found: Any = import_module("metagraph")
    path = "metagraph"
    for part in name.split("."):
        path = f"{path}.{part}"
        found = getattr(found, part) if hasattr(found, part) else import_module(path)
    return found


@contextmanager
def unless_elsewhere() -> Iterator[None]:
    """Pass over what needs a library that is not installed."""
    try:
        yield
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("metagraph"):
            raise


def value(expression: str) -> float:
    """Return what an expression of names below `metagraph` comes to."""
    for name in DOTTED.findall(expression):
        whole = name.split(".")
        for length in range(len(whole), 1, -1):  # as many parts as are modules
            try:
                import_module("metagraph." + ".".join(whole[:length]))
                break
            except ModuleNotFoundError as error:
                if error.name is not None and not error.name.startswith("metagraph"):
                    raise
    packages = {m.split(".")[0] for m in DOTTED.findall(expression)}
    return float(eval(expression, {p: import_module(f"metagraph.{p}") for p in packages}))


def digits(text: str) -> float:
    """Return half of the last printed place."""
    return 0.5 * 10 ** -len(text.partition(".")[2])


def printed(cell: str) -> list[float]:
    """Return the numbers of a cell, shares of 100 as shares of 1, too."""
    out = [float(a) * 10.0 ** int(b) for a, b in POWER.findall(cell)]
    for found in NUMBER.finditer(cell):
        number = float(found[0].replace(",", ""))
        out.append(number)
        if cell[found.end() :].lstrip().startswith("%"):
            out.append(number / 100)
    return out


def test_the_pages_hold_the_three_papers_from_their_first_section_to_their_last() -> None:
    sections = {p: {s for r in ROWS if r.paper == p for s in r.section.split(", ")} for p in PAPERS}
    assert {"1", "3", "4", "5", "6", "6.1", "6.2", "7", "7.1", "7.2", "7.3", "7.4", "8", "A"} <= sections[
        "papers-borer"
    ]
    assert {"4.1", "4.2", "5", "6", "7.1", "7.2", "7.3", "8", "8.1", "8.2", "8.3", "9"} <= sections[
        "papers-yang"
    ]
    assert {"3.2", "3.3", "4.1", "4.2", "4.3.1", "4.3.2", "4.4", "5", "6.1.1", "6.2", "6.3", "7"} <= sections[
        "papers-taylor"
    ]
    assert len(ROWS) > 150


@EVERY
def test_a_row_says_what_became_of_it_and_what_is_missing_names_nothing(paper: str) -> None:
    for row in of(paper):
        assert row.verdict in VERDICTS, row
        if row.verdict == "missing":
            assert row.ours == row.test == "-", row
        else:
            assert row.ours.startswith("`") and row.test.startswith("`"), row


@EVERY
def test_every_function_named_is_there(paper: str) -> None:
    for row in of(paper):
        for name in re.findall(r"`([^`]+)`", row.ours):
            with unless_elsewhere():
                assert named(name) is not None, row


@EVERY
def test_every_test_named_is_there(paper: str) -> None:
    for row in of(paper):
        for name in re.findall(r"`([^`]+)`", row.test):
            file, _, function = name.partition("::")
            text = (ROOT / "tests" / file).read_text(encoding="utf-8")
            assert re.search(rf"^def {function}\(", text, re.M), row


@EVERY
def test_every_value_is_the_codes_and_the_papers_where_it_is_called_the_same(paper: str) -> None:
    for row in of(paper):
        for expression, told in VALUE.findall(row.here):
            told = told.rstrip(".")
            with unless_elsewhere():
                assert abs(value(expression) - float(told)) <= digits(told) * 1.001, (row, expression)
            if row.verdict == "same" and row.there:
                assert any(abs(n - float(told)) <= digits(told) * 1.001 for n in printed(row.there)), row


@EVERY
def test_what_is_called_the_same_or_better_than_a_number_has_a_number_that_is_computed(paper: str) -> None:
    lacking = [row for row in of(paper) if row.verdict in ("same", "better") and row.there]
    assert not [row for row in lacking if not VALUE.search(row.here)]


@EVERY
def test_other_figures_of_what_is_called_the_same_or_better_say_which_command_makes_them(paper: str) -> None:
    for row in of(paper):
        words = re.sub(r"`[^`]*`", "", VALUE.sub("", row.here))
        if row.verdict in ("same", "better") and FIGURE.search(words):
            assert COMMAND.search(row.here), row


@EVERY
def test_the_numbers_told_of_a_paper_stand_in_it(paper: str) -> None:
    path = GIVEN / PAPERS[paper]
    if not path.is_file():
        pytest.skip("the papers are not beside the project")
    text = path.read_text(encoding="utf-8")
    known = set(PLAIN.findall(text)) | {str(n) for n, word in enumerate(WORDS, 2) if word in text}
    for row in of(paper):
        assert set(PLAIN.findall(row.there)) <= known, row


@pytest.mark.parametrize("name", ["graph.model.Actio", "synthesis.stats.KEYS", "nowhere.at_all"])
def test_a_name_that_is_gone_is_found_out(name: str) -> None:
    with pytest.raises((AttributeError, ModuleNotFoundError)):
        named(name)


def test_a_value_that_changed_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    assert value("synthesis.states.KEYS * 2") == 0.445
    monkeypatch.setattr("metagraph.synthesis.states.KEYS", 0.3)
    assert value("synthesis.states.KEYS * 2") == 0.6
    assert printed("37.5 %, 1.5 x 10^-3 and 1,823,041")[:2] == [0.0015, 37.5]
    assert 0.375 in printed("37.5 %") and 1_823_041 in printed("1,823,041")
    assert digits("0.25") == pytest.approx(0.005)
