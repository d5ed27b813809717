"""What `metagraph render` cannot do as asked is refused in words."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from app.cli.parser import main
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.store import save_project

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"


def test_options_of_bvh_are_for_bvh(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for option in (["--bvh-order", "yxz"], ["--bvh-metres"]):
        assert main(["render", str(SAMPLE), "-o", str(tmp_path / "a.npz"), *option]) == 1
        assert "--bvh-order and --bvh-metres are for .bvh files" in capsys.readouterr().err


def test_a_name_that_two_clips_have_is_refused_with_their_ids(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], toy: Any
) -> None:
    project: Any = toy.project()
    first, second = list(project.clips)[:2]
    name = project.clips[first].name
    path = tmp_path / "two.metagraph.yaml"
    for number, ident in enumerate((first, second)):
        file = tmp_path / f"clip{number}.bvh"
        write_bvh(project.clips[ident].motion, file)
        project = replace(
            project, clips={**project.clips, ident: replace(project.clips[ident], name=name, path=file.name)}
        )
    save_project(project, path)
    assert main(["render", str(path), "-o", str(tmp_path / "a.png"), "--clip", name]) == 1
    said = capsys.readouterr().err
    assert f"2 clips are called '{name}'; say which by its id: {first}, {second}" in said
