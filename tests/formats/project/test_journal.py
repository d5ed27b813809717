"""The autosave journal: whatever was finished is there after a crash, whatever the crash left of the file."""

from __future__ import annotations

import json
import os
import random
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.locking import make_owner
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.journal import Journal, find_changes, make_journal_path
from metagraph.formats.project.replay import apply_change
from metagraph.formats.recovery import find_left_journals, read_journal, recover
from metagraph.formats.store import (
    SUFFIX,
    compute_content_digest,
    compute_file_digest,
    encode_project,
    save_project,
)
from metagraph.graph import edits
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import Conversation, Rates, Segment, Side, Word
from metagraph.graph.model import Action, Project
from tests.processes import started
from tests.projects import clip, histories
from tests.sittings import kill_sittings

pytestmark = pytest.mark.usefixtures("numbered_ids")

ROOT = Path(__file__).resolve().parents[3]


def large(count: int) -> Project:
    project = edits.add_clips(
        Project("large"), [(f"clips/{n}.glb", 0, "ab" * 32, clip(f"clip {n}")) for n in range(20)]
    )
    project = edits.add_stance(project, "arms", "rest", ["c1"])
    made = {  # numbered as edits would, which take seconds to count so many
        f"a{n}": Action(f"a{n}", f"c{1 + n % 20}", "gesture", "arms", "s21", f"clip {n % 20}")
        for n in range(23, 23 + count)
    }
    graph = project.graphs["arms"]
    graph = replace(graph, actions={**graph.actions, **made})
    return replace(project, graphs={**project.graphs, "arms": graph})


# --- changes


@pytest.mark.nightly
@settings(max_examples=120, deadline=None)
@given(histories())
def test_changes_worked_into_the_old_data_give_the_new(states: list[Project]) -> None:
    data = to_data(states[0])
    for before, after in pairwise(states):
        change = json.loads(json.dumps(find_changes(before, after)))
        data = apply_change(data, change)
        assert data == to_data(after)
        for layer in ("body", "arms", "head"):  # order counts where it is order
            assert [a["id"] for a in data["layers"][layer]["actions"]] == list(after.graphs[layer].actions)


@settings(max_examples=40, deadline=None)
@given(histories(6), st.data())
def test_changes_lead_from_any_state_to_any_other(states: list[Project], data: Any) -> None:
    a, b = data.draw(st.sampled_from(states)), data.draw(st.sampled_from(states))
    assert from_data(apply_change(to_data(a), find_changes(a, b))) == from_data(to_data(b))


def test_the_same_project_has_no_changes() -> None:
    project = large(3)
    assert find_changes(project, project) == {}
    assert find_changes(project, replace(project, clips=dict(project.clips))) == {}


def test_what_differs_is_the_same_however_often_and_between_whatever_it_is_asked() -> None:
    first = large(3)
    second = edits.add_stance(first, "body", "standing")
    assert find_changes(first, second) == find_changes(first, second) != {}
    back = find_changes(second, first)
    assert back["layers"]["body"]["stances"] == {next(iter(second.graphs["body"].stances)): None}
    assert find_changes(first, first) == {}


@pytest.mark.parametrize(
    "edit",
    [
        lambda p: edits.update_actions(p, ["a50"], likelihood=2.0),
        lambda p: edits.remove_actions(p, ["a50", "a7000"]),
        lambda p: edits.place_clips(p, ["c1"], "arms", "fidget", "s21"),
        lambda p: edits.rename_stance(p, "s21", "at ease"),
        lambda p: edits.set_weight(p, "arms", "head", 0.5),
        lambda p: edits.rename_clip(p, "c7", "other"),
    ],
)
def test_a_record_is_small_in_a_large_project_also_when_the_edit_is_undone(edit: Any) -> None:
    before = large(10_000)
    after = edit(before)
    assert len(json.dumps(find_changes(before, after))) < 400
    assert len(json.dumps(find_changes(after, before))) < 800


