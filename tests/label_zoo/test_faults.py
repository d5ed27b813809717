"""Faults of other studios' clips: in each of their variants the program mends the fault and says so, or
reports it.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.label_zoo.faults import FAULTS, complaints
from tests.thorough import many

SELDOM = 0.03  # of the variants, in which a guess from motion may be wrong without a word


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_is_mended_or_reported_in_each_of_its_variants(kind: str, tmp_path: Path) -> None:
    count = many(1, 120)
    found = {n: complaints(kind, n, tmp_path / str(n)) for n in range(count)}
    wrong = {n: said for n, said in found.items() if said}
    assert len(wrong) <= SELDOM * count, wrong
