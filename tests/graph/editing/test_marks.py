"""What is on clips to find them again."""

from __future__ import annotations

import pytest

from metagraph.formats.project.journal import find_changes
from metagraph.formats.project.limits import find_unwritable
from metagraph.formats.project.merging import merge_projects
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.clip_mark import BARE, ClipMark
from metagraph.graph.editing.marks import mark, mark_of


@pytest.fixture
def project(toy):
    return toy.project()


def test_nothing_is_on_a_clip_and_nothing_is_kept_that_says_nothing(project):
    clip = next(iter(project.clips))
    assert mark_of(project, clip) == BARE
    marked = mark(project, [clip], rating=3)
    assert mark_of(marked, clip) == ClipMark(rating=3)
    assert mark(marked, [clip], rating=0).marks == {}
    assert mark(project, [clip], rating=0) is project
    assert mark(project, ["gone"], rating=5) is project


def test_marks_of_several_clips_keep_what_else_is_on_each(project):
    one, two = list(project.clips)[:2]
    marked = mark(mark(project, [one], note="too long"), [one, two], color="blue", favourite=True)
    assert mark_of(marked, one) == ClipMark("blue", 0, True, "too long")
    assert mark_of(marked, two) == ClipMark("blue", 0, True)


def test_marks_go_with_their_clip(project):
    one = next(iter(project.clips))
    assert edits.remove_clips(mark(project, [one], rating=1), [one]).marks == {}


def test_marks_are_saved_journalled_and_merged(project, tmp_path):
    one, two = list(project.clips)[:2]
    marked = mark(project, [one], rating=4, color="red", note="a1")
    path = tmp_path / "p.metagraph.yaml"
    save_project(marked, path)
    assert open_project(path).project.marks == marked.marks
    assert "marks" not in path.with_suffix("").name and "rating: 4" in path.read_text()
    assert find_changes(project, marked) == {"marks": {one: {"color": "red", "rating": 4, "note": "a1"}}}
    both = merge_projects(project, marked, mark(project, [two], favourite=True)).project
    assert both.marks == {one: marked.marks[one], two: ClipMark(favourite=True)}


@pytest.mark.parametrize("wrong", [{"rating": 6}, {"rating": -1}, {"color": "pink"}])
def test_what_no_file_could_hold_is_refused(project, wrong):
    one = next(iter(project.clips))
    assert "marks" in find_unwritable(project, mark(project, [one], **wrong))
