"""The README of an export, and what is said to do next."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from metagraph.engines.targets import registry
from metagraph.engines.targets.next_steps import README, STEPS, list_steps, make_readme
from metagraph.engines.targets.target import Contents
from metagraph.formats.store import open_project


def test_every_target_says_what_to_do_next():
    assert STEPS.keys() == registry.list_targets().keys()


@pytest.mark.parametrize("target", [name for name, steps in STEPS.items() if steps.guide])
def test_a_target_with_a_guide_of_its_own_writes_it_and_nothing_beside_it(toy, tmp_path, target):
    report = registry.write_for_target(toy.project(), target, tmp_path)
    guide = tmp_path / STEPS[target].guide.replace("{stem}", "toy")
    assert guide in report.files
    assert "Made by Metagraph" not in guide.read_text(encoding="utf-8")
    assert target == "unity-controller" or guide.name == README
    assert (tmp_path / README in report.files) == (guide.name == README)


@pytest.mark.parametrize("target", sorted(STEPS))
def test_steps_name_the_files_as_they_are_called(target):
    steps = list_steps(target, "my hero")
    assert steps and not any("{" in step for step in steps)
    assert page_of(target).is_file()


def page_of(target: str) -> Path:
    return Path(__file__).parents[2] / "docs" / f"{STEPS[target].page}.md"


def test_an_export_has_a_readme_with_its_files_its_steps_and_what_it_loses(toy, tmp_path):
    report = registry.write_for_target(toy.project(), "xstate", tmp_path)
    text = (tmp_path / README).read_text(encoding="utf-8")
    assert tmp_path / README in report.files
    assert report.steps == list_steps("xstate", "toy")
    assert "`toy.xstate.json`" in text and "1. Create a machine of XState 5 from 'toy.xstate.json'" in text
    assert all(loss in text for loss in report.losses)
    registry.write_for_target(toy.project(), "xstate", tmp_path)  # it is replaced without a question


def test_many_files_of_one_kind_are_counted():
    text = make_readme("vrma", "VRM animations", "files", "a", [f"{n}.vrma" for n in range(20)], ())
    assert "| `*.vrma` | an animation for each action; 20 files |" in text and "Nothing." in text


def test_the_readme_of_every_export_says_what_each_of_its_files_is(few, tmp_path):
    """Where there is a figure to export; the guides that targets write themselves say it in their own words."""
    project = open_project(few).project
    mesh = Path(__file__).parents[2] / "sample_clips" / "mannequin.glb"
    for target, steps in STEPS.items():
        if not steps.guide:
            registry.write_for_target(project, target, tmp_path / target, Contents(mesh))
            text = (tmp_path / target / README).read_text(encoding="utf-8")
            rows = re.findall(r"^\| `(.*)` \| (.*) \|$", text, re.MULTILINE)
            assert rows and all(words for _, words in rows), (target, rows)
            assert len(rows) < 16, target
