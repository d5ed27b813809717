"""What a journal's edits are worked into: the project file as it is, however it was written."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

from metagraph.formats import recovery
from metagraph.formats.project.data import FORMAT, from_data, to_data
from metagraph.formats.project.fields import Data
from metagraph.formats.project.journal import Journal, find_changes, make_journal_path
from metagraph.formats.project.replay import apply_change
from metagraph.formats.project.text import read_text_data
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import SUFFIX, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.model import Project
from tests.formats.test_every_field import whole
from tests.projects import clip, histories
from tests.thorough import many

pytestmark = pytest.mark.usefixtures("numbered_ids")

SAMPLES = Path(__file__).resolve().parents[2] / "sample_clips"


def edited(saved: Path, edit: Callable[[Project], Project]) -> tuple[Path, Project]:
    """Edit the project in a file, and leave the edit in a journal; return that and the project."""
    before = read_project(saved)
    after = edit(before)
    journal = Journal(make_journal_path(saved, "ab12"), saved)
    journal.edit(before, after, "Edit")
    journal.close()
    return journal.path, after


def rename(project: Project) -> Project:
    return edits.rename_project(project, "renamed")


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """A project whose actions say in the file what their clips are."""
    clips = [(f"{n}.glb", 0, f"{n}{n}" * 32, clip(f"{n}")) for n in range(3)]
    project = edits.add_stance(edits.add_clips(Project("show"), clips), "arms", "rest", ["c1"])
    stance = next(iter(project.graphs["arms"].stances))
    path = tmp_path / f"show{SUFFIX}"
    save_project(edits.place_clips(project, ["c2", "c3"], "arms", "gesture", stance), path)
    return path


@settings(
    max_examples=many(15, 200),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(states=histories(6))
def test_what_edits_begin_with_is_what_a_project_of_the_file_is_written_as(
    states: list[Project], tmp_path: Path
) -> None:
    path = tmp_path / f"drawn{SUFFIX}"
    save_project(states[-1], path)
    journal, after = edited(path, lambda p: replace(rename(p), name=f"{p.name} renamed"))
    left = read_journal(journal, path)
    assert left is not None and left.base == to_data(read_project(path))
    assert left.project == after == from_data(to_data(after))
    journal.unlink()


@pytest.mark.parametrize("name", ["sample", "seated", "practice"])
def test_the_samples_are_known_from_their_text_as_from_their_projects(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}{SUFFIX}"
    save_project(read_project(SAMPLES / f"{name}{SUFFIX}"), path)
    left = read_journal(edited(path, rename)[0], path)
    assert left is not None and left.base == to_data(read_project(path))


def test_one_project_is_made_of_a_file_as_it_was_saved(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = []
    monkeypatch.setattr(recovery, "from_data", lambda *a: made.append(1) or from_data(*a))
    monkeypatch.setattr(recovery, "read_project", lambda *a: pytest.fail("it is read twice"))
    journal, after = edited(saved, rename)
    left = read_journal(journal, saved)
    assert left is not None and left.project == after and len(made) == 1


def in_other_words(change: Callable[[Data], object]) -> Callable[[str], str]:
    """Return what changes the data of a text and writes it as no Metagraph does."""

    def written(text: str) -> str:
        data = read_text_data(text)[0]
        change(data)
        return json.dumps(data)

    return written


@pytest.mark.parametrize(
    "by_hand",
    [
        lambda text: text + "# a comment\n",
        lambda text: text.replace("name: show", "name: 'show'"),
        lambda text: text.replace(f"metagraph: {FORMAT}", "metagraph: 1\nnext_id: 7"),
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", "\r\n"),
        in_other_words(lambda data: data.pop("layers")),
        in_other_words(lambda data: data["layers"].update(body=None)),
        in_other_words(lambda data: data["layers"]["head"].pop("actions")),
        in_other_words(lambda data: data.update(layers={}, clips=[])),
        in_other_words(lambda data: data.update(settings=None, language=None, manual=None)),
        in_other_words(lambda data: data.pop("name")),
    ],
)
def test_a_file_that_was_written_by_hand_is_worked_into_as_it_is_read(
    saved: Path, by_hand: Callable[[str], str]
) -> None:
    text = saved.read_text(encoding="utf-8")
    saved.write_bytes(by_hand(text).encode())
    assert saved.read_bytes() != text.encode()
    journal, after = edited(saved, rename)
    left = read_journal(journal, saved)
    assert left is not None and not left.is_damaged and not left.behind
    assert left.project == after and left.common == read_project(saved)


def test_a_clip_that_another_took_the_place_of_is_still_told_of_after_recovering(saved: Path) -> None:
    text = saved.read_text(encoding="utf-8")
    swapped = re.sub(r'clip_sha256: "?11+"?', "clip_sha256: abcdefabcdef", text)
    saved.write_text(swapped, encoding="utf-8")
    assert swapped != text
    journal, after = edited(saved, rename)
    left = read_journal(journal, saved)
    assert left is not None and left.project == after and left.base == to_data(read_project(saved))


# --- what is written of an edit


def test_whatever_of_a_project_is_saved_is_written_of_an_edit() -> None:
    project = from_data(whole())
    same = [
        field.name
        for field in fields(Project)
        if field.compare and getattr(project, field.name) == getattr(Project(), field.name)
    ]
    assert not same, "the test has nothing of them to take away"
    for field in fields(Project):
        if field.compare:
            assert find_changes(project, replace(project, **{field.name: getattr(Project(), field.name)}))


def test_the_language_of_conversations_is_there_after_a_crash(saved: Path) -> None:
    journal, after = edited(saved, lambda p: conversation_edits.set_language(p, "de"))
    left = read_journal(journal, saved)
    assert left is not None and left.project.language == after.language == "de"
    back = conversation_edits.set_language(after, "auto")
    assert (
        apply_change(to_data(after), find_changes(after, back))
        == to_data(back)
        == to_data(read_project(saved))
    )