def test_what_was_removed_comes_back_to_its_place() -> None:
    before = large(6)
    after = edits.remove_actions(before, [a.id for a in list(before.graphs["arms"].actions.values())[:4]])
    change = find_changes(after, before)
    assert "actions_order" not in change["layers"]["arms"]
    assert [a["id"] for a in apply_change(to_data(after), change)["layers"]["arms"]["actions"]] == list(
        before.graphs["arms"].actions
    )


# --- the file


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / f"show{SUFFIX}"
    save_project(large(5), path)
    return path


def written(saved: Path | None, path: Path, count: int) -> list[Project]:
    """Write a journal of `count` edits; return every state."""
    states = [large(5)]
    journal = Journal(path, saved)
    if saved is None:
        journal.begin(states[0])
    for n in range(count):
        states.append(edits.rename_clip(states[-1], "c1", f"name {n}"))
        journal.edit(states[-2], states[-1])
    journal.close()
    return states


def same(project: Project, other: Project) -> bool:
    return to_data(project) == to_data(other)


def test_every_finished_edit_is_there_at_once(saved: Path) -> None:
    path = make_journal_path(saved)
    journal = Journal(path, saved)
    project = large(5)
    assert recover(path, saved) is None
    for n in range(3):
        after = edits.rename_clip(project, "c1", f"name {n}")
        journal.edit(project, after)
        project = after
        found = recover(path, saved)
        assert found is not None
        assert found[1] == n + 1
        assert same(found[0], project)
    journal.remove()
    assert recover(path, saved) is None
    assert not path.exists()


def test_nothing_is_written_before_the_first_edit_or_for_no_change(saved: Path) -> None:
    path = make_journal_path(saved)
    journal = Journal(path, saved)
    journal.edit(large(5), large(5).with_graph(large(5).graphs["arms"]))
    assert not path.exists()
    journal.remove()


def test_a_project_never_saved_is_recovered_from_the_journal_alone(tmp_path: Path) -> None:
    states = written(None, tmp_path / "j", 3)
    found = recover(tmp_path / "j", None)
    assert found is not None
    assert same(found[0], states[-1])


def test_undone_edits_are_recovered_undone(saved: Path) -> None:
    path = make_journal_path(saved)
    a = large(5)
    b = edits.remove_actions(a, ["a23", "a24"])
    journal = Journal(path, saved)
    for before, after in ((a, b), (b, a), (a, b), (b, a)):
        journal.edit(before, after)
    journal.close()
    found = recover(path, saved)
    assert found is not None
    assert same(found[0], a)
    assert list(found[0].graphs["arms"].actions) == list(a.graphs["arms"].actions)


@pytest.mark.nightly
def test_a_torn_file_gives_every_edit_before_the_tear(saved: Path) -> None:
    path = make_journal_path(saved)
    states = written(saved, path, 6)
    whole = path.read_bytes()
    ends = [found.start() for found in re.finditer(rb"\n\n", whole)][2:]  # of the edits' records
    for length in range(0, len(whole) + 1, 7):
        path.write_bytes(whole[:length])
        edits_left = sum(end <= length for end in ends)
        found = recover(path, saved)
        assert (found is None) == (edits_left == 0)
        if found is not None:
            assert found[1] == edits_left
            assert same(found[0], states[edits_left])


@pytest.mark.parametrize(
    "tail",
    [
        b"\x00" * 500 + b"\n",
        b"garbage\n",
        b"[1]\n",
        b'{"clips": {"c1": {"id": 7}}}\n',
        b"\xff\xfe\n",
        b"[" * 9999 + b"\n",
        b'{"layers": 3}\n',
    ],
)
def test_garbage_behind_good_edits_takes_nothing_of_them_away(saved: Path, tail: bytes) -> None:
    path = make_journal_path(saved)
    states = written(saved, path, 3)
    path.write_bytes(path.read_bytes() + tail + b'{"name": "after the garbage"}\n')
    found = recover(path, saved)
    assert found is not None
    assert found[1] == 3
    assert same(found[0], states[-1])


@pytest.mark.parametrize("content", [b"", b"\n", b'{"sav'])
def test_a_file_with_no_edit_is_nothing_to_recover(saved: Path, content: bytes) -> None:
    path = make_journal_path(saved)
    path.write_bytes(content)
    assert recover(path, saved) is None


