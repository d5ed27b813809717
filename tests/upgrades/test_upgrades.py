"""What earlier versions wrote is opened for ever: projects, journals, logs of studies, settings.

`<format>/` holds files as they were written then; none is ever made again or changed, each released format
adds a folder of its own. Exports have theirs in tests/engines/old.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from metagraph.formats.project.data import FORMAT, from_data, to_data
from metagraph.formats.project.text import parse_yaml
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import UPGRADES, read_project, save_project
from metagraph.motion.joint_map import JointMap
from metagraph.research.study.logs.log import read_log as read_log
from metagraph.suggest.memory import Memory

HERE = Path(__file__).parent
FORMATS = sorted((p for p in HERE.iterdir() if p.name.isdecimal()), key=lambda p: int(p.name))


def every(pattern: str) -> list[Any]:
    return [pytest.param(p, id=f"{p.parent.name}-{p.name}") for f in FORMATS for p in sorted(f.glob(pattern))]


def test_every_format_there_was_is_kept() -> None:
    assert [int(p.name) for p in FORMATS] == list(range(1, FORMAT + 1))
    assert set(UPGRADES) == set(range(1, FORMAT))


@pytest.mark.parametrize("path", every("*.metagraph.yaml"))
def test_projects_are_read_saved_and_read_again(path: Path, tmp_path: Path) -> None:
    notes: list[str] = []
    project = read_project(path, notes)
    assert not notes and project.name == "First" and project.clips and project.skeleton is not None
    assert project.lines["hello"].text == "Hello there." and project.notes["project"] == "kept for ever"
    save_project(project, tmp_path / "again.metagraph.yaml")
    again = read_project(tmp_path / "again.metagraph.yaml")
    assert to_data(again) == to_data(project)
    said, kept = parse_yaml(path.read_text(encoding="utf-8"))[0], to_data(project)
    lost = [key for key in said if key not in kept and key != "next_id"]
    assert not lost, "a field that was written is not read any more"


@pytest.mark.parametrize("path", every("*.journal"))
def test_journals_are_recovered(path: Path) -> None:
    left = read_journal(path, None)
    assert left is not None and left.project.name == "Second" and left.edits == 2


@pytest.mark.parametrize("path", every("log.jsonl"))
def test_logs_of_studies_are_read(path: Path) -> None:
    log = read_log(path)
    assert not log.problems and not log.torn and [e["type"] for e in log.events] == ["begin", "edit"]


@pytest.mark.parametrize("path", every("*.json"))
def test_settings_are_read(path: Path) -> None:
    from app.project.pattern_files import read_patterns

    rows = json.loads(path.read_bytes())
    match path.stem:
        case "joint_maps":
            assert [JointMap.from_json(row).source for row in rows]
        case "patterns":
            assert read_patterns(path) is not None
        case "memory":
            assert Memory.from_json(rows) is not None
        case "recent":
            assert all(isinstance(name, str) for name in rows)
        case _:
            raise AssertionError(f"nobody reads {path.name}")


def test_a_project_of_a_format_to_come_is_told_and_left_alone() -> None:
    from metagraph.errors import FileError
    from metagraph.formats.store import parse_project

    text = (FORMATS[-1] / "first.metagraph.yaml").read_text(encoding="utf-8")
    newer = text.replace(f"metagraph: {FORMAT}", f"metagraph: {FORMAT + 1}")
    with pytest.raises(FileError, match="newer"):
        parse_project(newer, Path("x"))
    assert from_data(parse_yaml(text)[0]).name == "First"
