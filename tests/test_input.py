"""What projects, journals and batches do with names and texts that cannot be written, and with files that one
reader trips over.
"""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from app.project.opening import open_whole
from metagraph.common import files
from metagraph.engines.targets import registry
from metagraph.formats import clips
from metagraph.formats.bvh import file as bvh
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.imports import import_files
from metagraph.formats.project.journal import Journal
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import open_project, read_project, save_project
from metagraph.graph.model import Project
from metagraph.graph.requests import Line

ODD = "a\ud800b"
posix = pytest.mark.skipif(sys.platform != "linux", reason="other systems take no such names")


def test_half_a_character_in_a_journal_is_opened_saved_and_exported(toy: Any, tmp_path: Path) -> None:
    project = toy.project()
    odd = replace(project, name=ODD, lines={ODD: Line(text=ODD)}, notes={"project": ODD}, points={})
    journal = Journal(tmp_path / "j", None)
    journal.begin(project, 1)
    journal.edit(project, odd, ODD)
    journal.close()
    left = read_journal(tmp_path / "j", None)
    assert left is not None and left.project.name == "a\ufffdb"
    json.dumps(left.project.notes["project"], ensure_ascii=False).encode()
    for n, one in enumerate((left.project, odd)):
        save_project(one, tmp_path / f"{n}.metagraph.yaml")
        assert read_project(tmp_path / f"{n}.metagraph.yaml").name == "a\ufffdb"
    made = registry.write_for_target(odd, "metagraph", tmp_path / "out")
    assert "a\ufffdb" in made.files[0].read_text(encoding="utf-8")


@posix
def test_a_project_in_a_folder_of_any_name_is_opened_and_takes_clips(toy: Any, tmp_path: Path) -> None:
    folder = tmp_path / os.fsdecode(b"f\xff")
    try:
        folder.mkdir()
    except OSError:
        pytest.skip("this disk takes no such name")
    path = folder / os.fsdecode(b"p\xfe.metagraph.yaml")
    write_bvh(toy.clip("wave", 0.5), folder / "wave.bvh")
    write_bvh(toy.clip("bad", 0.5), folder / os.fsdecode(b"bad\xff.bvh"))
    read = import_files(Project(), folder, [folder])
    assert [name for name, *_ in read.loaded] == ["wave.bvh"]
    assert len(read.failures) == 1 and "not text" in read.failures[0] and read.failures[0].isprintable()
    save_project(read.into(Project()), path)
    opened = open_whole(path)
    assert not opened.notes and len(opened.project.clips) == 1


@pytest.mark.parametrize("name", ["x" * 5000, "x/" * 2400, "a\0b", "..", "/dev/zero", "pipe", "a\\b" * 2000])
def test_a_project_opens_whatever_its_files_are_called(toy: Any, tmp_path: Path, name: str) -> None:
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
    project = toy.project()
    some = {i: replace(e, path=name, motion=None, source=None) for i, e in project.clips.items()}
    lines = {"a": Line(audio=name), "p": Line(phones=name)}
    path = tmp_path / "p.metagraph.yaml"
    save_project(replace(project, clips=some, lines=lines, character=name), path)
    assert open_project(path).notes
    opened = open_whole(path)
    assert len(opened.notes) >= 2 and all(len(note) < 2000 for note in opened.notes)


@pytest.mark.parametrize(
    "error", [ZeroDivisionError("x"), MemoryError(), RecursionError(), OSError(36, "long")]
)
def test_a_clip_whose_reader_fails_spoils_no_other(
    toy: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    for name in ("a", "bad", "c"):
        write_bvh(toy.clip(name, 0.5), tmp_path / f"{name}.bvh")
    real = bvh.read_bvh

    def trips(path: Path, *args: Any, **more: Any) -> Any:
        if path.stem == "bad":
            raise error
        return real(path, *args, **more)

    monkeypatch.setattr(bvh, "read_bvh", trips)
    for strict in (True, False):
        monkeypatch.setattr(files, "strict", strict)
        report = clips.import_clips(sorted(tmp_path.glob("*.bvh")))
        assert [p.stem for p, *_ in report.clips] == ["a", "c"]
        assert [f.path.stem for f in report.failures] == ["bad"] and report.failures[0].remedy