@pytest.mark.parametrize("content", [b"\x00\n\x00\n", b"{}\n{}\n", b"[]\n{}\n", b"x", b"{}\n"])
def test_a_journal_nobody_can_read_is_kept_and_told(saved: Path, content: bytes) -> None:
    path = make_journal_path(saved)
    path.write_bytes(content)
    with pytest.raises(FileError, match=r"damaged.*kept"):
        recover(path, saved)
    assert path.read_bytes() == content


def test_a_journal_of_which_no_edit_is_good_is_kept_and_told(saved: Path) -> None:
    path = make_journal_path(saved)
    written(saved, path, 0)
    journal = Journal(path, saved)
    journal.begin()
    journal.close()
    path.write_bytes(path.read_bytes() + b'{"clips": 3}\n')
    with pytest.raises(FileError, match=r"is damaged"):
        recover(path, saved)


def test_a_journal_of_another_state_of_the_file_is_refused_and_kept(saved: Path) -> None:
    path = make_journal_path(saved)
    written(saved, path, 3)
    content = path.read_bytes()
    save_project(edits.rename_project(large(5), "other"), saved)
    with pytest.raises(FileError, match=r"another state .*kept"):
        recover(path, saved)
    assert path.read_bytes() == content


def test_a_journal_knows_the_file_as_it_was_when_the_edits_began(saved: Path) -> None:
    path = make_journal_path(saved)
    journal = Journal(path, saved)
    save_project(edits.rename_project(large(5), "changed by somebody else"), saved)
    journal.edit(large(5), edits.rename_clip(large(5), "c1", "x"))
    journal.close()
    with pytest.raises(FileError, match="another state"):
        recover(path, saved)


def test_there_is_no_journal_where_there_is_no_file(tmp_path: Path) -> None:
    assert recover(tmp_path / "none", None) is None
    assert recover(tmp_path, None) is None


# --- saving while edits go on


@pytest.fixture
def kept() -> Iterator[Callable[..., Journal]]:
    """Makes journals, and closes them in the end."""
    made: list[Journal] = []

    def make(*words: Any) -> Journal:
        made.append(Journal(*words))
        return made[-1]

    yield make
    for journal in made:
        journal.close()


@pytest.mark.parametrize("written", [False, True])
def test_edits_made_while_saving_are_known_whichever_file_a_crash_leaves(
    saved: Path, kept: Callable[..., Journal], written: bool
) -> None:
    path = make_journal_path(saved)
    states = [large(5)]
    for n in range(5):
        states.append(edits.rename_clip(states[-1], "c1", f"name {n}"))
    journal = kept(path, saved)
    journal.edit(states[0], states[1])
    journal.edit(states[1], states[2])
    mark = journal.mark()
    assert mark is not None
    journal.edit(states[2], states[3])  # while the thread puts the file into words
    journal.settle(mark, compute_content_digest(encode_project(states[2], saved)))
    journal.edit(states[3], states[4])  # while it writes
    if written:
        save_project(states[2], saved)
    journal.edit(states[4], states[5])
    found = recover(path, saved)
    assert found is not None
    assert same(found[0], states[5])
    assert found[1] == (3 if written else 5)


def test_a_journal_of_which_all_was_saved_offers_nothing(saved: Path, kept: Callable[..., Journal]) -> None:
    journal, after = kept(make_journal_path(saved), saved), edits.rename_clip(large(5), "c1", "x")
    journal.edit(large(5), after)
    mark = journal.mark()
    assert mark is not None
    journal.settle(mark, compute_content_digest(encode_project(after, saved)))
    save_project(after, saved)
    assert recover(journal.path, saved) is None


def test_nothing_is_marked_before_the_first_edit(saved: Path, kept: Callable[..., Journal]) -> None:
    journal = kept(make_journal_path(saved), saved)
    assert journal.mark() is None
    assert not journal.path.exists()


