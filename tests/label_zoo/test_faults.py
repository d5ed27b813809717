"""Faults of other studios' clips: in each of their variants the program mends the fault and says so, or
reports it.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.label_zoo.faults import FAULTS, complaints
from tests.thorough import many


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_is_mended_or_reported_in_each_of_its_variants(kind: str, tmp_path: Path) -> None:
    found = {n: complaints(kind, n, tmp_path / str(n)) for n in range(many(1, 25))}
    assert not {n: said for n, said in found.items() if said}
