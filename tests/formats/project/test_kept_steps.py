"""Steps kept with a saved project: every state is there again, and damage costs only what is older."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.project import kept_steps
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.kept_steps import decode_steps, encode_steps
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.projects import histories

pytestmark = pytest.mark.usefixtures("numbered_ids")


def steps_between(states: list[Project]) -> list[UndoStep]:
    states = [states[0], *(b for a, b in pairwise(states) if to_data(a) != to_data(b))]
    return [UndoStep(f"edit {n}", a, b) for n, (a, b) in enumerate(pairwise(states))]


def seeds(count: int) -> list[UndoStep]:
    return steps_between([edits.set_settings(Project(), seed=n) for n in range(count + 1)])


@pytest.mark.nightly
@settings(max_examples=80, deadline=None)
@given(histories())
def test_every_state_is_there_again_from_the_last_one_alone(states: list[Project]) -> None:
    steps = steps_between(states)
    if not steps:
        return
    opened = from_data(to_data(steps[-1].after))
    again = decode_steps(encode_steps(steps), opened)
    assert again[-1].after is opened
    assert [s.text for s in again] == [s.text for s in steps]
    for old, new in zip(steps, again, strict=True):
        assert to_data(new.before) == to_data(old.before) and to_data(new.after) == to_data(old.after)
    assert all(a.after is b.before for a, b in pairwise(again))


def test_no_steps_are_no_bytes_and_back() -> None:
    assert encode_steps([]) == b""
    assert decode_steps(b"", Project()) == ()


def test_the_latest_steps_are_kept_where_there_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = seeds(120)
    again = decode_steps(encode_steps(steps), steps[-1].after)
    assert len(again) == kept_steps.MAX_STEPS
    assert again[-1].text == "edit 119"
    monkeypatch.setattr(kept_steps, "MAX_BYTES", 500)
    few = decode_steps(encode_steps(steps), steps[-1].after)
    assert 0 < len(few) < 20 and few[-1].text == "edit 119"


@pytest.mark.nightly
@settings(max_examples=200, deadline=None)
@given(st.data())
def test_damage_leaves_the_steps_after_it_and_raises_nothing(data: st.DataObject) -> None:
    steps = seeds(6)
    content = bytearray(encode_steps(steps))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    again = decode_steps(bytes(content), steps[-1].after)
    assert len(again) <= 12
    assert not again or again[-1].after is steps[-1].after
