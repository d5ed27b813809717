"""The example study is as its maker writes it, and can be run."""

from __future__ import annotations

import pytest

from metagraph.formats.store import open_project, read_project
from metagraph.graph.check import check_project
from metagraph.research.study.plan.task_projects import make_task_project
from metagraph.research.study.sitting import list_phases
from metagraph.research.study.study_plan import read_study
from sample_clips.make.study import FOLDER, TASKS, text


def test_the_study_file_is_its_makers() -> None:
    assert (FOLDER / "study.yaml").read_text(encoding="utf-8") == text()


def test_nothing_is_missing() -> None:
    study = read_study(FOLDER)
    assert study.problems() == []
    assert [len(study.clips(t.clips)) for t in study.plan.tasks] == [10, 20]
    assert len(list_phases(study, "P01")) == len(list_phases(study, "P16"))


@pytest.mark.parametrize("task", TASKS)
def test_a_right_answer_is_whole_and_has_no_faults(task: str) -> None:
    opened = open_project(FOLDER / f"{task}.metagraph.yaml")
    assert not opened.notes
    assert not [p for p in check_project(opened.project) if p.severity == "error"]
    assert {a.clip for a in opened.project.actions()} == set(opened.project.clips)


def test_a_task_begins_with_the_references_base_pose_and_character() -> None:
    study = read_study(FOLDER)
    project = make_task_project(study, study.plan.task("twenty").clips, "twenty", study.reference("twenty"))
    right = read_project(study.reference("twenty"))
    assert (
        project.clips[project.base.clip].name == right.clips[right.base.clip].name == "hands_at_sides__stance"
    )
    assert project.character is not None and project.character.endswith("mannequin.glb")
    assert not list(project.actions())
