"""A session that goes on: memory and the cost of a tick stay what they are; a day of it is run by hand
(tests/benchmarks/soak_live.py).
"""

from __future__ import annotations

from tests.benchmarks.soak_live import soak


def test_what_a_session_keeps_does_not_grow_with_time_but_for_what_was_asked() -> None:
    rows = soak(0.15, rate=10, every=90.0, history=30.0)
    assert all(row["unanswered"] <= 0 for row in rows)
    kept = [row["memory"] - row["tape"] for row in rows[2:]]  # the past is kept up to a length
    assert max(kept) - min(kept) < 3e6
    assert max(row["known"] for row in rows) < 400 and max(row["past"] for row in rows) < 30
