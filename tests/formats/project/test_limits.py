"""Whatever an edit makes can be opened again, or the edit is refused in words."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.project.limits import find_unwritable
from metagraph.formats.store import SUFFIX, encode_project, parse_project, save_project
from metagraph.graph import edits, requests
from metagraph.graph.model import Project
from tests.projects import clip, histories

pytestmark = pytest.mark.usefixtures("numbered_ids")

BEYOND: dict[str, Callable[[Project], Project]] = {
    "seed": lambda p: edits.set_settings(p, seed=-1),
    "seed ": lambda p: edits.set_settings(p, seed=2**32),
    "memory": lambda p: edits.set_settings(p, memory=1e9),
    "rest": lambda p: edits.set_settings(p, rest=-0.1),
    "alpha": lambda p: edits.set_settings(p, alpha=math.inf),
    "cooldown": lambda p: edits.update_actions(p, [first_action(p)], cooldown=-1.0),
    "likelihood": lambda p: edits.update_actions(p, [first_action(p)], likelihood=math.nan),
    "points": lambda p: replace(p, points={"far": (1e6 * 1.01, 0.0, 0.0)}),
    "text": lambda p: replace(p, lines={"l1": requests.Line(text="a" * 20_001)}),
    "name": lambda p: replace(p, performances={"p1": requests.Performance(name="a" * 300)}),
}


def first_action(project: Project) -> str:
    return next(iter(project.actions())).id


def small() -> Project:
    project = edits.add_clips(Project("show"), [("a.glb", 0, "ab" * 32, clip("a"))])
    return edits.add_stance(project, "arms", "rest", ["c1"])


@pytest.mark.parametrize("what", BEYOND)
def test_what_could_not_be_opened_again_is_refused_and_named(what: str) -> None:
    why = find_unwritable(small(), BEYOND[what](small()))
    assert why is not None and what.strip() in why


@pytest.mark.parametrize("what", BEYOND)
def test_it_is_not_saved_either_and_the_old_file_stays(tmp_path: Path, what: str) -> None:
    path = tmp_path / f"show{SUFFIX}"
    save_project(small(), path)
    before = path.read_bytes()
    with pytest.raises(FileError, match="cannot be saved"):
        save_project(BEYOND[what](small()), path)
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


def test_the_limits_themselves_are_taken() -> None:
    project = replace(
        edits.set_settings(small(), seed=2**32 - 1, memory=600.0),
        points={"far": (1e6, -1e6, 0.0)},
        lines={"l1": requests.Line(text="a" * 20_000)},
    )
    assert find_unwritable(small(), project) is None
    assert parse_project(encode_project(project, Path("x")).decode(), Path("x")) == parse_project(
        encode_project(project, Path("x")).decode(), Path("x")
    )


@settings(max_examples=60, deadline=None)
@given(histories(8), st.data())
def test_no_edit_that_is_good_is_refused(states: list[Project], data: st.DataObject) -> None:
    a, b = data.draw(st.sampled_from(states)), data.draw(st.sampled_from(states))
    assert find_unwritable(a, b) is None
