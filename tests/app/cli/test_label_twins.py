"""`metagraph label` says which arm a stance lacks, and makes twins for it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from app.cli.parser import main
from app.project.files import SAMPLE
from metagraph.formats.store import open_project
from metagraph.graph.editing.one_sided import list_one_sided


def test_an_arm_that_has_nothing_is_named_and_gets_twins(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "clips"
    folder.mkdir()
    names = sorted((SAMPLE.parent / "clips").glob("arms_crossed__*.glb"))
    for path in names:
        if "__to__" not in path.name:
            shutil.copy(path, folder)
    words = ["label", str(folder), "--no-pictures", "--play", "0", "--json"]
    main(words)
    shown = capsys.readouterr()
    (lacking,) = json.loads(shown.out)["one arm"].values()
    assert lacking["lacks"] == "left" and lacking["actions"] > 2
    assert "of the right arm and none of the left" in shown.err and "--twins adds" in shown.err
    again = tmp_path / "again.metagraph.yaml"
    main([*words, "--twins", "--out", str(again)])
    assert json.loads(capsys.readouterr().out)["twins"] == lacking["actions"]
    project = open_project(again).project
    assert not list_one_sided(project)
    made = [c for c in project.clips.values() if c.path.startswith("mirrored/")]
    assert len(made) == lacking["actions"] and all(c.motion is not None for c in made)


def test_importing_what_has_one_arm_only_names_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "p.metagraph.yaml"
    assert main(["import", str(path), str(SAMPLE), "--json"]) == 0
    shown = capsys.readouterr()
    assert json.loads(shown.out)["one arm"] == dict.fromkeys(
        ("arms crossed", "hand to chin", "hands clasped"), "left"
    )
    assert shown.err.count("one arm: ") == 3 and "--twins adds mirrored twins" in shown.err
    main(["import", str(path), str(SAMPLE), "--json"])
    assert "one arm" not in capsys.readouterr().err, "it was said before"
