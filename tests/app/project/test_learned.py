"""What the user taught is kept between projects, by all windows together, and never lost to a broken file."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QLockFile

from app.project import learned as module
from app.project.autosave import state_folder
from app.project.document import Document
from app.project.jobs import Jobs
from app.project.learned import CLIPS, WORDS, Learned
from metagraph.formats.store import open_project, save_project

ROOT = Path(__file__).resolve().parents[3]
NAMES = ["idle_arms_wobble", "idle_arms_shrug", "idle_arms"]


@pytest.fixture
def taught(qapp: object) -> Learned:
    return Learned()


def test_nothing_is_known_at_first_and_no_file_is_made(taught: Learned, qapp: object) -> None:
    assert (
        taught.on
        and taught.patterns.learned == {}
        and taught.examples_for(Document()) == []
        and taught.clips == 0
    )
    assert not (state_folder() / WORDS).exists()


def test_two_windows_do_not_lose_what_the_other_learned(taught: Learned) -> None:
    other = Learned()
    assert other.patterns.learned == {}
    taught.correct("idle_arms_wobble", "kind", "fidget", NAMES)
    other.correct("idle_arms_shrug", "limb", "left", NAMES)
    assert set(taught.patterns.learned) == set(other.patterns.learned) == {"kind", "limb"}
    assert Learned().patterns == taught.patterns


def test_while_learning_is_off_nothing_is_remembered_or_used_but_own_patterns_are(taught: Learned) -> None:
    taught.correct("idle_arms_wobble", "kind", "fidget", NAMES)
    taught.edit(lambda p: p.with_pattern("kinds", "bonk", "gesture"))
    taught.set_on(False)
    taught.correct("idle_arms_shrug", "kind", "fidget", NAMES)
    assert taught.patterns.learned == {} and taught.patterns.meanings["kinds"]["bonk"] == "gesture"
    taught.set_on(True)
    assert set(taught.patterns.learned["kind"]) == {"wobble"}
    taught.forget()
    assert Learned().patterns.learned == {} and Learned().patterns.meanings["kinds"]["bonk"] == "gesture"


def test_a_broken_file_is_set_aside_told_and_learning_goes_on(taught: Learned) -> None:
    told: list[str] = []
    taught.failed.connect(told.append)
    (state_folder() / WORDS).write_text('{"learned": 1, "names": {"patterns": 1, "kinds": 3}}')
    assert taught.patterns.learned == {}
    assert len(told) == 1 and "'names': 'kinds'" in told[0] and "learned-words.broken" in told[0]
    taught.correct("idle_arms_wobble", "kind", "fidget", NAMES)
    assert "kind" in Learned().patterns.learned and (state_folder() / "learned-words.broken").exists()
    (state_folder() / CLIPS).write_bytes(b"\xff\x00 no json")
    assert taught.examples_for(Document()) == [] and len(told) == 2


def test_a_window_that_holds_the_file_for_long_is_told_of(
    taught: Learned, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LOCK_WAIT", 20)
    told: list[str] = []
    taught.failed.connect(told.append)
    lock = QLockFile(str(state_folder() / "learned-words.lock"))
    assert lock.tryLock(0)
    taught.correct("idle_arms_wobble", "kind", "fidget", NAMES)
    lock.unlock()
    assert "another window" in told[0] and taught.patterns.learned == {}


def test_labelled_clips_of_a_saved_project_teach_the_others(
    taught: Learned, tmp_path: Path, qtbot: object
) -> None:
    opened = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    project = replace(
        opened,
        clips={i: replace(c, path=str(ROOT / "sample_clips" / c.path)) for i, c in opened.clips.items()},
    )
    path = tmp_path / "first.metagraph.yaml"
    save_project(project, path, path)
    document, jobs = Document(), Jobs()
    document.load(project, path)
    taught.keep(document, jobs)
    qtbot.waitUntil(lambda: taught.clips == len(project.clips), timeout=20000)  # type: ignore[attr-defined]
    assert taught.examples_for(document) == []
    another = Document()
    another.load(opened, None)
    examples = taught.examples_for(another)
    assert len(examples) == len(project.clips) and all(len(e.measures) for e in examples)
    document.close_journal()
    another.close_journal()
    jobs.stop()


def test_at_closing_only_what_was_saved_and_not_yet_kept_is_kept(taught: Learned, tmp_path: Path) -> None:
    document = Document()
    document.load(
        open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project, tmp_path / "a.metagraph.yaml"
    )
    taught.keep(document)
    assert not (state_folder() / CLIPS).exists()
    stopped = Jobs()
    stopped.stop()
    taught.keep(document, stopped)
    taught.keep(document)
    assert taught.clips == 152
    assert json.loads((state_folder() / CLIPS).read_text())["learned"] == 1
    document.close_journal()
