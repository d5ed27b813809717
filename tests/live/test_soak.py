"""A session that goes on: memory and the cost of a tick stay what they are; a day of it is run by hand
(tests/benchmarks/soak_live.py).
"""

from __future__ import annotations

import pytest

from tests.benchmarks.soak_live import soak
from tests.thorough import THOROUGH


@pytest.mark.nightly
def test_what_a_session_keeps_does_not_grow_with_time_but_for_what_was_asked() -> None:
    hours = 0.15 if THOROUGH else 0.01
    rows = list(soak(hours, rate=5, every=hours * 600, history=10.0, traced=True))
    assert all(row["unanswered"] <= 0 for row in rows)
    kept = [row["memory"] - row["tape"] for row in rows[3:]]  # the past is kept up to a length
    assert max(kept) - min(kept) < 4e6
    assert max(row["known"] for row in rows) < 400 and max(row["past"] for row in rows) < 30
