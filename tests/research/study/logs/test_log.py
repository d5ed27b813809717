"""Logs lose nothing that was written, say what is wrong with them, and add up to the times that were
spent.
"""

from __future__ import annotations

import json
import os
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.research.study.logs.log import TYPES, Writer, read_log


class Clock:
    """A clock that is told what time it is."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def __call__(self) -> float:
        return self.seconds

    def now(self) -> datetime:
        return datetime(2026, 3, 1, 9, tzinfo=UTC) + timedelta(seconds=self.seconds)


@pytest.fixture
def clock() -> Clock:
    return Clock()


class Story:
    """Writes a log in which events are given with the seconds before them."""

    def __init__(self, path: Path, clock: Clock) -> None:
        self.path, self.clock = path, clock
        self.writer = Writer(path, clock, clock.now)
        self.writer.begin(participant="P01")

    def __call__(self, after: float, kind: str, **fields: object) -> None:
        self.clock.seconds += after
        self.writer.add(kind, **fields)

    def restart(self, seconds: float) -> None:
        self.writer.close()
        self.clock.seconds += seconds
        self.writer = Writer(self.path, self.clock, self.clock.now)
        self.writer.begin()

    def log(self):
        self.writer.sync()
        return read_log(self.path)


@pytest.fixture
def story(tmp_path: Path, clock: Clock):
    out = Story(tmp_path / "P01" / "log.jsonl", clock)
    yield out
    out.writer.close()


TASK = {"name": "task", "condition": "meta", "task": "ten", "index": 4}


# --- writing and reading


def test_a_log_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileError, match=r"log\.jsonl"):
        read_log(tmp_path / "log.jsonl")


def test_an_empty_log_has_no_events(tmp_path):
    (tmp_path / "log.jsonl").touch()
    log = read_log(tmp_path / "log.jsonl")
    assert (log.events, log.torn, log.problems, log.tasks(), log.answers()) == ((), False, (), [], [])
    assert log.participant == tmp_path.name


def test_events_are_numbered_and_timed_and_read_back(story):
    story(1.25, "phase", name="consent", state="begin", index=0)
    log = story.log()
    assert [e["n"] for e in log.events] == [0, 1]
    assert log.events[1] | {"run": ""} == {
        "n": 1, "run": "", "mono": 1.25, "wall": "2026-03-01T09:00:01.250Z", "type": "phase",
        "name": "consent", "state": "begin", "index": 0,
    }  # fmt: skip
    assert log.participant == "P01"
    assert not log.problems and not log.torn and not log.complete


def test_an_event_is_in_the_file_as_soon_as_it_is_added(story):
    story(0, "view", what="zoom")
    assert len(story.path.read_bytes().splitlines()) == 2


def test_a_kind_that_there_is_not_is_refused_and_takes_no_number(story):
    with pytest.raises(ValueError, match="'click'"):
        story(0, "click")
    with pytest.raises(TypeError):
        story(0, "note", words=object())
    story(0, "note", words="é\n")
    log = story.log()
    assert [e["n"] for e in log.events] == [0, 1]
    assert log.events[1]["words"] == "é\n"


def test_going_on_tells_where_it_was_left_and_what_time_was_lost(story):
    story(2, "note", words="tea")
    story.restart(40)
    story(1, "end")
    log = story.log()
    assert [e["n"] for e in log.events] == [0, 1, 2, 3]
    assert log.events[2]["type"] == "resumed"
    assert (log.events[2]["after"], log.events[2]["lost"]) == (1, 40.0)
    assert len({e["run"] for e in log.events}) == 2
    assert log.complete


@pytest.mark.parametrize("cut", [1, 2, 7, 30])
def test_a_torn_last_line_is_left_out_and_kept_aside(story, tmp_path, cut):
    story(1, "note", words="kept")
    story(1, "note", words="torn")
    story.writer.close()
    content = story.path.read_bytes()
    story.path.write_bytes(content[:-cut])
    log = read_log(story.path)
    assert log.torn and len(log.events) == 2 and not log.problems
    story.restart(5)
    torn = content[:-cut].rsplit(b"\n", 1)[1]
    assert [p.read_bytes() for p in story.path.parent.glob("log.torn-*")] == [torn]
    assert [e["n"] for e in story.log().events] == [0, 1, 2]
    assert not story.log().torn


def test_lines_that_are_damaged_are_told_and_the_others_kept(story):
    for n in range(5):
        story(1, "note", words=str(n))
    story.writer.close()
    lines = story.path.read_bytes().splitlines(keepends=True)
    lines[2] = b"\x00\xff{\n"
    del lines[4]
    lines.append(lines[-1])
    story.path.write_bytes(b"".join(lines))
    log = read_log(story.path)
    assert [e["n"] for e in log.events] == [0, 1, 3, 5]
    assert [p.split(":")[0] for p in log.problems] == ["line 3", "line 5", "line 6"]
    assert (
        "no JSON" in log.problems[0]
        and "event 4 is missing" in log.problems[1]
        and "there twice" in log.problems[2]
    )


def test_a_number_is_not_used_again_when_the_last_line_cannot_be_read(story):
    story(1, "note", words="x")
    story.writer.close()
    lines = story.path.read_bytes().splitlines(keepends=True)
    story.path.write_bytes(lines[0] + b"broken\n")
    story.restart(1)
    assert [e["n"] for e in story.log().events] == [0, 2]
    assert len(story.log().problems) == 1


@pytest.mark.parametrize(
    ("event", "words"),
    [
        ([], "is no event"), ({}, "has no n"), ({"n": True}, "has no n"),
        ({"n": 0, "run": "a", "mono": 0, "wall": "x", "type": "end"}, "none"),
        ({"n": 0, "run": "a", "mono": 0, "wall": "2026-01-01", "type": "end"}, "time zone"),
        ({"n": 0, "run": "a", "mono": 0, "wall": "2026-01-01T00:00:00Z", "type": "dance"}, "no kind of event"),
    ],
)  # fmt: skip
def test_what_is_no_event_is_told(tmp_path, event, words):
    path = tmp_path / "log.jsonl"
    path.write_text(json.dumps(event) + "\n")
    assert words in read_log(path).problems[0]


@given(st.binary(max_size=300))
def test_whatever_is_in_the_file_is_read_without_an_error(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("fuzz") / "log.jsonl"
    path.write_bytes(content)
    log = read_log(path)
    assert log.tasks() == []


@given(
    st.lists(
        st.fixed_dictionaries(
            {"type": st.sampled_from(TYPES), "mono": st.floats(-1e6, 1e6), "run": st.sampled_from("ab")},
            optional={
                k: st.one_of(
                    st.none(), st.text(max_size=3), st.integers(), st.lists(st.integers(), max_size=2)
                )
                for k in (
                    "name",
                    "state",
                    "index",
                    "K",
                    "drag_s",
                    "clips",
                    "what",
                    "condition",
                    "path",
                    "value",
                    "item",
                )
            },
        ),
        max_size=12,
    )
)
def test_odd_events_add_up_to_something(tmp_path_factory, events):
    path = tmp_path_factory.mktemp("fuzz") / "log.jsonl"
    whole = [{"n": n, "wall": "2026-01-01T00:00:00Z", **e, "name": "task"} for n, e in enumerate(events)]
    path.write_text("".join(json.dumps(e) + "\n" for e in whole))
    log = read_log(path)
    for run in log.tasks():
        assert run.seconds >= 0
        assert sum(run.spent.values()) == pytest.approx(run.seconds)
    log.answers()


def test_a_full_disk_is_told_and_what_could_not_be_written_comes_with_the_next(story, monkeypatch):
    write = os.write

    def full(handle: int, content: bytes) -> int:
        write(handle, content[:9])
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "write", full)
        with pytest.raises(FileError, match="No space left"):
            story(1, "note", words="first")
    assert len(story.log().events) == 1 and not story.log().torn
    story(1, "note", words="second")
    assert [e.get("words") for e in story.log().events] == [None, "first", "second"]


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "P01").write_text("in the way")
    with pytest.raises(FileError, match=r"log\.jsonl"):
        Writer(tmp_path / "P01" / "log.jsonl")


# --- adding up


def test_a_task_takes_its_active_time_without_pauses_absences_and_crashes(story):
    story(9, "phase", state="begin", **TASK)
    story(10, "view", what="layer")
    story(3, "pause", state="begin")
    story(500, "pause", state="end")
    story(20, "edit", what="place", clips=["wave"])
    story(61, "idle", seconds=61)
    story(60, "edit", what="place", clips=["nod"])
    story.restart(3600)
    story(7, "phase", state="end", why="done", **TASK)
    (run,) = story.log().tasks()
    assert (run.participant, run.condition, run.task, run.index) == ("P01", "meta", "ten", 4)
    assert run.seconds == pytest.approx(10 + 3 + 20 + 60 + 7)
    assert (run.paused, run.away) == (500, 61)
    assert run.wall == pytest.approx(10 + 3 + 500 + 20 + 61 + 60 + 3600 + 7)
    assert run.finished and not run.timed_out


def test_a_pause_ends_with_the_program_that_was_killed_in_it(story):
    story(0, "phase", state="begin", **TASK)
    story(5, "pause", state="begin")
    story.restart(100)
    story(5, "phase", state="end", **TASK)
    (run,) = story.log().tasks()
    assert (run.seconds, run.paused) == (10, 0)


def test_operators_edits_undos_and_errors_are_counted_within_the_task(story):
    story(1, "ops", K=50, P=1, B=2, D=0, H=1)
    story(0, "phase", state="begin", **TASK)
    story(1, "ops", K=3, P=2, B=4, D=1, H=1, drag_s=0.75)
    story(0, "edit", what="place", clips=["wave"])
    story(1, "undo", words="x")
    story(1, "redo", words="x")
    story(1, "ops", P=1)
    story(1, "error", what="refused", words="x")
    story(1, "error", what="warning", words="x")
    story(0, "phase", state="end", **TASK)
    story(1, "edit", what="place", clips=["wave"])
    (run,) = story.log().tasks()
    assert run.operators == {"K": 3, "P": 3, "B": 4, "D": 1, "H": 1}
    assert (run.drag_s, run.edits, run.undos, run.errors) == (0.75, 1, 1, 1)


def test_the_time_before_an_edit_belongs_to_its_clips(story):
    story(0, "phase", state="begin", **TASK)
    story(4, "edit", what="place", clips=["wave", "nod"])
    story(1, "edit", what="stance", clips=[])
    story(5, "view", what="layer")
    story(3, "edit", what="timing", clips=["wave"])
    story(30, "phase", state="end", **TASK)
    (run,) = story.log().tasks()
    assert run.per_clip == {"wave": 2 + 9, "nod": 2}
    assert list(run.per_clip) == ["wave", "nod"]


def test_time_is_told_by_what_it_went_into(story):
    story(0, "phase", state="begin", **TASK)
    story(2, "ops", D=1, drag_s=1.5)
    story(1, "edit", what="place", clips=["wave"])  # 1.5 dragging, 1.5 other
    story(4, "playback", what="alone")  # 4 looking
    story(1, "ops", D=1, drag_s=0.5)
    story(2, "edit", what="timing", clips=["wave"])  # 3 timing, its drag with it
    story(5, "undo", words="")  # 5 undoing
    story(6, "phase", state="end", **TASK)  # 6 other
    (run,) = story.log().tasks()
    assert run.spent == {"dragging": 1.5, "timing": 3, "looking": 4, "undoing": 5, "other": 7.5}
    assert sum(run.spent.values()) == pytest.approx(run.seconds)


def test_a_task_that_was_broken_off_is_not_finished_nor_is_one_that_ran_out_of_time(story):
    story(0, "phase", state="begin", **TASK)
    story(8, "artefact", path="4-ten-meta.metagraph.yaml", digest="abc", condition="meta", task="ten")
    story(0, "phase", state="end", why="time", **TASK)
    story(0, "phase", state="begin", **TASK | {"condition": "manual", "index": 5})
    story(2, "edit", what="link", clips=["nod"])
    first, second = story.log().tasks()
    assert (first.finished, first.timed_out, first.artefact, first.digest) == (
        False,
        True,
        "4-ten-meta.metagraph.yaml",
        "abc",
    )
    assert (second.finished, second.timed_out, second.condition, second.seconds) == (
        False,
        False,
        "manual",
        2,
    )


def test_the_last_answer_to_an_item_counts(story):
    about = {"name": "questionnaire", "condition": "meta", "index": 7}
    story(0, "phase", state="begin", **about)
    story(1, "answer", questionnaire="sus", item="sus1", value=4)
    story(1, "answer", questionnaire="sus", item="sus2", value=1)
    story(1, "answer", questionnaire="sus", item="sus1", value=5)
    story(0, "phase", state="end", **about)
    found = story.log().answers()
    assert [(a.item, a.value, a.condition, a.index) for a in found] == [
        ("sus1", 5, "meta", 7),
        ("sus2", 1, "meta", 7),
    ]
