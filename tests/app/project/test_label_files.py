"""Files of labels, chosen or dropped: actions are placed and changed, with the clips beside them, in one step."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog

from app.project.label_files import find_clips_beside
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.clips import read_clips

pytestmark = pytest.mark.window


@pytest.fixture
def labels(tmp_path, toys):
    """A clip and labels as another program leaves them: one new action, one changed, one that cannot be."""
    project = toys.document.project
    known = next(a for a in project.actions() if a.kind == "gesture")
    motion = project.clips[known.clip].motion
    write_bvh(motion, tmp_path / "back.bvh")
    shutil.copy(tmp_path / "back.bvh", tmp_path / "other.bvh")
    (name,) = (clip.name for clip in read_clips(tmp_path / "back.bvh"))
    stance = project.graphs["arms"].stances[known.stance].name if known.layer == "arms" else "apart"
    rows = [
        {"clip": name, "name": "new there", "kind": "gesture", "layer": "arms", "stance": stance},
        {"clip": project.clips[known.clip].name, "action": known.id, "name": "renamed there"},
        {"clip": "nowhere", "name": "lost", "kind": "gesture", "layer": "arms", "stance": "x"},
    ]
    (tmp_path / "back.labels.json").write_text(json.dumps({"labels": 1, "actions": rows}))
    return tmp_path / "back.labels.json", known.id


@pytest.mark.nightly
def test_chosen_labels_are_taken_in_as_one_step(toys, labels, monkeypatch):
    path, known = labels
    before = toys.document.project
    told, reported = [], []
    toys.importing.told.connect(told.append)
    toys.importing.report.connect(lambda title, lines: reported.append((title, lines)))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(path), ""))
    toys.do("import_labels")
    toys.wait(lambda: toys.document.project.action(known).name == "renamed there")
    assert told[-1] == "Labelled 2 of 3 actions"
    ((title, lines),) = reported
    assert title == told[-1] and any("nowhere" in line for line in lines)
    (new,) = (a for a in toys.document.project.actions() if a.name == "new there")
    assert Path(toys.document.project.clips[new.clip].path).name == "back.bvh"
    assert len(toys.document.project.clips) == len(before.clips) + 1
    toys.document.undo()
    assert toys.document.project is before


@pytest.mark.nightly
def test_dropped_labels_are_taken_in_and_a_broken_file_is_told(toys, labels, tmp_path, monkeypatch):
    path, known = labels
    toys.importing.import_paths([str(path)])
    toys.wait(lambda: toys.document.project.action(known).name == "renamed there")
    bad = tmp_path / "bad.labels.json"
    bad.write_text("{")
    shown = []
    monkeypatch.setattr(toys.files, "show_failure", lambda *words: shown.append(words))
    before = toys.document.project
    toys.importing.import_paths([str(bad)])
    toys.wait(lambda: bool(shown))
    assert toys.document.project is before and "docs/animators/label-files.md" in str(shown[0])


def test_clips_that_are_called_as_the_labels_are_come_with_them(labels):
    path, _ = labels
    assert [p.name for p in find_clips_beside(path)] == ["back.bvh"]