def test_the_last_of_several_savings_counts(saved: Path, kept: Callable[..., Journal]) -> None:
    journal, states = kept(make_journal_path(saved), saved), [large(5)]
    for n in range(6):
        states.append(edits.rename_clip(states[-1], "c1", f"name {n}"))
        journal.edit(states[-2], states[-1])
        if n in (1, 3):
            mark = journal.mark()
            assert mark is not None
            journal.settle(mark, compute_content_digest(encode_project(states[-1], saved)))
            save_project(states[-1], saved)
    found = recover(journal.path, saved)
    assert found is not None
    assert same(found[0], states[-1]) and found[1] == 2


def test_edits_that_were_recovered_and_killed_before_the_next_are_there_still(
    saved: Path, kept: Callable[..., Journal]
) -> None:
    journal, project = kept(make_journal_path(saved), saved), edits.rename_clip(large(5), "c1", "recovered")
    journal.begin(project, unsaved=3)
    found = recover(journal.path, saved)
    assert found is not None
    assert same(found[0], project) and found[1] == 3


def test_a_project_in_a_journal_without_an_edit_is_nothing_to_recover(
    saved: Path, kept: Callable[..., Journal]
) -> None:
    journal = kept(make_journal_path(saved), saved)
    journal.begin(large(5))
    assert recover(journal.path, saved) is None


# --- sittings


def test_a_journal_that_holds_its_project_is_read_though_the_file_has_changed(
    saved: Path, kept: Callable[..., Journal]
) -> None:
    journal, after = (
        kept(make_journal_path(saved, "ab"), saved, make_owner()),
        edits.rename_clip(large(5), "c1", "mine"),
    )
    before = compute_file_digest(saved)
    journal.begin(large(5))
    journal.edit(large(5), after)
    save_project(edits.rename_project(large(5), "theirs"), saved)
    found = read_journal(journal.path, saved)
    assert found is not None
    assert same(found.project, after)
    assert found.behind and found.digest == before, "saving it has to ask"
    with pytest.raises(FileError, match="another state"):
        recover(journal.path, saved)


def test_the_journal_of_a_sitting_that_goes_on_is_not_offered_and_those_of_dead_ones_are(
    saved: Path, kept: Callable[..., Journal]
) -> None:
    after, paths = edits.rename_clip(large(5), "c1", "x"), []
    for sitting in ("a1", "b2", ""):
        journal = kept(make_journal_path(saved, sitting), saved, make_owner() if sitting else None)
        journal.edit(large(5), after)
        journal.close()
        paths.append(journal.path)
    assert find_left_journals(saved) == [paths[2]], (
        "one that does not say whose it is was written before they did"
    )
    kill_sittings(saved.parent)
    assert sorted(find_left_journals(saved)) == sorted(paths)


def test_the_journals_of_other_projects_beside_it_are_not_its_own(
    saved: Path, kept: Callable[..., Journal]
) -> None:
    for name in (f"a{saved.name}", f"{saved.name}.copy", "x"):
        journal = kept(make_journal_path(saved.with_name(name), "ab"), None)
        journal.begin(large(1), 1)
        journal.close()
    assert find_left_journals(saved) == []
    assert find_left_journals(saved.parent / "no such folder" / "x") == []


