"""What is remembered of projects: found once, and never keeping a project alive."""

from __future__ import annotations

import gc
from dataclasses import replace
from weakref import ref

import pytest

from metagraph.graph import edits
from metagraph.graph.face.rig import find_face
from metagraph.graph.model import Project
from metagraph.graph.remembered import Remembered
from metagraph.playback.timing.phases import find_phases
from tests.posing import body_of, rig


@pytest.fixture
def found():
    """A memory of projects' clips, and a way to ask it that tells how often it had to find."""
    memory: Remembered[object] = Remembered(lambda p: (p.clips,), most=2)
    count: list[Project] = []

    def of(project: Project, more: object = None) -> object:
        return memory.of(project, more, lambda: (count.append(project.name), object())[1])  # type: ignore[arg-type]

    return of, count


def test_projects_with_the_very_same_parts_share_what_was_found(found, toy) -> None:
    of, count = found
    project = toy.project()
    edited = edits.set_settings(project, seed=5)
    assert of(project) is of(edited) is of(project)
    assert of(project, "more") is not of(project)
    assert of(replace(project, clips=dict(project.clips))) is not of(project), "equal parts are not the same"
    assert len(count) >= 3


def test_an_edited_project_needs_the_one_before_no_longer(found, toy) -> None:
    of, count = found
    project = toy.project()
    first = of(project)
    for seed in range(5):  # each asks while the one before still lives, and outlives it
        edited = edits.set_settings(project, seed=seed + 10)
        assert of(edited) is first
        project = edited
    del edited
    for seed in range(5):
        assert of(edits.set_settings(project, seed=seed + 20)) is first, "passing copies change nothing"
    assert len(count) == 1


def test_what_has_the_ids_of_parts_that_are_gone_is_found_anew(found) -> None:
    of, count = found
    for n in range(50):  # a new dictionary often stands where the last one did
        of(Project(f"p{n}", clips={str(n): object()}))  # type: ignore[dict-item]
    assert len(count) == 50


@pytest.mark.nightly
def test_poses_faces_and_phases_keep_no_closed_project(toy) -> None:
    def ask() -> list[ref[object]]:
        project = toy.project()
        rig(project)
        body_of(project)
        find_face(project)
        for action in project.actions():
            find_phases(project, action)
        return [ref(project), *(ref(entry.motion) for entry in project.clips.values())]

    seen = ask()
    gc.collect()
    assert not [x for x in (r() for r in seen) if x is not None]
