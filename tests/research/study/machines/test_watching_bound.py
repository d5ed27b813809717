"""How far watching bounds the race of experts: the page says what its command computes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.benchmarks.bench_watching import compute_rows, main

PAGE = Path(__file__).resolve().parents[4] / "docs" / "researchers" / "experts-paths.md"


def test_the_page_has_the_table_that_the_command_prints(capsys: pytest.CaptureFixture[str]) -> None:
    main()
    shown = PAGE.read_text(encoding="utf-8").partition("<!-- bound -->")[2].partition("<!-- end")[0]
    assert shown.strip() == capsys.readouterr().out.strip()


def test_no_ratio_exceeds_its_bound_and_the_aims_are_met_by_watching_faster() -> None:
    rows = {(clips, names): row for clips, names, *row in compute_rows()}
    assert all(ratio < bound for _, ratio, bound, _ in rows.values())
    assert rows[152, "Informative names"][3] > 2.5 and rows[152, "Uninformative names"][3] > 5