def test_beginning_anew_never_leaves_less_than_before(
    saved: Path, kept: Callable[..., Journal], monkeypatch: pytest.MonkeyPatch
) -> None:
    journal, after = kept(make_journal_path(saved), saved), edits.rename_clip(large(5), "c1", "x")
    journal.edit(large(5), after)

    def stop(*args: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", stop)  # killed just then
    with pytest.raises(KeyboardInterrupt):
        journal.begin(after, 1)
    found = recover(journal.path, saved)
    assert found is not None and same(found[0], after)


def test_a_folder_that_cannot_be_written_is_told_in_words(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    journal = Journal(tmp_path / "file" / "j", None)
    with pytest.raises(FileError, match="cannot be written"):
        journal.edit(large(1), large(2))


@pytest.mark.nightly
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.randoms(use_true_random=False))
def test_a_journal_with_bytes_changed_gives_a_project_or_an_error_in_words(
    saved: Path, chance: random.Random
) -> None:
    path = make_journal_path(saved)
    written(saved, path, 3)
    content = bytearray(path.read_bytes())
    for _ in range(chance.randint(1, 4)):
        content[chance.randrange(len(content))] = chance.randrange(256)
    path.write_bytes(content)
    try:
        recover(path, saved)
    except FileError as error:
        assert error.cause and error.where and error.remedy


CHILD = """
import sys
from pathlib import Path
from metagraph.formats.project.journal import Journal, make_journal_path
from metagraph.formats.store import read_project
from metagraph.graph import edits

saved = Path(sys.argv[1])
project = read_project(saved)
journal = Journal(make_journal_path(saved), saved)
n = 0
while True:
    after = edits.rename_clip(project, "c1", f"name {n}")
    journal.edit(project, after)
    project = after
    print(n, flush=True)
    n += 1
"""


@pytest.mark.skipif(os.name == "nt", reason="there is no kill -9 on Windows")
def test_a_process_killed_between_edits_loses_none_that_was_finished(saved: Path) -> None:
    with started(sys.executable, "-c", CHILD, saved, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        finished = -1
        for line in child.stdout:
            finished = int(line)
            if finished >= 25:
                break
        os.kill(child.pid, signal.SIGKILL)
        rest = child.stdout.read().split()
    finished = int(rest[-1]) if rest else finished
    found = recover(make_journal_path(saved), saved)
    assert found is not None
    assert found[1] >= finished + 1  # at most one more, whose number was not printed yet
    assert found[0].clips["c1"].name == f"name {found[1] - 1}"


# --- conversations


def talk(words: int, segments: int) -> Project:
    """A conversation whose first side has some words, three a segment; the second says as many, but is not
    segmented.
    """
    said = tuple(Word(text=f"wörd{n}", start=n / 3, end=n / 3 + 0.3) for n in range(words))
    clauses = tuple(Segment("clause", float(n), n + 0.9, n + 0.1 + 0.2, "a b c") for n in range(segments))
    sides = (Side(name="Ada", words=said, segments=clauses, rates=Rates(clause=0.5)), Side(words=said))
    return conversation_edits.add_conversation(
        Project("talk"), Conversation(name="x", length=words / 3 + 1, sides=sides)
    )[0]


def test_what_a_conversation_is_kept_as_is_what_its_type_says() -> None:
    project = talk(6, 2)
    (kept,) = to_data(project)["conversations"].values()
    plain = msgspec.to_builtins(next(iter(project.conversations.values())))
    assert list(kept["sides"][0]) == list(plain["sides"][0]), "in the same order"
    assert kept["sides"][0]["words"][1] == {"text": "wörd1", "start": 0.333333, "end": 0.633333}
    assert kept["sides"][1] == {"words": kept["sides"][0]["words"]}
    assert kept["sides"][0]["segments"] == [
        {**s, "peak": round(s["peak"], 6)} for s in plain["sides"][0]["segments"]
    ]


def test_edits_of_a_conversation_are_recovered_and_do_not_touch_its_words_again(tmp_path: Path) -> None:
    from metagraph.formats.project import data

    states = [talk(300, 100)]
    (ident,) = states[0].conversations
    for at in (0, 5, 7):
        states.append(conversation_edits.move_segment(states[-1], ident, 0, at, 0.05))
    states.append(
        conversation_edits.change_side(states[-1], ident, 1, name="Ben \udcff")
    )  # what a name that is no text becomes
    journal = Journal(tmp_path / "journal", None)
    journal.begin(states[0])
    before = data._rows_data.cache_info().misses
    for a, b in pairwise(states):
        journal.edit(a, b)
    journal.close()
    assert data._rows_data.cache_info().misses - before <= 3, "one list of segments an edit, no words"
    found = recover(tmp_path / "journal", None)
    assert found is not None and found[1] == 4
    assert found[0].conversations == from_data(to_data(states[-1])).conversations


def test_a_skeleton_that_was_read_twice_is_no_change_and_another_is(tmp_path: Path) -> None:
    project = large(2)
    again = from_data(to_data(project))
    assert project.skeleton is not again.skeleton and "skeleton" not in find_changes(project, again)
    assert find_changes(project, replace(again, skeleton=None))["skeleton"] == []
