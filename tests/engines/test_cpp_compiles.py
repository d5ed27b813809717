"""All that is written in C++ for users, and what tests make of it, is C++17 without a warning. That it also does
what it should is seen at night (`test_runtime_cpp.py`, `test_runtime_unreal.py`), since to make a program of it
takes four times as long.
"""

from __future__ import annotations

from pathlib import Path

from metagraph.graph.model import Project
from tests.engines.cpp_program import compiled, every_part, needs_compiler, write_probe
from tests.unchanged import only_when_changed

pytestmark = [needs_compiler, *only_when_changed("warnings of C++")]


def test_the_core_the_plugin_the_example_and_the_programs_of_tests_compile_without_a_warning(
    sample: Project, tmp_path: Path
) -> None:
    places = write_probe(tmp_path, every_part(sample))
    compiled(tmp_path / "probe.cpp", tmp_path / "none", "-fsyntax-only", *places)
