"""The README of an export, and what is said to do next."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.engines.targets import registry
from metagraph.engines.targets.next_steps import README, STEPS, list_steps, make_readme
from metagraph.engines.targets.target import Contents
from metagraph.formats.store import open_project
from tests.browsing import MODULES


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
    assert all(loss[1:] in text for loss in report.losses)
    registry.write_for_target(toy.project(), "xstate", tmp_path)  # it is replaced without a question


def test_many_files_of_one_kind_are_counted():
    text = make_readme("vrma", "VRM animations", "files", "a", [f"{n}.vrma" for n in range(20)], ())
    assert "| `*.vrma` | an animation for each action; 20 files |" in text and "Nothing." in text


@pytest.mark.nightly
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


def test_no_export_takes_more_than_three_steps():
    assert all(1 <= len(steps.steps) <= 3 for steps in STEPS.values())


@pytest.mark.skipif(
    shutil.which("node") is None or not (MODULES / "xstate").is_dir(), reason="needs npm's xstate"
)
def test_the_first_lines_for_xstate_run(toy, tmp_path):
    registry.write_for_target(toy.project(), "xstate", tmp_path)
    (tmp_path / "node_modules").symlink_to(MODULES)
    text = (tmp_path / README).read_text(encoding="utf-8")
    (code,) = re.findall(r"```js\n(.*?)```", text, re.DOTALL)
    (tmp_path / "first.mjs").write_text(code + "process.exit(0);\n")
    done = subprocess.run(["node", "first.mjs"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "true" in done.stdout  # a loop plays


@pytest.mark.skipif(shutil.which("g++") is None, reason="needs a C++ compiler (g++)")
@pytest.mark.nightly
def test_the_first_lines_for_cpp_run(toy, tmp_path):
    registry.write_for_target(toy.project(), "cpp", tmp_path)
    (code,) = re.findall(r"```cpp\n(.*?)```", (tmp_path / README).read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "first.cpp").write_text(code)
    subprocess.run(["g++", "-std=c++17", "-O0", "-I.", "first.cpp", "-o", "first"], cwd=tmp_path, check=True)
    done = subprocess.run(["./first"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert float(done.stdout) == pytest.approx(1.0, abs=0.5)  # metres


def test_the_first_lines_for_python_and_javascript_run(toy, tmp_path):
    for target, language, program in (("metagraph", "python", sys.executable), ("javascript", "js", "node")):
        registry.write_for_target(toy.project(), target, tmp_path / target)
        text = (tmp_path / target / README).read_text(encoding="utf-8")
        (code,) = re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)
        name = "first.mjs" if language == "js" else "first.py"
        (tmp_path / target / name).write_text(code)
        if shutil.which(program):
            words = [program, name]
            env = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
            done = subprocess.run(words, cwd=tmp_path / target, capture_output=True, text=True, env=env)
            assert done.returncode == 0, done.stderr
