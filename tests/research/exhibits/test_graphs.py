"""What key states save is measured, not only worked out."""

from __future__ import annotations

import pytest

from app.project.files import SAMPLE
from metagraph.formats.store import open_project
from metagraph.research.exhibits.graphs import measure_key_saving
from metagraph.synthesis.states import KEYS, read_states


def test_key_states_leave_twenty_times_fewer_pairs_and_take_less_time() -> None:
    clips = [c.motion for c in open_project(SAMPLE).project.clips.values() if c.duration > 2.5][:16]
    found = measure_key_saving(read_states(clips), [() for _ in clips])
    assert found.states > 1000
    assert found.pairs == pytest.approx(1 / KEYS**2, rel=0.15)
    assert found.seconds > 2
