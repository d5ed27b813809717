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


def test_a_clip_that_is_not_there_is_refused_with_the_names_of_those_that_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], toy: Any
) -> None:
    project: Any = toy.project()
    path = tmp_path / "made.metagraph.yaml"
    names = ["hh, own, seed 1", *(f"other {n}" for n in range(30))]
    clips = dict(project.clips)
    motion = next(iter(clips.values())).motion
    made = {}
    for n, name in enumerate(names):
        write_bvh(motion, tmp_path / f"clip{n}.bvh")
        entry = next(iter(clips.values()))
        made[f"c{n}"] = replace(entry, id=f"c{n}", name=name, path=f"clip{n}.bvh")
    save_project(replace(project, clips={**clips, **made}), path)
    assert main(["render", str(path), "-o", str(tmp_path / "a.png"), "--clip", "hh"]) == 1
    said = capsys.readouterr().err
    assert "there is no clip 'hh' in the project; its clips are 'hh, own, seed 1', " in said
    assert " more" in said


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
